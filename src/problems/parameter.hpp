#pragma once

#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "core/extended_precision.hpp"
#include "problems/problem_entry.hpp"

namespace fw::problems {

/// A parameter, meant as the decimal number that a person wrote: 0.6 is 3/5. In double it is the nearest
/// double; in binary128 it is the nearest binary128 to the *decimal* (the shortest one that reads back as the
/// double), so that references agree with digits published for e = 0.6.
class Parameter {
 public:
  explicit Parameter(double value);

  /// The value in scalar S.
  template <class S>
  S as() const {
    if constexpr (std::is_same_v<S, Float128>) {
      return decimal_;
    } else {
      return S(binary_);
    }
  }
  double binary() const { return binary_; }
  const Float128& decimal() const { return decimal_; }

 private:
  double binary_;
  Float128 decimal_;
};

/// The parameters in force: the defaults of `entry` overridden by what was given.
class ParameterSet {
 public:
  /// Throws InputError for a name that `entry` does not have (the message lists those it has) and for values
  /// that are not finite.
  ParameterSet(const ProblemEntry& entry, const ProblemParameters& given);

  /// The parameter called `name`, which has to be one of the entry's.
  Parameter operator[](const std::string& name) const;
  /// The same, checked to be > 0.
  Parameter positive(const std::string& name) const;
  /// The same, checked to be ≥ 0.
  Parameter non_negative(const std::string& name) const;
  /// The same, checked to be a whole number in [least, largest].
  int whole(const std::string& name, int least, int largest) const;
  /// Throws InputError "problem …: parameter name = value, expected …".
  [[noreturn]] void reject(const std::string& name, const std::string& expected) const;

  /// "a=1, b=0.5", sorted by name, each number in the shortest form that reads back as the same double.
  std::string text() const;

 private:
  std::string problem_;
  ProblemParameters values_;
};

/// Sets y₀ to the rounded `state`, and `y0_extended` where rounding changed something.
void set_initial_state(Ivp& ivp, const std::vector<Float128>& state);

}  // namespace fw::problems
