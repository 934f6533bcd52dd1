#include "store/trajectory_writer.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.hpp"
#include "samples.hpp"
#include "scratch_directory.hpp"
#include "store/hdf5/dataset.hpp"
#include "store/input_file.hpp"
#include "system/provenance.hpp"
#include "system/sha256.hpp"

namespace fw::store::test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

TEST(TrajectoryWriter, WritesEveryRootAttributeOfTheContract) {
  const ScratchDirectory scratch;
  write_trajectory(scratch / "a.h5", 3, 4);
  const LibraryLock lock;
  const Attributes attributes = InputFile(scratch / "a.h5").attributes();
  const Provenance origin = provenance();
  EXPECT_EQ(text_of(attributes, "format"), "federwerk");
  EXPECT_EQ(integer_of(attributes, "format_version", 0), 1);
  EXPECT_EQ(text_of(attributes, "kind"), "trajectory");
  EXPECT_EQ(text_of(attributes, "title"), header().title);
  EXPECT_THAT(text_of(attributes, "created"),
              ::testing::MatchesRegex("[0-9]{4}-[0-9]{2}-[0-9]{2}T[0-9]{2}:[0-9]{2}:[0-9]{2}Z"));
  EXPECT_EQ(text_of(attributes, "command_line"), header().command_line);
  EXPECT_EQ(text_of(attributes, "git_commit"), origin.git_commit);
  EXPECT_EQ(integer_of(attributes, "git_dirty", -1), origin.git_dirty ? 1 : 0);
  EXPECT_EQ(text_of(attributes, "compiler"), origin.compiler);
  EXPECT_EQ(text_of(attributes, "compiler_flags"), origin.compiler_flags);
  EXPECT_EQ(text_of(attributes, "cpu"), origin.cpu);
  EXPECT_EQ(text_of(attributes, "libraries"), origin.libraries);
  EXPECT_EQ(text_of(attributes, "spec"), header().spec);
  EXPECT_EQ(text_of(attributes, "spec_sha256"), sha256_hex(header().spec));
  EXPECT_EQ(integer_of(attributes, "seed", 0), -7);
  EXPECT_EQ(text_of(attributes, "status"), "complete");
  EXPECT_EQ(text_of(attributes, "solver_status"), "success");
  EXPECT_EQ(integer_of(attributes, "quick", -1), 0);
  EXPECT_EQ(text_of(attributes, "seal"), "sha256");
  EXPECT_EQ(text_of(attributes, "frame_origin"), "ends of steps");
  EXPECT_EQ(text_of(attributes, "frame_spacing"), "even");
  EXPECT_EQ(attributes.size(), 21U);
}

TEST(TrajectoryWriter, StoresEveryNumberOfEveryFrameForAnySizeOfChunk) {
  // (particles, frames, expected frames): chunks of many frames, of one frame, of a part of a frame;
  // forecasts that are too small and too large
  const std::vector<std::array<int, 3>> sizes{{1, 1, 1},    {2, 101, 101}, {3, 500, 7},   {3, 5, 100000},
                                              {9000, 7, 7}, {30000, 3, 3}, {50001, 2, 2}, {1, 70000, 70000}};
  for (const auto& [n, frames, expected] : sizes) {
    SCOPED_TRACE(::testing::Message() << n << " particles, " << frames << " frames, expected " << expected);
    const ScratchDirectory scratch;
    {
      TrajectoryWriter writer(scratch / "a.h5", header(), chain(n), known_quantities, expected);
      for (int f = 0; f < frames; ++f) writer.frame(0.5 * f, known_state(n, f));
      writer.finish({}, {});
    }
    const LibraryLock lock;
    const InputFile file(scratch / "a.h5");
    const Handle group = open_group(file.id(), "trajectory");
    const auto un = static_cast<hsize_t>(n), uf = static_cast<hsize_t>(frames);
    EXPECT_THAT(dataset_shape(group, "position"), ElementsAre(uf, un, 3U));
    EXPECT_THAT(dataset_shape(group, "velocity"), ElementsAre(uf, un, 3U));
    EXPECT_THAT(dataset_shape(group, "linear_momentum"), ElementsAre(uf, 3U));
    EXPECT_THAT(dataset_shape(group, "angular_momentum"), ElementsAre(uf, 3U));
    EXPECT_THAT(dataset_shape(group, "kinetic_energy"), ElementsAre(uf));
    const auto numbers = [&](const char* name) {
      return std::get<std::vector<double>>(read_dataset(group, name).values);
    };
    const auto position = numbers("position"), velocity = numbers("velocity"), time = numbers("time"),
               kinetic = numbers("kinetic_energy"), potential = numbers("potential_energy"),
               total = numbers("total_energy"), elastic = numbers("elastic_energy"),
               gravitational = numbers("gravitational_energy"), obstacle = numbers("obstacle_energy"),
               linear = numbers("linear_momentum"), angular = numbers("angular_momentum");
    const std::size_t half = 3 * static_cast<std::size_t>(n);
    std::size_t wrong = 0;
    for (std::size_t f = 0; f < static_cast<std::size_t>(frames); ++f) {
      const Vector state = known_state(n, static_cast<int>(f));
      const double t = 0.5 * static_cast<double>(f);
      const Vector q = state.head(3 * n), v = state.tail(3 * n);
      for (std::size_t i = 0; i < half; ++i) {
        wrong += position[f * half + i] != q[static_cast<Index>(i)];
        wrong += velocity[f * half + i] != v[static_cast<Index>(i)];
      }
      wrong += time[f] != t || kinetic[f] != 1.0 + t || elastic[f] != 2.0 + q[0];
      wrong += gravitational[f] != 3.0 || obstacle[f] != 4.0 + v[0];
      wrong += potential[f] != elastic[f] + gravitational[f] + obstacle[f];
      wrong += total[f] != kinetic[f] + potential[f];
      wrong += linear[3 * f] != t || linear[3 * f + 1] != 5.0 || linear[3 * f + 2] != 6.0;
      wrong += angular[3 * f] != 7.0 || angular[3 * f + 1] != t || angular[3 * f + 2] != 8.0;
    }
    EXPECT_EQ(wrong, 0U);
  }
}

