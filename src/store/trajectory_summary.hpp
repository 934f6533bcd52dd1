#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "store/hdf5/attribute.hpp"

namespace fw::store {

/// A trajectory in a few numbers. Without frames the times, energies and the drift are NaN.
struct TrajectorySummary {
  Attributes attributes;  ///< of the root
  std::uint64_t frames = 0;
  std::uint64_t particles = 0;
  std::uint64_t springs = 0;
  double time_start = 0.0, time_end = 0.0;            ///< [s]
  double kinetic_start = 0.0, kinetic_end = 0.0;      ///< [J]
  double potential_start = 0.0, potential_end = 0.0;  ///< [J]
  double drift = 0.0;                                 ///< E(end) − E(start) [J]
  double largest_drift = 0.0;                         ///< max over the frames of |E − E(start)| [J]
  bool is_driven = false;  ///< forces or supports over time do work: the energy need not stay
  std::vector<std::pair<std::string, double>> counters;  ///< as in /counters

  double total_start() const { return kinetic_start + potential_start; }
  double total_end() const { return kinetic_end + potential_end; }
};

/// Reads /trajectory, /system and /counters. Throws InputError that names the file.
TrajectorySummary read_trajectory_summary(const std::filesystem::path& path);

}  // namespace fw::store
