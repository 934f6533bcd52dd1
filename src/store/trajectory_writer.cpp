#include "store/trajectory_writer.hpp"

#include <fmt/format.h>

#include <array>

#include "store/file/output_file.hpp"
#include "store/hdf5/extendible_dataset.hpp"

namespace fw::store {

namespace {

void write_system(hid_t file, const mechanics::MassSpringModel& model) {
  const Handle group = make_group(file, "system");
  const mechanics::Springs& springs = model.springs;
  std::vector<std::int32_t> between;
  between.reserve(2 * springs.size());
  for (std::size_t i = 0; i < springs.size(); ++i) {
    between.push_back(springs.first[i]);
    between.push_back(springs.second[i]);
  }
  const bool strain = springs.law == mechanics::SpringLaw::strain;
  write_dataset(group, "mass", "kg", {model.mass.size()}, std::span(model.mass));
  write_dataset(group, "fixed", "1", {model.fixed.size()},
                std::span<const std::int32_t>(model.fixed.data(), model.fixed.size()));
  write_dataset(group, "springs", "1", {springs.size(), 2}, std::span<const std::int32_t>(between));
  write_dataset(group, "stiffness", strain ? "N" : "N/m", {springs.size()}, std::span(springs.stiffness));
  write_dataset(group, "damping", "N*s/m", {springs.size()}, std::span(springs.damping));
  write_dataset(group, "rest_length", "m", {springs.size()}, std::span(springs.rest_length));
}

void write_counters(hid_t file, const Work& work) {
  const Handle group = make_group(file, "counters");
  const auto count = [&](const char* name, std::uint64_t value) {
    const auto number = static_cast<std::int64_t>(value);
    write_dataset(group, name, "1", {}, std::span<const std::int64_t>(&number, 1));
  };
  count("rhs_evaluations", work.rhs_evaluations);
  count("jacobian_evaluations", work.jacobian_evaluations);
  count("jacobian_products", work.jacobian_products);
  count("factorisations", work.factorisations);
  count("linear_solves", work.linear_solves);
  count("linear_iterations", work.linear_iterations);
  count("newton_iterations", work.newton_iterations);
  count("accepted_steps", work.accepted_steps);
  count("rejected_steps", work.rejected_steps);
  write_dataset(group, "seconds", "s", {}, std::span<const double>(&work.seconds, 1));
}

}  // namespace

struct TrajectoryWriter::Datasets {
  explicit Datasets(const std::filesystem::path& path) : file(path) {}

  OutputFile file;
  ExtendibleDataset time, position, velocity, kinetic, potential, total, elastic, gravitational, obstacle,
      linear_momentum, angular_momentum;

  std::array<ExtendibleDataset*, 11> all() {
    return {&time,    &position,      &velocity, &kinetic,         &potential,       &total,
            &elastic, &gravitational, &obstacle, &linear_momentum, &angular_momentum};
  }
};

TrajectoryWriter::TrajectoryWriter(const std::filesystem::path& path, const FileHeader& header,
                                   const mechanics::MassSpringModel& model, QuantitiesOf quantities,
                                   Index expected_frames)
    : quantities_(std::move(quantities)), particles_(static_cast<Index>(model.mass.size())) {
  const LibraryLock lock;
  datasets_ = std::make_unique<Datasets>(path);
  Datasets& d = *datasets_;
  d.file.guarded([&] {
    FileHeader of_trajectory = header;
    of_trajectory.kind = "trajectory";
    write_header(d.file.id(), of_trajectory);
    write_system(d.file.id(), model);
    const Handle group = make_group(d.file.id(), "trajectory");
    const auto frames = static_cast<hsize_t>(std::max<Index>(expected_frames, 1));
    const auto n = static_cast<hsize_t>(particles_);
    const auto make = [&](ExtendibleDataset& dataset, const char* name, const char* unit,
                          const Shape& entry) {
      dataset = ExtendibleDataset(group, name, unit, entry, frames);
    };
    make(d.time, "time", "s", {});
    make(d.position, "position", "m", {n, 3});
    make(d.velocity, "velocity", "m/s", {n, 3});
    make(d.kinetic, "kinetic_energy", "J", {});
    make(d.potential, "potential_energy", "J", {});
    make(d.total, "total_energy", "J", {});
    make(d.elastic, "elastic_energy", "J", {});
    make(d.gravitational, "gravitational_energy", "J", {});
    make(d.obstacle, "obstacle_energy", "J", {});
    make(d.linear_momentum, "linear_momentum", "kg*m/s", {3});
    make(d.angular_momentum, "angular_momentum", "kg*m^2/s", {3});
  });
}

TrajectoryWriter::~TrajectoryWriter() {
  const LibraryLock lock;
  datasets_.reset();
}

void TrajectoryWriter::frame(double time, ConstVectorRef state) {
  if (!datasets_ || !datasets_->file.is_open())
    throw InputError("the trajectory is finished; no frame can be added");
  if (state.size() != 6 * particles_) {
    throw InputError(fmt::format("a frame of {} particles has {} entries; found {}", particles_,
                                 6 * particles_, state.size()));
  }
  const auto q = state.head(3 * particles_), v = state.tail(3 * particles_);
  const FrameQuantities quantities = quantities_(time, q, v);
  const double potential = quantities.elastic + quantities.gravitational + quantities.obstacle;

  const LibraryLock lock;
  Datasets& d = *datasets_;
  const auto number = [](ExtendibleDataset& dataset, const double& value) { dataset.append({&value, 1}); };
  const auto vector = [](ExtendibleDataset& dataset, const Vec3<double>& a) {
    const std::array<double, 3> entries{a.x, a.y, a.z};
    dataset.append(entries);
  };
  const auto size = static_cast<std::size_t>(3 * particles_);
  d.file.guarded([&] {
    number(d.time, time);
    d.position.append({state.data(), size});
    d.velocity.append({state.data() + size, size});
    number(d.kinetic, quantities.kinetic);
    number(d.potential, potential);
    number(d.total, quantities.kinetic + potential);
    number(d.elastic, quantities.elastic);
    number(d.gravitational, quantities.gravitational);
    number(d.obstacle, quantities.obstacle);
    vector(d.linear_momentum, quantities.linear_momentum);
    vector(d.angular_momentum, quantities.angular_momentum);
  });
}

void TrajectoryWriter::finish(const Status& status, const Work& work) {
  if (!datasets_ || !datasets_->file.is_open()) throw InputError("the trajectory is finished already");
  const LibraryLock lock;
  // Whatever happens below, nothing but the published file remains.
  const std::unique_ptr<Datasets> d = std::move(datasets_);
  d->file.guarded([&] {
    for (ExtendibleDataset* dataset : d->all()) {
      dataset->flush();
      *dataset = ExtendibleDataset();
    }
    write_counters(d->file.id(), work);
    write_attribute(d->file.id(), "solver_status", status.describe());
    write_status(d->file.id(), status.ok());
  });
  d->file.publish(OutputFile::Seal::none);
}

}  // namespace fw::store