TEST(TrajectoryWriter, StoresTheSystemAndTheWork) {
  const ScratchDirectory scratch;
  write_trajectory(scratch / "a.h5", 3, 2);
  const LibraryLock lock;
  const InputFile file(scratch / "a.h5");
  const Handle system = open_group(file.id(), "system"), counters = open_group(file.id(), "counters");
  const auto doubles = [](hid_t group, const char* name) {
    return std::get<std::vector<double>>(read_dataset(group, name).values);
  };
  const auto integers = [](hid_t group, const char* name) {
    return std::get<std::vector<std::int64_t>>(read_dataset(group, name).values);
  };
  EXPECT_THAT(doubles(system, "mass"), ElementsAre(1.0, 1.5, 2.0));
  EXPECT_THAT(integers(system, "fixed"), ElementsAre(0));
  EXPECT_THAT(dataset_shape(system, "springs"), ElementsAre(2U, 2U));
  EXPECT_THAT(integers(system, "springs"), ElementsAre(0, 1, 1, 2));
  EXPECT_THAT(doubles(system, "stiffness"), ElementsAre(101.0, 102.0));
  EXPECT_THAT(doubles(system, "damping"), ElementsAre(0.5, 1.0));
  EXPECT_THAT(doubles(system, "rest_length"), ElementsAre(0.91, 0.92));
  EXPECT_THAT(integers(counters, "rhs_evaluations"), ElementsAre(4000000001));
  EXPECT_THAT(integers(counters, "accepted_steps"), ElementsAre(12));
  EXPECT_THAT(doubles(counters, "seconds"), ElementsAre(0.25));
  EXPECT_EQ(read_dataset(counters, "seconds").unit, "s");
}

TEST(TrajectoryWriter, TheStiffnessOfAStrainLawIsAForce) {
  const ScratchDirectory scratch;
  mechanics::MassSpringModel model = chain(2);
  model.springs.law = mechanics::SpringLaw::strain;
  TrajectoryWriter writer(scratch / "a.h5", header(), model, known_quantities, 1);
  writer.finish({}, {});
  const LibraryLock lock;
  const InputFile file(scratch / "a.h5");
  EXPECT_EQ(read_dataset(open_group(file.id(), "system"), "stiffness").unit, "N");
}

TEST(TrajectoryWriter, StoresGroupsOfSpringsOneAfterTheOtherWithTheirLawsAndNames) {
  const ScratchDirectory scratch;
  mechanics::MassSpringModel model = chain(4);
  model.springs.groups = {{"frame", mechanics::SpringLaw::hooke, 1},
                          {"", mechanics::SpringLaw::strain, 0},
                          {"rope", mechanics::SpringLaw::tension_only, 2}};
  const auto unit = [&](const char* name) {
    TrajectoryWriter writer(scratch / name, header(), model, known_quantities, 1);
    writer.finish({}, {});
    const LibraryLock lock;
    const InputFile file(scratch / name);
    return read_dataset(open_group(file.id(), "system"), "stiffness").unit;
  };
  EXPECT_EQ(unit("a.h5"), "SI") << "newtons in one group, newtons per metre in the others";
  const LibraryLock lock;
  const InputFile file(scratch / "a.h5");
  const Handle system = open_group(file.id(), "system");
  EXPECT_THAT(std::get<std::vector<std::int64_t>>(read_dataset(system, "spring_group").values),
              ElementsAre(0, 2, 2));
  EXPECT_THAT(std::get<std::vector<std::string>>(read_dataset(system, "group_law").values),
              ElementsAre("hooke", "strain", "tension_only"));
  EXPECT_THAT(std::get<std::vector<std::string>>(read_dataset(system, "group_name").values),
              ElementsAre("frame", "", "rope"));
  EXPECT_THAT(dataset_shape(system, "springs"), ElementsAre(3U, 2U));
}

