#include "store/checkpoint_file.hpp"

#include <fmt/format.h>

#include <system_error>

#include "core/error.hpp"
#include "core/state_archive.hpp"
#include "store/file/open_regular.hpp"
#include "store/file/seal.hpp"
#include "store/file/temporary_file.hpp"
#include "store/write_target.hpp"

namespace fw::store {

namespace {

/// The first line of the file; its number is the version of the format.
constexpr std::string_view family = "federwerk checkpoint ";
constexpr std::string_view first_line = "federwerk checkpoint 2\n";
/// A number whose bytes read differently backwards.
constexpr double byte_order = 1.0;

void serialise(StateArchive& archive, StepControl& control) {
  bool is_fixed = std::holds_alternative<FixedStep>(control);
  archive.visit("has a constant step", is_fixed);
  if (archive.is_loading()) control = is_fixed ? StepControl(FixedStep{}) : StepControl(AdaptiveStep{});
  if (is_fixed) {
    auto& fixed = std::get<FixedStep>(control);
    archive.visit("step", fixed.step);
    archive.visit("allow a short last step", fixed.allow_short_last_step);
    return;
  }
  auto& adaptive = std::get<AdaptiveStep>(control);
  archive.visit("relative tolerance", adaptive.relative_tolerance);
  archive.visit("absolute tolerance", adaptive.absolute_tolerance);
  archive.visit("absolute tolerance of velocities", adaptive.absolute_velocity_tolerance);
  archive.visit("initial step", adaptive.initial_step);
  archive.visit("minimum step", adaptive.minimum_step);
  archive.visit("maximum step", adaptive.maximum_step);
  archive.visit("maximum steps", adaptive.maximum_steps);
}

void serialise(StateArchive& archive, Checkpoint& checkpoint) {
  archive.require_equal("byte order", byte_order);
  archive.visit("program", checkpoint.program);
  archive.visit("scene file", checkpoint.scene_name);
  archive.visit("scene", checkpoint.scene);
  archive.visit("method", checkpoint.method);
  archive.visit("PETSc options", checkpoint.petsc);
  archive.visit("output", checkpoint.output);
  serialise(archive, checkpoint.control);
  archive.visit("end time", checkpoint.end_time);
  archive.visit("frames", checkpoint.frames);
  archive.visit("time", checkpoint.time);
  archive.visit_any_size("times of the frames", checkpoint.frame_times);
  archive.visit_any_size("states of the frames", checkpoint.frame_states);
  archive.visit("run", checkpoint.run);
}

std::string content_of(const DriverFile& file) {
  std::string text(file.size(), '\0');
  if (!file.read(0, text.data(), text.size())) throw SystemError("the file cannot be read");
  return text;
}

}  // namespace

void write_checkpoint(const std::filesystem::path& path, const Checkpoint& checkpoint) {
  StateWriter writer;
  Checkpoint written = checkpoint;  // one function visits in both directions
  serialise(writer, written);
  TemporaryFile file(path);
  file.file()->write(0, first_line.data(), first_line.size());
  file.file()->write(first_line.size(), writer.bytes().data(), writer.bytes().size());
  file.check();
  append_seal(*file.file());
  file.publish();
}

Checkpoint read_checkpoint(const std::filesystem::path& path) {
  const auto file = open_regular(path);
  const std::string name = fmt::format("checkpoint \"{}\"", path.string());
  const std::string text = content_of(*file);
  if (!text.starts_with(family)) {
    throw InputError(fmt::format("\"{}\" is no checkpoint of federwerk", path.string()));
  }
  if (!text.starts_with(first_line)) {
    const std::string version = text.substr(family.size(), text.find('\n') - family.size()).substr(0, 20);
    throw InputError(fmt::format("{}: found version \"{}\" of the format, expected 2", name, version));
  }
  switch (check_seal(*file)) {
    case SealState::intact:
      break;
    case SealState::absent:
      throw InputError(name + " is truncated: it has no SHA-256 at its end");
    case SealState::broken:
      throw InputError(name + " is damaged: its content does not match its SHA-256");
  }
  Checkpoint checkpoint;
  try {
    StateReader reader(
        std::string_view(text).substr(first_line.size(), text.size() - first_line.size() - seal_size));
    serialise(reader, checkpoint);
    reader.finish();
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: {}", name, error.what()));
  }
  return checkpoint;
}

void check_checkpoint_target(const std::filesystem::path& path) {
  check_writable_place(path);
  std::error_code ignored;
  if (!std::filesystem::exists(path, ignored)) return;
  const auto file = open_regular(path);
  std::string start(family.size(), '\0');
  if (file->size() < start.size() || !file->read(0, start.data(), start.size()) || start != family) {
    throw InputError(
        fmt::format("--checkpoint would overwrite \"{}\", which is no checkpoint", path.string()));
  }
}

}  // namespace fw::store
