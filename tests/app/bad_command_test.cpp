#include <sched.h>
#include <sys/mount.h>

#include "app/bad_input.hpp"

namespace fw::app::test {
namespace {

using store::test::ScratchDirectory;
using ::testing::HasSubstr;
using Words = std::vector<std::string>;

class BadCommand : public ::testing::TestWithParam<BadInput> {};

TEST_P(BadCommand, IsRefusedWithOneMessageAndNoFile) {
  expect_refused(GetParam());
}

const std::string spring =
    "[particles]\nposition = [[0,0,0], [1,0,0]]\nmass = 1\n[springs]\nbetween = [[0,1]]\nstiffness = 1\n";

/// `simulate s.toml` with these further arguments.
BadInput simulate(const std::string& name, const Words& arguments, const Words& message) {
  Words all{"simulate", "s.toml"};
  all.insert(all.end(), arguments.begin(), arguments.end());
  return {name, all, {{"s.toml", spring}}, message};
}

/// The same with a valid method, step and end time before.
BadInput rk4(const std::string& name, const Words& arguments, const Words& message) {
  Words all{"--method", "rk4", "--step", "0.1", "--t-end", "1"};
  all.insert(all.end(), arguments.begin(), arguments.end());
  return simulate(name, all, message);
}

INSTANTIATE_TEST_SUITE_P(
    Usage, BadCommand,
    ::testing::Values(
        BadInput{"None", {}, {}, {"subcommand"}},
        BadInput{"Unknown", {"simulat"}, {}, {"subcommand", "\"simulat\"", "did you mean \"simulate\""}},
        BadInput{"UnknownOption", {"--fast"}, {}, {"--fast"}},
        BadInput{"ListNothing", {"list"}, {}, {"what", "federwerk list --help"}},
        BadInput{"ListUnknown", {"list", "method"}, {}, {"method", "methods", "problems"}},
        BadInput{"ListUnknownOption", {"list", "methods", "--xml"}, {}, {"--xml"}},
        BadInput{"DescribeNothing", {"describe"}, {}, {"name"}},
        BadInput{"DescribeNameOfOthers", {"describe", "dopri5"}, {}, {"called \"dormand_prince_54\" here"}},
        BadInput{"DescribeUnknown", {"describe", "rk5"}, {}, {"rk5", "did you mean \"rk4\""}},
        BadInput{"ShowNothing", {"show"}, {}, {"file"}}, BadInput{"RunNothing", {"run"}, {}, {"study"}},
        BadInput{"ControlCharacters", {"describe", "a\nb\x1b[31m"}, {}, {"unknown name"}}),
    name_of);

INSTANTIATE_TEST_SUITE_P(
    Simulate, BadCommand,
    ::testing::Values(
        BadInput{"WithoutScene", {"simulate", "--method", "rk4", "--t-end", "1"}, {}, {"scene"}},
        BadInput{"SceneIsADevice",
                 {"simulate", "/dev/zero", "--method", "rk4", "--step", "0.1", "--t-end", "1", "-o", "a.h5"},
                 {},
                 {"/dev/zero", "device"}},
        simulate("WithoutMethod", {"--step", "0.1", "--t-end", "1"}, {"--method"}),
        simulate("WithoutEnd", {"--method", "rk4", "--step", "0.1"}, {"--t-end"}),
        simulate("WithoutStep", {"--method", "rk4", "--t-end", "1"}, {"rk4", "--step"}),
        simulate("MethodEmpty", {"--method", "", "--step", "1", "--t-end", "1"}, {"method"}),
        simulate("MethodUnknown", {"--method", "rk", "--step", "1", "--t-end", "1"},
                 {"unknown method \"rk\""}),
        simulate("MethodMisspelt", {"--method", "velocity_verlett", "--step", "1", "--t-end", "1"},
                 {"velocity_verlett", "did you mean \"velocity_verlet\""}),
        simulate("MethodUnclosed", {"--method", "rk4[a=1", "--step", "1", "--t-end", "1"}, {"rk4[a=1", "]"}),
        simulate("PetscForAnotherMethod",
                 {"--method", "rk4", "--petsc", "-ksp_type cg", "--step", "1", "--t-end", "1"},
                 {"--petsc", "rk4", "takes no options of PETSc"}),
        simulate("PetscTwice",
                 {"--method", "petsc:ts_rk[petsc=-ts_adapt_type none]", "--petsc", "-ts_adapt_type dsp",
                  "--step", "1", "--t-end", "1"},
                 {"--petsc", "expected one of them"}),
        simulate("PetscTypeUnknown",
                 {"--method", "petsc:ts_bdf", "--petsc", "-ksp_type gmress", "--step", "1", "--t-end", "1"},
                 {"petsc:ts_bdf", "-ksp_type", "gmress"}),
        simulate("PetscWithoutDash",
                 {"--method", "petsc:ts_bdf", "--petsc", "ksp_type cg", "--step", "1", "--t-end", "1"},
                 {"ksp_type", "expected an option"}),
        simulate("MethodTakesNoOptions", {"--method", "rk4[a=1]", "--step", "1", "--t-end", "1"},
                 {"rk4", "no options", "\"a\""}),
        simulate("OptionUnknown",
                 {"--method", "implicit_euler_linearised[solver=lu]", "--step", "1", "--t-end", "1"},
                 {"implicit_euler_linearised", "\"solver\"", "linear_solver"}),
        simulate("OptionWithoutValue",
                 {"--method", "implicit_euler_linearised[linear_solver]", "--step", "1", "--t-end", "1"},
                 {"\"linear_solver\"", "option=value"}),
        simulate("OptionTwice",
                 {"--method", "implicit_euler_linearised[tangent=exact,tangent=exact]", "--step", "1",
                  "--t-end", "1"},
                 {"\"tangent\" twice"}),
        simulate("OptionTrailingComma",
                 {"--method", "implicit_euler_linearised[tangent=exact,]", "--step", "1", "--t-end", "1"},
                 {"option=value"}),
        simulate("OptionValueUnknown",
                 {"--method", "implicit_euler_linearised[linear_solver=qr]", "--step", "1", "--t-end", "1"},
                 {"linear_solver", "\"qr\"", "cholesky"}),
        simulate("OptionValueOutOfRange",
                 {"--method", "implicit_euler_linearised[linear_tolerance=0]", "--step", "1", "--t-end", "1"},
                 {"linear_tolerance", "\"0\""}),
        simulate("StepZero", {"--method", "rk4", "--step", "0", "--t-end", "1"},
                 {"--step", "found 0", "> 0"}),
        simulate("StepNegative", {"--method", "rk4", "--step", "-0.1", "--t-end", "1"}, {"--step", "-0.1"}),
        simulate("StepNotANumber", {"--method", "rk4", "--step", "nan", "--t-end", "1"}, {"--step", "nan"}),
        simulate("StepInfinite", {"--method", "rk4", "--step", "inf", "--t-end", "1"}, {"--step", "inf"}),
        simulate("StepOverflows", {"--method", "rk4", "--step", "1e999", "--t-end", "1"}, {"--step"}),
        simulate("StepText", {"--method", "rk4", "--step", "0,1", "--t-end", "1"}, {"--step", "0,1"}),
        simulate("StepMissingValue", {"--method", "rk4", "--t-end", "1", "--step"}, {"--step"}),
        simulate("StepTwice", {"--method", "rk4", "--step", "0.1", "--step", "0.2", "--t-end", "1"},
                 {"--step"}),
        simulate("StepTooSmall", {"--method", "rk4", "--step", "1e-300", "--t-end", "1"},
                 {"step", "1e-300", "2^53"}),
        simulate("StepAndTolerances", {"--method", "rk4", "--step", "0.1", "--rtol", "1e-6", "--t-end", "1"},
                 {"--step", "--rtol"}),
        simulate("TolerancesForAFixedStep",
                 {"--method", "rk4", "--rtol", "1e-6", "--atol", "1e-6", "--t-end", "1"}, {"rk4", "--step"}),
        simulate("AdaptiveWithStep", {"--method", "sundials:cvode_bdf", "--step", "0.1", "--t-end", "1"},
                 {"sundials:cvode_bdf", "--rtol"}),
        simulate("AdaptiveWithoutTolerances", {"--method", "sundials:cvode_bdf", "--t-end", "1"},
                 {"sundials:cvode_bdf", "--rtol", "--atol"}),
        simulate("AdaptiveWithoutAbsoluteTolerance",
                 {"--method", "sundials:cvode_bdf", "--rtol", "1e-6", "--t-end", "1"}, {"--atol"}),
        simulate("RelativeToleranceZero",
                 {"--method", "sundials:cvode_bdf", "--rtol", "0", "--atol", "1e-6", "--t-end", "1"},
                 {"--rtol", "found 0"}),
        simulate("AbsoluteToleranceNotANumber",
                 {"--method", "sundials:cvode_bdf", "--rtol", "1e-6", "--atol", "nan", "--t-end", "1"},
                 {"--atol", "nan"}),
        simulate("EndZero", {"--method", "rk4", "--step", "0.1", "--t-end", "0"}, {"--t-end", "found 0"}),
        simulate("EndNegative", {"--method", "rk4", "--step", "0.1", "--t-end", "-1"}, {"--t-end", "-1"}),
        simulate("EndNotANumber", {"--method", "rk4", "--step", "0.1", "--t-end", "nan"}, {"--t-end", "nan"}),
        simulate("EndInfinite", {"--method", "rk4", "--step", "0.1", "--t-end", "inf"}, {"--t-end", "inf"}),
        rk4("FramesZero", {"--frames", "0"}, {"--frames", "found 0"}),
        rk4("FramesOne", {"--frames", "1"}, {"--frames", "found 1", "from 2"}),
        rk4("FramesNegative", {"--frames", "-1"}, {"--frames", "-1"}),
        rk4("FramesHuge", {"--frames", "1000000000000000000"}, {"--frames", "1000000000000000000"}),
        rk4("FramesBeyondAnInteger", {"--frames", "99999999999999999999"},
            {"--frames", "found 99999999999999999999,", "below 2^63"}),
        rk4("FramesFraction", {"--frames", "2.5"}, {"--frames", "2.5"}),
        rk4("UnknownOption", {"--stpe", "1"}, {"--stpe"}), rk4("ExtraArgument", {"t.toml"}, {"t.toml"}),
        simulate("MultistepBrokenInterval",
                 {"--method", "verlet", "--step", "0.3", "--t-end", "1", "-o", "a.h5"},
                 {"0.3", "verlet", "0.25", "0.3333333333333333"}),
        simulate("MultistepStepLongerThanTheInterval",
                 {"--method", "verlet", "--step", "3", "--t-end", "1", "-o", "a.h5"}, {"verlet", "is 1"})),
    name_of);

BadInput with_file(BadInput bad, const std::string& name, const std::string& content) {
  bad.files.emplace_back(name, content);
  return bad;
}

INSTANTIATE_TEST_SUITE_P(
    Output, BadCommand,
    ::testing::Values(
        rk4("DirectoryThatCannotBeMade", {"-o", "/proc/nowhere/a.h5"}, {"cannot make", "/proc/nowhere"}),
        with_file(rk4("IsADirectory", {"-o", "d"}, {"\"d\"", "directory"}), "d/", ""),
        with_file(rk4("BelowAFile", {"-o", "f/a.h5"}, {"f/a.h5", "is no directory"}), "f", "x"),
        with_file(rk4("ForeignFile", {"-o", "notes.txt"}, {"notes.txt", "will not overwrite"}), "notes.txt",
                  "my thesis\n"),
        rk4("TheSceneItself", {"-o", "s.toml"}, {"s.toml", "will not overwrite"}),
        with_file(rk4("ForeignDefaultFile", {}, {"s-rk4.h5", "will not overwrite"}), "s-rk4.h5", ""),
        with_file(rk4("Pipe", {"-o", "p"}, {"\"p\"", "not a regular file"}), "p|", ""),
        rk4("ProcessFileSystem", {"-o", "/proc/a.h5"}, {"/proc/a.h5"}),
        rk4("SystemFileSystem", {"-o", "/sys/a.h5"}, {"/sys/a.h5"}),
        rk4("NameTooLong", {"-o", std::string(300, 'a') + ".h5"}, {"too long"}),
        with_file(rk4("XdmfIsADirectory", {"-o", "a.h5", "--xdmf"}, {"a.xdmf", "directory"}), "a.xdmf/", ""),
        rk4("XdmfOverTheResult", {"-o", "a.xdmf", "--xdmf"}, {"a.xdmf", "--xdmf"})),
    name_of);

INSTANTIATE_TEST_SUITE_P(
    Show, BadCommand,
    ::testing::Values(
        BadInput{"Missing", {"show", "a.h5"}, {}, {"a.h5", "No such file"}},
        BadInput{"Directory", {"show", "d"}, {{"d/", ""}}, {"\"d\"", "not a regular file"}},
        BadInput{"Empty", {"show", "a.h5"}, {{"a.h5", ""}}, {"a.h5", "not an HDF5 file"}},
        BadInput{"Text", {"show", "a.h5"}, {{"a.h5", "hello\n"}}, {"a.h5", "not an HDF5 file"}},
        BadInput{"TextAsJson", {"show", "a.h5", "--json"}, {{"a.h5", "x"}}, {"a.h5", "not an HDF5 file"}}),
    name_of);

TEST(BadCommand, ShowRefusesATruncatedResult) {
  const ScratchDirectory scratch;
  store::test::write_bytes(scratch / "s.toml", spring);
  ASSERT_EQ(run(scratch.path(),
                {"simulate", "s.toml", "--method", "rk4", "--step", "0.1", "--t-end", "1", "-o", "a.h5"})
                .exit_code,
            0);
  const std::string whole = store::test::read_bytes(scratch / "a.h5");
  EXPECT_EQ(run(scratch.path(), {"show", "a.h5"}).exit_code, 0);
  expect_refused(
      {"", {"show", "a.h5"}, {{"a.h5", whole.substr(0, whole.size() - 100)}}, {"a.h5", "truncated"}});
}

TEST(BadCommand, SimulateRefusesAReadOnlyFileSystem) {
  const ScratchDirectory scratch;
  store::test::write_bytes(scratch / "s.toml", spring);
  const auto read_only = [&] {
    if (::unshare(CLONE_NEWNS) != 0 && ::unshare(CLONE_NEWUSER | CLONE_NEWNS) != 0) return false;
    const std::string place = scratch.path().string();
    return ::mount("none", "/", nullptr, MS_REC | MS_PRIVATE, nullptr) == 0 &&
           ::mount(place.c_str(), place.c_str(), nullptr, MS_BIND, nullptr) == 0 &&
           ::mount(nullptr, place.c_str(), nullptr, MS_BIND | MS_REMOUNT | MS_RDONLY, nullptr) == 0;
  };
  const ProcessResult result = run(
      scratch.path(),
      {"simulate", "s.toml", "--method", "rk4", "--step", "0.1", "--t-end", "1", "-o", "a.h5"}, read_only);
  if (result.exit_code == Process::not_prepared) GTEST_SKIP() << "not allowed to mount";
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.err, HasSubstr("cannot write \"a.h5\": Read-only file system"));
  EXPECT_THAT(scratch.names(), ::testing::ElementsAre("s.toml"));
}

}  // namespace
}  // namespace fw::app::test
