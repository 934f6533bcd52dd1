#include "mechanics/assembly/force_kernel.hpp"

#include <gtest/gtest.h>

#include "random_model.hpp"

namespace fw::mechanics {
namespace {

/// The forces of a network of springs with each spring done from its second end first; `is_wrong` leaves out
/// the damper of the last spring.
class ReversedKernel final : public ForceKernel {
 public:
  ReversedKernel(const MassSpringModel& model, bool is_wrong) : model_(model), is_wrong_(is_wrong) {}

  std::uint64_t force(const double* q, const double* v, double* f) const override {
    const Springs& springs = model_.springs;
    std::uint64_t degenerate = 0;
    std::fill_n(f, 3 * model_.mass.size(), 0.0);
    for (std::size_t e = springs.size(); e-- > 0;) {
      const int i = springs.second[e], j = springs.first[e];
      SpringParameters spring = spring_parameters(springs, e);
      if (is_wrong_ && e + 1 == springs.size()) spring.damping = 0.0;
      with_spring_law(springs.law_of(e), [&](auto law) {
        const Vec3<double> on_i =
            spring_force<law()>(spring, load3(q, j) - load3(q, i), load3(v, j) - load3(v, i), degenerate);
        add3(f, i, on_i);
        add3(f, j, -on_i);
      });
    }
    return degenerate;
  }

 private:
  const MassSpringModel& model_;
  bool is_wrong_;
};

SystemParts reversed(bool is_wrong) {
  return {.kernel = [=](const MassSpringModel& model) {
    return std::make_unique<const ReversedKernel>(model, is_wrong);
  }};
}

/// The largest deviation of a system's forces from the plain loop, over the largest force, at random states.
double deviation_from_plain_loop(const MassSpringSystem& system, std::uint64_t seed) {
  RandomModels random(seed);
  double worst = 0.0;
  for (int trial = 0; trial < 10; ++trial) {
    const State state = random.state(system.model());
    Vector plain(state.q.size());
    system.elements().force(state.q.data(), state.v.data(), plain.data());
    worst = std::max(worst, relative_deviation(force_of(system, state), plain));
  }
  return worst;
}

TEST(ForceKernel, TakesThePlaceOfThePlainLoopInForcesAndRightHandSides) {
  RandomModels random(20261201);
  MassSpringModel model = random.network(SpringLaw::hooke, 8, 20, true);
  model.springs.groups = {
      {"", SpringLaw::hooke, 7}, {"", SpringLaw::tension_only, 6}, {"", SpringLaw::strain, 7}};
  const MassSpringSystem system(model, reversed(false));
  EXPECT_LE(deviation_from_plain_loop(system, 1), 1e-14);

  State state = random.state(model);
  Vector dydt(2 * state.q.size());
  system.rhs(0.0, state.stacked(), dydt);
  EXPECT_EQ(dydt.tail(state.q.size()), Vector(force_of(system, state).cwiseQuotient(system.mass())));
  state.q.segment<3>(3 * model.springs.first[0]) = state.q.segment<3>(3 * model.springs.second[0]);
  const std::uint64_t before = system.degenerate_spring_evaluations();
  force_of(system, state);
  EXPECT_GT(system.degenerate_spring_evaluations(), before) << "what the kernel counts is kept";
}

TEST(ForceKernel, ThatForgetsOneDamperIsCaughtByThePlainLoop) {
  RandomModels random(20261202);
  const MassSpringModel model = random.network(SpringLaw::hooke, 8, 20, true);
  EXPECT_LE(deviation_from_plain_loop(MassSpringSystem(model, reversed(false)), 2), 1e-14);
  EXPECT_GE(deviation_from_plain_loop(MassSpringSystem(model, reversed(true)), 2), 1e-4);
}

}  // namespace
}  // namespace fw::mechanics
