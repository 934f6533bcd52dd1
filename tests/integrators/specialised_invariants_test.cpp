#include "integrators/energy_momentum/average_vector_field.hpp"
#include "integrators/energy_momentum/discrete_gradient.hpp"
#include "integrators/exponential/exponential_rosenbrock_euler.hpp"
#include "integrators/exponential/gautschi.hpp"
#include "integrators/graphics/projective_dynamics.hpp"
#include "integrators/graphics/xpbd.hpp"
#include "integrators/special/r_respa.hpp"
#include "integrators/structural/generalised_alpha.hpp"
#include "integrators/structural/hht_alpha.hpp"
#include "integrators/structural/newmark.hpp"
#include "integrators/tableau/linear_multistep.hpp"
#include "order_levels.hpp"
#include "schemes/multistep_formulas.hpp"

namespace fw::integrators {
namespace {

std::vector<std::unique_ptr<Integrator>> specialised_schemes() {
  std::vector<std::unique_ptr<Integrator>> list;
  for (const auto& formula : schemes::multistep_formulas()) list.push_back(make_linear_multistep(formula));
  list.push_back(make_newmark());
  list.push_back(make_hht_alpha());
  list.push_back(make_generalised_alpha());
  list.push_back(make_average_vector_field());
  list.push_back(make_discrete_gradient());
  list.push_back(make_exponential_rosenbrock_euler());
  list.push_back(make_gautschi());
  list.push_back(make_projective_dynamics());
  list.push_back(make_xpbd());
  list.push_back(make_r_respa());
  return list;
}

TEST(SpecialisedSchemes, HoldFixedPointsStillAndRepeatBitForBit) {
  for (const auto& scheme : specialised_schemes()) {
    const Ivp ivp =
        random_network(91, {.is_damped = !scheme->info().needs.has(Capability::position_forces)}, 1.0);
    const auto& fixed = ivp.system->second_order()->fixed();
    const Index n = ivp.y0.size() / 2;
    const Solution solution = run(*scheme, ivp, 1.0 / 256.0);
    ASSERT_TRUE(solution.status.ok()) << scheme->info().name << ": " << solution.status.describe();
    for (Index i = 0; i < n; ++i) {
      if (!fixed[static_cast<std::size_t>(i)]) continue;
      EXPECT_EQ(solution.state[i], ivp.y0[i]) << scheme->info().name;
      EXPECT_EQ(solution.state[n + i], 0.0) << scheme->info().name;
    }
    EXPECT_EQ(run(*scheme, ivp, 1.0 / 256.0).state, solution.state) << scheme->info().name;
  }
}

TEST(SpecialisedSchemes, KeepTheLinearMomentumOfAFreeNetwork) {
  for (const auto& scheme : specialised_schemes()) {
    const Ivp ivp = random_network(
        92, {.is_damped = !scheme->info().needs.has(Capability::position_forces), .is_free = true}, 1.0);
    const auto& system = dynamic_cast<const mechanics::MassSpringSystem&>(*ivp.system);
    const Index n = ivp.y0.size() / 2;
    const Solution solution = run(*scheme, ivp, 1.0 / 256.0);
    ASSERT_TRUE(solution.status.ok()) << scheme->info().name << ": " << solution.status.describe();
    const Vec3<double> change =
        system.linear_momentum(solution.state.tail(n)) - system.linear_momentum(ivp.y0.tail(n));
    EXPECT_LT(norm(change), 1e-11) << scheme->info().name;
  }
}

TEST(SpecialisedSchemes, TakeAShorterLastStepUnlessTheyAreMultistep) {
  for (const auto& scheme : specialised_schemes()) {
    if (scheme->info().is_multistep) continue;
    const Ivp ivp =
        random_network(93, {.is_damped = !scheme->info().needs.has(Capability::position_forces)}, 1.0);
    // 99 whole steps and a tenth of one: the end lies near that of the run whose steps fit.
    const double h = 1.0 / 99.1;
    const Vector whole = run(*scheme, ivp, 0.01).state;
    const Solution broken = run(*scheme, ivp, h);
    ASSERT_TRUE(broken.status.ok()) << scheme->info().name << ": " << broken.status.describe();
    EXPECT_EQ(broken.work.accepted_steps, 100u);
    const Vector fine = run(*scheme, ivp, 1.0 / 1600.0).state;
    EXPECT_LT((broken.state - fine).norm(), 2.0 * (whole - fine).norm() + 1e-6) << scheme->info().name;
  }
}

}  // namespace
}  // namespace fw::integrators
