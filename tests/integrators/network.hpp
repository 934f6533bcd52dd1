#pragma once

#include <algorithm>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "integrators/special/implicit_euler_linearised.hpp"
#include "integrators/special/verlet.hpp"
#include "integrators/tableau/diagonally_implicit_runge_kutta.hpp"
#include "integrators/tableau/explicit_runge_kutta.hpp"
#include "integrators/tableau/fully_implicit_runge_kutta.hpp"
#include "integrators/tableau/nystrom.hpp"
#include "integrators/tableau/rosenbrock.hpp"
#include "integrators/tableau/splitting.hpp"
#include "mechanics/mass_spring_system.hpp"
#include "mechanics/random_model.hpp"
#include "schemes/explicit_tableaus.hpp"
#include "schemes/implicit_tableaus.hpp"
#include "schemes/nystrom_tableaus.hpp"
#include "schemes/rosenbrock_tableaus.hpp"
#include "schemes/splitting_schemes.hpp"

namespace fw::integrators {

/// A connected network: a random closed path through all particles and random chords, at positions that keep
/// a distance from each other (a perturbed lattice), with velocities up to 0.5 m/s.
struct NetworkOptions {
  mechanics::SpringLaw law = mechanics::SpringLaw::hooke;
  bool is_damped = true;
  bool is_free = false;  ///< neither gravity, drag nor fixed particles
  int particles = 8;
};

inline Ivp random_network(std::uint64_t seed, const NetworkOptions& options, double end_time) {
  mechanics::RandomModels random(seed);
  mechanics::MassSpringModel model;
  const int n = options.particles;
  Ivp ivp;
  ivp.y0 = Vector::Zero(6 * n);
  for (int i = 0; i < n; ++i) {
    model.mass.push_back(random.uniform(0.3, 2.5));
    const Vec3<double> lattice{static_cast<double>(i % 2), static_cast<double>(i / 2 % 2),
                               static_cast<double>(i / 4)};
    store3(ivp.y0.data(), i, lattice + random.point(0.2));
    store3(ivp.y0.data() + 3 * n, i, random.point(0.5));
  }
  model.springs.law = options.law;
  const auto connect = [&](int i, int j) {
    random.add_spring(model.springs, i, j, options.is_damped);
    const double length = norm(load3(ivp.y0.data(), j) - load3(ivp.y0.data(), i));
    model.springs.rest_length.back() = length * random.uniform(0.8, 1.2);
    if (options.is_damped) model.springs.damping.back() = random.uniform(0.05, 1.0);
  };
  for (int i = 0; i < n; ++i) connect(i, (i + 1) % n);
  for (int chord = 0; chord < n; ++chord) {
    const int i = random.integer(0, n - 1);
    connect(i, (i + random.integer(2, n - 2)) % n);
  }
  if (!options.is_free) {
    model.gravity = random.point(5.0);
    if (options.is_damped) model.drag = random.uniform(0.01, 0.2);
    model.fixed = {1, 4};
    for (int i : model.fixed) store3(ivp.y0.data() + 3 * n, i, Vec3<double>{});
  }
  ivp.t1 = end_time;
  ivp.system = std::make_shared<const mechanics::MassSpringSystem>(std::move(model));
  return ivp;
}

/// The entry of that name in a family of schemes given by data.
template <class Scheme>
const Scheme& named(const std::vector<Scheme>& family, const std::string& name) {
  const auto found =
      std::find_if(family.begin(), family.end(), [&](const Scheme& scheme) { return scheme.name == name; });
  if (found == family.end()) throw std::logic_error("no scheme \"" + name + "\"");
  return *found;
}

inline std::unique_ptr<Integrator> explicit_runge_kutta(const std::string& name) {
  return make_explicit_runge_kutta(named(schemes::explicit_tableaus(), name));
}
inline std::unique_ptr<Integrator> splitting(const std::string& name) {
  return make_splitting(named(schemes::splitting_schemes(), name));
}
inline std::unique_ptr<Integrator> nystrom(const std::string& name) {
  return make_nystrom(named(schemes::nystrom_tableaus(), name));
}

/// The first entry of the list, implicit Euler.
inline std::unique_ptr<Integrator> make_implicit_euler() {
  return make_diagonally_implicit_runge_kutta(schemes::diagonally_implicit_tableaus().front());
}

/// Hand-written schemes that take constant steps and any force.
inline std::vector<std::unique_ptr<Integrator>> all_schemes() {
  std::vector<std::unique_ptr<Integrator>> list;
  for (const schemes::ButcherTableau& tableau : schemes::explicit_tableaus()) {
    list.push_back(make_explicit_runge_kutta(tableau));
  }
  list.push_back(nystrom("nystrom4_general"));
  for (const schemes::SplittingScheme& scheme : schemes::splitting_schemes()) {
    list.push_back(make_splitting(scheme));
  }
  list.push_back(make_verlet(VerletVelocity::central));
  list.push_back(make_verlet(VerletVelocity::backward));
  for (const schemes::ButcherTableau& tableau : schemes::diagonally_implicit_tableaus()) {
    list.push_back(make_diagonally_implicit_runge_kutta(tableau));
  }
  for (const schemes::ButcherTableau& tableau : schemes::fully_implicit_tableaus()) {
    list.push_back(make_fully_implicit_runge_kutta(tableau));
  }
  for (const schemes::RosenbrockTableau& tableau : schemes::rosenbrock_tableaus()) {
    list.push_back(make_rosenbrock(tableau));
  }
  for (auto kind : {linalg::LinearSolverKind::conjugate_gradient, linalg::LinearSolverKind::sparse_cholesky,
                    linalg::LinearSolverKind::sparse_lu}) {
    list.push_back(make_implicit_euler_linearised({.linear_solver = {.kind = kind}}));
  }
  return list;
}

inline Solution run(const Integrator& integrator, const Ivp& ivp, double step) {
  NullObserver observer;
  return integrator.solve(ivp, FixedStep{.step = step}, observer);
}

}  // namespace fw::integrators
