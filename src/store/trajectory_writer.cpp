#include "store/trajectory_writer.hpp"

#include <fmt/format.h>

#include <string>
#include <vector>

#include "core/work_counters.hpp"
#include "store/file/output_file.hpp"
#include "store/hdf5/extendible_dataset.hpp"

namespace fw::store {

namespace {

const char* name_of(mechanics::SpringLaw law) {
  switch (law) {
    case mechanics::SpringLaw::hooke:
      return "hooke";
    case mechanics::SpringLaw::strain:
      return "strain";
    case mechanics::SpringLaw::tension_only:
      return "tension_only";
  }
  throw InputError("law of springs: found a value outside the enumeration");
}

/// That of the springs' stiffness: newtons under the law "strain", else newtons per metre.
const char* stiffness_unit(const mechanics::Springs& springs) {
  bool strain = false, other = false;
  springs.for_each_group([&](const mechanics::SpringGroup& group, std::size_t) {
    (group.law == mechanics::SpringLaw::strain ? strain : other) = true;
  });
  return strain && other ? "SI" : strain ? "N" : "N/m";
}

void write_spring_groups(hid_t group, const mechanics::Springs& springs) {
  std::vector<std::int32_t> number;
  std::vector<std::string> law, name;
  number.reserve(springs.size());
  springs.for_each_group([&](const mechanics::SpringGroup& of_one_law, std::size_t) {
    number.insert(number.end(), of_one_law.size, static_cast<std::int32_t>(law.size()));
    law.emplace_back(name_of(of_one_law.law));
    name.push_back(of_one_law.name);
  });
  write_dataset(group, "spring_group", "1", {number.size()}, std::span<const std::int32_t>(number));
  write_dataset(group, "group_law", "", {law.size()}, std::span<const std::string>(law));
  write_dataset(group, "group_name", "", {name.size()}, std::span<const std::string>(name));
}

void write_system(hid_t file, const mechanics::MassSpringModel& model) {
  const Handle group = make_group(file, "system");
  const mechanics::Springs& springs = model.springs;
  std::vector<std::int32_t> between;
  between.reserve(2 * springs.size());
  for (std::size_t i = 0; i < springs.size(); ++i) {
    between.push_back(springs.first[i]);
    between.push_back(springs.second[i]);
  }
  write_dataset(group, "mass", "kg", {model.mass.size()}, std::span(model.mass));
  write_dataset(group, "fixed", "1", {model.fixed.size()},
                std::span<const std::int32_t>(model.fixed.data(), model.fixed.size()));
  write_dataset(group, "springs", "1", {springs.size(), 2}, std::span<const std::int32_t>(between));
  write_dataset(group, "stiffness", stiffness_unit(springs), {springs.size()}, std::span(springs.stiffness));
  write_dataset(group, "damping", "N*s/m", {springs.size()}, std::span(springs.damping));
  write_dataset(group, "rest_length", "m", {springs.size()}, std::span(springs.rest_length));
  if (!springs.groups.empty()) write_spring_groups(group, springs);
}

void write_counters(hid_t file, const Work& work) {
  const Handle group = make_group(file, "counters");
  for (const WorkCounter& counter : work_counters) {
    const auto number = static_cast<std::int64_t>(work.*counter.count);
    write_dataset(group, counter.name, "1", {}, std::span<const std::int64_t>(&number, 1));
  }
  write_dataset(group, "seconds", "s", {}, std::span<const double>(&work.seconds, 1));
}

void write_notes(hid_t file, const RunNotes& notes) {
  if (!notes.warnings.empty()) {
    std::string text;
    for (const std::string& warning : notes.warnings) text += (text.empty() ? "" : "\n") + warning;
    write_attribute(file, "warnings", text);
  }
  if (!notes.stopped_at.empty()) write_attribute(file, "stopped_at", notes.stopped_at);
  if (!notes.has_events) return;
  const Handle group = make_group(file, "events");
  write_dataset(group, "time", "s", {notes.event_times.size()}, std::span<const double>(notes.event_times));
  write_dataset(group, "event", "", {notes.event_names.size()}, std::span<const std::string>(notes.event_names));
}

}  // namespace

struct TrajectoryWriter::Datasets {
  explicit Datasets(const std::filesystem::path& path) : file(path) {}

  OutputFile file;
  ExtendibleDataset time, position, velocity;
  std::vector<ExtendibleDataset> quantities;

  void close() {
    const auto end = [](ExtendibleDataset& dataset) {
      dataset.flush();
      dataset = ExtendibleDataset();
    };
    end(time);
    end(position);
    end(velocity);
    for (ExtendibleDataset& dataset : quantities) end(dataset);
  }
};

TrajectoryWriter::TrajectoryWriter(const std::filesystem::path& path, const FileHeader& header,
                                   const mechanics::MassSpringModel& model, FrameQuantities quantities,
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
    d.time = ExtendibleDataset(group, "time", "s", {}, frames);
    d.position = ExtendibleDataset(group, "position", "m", {n, 3}, frames);
    d.velocity = ExtendibleDataset(group, "velocity", "m/s", {n, 3}, frames);
    std::size_t components = 0;
    for (const FrameQuantity& quantity : quantities_.list) {
      const Shape entry =
          quantity.components == 1 ? Shape{} : Shape{static_cast<hsize_t>(quantity.components)};
      d.quantities.emplace_back(group, quantity.name.c_str(), quantity.unit.c_str(), entry, frames);
      components += static_cast<std::size_t>(quantity.components);
    }
    values_.resize(components);
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
  quantities_.evaluate(time, q, v, values_);

  const LibraryLock lock;
  Datasets& d = *datasets_;
  const auto size = static_cast<std::size_t>(3 * particles_);
  d.file.guarded([&] {
    d.time.append({&time, 1});
    d.position.append({state.data(), size});
    d.velocity.append({state.data() + size, size});
    std::span<const double> rest(values_);
    for (std::size_t k = 0; k < d.quantities.size(); ++k) {
      const auto components = static_cast<std::size_t>(quantities_.list[k].components);
      d.quantities[k].append(rest.first(components));
      rest = rest.subspan(components);
    }
  });
}

void TrajectoryWriter::finish(const Status& status, const Work& work, const RunNotes& notes) {
  if (!datasets_ || !datasets_->file.is_open()) throw InputError("the trajectory is finished already");
  const LibraryLock lock;
  // Whatever happens below, nothing but the published file remains.
  const std::unique_ptr<Datasets> d = std::move(datasets_);
  d->file.guarded([&] {
    d->close();
    write_counters(d->file.id(), work);
    write_notes(d->file.id(), notes);
    write_attribute(d->file.id(), "solver_status", status.describe());
    write_status(d->file.id(), status.ok());
  });
  d->file.publish();
}

}  // namespace fw::store
