#pragma once

#include <string>

/// Where things lie on this machine. Compiled in one file, so that a checkout in another folder takes all
/// others from the compiler cache.
namespace fw::test {

/// The checkout.
std::string source_directory();

/// The program `federwerk` of this build.
std::string federwerk_executable();

/// A Python with numpy and h5py: scripts/python of the checkout, for a shell.
std::string python_command();

}  // namespace fw::test
