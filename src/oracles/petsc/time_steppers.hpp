#pragma once

#include <memory>
#include <string>
#include <vector>

#include "ode/integrator.hpp"

namespace fw::oracles {

/// Methods of PETSc's TS [Abhyankar et al. 2018] as integrators. Adaptive runs use PETSc's basic controller
/// with its weighted root mean square norm and the tolerances given; `petsc` are further options in PETSc's
/// notation ("-ts_adapt_type dsp -snes_rtol 1e-12"), which override what is set here. InputError for a type
/// that does not exist, numbers out of range and options that PETSc did not use.

/// One of a family of schemes by its name in PETSc.
struct TsType {
  std::string name;
  int order;
  int stages = 1;  ///< right-hand sides per step, first-same-as-last not counted twice; of explicit schemes
};

/// Explicit Runge-Kutta: 1fe, 2a, 2b, 3, 3bs, 4, 5f, 5dp, 5bs, 6vr, 7vr, 8vr.
struct TsRkOptions {
  std::string type = "5dp";
  std::string petsc{};
};
const std::vector<TsType>& ts_rk_types();
std::unique_ptr<Integrator> make_ts_rk(const TsRkOptions& options = {});

/// The θ-method, y₁ = y₀ + h f(t₀ + θh, y₀ + θ(y₁ − y₀)) or, as an endpoint variant,
/// y₁ = y₀ + h((1 − θ) f₀ + θ f₁). θ = 1: implicit Euler; θ = ½: midpoint rule or trapezoidal rule.
struct TsThetaOptions {
  double theta = 0.5;
  bool endpoint = false;
  std::string petsc{};
};
std::unique_ptr<Integrator> make_ts_theta(const TsThetaOptions& options = {});

/// Backward differentiation formulas of a given order, 1 to 6, with variable steps. PETSc starts with small
/// implicit Euler steps: with constant steps, orders above 2 converge with order 2 only.
struct TsBdfOptions {
  int order = 5;
  double tolerance_factor = 1e-3;  ///< PETSc's own tolerances as a fraction of those given (decision 0017)
  std::string petsc{};
};
std::unique_ptr<Integrator> make_ts_bdf(const TsBdfOptions& options = {});

/// Additive Runge-Kutta: 1bee, a2, l2, ars122, 2c, 2d, 2e, 3, ars443, 4, 5. The whole right-hand side
/// implicitly, or with `splitting` stiff springs implicitly and the rest explicitly.
struct TsArkimexOptions {
  std::string type = "4";
  bool splitting = false;
  std::string petsc{};
};
const std::vector<TsType>& ts_arkimex_types();
std::unique_ptr<Integrator> make_ts_arkimex(const TsArkimexOptions& options = {});

/// Rosenbrock-W: 2m, 2p, ra3pw, ra34pw2, rodas3, sandu3, grk4t, shamp4, veldd4, 4l. PETSc's work for
/// autonomous systems; here time is one more unknown.
struct TsRoswOptions {
  std::string type = "ra34pw2";
  std::string petsc{};
};
const std::vector<TsType>& ts_rosw_types();
std::unique_ptr<Integrator> make_ts_rosw(const TsRoswOptions& options = {});

/// Generalised-α on M q̈ = f(t, q, v) with the spectral radius 0 ≤ ρ∞ ≤ 1 at infinite frequency
/// [Chung, Hulbert 1993]. Of order 2 for ρ∞ = 1. Below that PETSc 3.18's estimate of the initial acceleration
/// is wrong by a factor of two (a difference quotient over half a step is divided by half of its length),
/// which leaves an error of first order.
struct TsAlpha2Options {
  double rho_infinity = 1.0;
  std::string petsc{};
};
std::unique_ptr<Integrator> make_ts_alpha2(const TsAlpha2Options& options = {});

/// Symplectic splitting of order 1 (symplectic Euler), 2 (velocity Verlet), 3 or 4; forces f(t, q) only.
struct TsBasicSymplecticOptions {
  int order = 2;
  std::string petsc{};
};
std::unique_ptr<Integrator> make_ts_basicsymplectic(const TsBasicSymplecticOptions& options = {});

}  // namespace fw::oracles
