#pragma once

#include <cmath>

#include "conformance/seeded_engines.hpp"
#include "integrators/energy_momentum/average_vector_field.hpp"
#include "integrators/structural/alpha_family.hpp"
#include "integrators/structural/generalised_alpha.hpp"
#include "integrators/structural/newmark.hpp"
#include "integrators/tableau/diagonally_implicit_runge_kutta.hpp"
#include "mechanics/mass_spring_system.hpp"

namespace fw::conformance {

namespace detail {

/// Adds `block(d, stiffness, rest_length)` for every spring of direction d to the rows of its free ends: with
/// the sign `diagonal` in the blocks (i, i) and (j, j), `coupling` in (i, j) and (j, i). Other systems stay
/// as they are.
template <class Block>
void correct_springs(const SecondOrderSystem& system, ConstVectorRef q, SparseMatrix& K, double diagonal,
                     double coupling, Block block) {
  const auto* springs = dynamic_cast<const mechanics::MassSpringSystem*>(&system);
  if (springs == nullptr) return;
  const mechanics::Springs& list = springs->model().springs;
  for (std::size_t e = 0; e < list.size(); ++e) {
    const Index i = list.first[e], j = list.second[e];
    const Eigen::Vector3d d = q.segment<3>(3 * j) - q.segment<3>(3 * i);
    const Eigen::Matrix3d B = block(d, list.stiffness[e], list.rest_length[e]);
    for (const auto& [row, column] : {std::pair{i, i}, {j, j}, {i, j}, {j, i}}) {
      if (system.fixed()[static_cast<std::size_t>(3 * row)] != 0) continue;
      for (Index r = 0; r < 3; ++r) {
        for (Index c = 0; c < 3; ++c) {
          K.coeffRef(3 * row + r, 3 * column + c) += (row == column ? diagonal : coupling) * B(r, c);
        }
      }
    }
  }
}

/// Erratum E1: +2 k l₀/L³ d dᵀ in K_ii for −k l₀/L³ d dᵀ.
inline void apply_wrong_sign(const SecondOrderSystem& system, ConstVectorRef q, SparseMatrix& K) {
  correct_springs(system, q, K, 3.0, 0.0,
                  [](const Eigen::Vector3d& d, double k, double l0) -> Eigen::Matrix3d {
                    return k * l0 / std::pow(d.norm(), 3) * d * d.transpose();
                  });
}

/// Without k (1 − l₀/L)(I − n nᵀ).
inline void drop_geometric_stiffness(const SecondOrderSystem& system, ConstVectorRef q, SparseMatrix& K) {
  correct_springs(system, q, K, 1.0, -1.0,
                  [](const Eigen::Vector3d& d, double k, double l0) -> Eigen::Matrix3d {
                    const Eigen::Vector3d n = d.normalized();
                    return k * (1.0 - l0 / d.norm()) * (Eigen::Matrix3d::Identity() - n * n.transpose());
                  });
}

inline std::unique_ptr<Integrator> altered(const std::string& name, Alteration alteration) {
  return on_altered_system(right_scheme(name), [alteration](const Ivp&, double) { return alteration; });
}

/// Every time of evaluation moved by `steps` of the constant step.
inline std::unique_ptr<Integrator> with_shifted_time(const std::string& name, double steps) {
  return on_altered_system(right_scheme(name), [steps](const Ivp&, double h) {
    return Alteration{.time = [by = steps * h](double t) { return t + by; }};
  });
}

inline std::unique_ptr<Integrator> with_control(const std::string& name, ClaimingIntegrator::Solve solve) {
  const std::unique_ptr<Integrator> right = right_scheme(name);
  return std::make_unique<ClaimingIntegrator>(right->info(), right->extended_solver(), std::move(solve));
}

/// Reports every error of an attempt as at most 0.9 of the tolerance.
inline Solution accept_every_step(const std::shared_ptr<const integrators::AdaptiveIntegrator>& right,
                                  const Ivp& ivp, const StepControl& control, Observer& observer) {
  const auto* adaptive = std::get_if<AdaptiveStep>(&control);
  if (adaptive == nullptr) return right->solve(ivp, control, observer);
  const integrators::AdaptiveIntegrator mutant(
      right->info(), {}, [right, tolerances = *adaptive](const Ivp& problem, Work& work) {
        return std::make_unique<SpoiledStepper>(
            right->make_stepper(problem, work),
            [tolerances](double, ConstVectorRef y, VectorRef y_new, VectorRef error) {
              const double size = integrators::error_in_tolerances(integrators::ErrorNorm::root_mean_square,
                                                                   tolerances, error, y, y_new);
              if (size > 0.9) error *= 0.9 / size;
            });
      });
  return mutant.solve(ivp, control, observer);
}

/// Takes whole steps until the end is passed and calls that the end.
inline Solution overshoot(const Integrator& right, const Ivp& ivp, const StepControl& control,
                          Observer& observer) {
  const auto* fixed = std::get_if<FixedStep>(&control);
  if (fixed == nullptr) return right.solve(ivp, control, observer);
  const StepCount count = count_steps(ivp.t0, ivp.t1, fixed->step);
  Ivp longer = ivp;
  if (count.remainder > 0.0) longer.t1 = ivp.t0 + static_cast<double>(count.total()) * fixed->step;
  Solution solution = right.solve(longer, control, observer);
  solution.time = ivp.t1;
  return solution;
}

}  // namespace detail

/// Mistakes in the evaluation of forces, masses and matrices.
inline std::vector<SeededBug> wrong_mechanics() {
  using namespace detail;
  const char* order = "order, forces f(t, q)";
  const char* damped_order = "order, forces f(t, q, v)";
  const char* agreement = "agreement with the oracle";
  const auto verlet = [](const char* name, const char* description, VerletMistake mistake,
                         std::vector<std::string> caught_by) {
    return hand_written_bug(
        name, description, "velocity_verlet",
        [mistake](bool mutated) { return verlet_with(mutated ? mistake : VerletMistake::none); },
        std::move(caught_by));
  };
  const char* oscillator = "oscillator matrix";
  std::vector<SeededBug> bugs;
  bugs.push_back(verlet("verlet_stale_force", "the old force in the second half-kick",
                        VerletMistake::stale_force,
                        {order, damped_order, oscillator, "symplectic", "reversible in time"}));
  bugs.push_back(verlet("verlet_missing_inverse_mass", "f in place of f/m",
                        VerletMistake::missing_inverse_mass, {order, damped_order, oscillator}));
  bugs.push_back(verlet("verlet_force_at_the_old_time", "f(t, q') in place of f(t + h, q')",
                        VerletMistake::force_at_the_old_time, {order, damped_order}));
  bugs.push_back(verlet("verlet_lagged_damper",
                        "E6: f(t + h, q', v) with the old velocity, claimed of order 2",
                        VerletMistake::lagged_damper, {damped_order, oscillator}));
  bugs.push_back(verlet("verlet_half_kick_missing", "the second half-kick left out",
                        VerletMistake::half_kick_missing, {order, damped_order, oscillator}));
  bugs.push_back(hand_written_bug(
      "rk4_wrong_node", "the third stage at t in place of t + h/2", "rk4",
      [](bool mutated) { return rk4_with_third_node(mutated ? 0.0 : 0.5); },
      {order, damped_order, "order, y' = f(t, y)", "polynomial exactness", "tableau of the running code"}));
  bugs.push_back(code_bug("midpoint_force_at_the_start", "force at t in place of t + h/2",
                          "implicit_midpoint", [] { return with_shifted_time("implicit_midpoint", -0.5); },
                          {order, damped_order, "order, y' = f(t, y)", "polynomial exactness"}));
  bugs.push_back(code_bug("kahan_li8_times_shifted", "forces one step late, in double only", "kahan_li8",
                          [] { return with_shifted_time("kahan_li8", -1.0); },
                          {"double and binary128 agree"}));
  for (const char* twin : {"ros3p", "rodas4"}) {
    // The order of ros3p is measured in double; that of rodas4 in binary128, where the matrix is the right
    // one.
    bugs.push_back(code_bug(
        std::string(twin) + "_damper_dropped", "the matrix of the Rosenbrock scheme without D", twin,
        [twin] {
          return altered(
              twin, {.damping = [](const SecondOrderSystem&, SparseMatrix& D) { D.coeffs().setZero(); }});
        },
        {twin == std::string("ros3p") ? damped_order : "double and binary128 agree", "stability function",
         agreement}));
  }
  bugs.push_back(code_bug("rodas4_geometric_stiffness_dropped", "K without k (1 - l0/L)(I - n n^T)", "rodas4",
                          [] { return altered("rodas4", {.stiffness = drop_geometric_stiffness}); },
                          {agreement}));
  bugs.push_back(code_bug("rodas4_sign_of_E1", "K_ii with +2 k l0/L^3 d d^T, as printed", "rodas4",
                          [] { return altered("rodas4", {.stiffness = apply_wrong_sign}); }, {agreement}));
  bugs.push_back(code_bug("ros3p_time_derivative_dropped", "without gamma_i h^2 df/dt", "ros3p",
                          [] {
                            // Times on a grid of h/8: the differences that would give ∂f/∂t are zero, the
                            // stages are on the grid.
                            return on_altered_system(right_scheme("ros3p"), [](const Ivp& ivp, double h) {
                              return Alteration{.time = [t0 = ivp.t0, unit = h / 8.0](double t) {
                                return unit == 0.0 ? t : t0 + std::round((t - t0) / unit) * unit;
                              }};
                            });
                          },
                          {order, damped_order, "polynomial exactness"}));
  bugs.push_back(
      code_bug("verlet_leaks_momentum", "the force on one particle a thousandth too large", "velocity_verlet",
               [] {
                 return altered("velocity_verlet", {.force = [](const SecondOrderSystem& system,
                                                                ConstVectorRef, ConstVectorRef, VectorRef f) {
                                  if (system.has_springs()) f.tail<3>() *= 1.001;
                                }});
               },
               {"linear momentum"}));
  bugs.push_back(
      code_bug("verlet_moves_fixed_particles", "weight acts on fixed particles too", "velocity_verlet",
               [] {
                 return altered("velocity_verlet", {.force = [](const SecondOrderSystem& system,
                                                                ConstVectorRef, ConstVectorRef, VectorRef f) {
                                  for (Index i = 0; i < f.size(); ++i) {
                                    if (system.fixed()[static_cast<std::size_t>(i)] != 0)
                                      f[i] -= 0.1 * system.mass()[i];
                                  }
                                }});
               },
               {"fixed particles"}));
  return bugs;
}

/// Mistakes of solvers, starts, ends and parameters.
inline std::vector<SeededBug> wrong_algorithms() {
  using namespace detail;
  const char* order = "order, forces f(t, q)";
  const char* damped_order = "order, forces f(t, q, v)";
  std::vector<SeededBug> bugs;
  // One correction from the old velocity leaves a scheme that is still symmetric and of order 2.
  bugs.push_back(hand_written_bug(
      "midpoint_one_newton_iteration", "Newton's iteration stopped after the first correction",
      "implicit_midpoint", [](bool mutated) { return midpoint_with_newton_iterations(mutated ? 1 : 30); },
      {"symplectic"}));
  bugs.push_back(code_bug("midpoint_loose_newton", "Newton's tolerance 1e-3", "implicit_midpoint",
                          [] {
                            return integrators::make_diagonally_implicit_runge_kutta(
                                tableau_of<schemes::ButcherTableau>("implicit_midpoint"),
                                {.newton_tolerance = 1e-3});
                          },
                          {"symplectic", "reversible in time"}));
  for (const char* twin : {"adams_bashforth4", "bdf3"}) {
    bugs.push_back(hand_written_bug(std::string(twin) + "_started_by_euler", "start of too low order", twin,
                                    [twin](bool mutated) { return multistep_by_hand(twin, mutated, false); },
                                    {order, damped_order, "order, y' = f(t, y)"}));
  }
  bugs.push_back(hand_written_bug(
      "adams_bashforth2_clipped_last_step", "a shorter last step with the formula for equal steps",
      "adams_bashforth2", [](bool mutated) { return multistep_by_hand("adams_bashforth2", false, mutated); },
      {"shorter last step"}));
  bugs.push_back(code_bug("rk4_overshoots_the_end", "a whole last step where a shorter one is due", "rk4",
                          [] {
                            const std::shared_ptr<const Integrator> right = right_scheme("rk4");
                            return with_control("rk4", [right](const Ivp& ivp, const StepControl& control,
                                                               Observer& observer) {
                              return overshoot(*right, ivp, control, observer);
                            });
                          },
                          {"shorter last step"}));
  bugs.push_back(code_bug("newmark_gamma_0_55", "gamma = 0.55, claimed of order 2", "newmark",
                          [] { return integrators::make_newmark({.beta = 0.25, .gamma = 0.55}); },
                          {order, damped_order}));
  bugs.push_back(code_bug("generalised_alpha_wrong_alpha_f", "alpha_f a tenth too large", "generalised_alpha",
                          [] {
                            integrators::AlphaParameters parameters =
                                integrators::alpha_parameters(integrators::GeneralisedAlphaOptions{});
                            parameters.alpha_f += 0.1;
                            return std::make_unique<integrators::FixedStepIntegrator>(
                                right_scheme("generalised_alpha")->info(),
                                integrators::alpha_family_stepper(parameters));
                          },
                          {order, damped_order}));
  bugs.push_back(code_bug("discrete_gradient_as_midpoint",
                          "the force at the midpoint in place of the discrete gradient", "discrete_gradient",
                          [] { return integrators::make_average_vector_field({.quadrature_points = 1}); },
                          {"energy"}));
  bugs.push_back(code_bug(
      "rk4_linear_dense_output", "a straight line in place of the Hermite polynomial", "rk4",
      [] {
        const std::shared_ptr<const Integrator> right = right_scheme("rk4");
        return with_control("rk4", [right](const Ivp& ivp, const StepControl& control, Observer& observer) {
          StraightLineObserver line(observer);
          return right->solve(ivp, control, line);
        });
      },
      {"dense output"}));
  const auto cubic = [](const char* name, std::vector<std::string> caught_by) {
    return code_bug(
        std::string(name) + "_cubic_dense_output", "cubic Hermite polynomials in place of side steps", name,
        [name] { return with_cubic_dense_output(right_scheme(name)); }, std::move(caught_by));
  };
  bugs.push_back(cubic("dormand_prince_853", {"dense output", "frames against the end"}));
  bugs.push_back(cubic("rodas4", {"dense output"}));  // an order lower: frames show it at tighter tolerances
  return bugs;
}

/// Mistakes in error estimates, step control and counting.
inline std::vector<SeededBug> wrong_step_control() {
  using namespace detail;
  const auto pair = [](const char* name, const char* description, PairMistake mistake,
                       std::vector<std::string> caught_by) {
    return hand_written_bug(
        name, description, "bogacki_shampine_32",
        [mistake](bool mutated) {
          return pair_by_hand("bogacki_shampine_32", mutated ? mistake : PairMistake::none);
        },
        std::move(caught_by));
  };
  std::vector<SeededBug> bugs;
  bugs.push_back(pair("pair_slope_not_refreshed",
                      "the first slope of a repeated step is the last of the rejected one",
                      PairMistake::slope_not_refreshed, {"rejected steps"}));
  bugs.push_back(pair("pair_evaluates_twice", "the last slope is not kept for the next step",
                      PairMistake::evaluates_twice, {"evaluations per step"}));
  bugs.push_back(pair("pair_forgets_to_count", "an evaluation that Work does not count",
                      PairMistake::forgets_to_count, {"evaluations per step"}));
  bugs.push_back(code_bug("dormand_prince_estimate_times_h", "the error estimate multiplied by h",
                          "dormand_prince_54",
                          [] {
                            return with_spoiled_attempts(
                                right_scheme("dormand_prince_54"),
                                [](double h, ConstVectorRef, VectorRef, VectorRef error) { error *= h; });
                          },
                          {"order of the error estimate"}));
  bugs.push_back(code_bug("dormand_prince_goes_on_with_the_lower_order",
                          "chosen steps go on with the embedded solution", "dormand_prince_54",
                          [] {
                            return with_spoiled_attempts(right_scheme("dormand_prince_54"),
                                                         [](double, ConstVectorRef, VectorRef y_new,
                                                            VectorRef error) { y_new -= error; });
                          },
                          {"attempted steps"}));
  bugs.push_back(code_bug("dormand_prince_estimate_too_small",
                          "the error estimate a thousandth of what it is", "dormand_prince_54",
                          [] {
                            return with_spoiled_attempts(
                                right_scheme("dormand_prince_54"),
                                [](double, ConstVectorRef, VectorRef, VectorRef error) { error *= 1e-3; });
                          },
                          {"error against tolerance"}));
  bugs.push_back(code_bug("dormand_prince_accepts_every_step",
                          "steps are accepted though their error is above the tolerance", "dormand_prince_54",
                          [] {
                            const std::shared_ptr<const integrators::AdaptiveIntegrator> right(
                                dynamic_cast<const integrators::AdaptiveIntegrator*>(
                                    right_scheme("dormand_prince_54").release()));
                            return with_control(
                                "dormand_prince_54",
                                [right](const Ivp& ivp, const StepControl& control, Observer& observer) {
                                  return accept_every_step(right, ivp, control, observer);
                                });
                          },
                          {"rejected steps"}));
  bugs.push_back(code_bug(
      "dormand_prince_ignores_the_tolerance", "constant steps whatever the tolerance", "dormand_prince_54",
      [] {
        const std::shared_ptr<const Integrator> right = right_scheme("dormand_prince_54");
        return with_control("dormand_prince_54",
                            [right](const Ivp& ivp, const StepControl& control, Observer& observer) {
                              if (std::holds_alternative<FixedStep>(control))
                                return right->solve(ivp, control, observer);
                              return right->solve(ivp, FixedStep{.step = (ivp.t1 - ivp.t0) / 50.0}, observer);
                            });
      },
      {"error against tolerance", "rejected steps"}));
  return bugs;
}

/// Claims that are not true.
inline std::vector<SeededBug> wrong_claims() {
  std::vector<SeededBug> bugs;
  bugs.push_back(claim_bug("explicit_euler_claimed_symplectic", "explicit Euler is said to be symplectic",
                           "explicit_euler", [](MethodInfo& info) { info.is_symplectic = true; },
                           {"symplectic", "energy"}));
  bugs.push_back(claim_bug("symplectic_euler_claimed_not_symplectic", "the claim left out",
                           "symplectic_euler", [](MethodInfo& info) { info.is_symplectic = false; },
                           {"symplectic"}));
  bugs.push_back(claim_bug("ruth3_claimed_symmetric", "a composition that is no palindrome", "ruth3",
                           [](MethodInfo& info) { info.is_symmetric = true; }, {"reversible in time"}));
  bugs.push_back(claim_bug("heun_claimed_a_stable", "an explicit scheme said to be A-stable", "heun",
                           [](MethodInfo& info) { info.is_a_stable = true; }, {"A-stability"}));
  bugs.push_back(claim_bug("trapezoidal_claimed_l_stable", "A-stable, but |R(infinity)| = 1", "trapezoidal",
                           [](MethodInfo& info) { info.is_l_stable = true; }, {"L-stability"}));
  bugs.push_back(claim_bug(
      "backward_verlet_claimed_of_order_2", "E6: order 1 with dampers, claimed 2", "verlet_backward_velocity",
      [](MethodInfo& info) { info.order_with_velocity_forces = 2; }, {"order, forces f(t, q, v)"}));
  bugs.push_back(claim_bug("rk4_claims_three_stages", "a stage not counted", "rk4",
                           [](MethodInfo& info) { info.stages = 3; }, {"evaluations per step"}));
  bugs.push_back(claim_bug("midpoint_claims_energy", "symplectic, but said to conserve energy",
                           "implicit_midpoint", [](MethodInfo& info) { info.conserves_energy = true; },
                           {"energy"}));
  return bugs;
}

}  // namespace fw::conformance