TEST(TrajectoryWriter, AFailedSolverGivesAValidFileThatSaysSo) {
  const ScratchDirectory scratch;
  write_trajectory(scratch / "a.h5", 2, 3, {StatusCode::newton_failed, "at t = 1 after 10 iterations"});
  const LibraryLock lock;
  const InputFile file(scratch / "a.h5");
  EXPECT_EQ(text_of(file.attributes(), "status"), "incomplete");
  EXPECT_THAT(text_of(file.attributes(), "solver_status"), HasSubstr("newton_failed"));
  EXPECT_THAT(text_of(file.attributes(), "solver_status"), HasSubstr("at t = 1 after 10 iterations"));
  EXPECT_EQ(dataset_shape(open_group(file.id(), "trajectory"), "time"), Shape{3});
}

TEST(TrajectoryWriter, NothingIsUnderTheFinalNameBeforeFinish) {
  const ScratchDirectory scratch;
  TrajectoryWriter writer(scratch / "a.h5", header(), chain(2), known_quantities, 10);
  writer.frame(0.0, known_state(2, 0));
  ASSERT_EQ(scratch.names().size(), 1U);
  EXPECT_EQ(scratch.names()[0].rfind(".a.h5.", 0), 0U) << "hidden and recognisable: " << scratch.names()[0];
  writer.finish({}, {});
  EXPECT_THAT(scratch.names(), ElementsAre("a.h5"));
}

TEST(TrajectoryWriter, LeavesNothingBehindWithoutFinish) {
  const ScratchDirectory scratch;
  {
    TrajectoryWriter writer(scratch / "a.h5", header(), chain(2), known_quantities, 10);
    writer.frame(0.0, known_state(2, 0));
  }
  EXPECT_TRUE(scratch.names().empty());
}

TEST(TrajectoryWriter, KeepsTheEarlierFileUntilTheNewOneIsWhole) {
  const ScratchDirectory scratch;
  write_trajectory(scratch / "a.h5", 2, 3);
  const std::string before = read_bytes(scratch / "a.h5");
  {
    TrajectoryWriter writer(scratch / "a.h5", header(), chain(2), known_quantities, 10);
    writer.frame(0.0, known_state(2, 0));
    EXPECT_EQ(read_bytes(scratch / "a.h5"), before);
  }
  EXPECT_EQ(read_bytes(scratch / "a.h5"), before);
}

TEST(TrajectoryWriter, SweepsUpAfterAKilledWriterButNotAfterALivingOne) {
  const ScratchDirectory scratch;
  in_child([&]() -> int {
    TrajectoryWriter writer(scratch / "a.h5", header(), chain(2), known_quantities, 10);
    writer.frame(0.0, known_state(2, 0));
    ::_exit(0);
  });
  ASSERT_EQ(scratch.names().size(), 1U) << "the killed writer leaves its temporary file";
  TrajectoryWriter first(scratch / "a.h5", header(), chain(2), known_quantities, 10);
  EXPECT_EQ(scratch.names().size(), 1U) << "the file of the dead is gone, ours is there";
  TrajectoryWriter second(scratch / "a.h5", header(), chain(2), known_quantities, 10);
  EXPECT_EQ(scratch.names().size(), 2U) << "the file of the living stays";
  first.frame(0.0, known_state(2, 0));
  first.finish({}, {});
  second.finish({}, {});
  EXPECT_THAT(scratch.names(), ElementsAre("a.h5"));
}

TEST(TrajectoryWriter, RefusesFramesOfTheWrongSizeAndAfterTheEnd) {
  const ScratchDirectory scratch;
  TrajectoryWriter writer(scratch / "a.h5", header(), chain(2), known_quantities, 10);
  EXPECT_THROW(writer.frame(0.0, known_state(3, 0)), InputError);
  writer.frame(0.0, known_state(2, 0));
  writer.finish({}, {});
  EXPECT_THROW(writer.frame(1.0, known_state(2, 0)), InputError);
  EXPECT_THROW(writer.finish({}, {}), InputError);
  const LibraryLock lock;
  EXPECT_EQ(dataset_shape(InputFile(scratch / "a.h5").id(), "trajectory/time"), Shape{1});
}

TEST(TrajectoryWriter, TwoWritersDoNotDisturbEachOther) {
  const ScratchDirectory scratch;
  TrajectoryWriter a(scratch / "a.h5", header(), chain(2), known_quantities, 10);
  TrajectoryWriter b(scratch / "b.h5", header(), chain(3), known_quantities, 10);
  for (int f = 0; f < 5; ++f) {
    a.frame(f, known_state(2, f));
    b.frame(f, known_state(3, f + 100));
  }
  a.finish({}, {});
  b.finish({}, {});
  const LibraryLock lock;
  const InputFile first(scratch / "a.h5"), second(scratch / "b.h5");
  EXPECT_EQ(read_row(first.id(), "trajectory/position", 4)[0], 4.0);
  EXPECT_EQ(read_row(second.id(), "trajectory/position", 4)[0], 104.0);
}

}  // namespace
}  // namespace fw::store::test
