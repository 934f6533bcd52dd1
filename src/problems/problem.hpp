#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "ode/ivp.hpp"

namespace fw {

/// A function of time and state that the exact flow keeps constant.
struct Invariant {
  std::string name;  ///< for example "energy"
  std::string unit;
  std::function<double(double t, ConstVectorRef y)> value;
};

/// A published digit string that a reference has to reproduce.
struct KnownValue {
  double time = 0.0;    ///< [s]
  Index component = 0;  ///< index into y
  std::string digits;   ///< decimal, as published
};

/// The equations that theory is made for, as far as statements hold on them alone.
enum class TestEquation {
  none,
  single_oscillation,  ///< one undamped oscillation, q̈ = −ω²q or its first-order form, ω = `stiffness`
  prothero_robinson,   ///< ẏ = λ(y − φ(t)) + φ'(t)
  spring_chain,        ///< equal masses in a row, each tied to the next by a spring without a damper
};

/// A named initial value problem with everything that is known of it.
struct Problem {
  std::string name;  ///< as it is called in studies, for example "henon_heiles"
  std::string title;
  std::string description;  ///< the equations, in formula
  std::string source;       ///< literature
  Ivp ivp;
  TestEquation test_equation = TestEquation::none;
  /// y(t) in closed form, in binary128; empty where there is none.
  std::function<std::vector<Float128>(const Float128& t)> exact;
  std::vector<Invariant> invariants;
  std::vector<KnownValue> known_values;
  /// The largest |λ| of J along the solution [1/s]: tells how stiff it is on its interval.
  std::function<double()> stiffness;
  bool is_smooth = true;  ///< the right-hand side is smooth along the solution (no kinks)
  /// The parameters that were in force, as "name=value" text, for provenance and hashes.
  std::string parameters;
};

}  // namespace fw
