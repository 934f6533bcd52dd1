#include "store/trajectory_summary.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "store/hdf5/dataset.hpp"
#include "store/input_file.hpp"

namespace fw::store {

namespace {

std::vector<double> series(hid_t group, const std::string& name, std::size_t frames) {
  record::Column column = read_dataset(group, name);
  auto* values = std::get_if<std::vector<double>>(&column.values);
  if (values == nullptr || values->size() != frames) {
    throw LibraryError(fmt::format("dataset \"{}\" is no series of {} numbers", name, frames));
  }
  return std::move(*values);
}

void read_energies(hid_t group, TrajectorySummary& summary) {
  const std::vector<double> time = series(group, "time", summary.frames);
  const std::vector<double> kinetic = series(group, "kinetic_energy", summary.frames);
  const std::vector<double> potential = series(group, "potential_energy", summary.frames);
  if (time.empty()) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    summary.time_start = summary.time_end = summary.kinetic_start = summary.kinetic_end = nan;
    summary.potential_start = summary.potential_end = summary.drift = summary.largest_drift = nan;
    return;
  }
  summary.time_start = time.front();
  summary.time_end = time.back();
  summary.kinetic_start = kinetic.front();
  summary.kinetic_end = kinetic.back();
  summary.potential_start = potential.front();
  summary.potential_end = potential.back();
  summary.drift = summary.total_end() - summary.total_start();
  for (std::size_t i = 0; i < time.size(); ++i) {
    const double drift = std::abs(kinetic[i] + potential[i] - summary.total_start());
    // a frame that is not a number makes the whole series so
    summary.largest_drift = std::isnan(drift) ? drift : std::max(drift, summary.largest_drift);
    if (std::isnan(drift)) return;
  }
}

}  // namespace

TrajectorySummary read_trajectory_summary(const std::filesystem::path& path) {
  const LibraryLock lock;
  const InputFile file(path);
  if (!has_link(file.id(), "trajectory")) {
    throw InputError(
        fmt::format("\"{}\" holds no trajectory (its kind is \"{}\")", path.string(), file.kind()));
  }
  TrajectorySummary summary;
  summary.attributes = file.attributes();
  try {
    const Handle trajectory = open_group(file.id(), "trajectory");
    const Shape position = dataset_shape(trajectory, "position");
    if (position.size() != 3 || position[2] != 3)
      throw LibraryError("the positions are not of shape (F, n, 3)");
    summary.frames = position[0];
    summary.particles = position[1];
    const Shape springs = dataset_shape(open_group(file.id(), "system"), "springs");
    if (springs.size() != 2 || springs[1] != 2) throw LibraryError("the springs are not of shape (s, 2)");
    summary.springs = springs[0];
    read_energies(trajectory, summary);
    summary.is_driven = has_link(trajectory, "external_power");
    const Handle counters = open_group(file.id(), "counters");
    for (const std::string& name : link_names(counters)) {
      const record::Column column = read_dataset(counters, name);
      std::visit(
          [&]<class T>(const std::vector<T>& values) {
            if constexpr (std::is_arithmetic_v<T>) {
              if (values.size() == 1) summary.counters.emplace_back(name, static_cast<double>(values[0]));
            }
          },
          column.values);
    }
  } catch (const LibraryError& error) {
    throw InputError(fmt::format("\"{}\" is damaged: {}", path.string(), error.what()));
  }
  return summary;
}

}  // namespace fw::store
