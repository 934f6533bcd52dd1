#pragma once

#include <cstddef>
#include <string_view>
#include <vector>

#include "core/types.hpp"
#include "mechanics/driving_force.hpp"
#include "mechanics/elements/anchor.hpp"
#include "ode/switching_surfaces.hpp"

namespace fw::mechanics {

struct MassSpringModel;

/// All that depends on time in a mass-spring system, as a force f(t) that depends on nothing else.
///
/// A moving support differs from one that stands at its rest position p by such a force,
///
///   −k (x − p − d(t)) − c (v − ḋ(t)) = [−k (x − p) − c v] + [k d(t) + c ḋ(t)],
///
/// of which the first bracket is the anchor's element: elements, tangents and matrices know nothing of time
/// (decision 0082). Energies and powers are those of the anchor as it is, with the balance
///
///   d(T + V)/dt = P_ext − P_dissipated,   P_ext = Σ f(t)·v + Σ f_anchor·ḋ,
///
/// in which V has ½ k ‖x − p − d(t)‖² and P_dissipated has c ‖v − ḋ‖².
///
/// Fixed particles are left out of forces; the velocities of states are zero there. Immutable; nothing is
/// allocated by evaluations.
class Driving {
 public:
  /// Whether anything in the model depends on time.
  static bool is_needed(const MassSpringModel& model);

  /// Copies what it needs. Throws InputError that names the entry of `forces` or `support_motions`.
  explicit Driving(const MassSpringModel& model);
  Driving(const Driving&) = delete;
  Driving& operator=(const Driving&) = delete;

  /// Adds f(t) [N] to 3 entries per particle.
  template <class Scalar>
  void add_force(const Scalar& t, Scalar* f) const {
    add_force_as(t, f);
  }
  /// The same for complex forces, at a real time.
  void add_force(double t, Complex* f) const { add_force_as(t, f); }

  bool moves_supports() const { return !supports_.empty(); }
  /// Σ ½ k (‖x − p − d‖² − ‖x − p‖²) [J], by which the energies of anchors differ from those of their elements.
  double energy_of_motion(double t, const double* q) const;
  /// Σ c (‖v − ḋ‖² − ‖v‖²) [W], by which their dissipated power differs.
  double dissipation_of_motion(double t, const double* v) const;
  /// P_ext [W].
  double external_power(double t, const double* q, const double* v) const;

  bool is_smooth() const;
  /// Whether some times are known at which a derivative jumps.
  bool has_corners() const;
  /// The first corner of each function within the path. Numbers are those of `forces` and `support_motions`,
  /// phases the pieces of the tables counted from 1.
  template <class Scalar>
  void find_corners(const StatePath<Scalar>& path, SwitchSink<Scalar>& sink) const;

 private:
  /// A force and where it acts.
  struct Acting {
    formula::VectorFunction force;
    std::vector<int> particles;  ///< that are free
  };
  /// A motion and the anchors that follow it.
  struct Support {
    formula::VectorFunction displacement;
    std::vector<Anchor> anchors;
    std::vector<char> is_free;  ///< one per anchor
  };
  template <class Time, class Scalar>
  void add_force_as(const Time& t, Scalar* f) const;
  /// What stands in a switch beside its time.
  struct Corner {
    std::string_view kind;
    std::size_t number = 0;
    const formula::VectorFunction* function = nullptr;
    double jump = 0.0, rate = 0.0;  ///< per unit of the jump of the function's derivative
    std::vector<int> particles{};   ///< free ones
  };

  std::vector<Acting> forces_;
  std::vector<Support> supports_;
  std::vector<Corner> corners_;  ///< of the functions that have some, and move something
  std::size_t particles_ = 0;
};

extern template void Driving::find_corners(const StatePath<double>&, SwitchSink<double>&) const;
extern template void Driving::find_corners(const StatePath<Float128>&, SwitchSink<Float128>&) const;
extern template void Driving::add_force_as(const double&, double*) const;
extern template void Driving::add_force_as(const double&, Complex*) const;
extern template void Driving::add_force_as(const Float128&, Float128*) const;

}  // namespace fw::mechanics
