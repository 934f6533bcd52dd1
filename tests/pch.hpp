#pragma once

// What most tests include, compiled once, on top of src/pch.hpp. A test still includes what it uses.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <filesystem>
#include <random>
#include <set>
#include <stdexcept>

#include "../src/pch.hpp"
