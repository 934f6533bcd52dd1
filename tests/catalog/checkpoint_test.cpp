#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <random>
#include <set>

#include "catalog/method_runs.hpp"
#include "core/error.hpp"
#include "integrators/saved_run.hpp"

namespace fw::catalog {
namespace {

using integrators::difference;
using integrators::difference_from_end;
using integrators::EveryStep;
using integrators::items_of;
using integrators::SavedItem;
using integrators::StepRecord;
using ::testing::Contains;
using ::testing::HasSubstr;

constexpr std::uint64_t seed = 20261128;
constexpr int steps = 30;

/// A run that was never stopped, saved after every step.
struct Undisturbed {
  StepRecord record;
  EveryStep checkpoints;
  Solution solution;

  explicit Undisturbed(const MethodRun& run) {
    solution = run.integrator->solve(run.ivp, run.control, record, {.checkpoints = &checkpoints});
  }
};

/// Empty if a new run that continues from `saved` ends like the undisturbed one in states, dense output and
/// counters.
std::string difference_of_continued(const MethodRun& run, const Undisturbed& whole, double from,
                                    const std::string& saved) {
  StepRecord record(from);
  const std::unique_ptr<Integrator> anew = make_method(run.call);
  const Solution solution = anew->solve(run.ivp, run.control, record, {.resume = saved});
  if (solution.status.code != whole.solution.status.code) return "status: " + solution.status.describe();
  if (record.times.empty()) return "no steps";
  if (const std::string found = difference_from_end(whole.record, record); !found.empty()) return found;
  return difference(solution.work, whole.solution.work);
}

TEST(Checkpoint, AThousandOfAllOwnMethodsContinueToTheSameBits) {
  const std::vector<MethodRun> runs = method_runs(steps, true, false);
  constexpr std::size_t wanted = 1000;
  std::mt19937_64 random(seed);
  std::set<std::string> families;
  std::size_t done = 0;
  for (std::size_t k = 0; k < runs.size(); ++k) {
    const MethodRun& run = runs[k];
    const Undisturbed whole(run);
    ASSERT_TRUE(whole.solution.status.ok()) << run.name() << ": " << whole.solution.status.describe();
    const std::vector<std::pair<double, std::string>>& saved = whole.checkpoints.saved;
    ASSERT_FALSE(saved.empty()) << run.name();
    families.insert(run.integrator->info().family);
    // As many as bring the runs so far to their share of all.
    while (done < (wanted * (k + 1) + runs.size() - 1) / runs.size()) {
      const auto& [time, bytes] =
          saved[std::uniform_int_distribution<std::size_t>(0, saved.size() - 1)(random)];
      EXPECT_EQ(difference_of_continued(run, whole, time, bytes), "") << run.name() << " from t = " << time;
      ++done;
    }
  }
  EXPECT_GE(done, wanted);
  EXPECT_GE(families.size(), 14u);
}

/// The members without whose saved value the run ends otherwise: each in turn gets its value of the first
/// step in a state saved later, as if the stepper had left it out.
std::vector<std::string> members_that_matter(const MethodRun& run) {
  const Undisturbed whole(run);
  const std::vector<std::pair<double, std::string>>& saved = whole.checkpoints.saved;
  const std::string& early = saved[saved.size() / 4].second;
  const auto& [time, late] = saved[saved.size() * 2 / 3];
  const std::vector<SavedItem> old = items_of(early), present = items_of(late);
  std::vector<std::string> found;
  if (old.size() != present.size()) return {"other items"};
  for (std::size_t k = 0; k < present.size(); ++k) {
    if (old[k].size != present[k].size) return {"other sizes"};
    std::string seeded = late;
    seeded.replace(present[k].begin, present[k].size, early, old[k].begin, old[k].size);
    if (seeded == late) continue;
    std::string difference;
    try {
      difference = difference_of_continued(run, whole, time, seeded);
    } catch (const InputError& error) {
      difference = error.what();
    }
    if (!difference.empty()) found.push_back(present[k].name);
  }
  return found;
}

TEST(Checkpoint, ThatLeavesOutAMemberIsCaught) {
  const std::map<std::string, std::vector<std::string>> members = {
      {"dormand_prince_54", {"state", "steps", "slopes", "right-hand sides"}},
      {"tr_bdf2", {"first slope"}},
      {"verlet", {"force", "displacement"}},
      {"velocity_verlet", {"force"}},
      {"adams_bashforth3", {"history"}},
      {"bdf3", {"history", "slope"}},
      {"newmark", {"acceleration"}},
      {"gauss2", {"slopes"}},
      {"ark436", {"state", "steps"}},
      {"r_respa", {"stiff force", "soft force"}},
      {"gautschi", {"coordinates", "velocities", "rest of the force"}},
      {"implicit_euler_linearised", {"increment"}},
      {"rkc2", {"state", "steps"}}};
  // What is computed anew on one problem may be carried over on another: the stiff force of r_respa where it
  // depends on positions only.
  std::map<std::string, std::set<std::string>> caught, caught_with_tolerances;
  for (const MethodRun& run : method_runs(steps, true, false)) {
    if (!members.contains(run.call)) continue;
    const std::vector<std::string> found = members_that_matter(run);
    (run.is_fixed() ? caught : caught_with_tolerances)[run.call].insert(found.begin(), found.end());
  }
  EXPECT_GE(caught_with_tolerances.size(), 3u);
  for (const auto& [call, found] : caught_with_tolerances) {
    EXPECT_THAT(found, Contains("step to come")) << call;
  }
  EXPECT_EQ(caught.size(), members.size());
  for (const auto& [call, expected] : members) {
    for (const std::string& member : expected) EXPECT_THAT(caught[call], Contains(member)) << call;
  }
}

MethodRun first_run(const std::string& call, bool fixed = true) {
  for (const MethodRun& run : method_runs(steps, true, true)) {
    if (run.call == call && run.is_fixed() == fixed) return run;
  }
  throw std::logic_error("no run of " + call);
}

void expect_refusal(const MethodRun& run, const std::string& saved, const std::string& message) {
  StepRecord record;
  try {
    run.integrator->solve(run.ivp, run.control, record, {.resume = saved});
    ADD_FAILURE() << run.name() << ": expected a refusal with \"" << message << '"';
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr(message));
  }
  EXPECT_TRUE(record.times.empty());
}

TEST(Checkpoint, OfAnotherMethodStepOrProblemIsRefused) {
  const MethodRun run = first_run("verlet");
  const std::string saved = Undisturbed(run).checkpoints.saved[5].second;
  expect_refusal(first_run("newmark"), saved, "the method is \"verlet\", expected \"newmark\"");
  MethodRun other = run;
  other.control = FixedStep{.step = 0.5 * exact_step};
  expect_refusal(other, saved, "the step is 0.015625, expected 0.0078125");
  other = run;
  other.ivp.t1 += exact_step;
  expect_refusal(other, saved, "the end time is 0.46875, expected 0.484375");
  other = run;
  integrators::NetworkOptions larger;
  larger.particles = 8;
  other.ivp = integrators::random_network(7, larger, run.ivp.t1);
  expect_refusal(other, saved,
                 "found \"state\" (type v, 36 entries), expected \"state\" (type v, 48 entries)");
  const MethodRun chosen = first_run("dormand_prince_54", false);
  const std::string of_tolerances = Undisturbed(chosen).checkpoints.saved[2].second;
  other = chosen;
  std::get<AdaptiveStep>(other.control).relative_tolerance = 1e-5;
  expect_refusal(other, of_tolerances, "the relative tolerance is 1e-06, expected 1e-05");
  expect_refusal(first_run("dormand_prince_54"), of_tolerances, "expected \"step\"");
}

TEST(Checkpoint, ThatIsCutOffOrTooLongIsRefused) {
  const MethodRun run = first_run("bdf3");
  const std::string saved = Undisturbed(run).checkpoints.saved[5].second;
  for (std::size_t size = 1; size < saved.size(); size += 97) {
    StepRecord record;
    EXPECT_THROW(run.integrator->solve(run.ivp, run.control, record,
                                       {.resume = std::string_view(saved).substr(0, size)}),
                 InputError)
        << size;
  }
  expect_refusal(run, saved + "x", "1 bytes are left over");
}

TEST(Checkpoint, OfAForeignMethodIsRefusedBeforeItsFirstStep) {
  int foreign = 0;
  for (const MethodRun& run : method_runs(steps, false, true)) {
    if (!run.is_foreign()) continue;
    EveryStep checkpoints;
    StepRecord record;
    try {
      run.integrator->solve(run.ivp, run.control, record, {.checkpoints = &checkpoints});
      ADD_FAILURE() << run.name();
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), HasSubstr("cannot be saved: the library does not give out its memory"));
    }
    EXPECT_LE(record.times.size(), 1u);
    ++foreign;
  }
  EXPECT_GT(foreign, 20);
  NullObserver observer;
  EveryStep checkpoints;
  const MethodRun springs = first_run("implicit_euler_linearised");
  EXPECT_THROW(make_method("implicit_euler_linearised[linear_solver=petsc]")
                   ->solve(springs.ivp, springs.control, observer, {.checkpoints = &checkpoints}),
               InputError);
}

}  // namespace
}  // namespace fw::catalog
