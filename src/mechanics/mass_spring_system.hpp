#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>

#include "mechanics/assembly/element_assembly.hpp"
#include "mechanics/mass_spring_model.hpp"
#include "mechanics/spring_splitting.hpp"
#include "ode/energies.hpp"
#include "ode/ode_system.hpp"

namespace fw::mechanics {

class Driving;

/// What a mass-spring system is made of besides its model, for those who have other elements or faster loops
/// than the shipped ones. Each is called with the system's own copy of the model, which outlives the result.
struct SystemParts {
  /// The sums over the elements; empty: those of the model, over the types of `ElementBatch`.
  std::function<std::unique_ptr<const ElementAssembly>(const MassSpringModel& model)> elements{};
  /// The forces in double precision; empty: the plain loop of the elements.
  std::function<std::unique_ptr<const ForceKernel>(const MassSpringModel& model)> kernel{};
};

/// A damped mass-spring system as a first-order system y = (x, v), particle i at 3i, 3i+1, 3i+2 of each half
/// [Zachmann 2011, S5-S9].
///
/// Forces, energies and matrices are sums over the force elements (mechanics/elements, mechanics/assembly);
/// what depends on time is a force of its own beside them, which depends on nothing else (`Driving`). A fixed
/// particle has zero force, zero ẋ and v̇ and zero rows in J, K and D; its velocity is taken to be zero in the
/// state, so that it holds still in dampers and energies as well. Outputs may not alias inputs.
/// Evaluations allocate nothing but the pattern, which is made on first use of a matrix and shared by all
/// threads.
class MassSpringSystem final : public OdeSystem, public SecondOrderSystem {
 public:
  /// Checks sizes, index ranges and signs of the parameters; throws InputError that names the entry.
  explicit MassSpringSystem(MassSpringModel model, SystemParts parts = {});
  ~MassSpringSystem() override;

  const MassSpringModel& model() const { return model_; }
  const ElementAssembly& elements() const { return *elements_; }
  /// Positions of each element's blocks in the matrices, made once on first use.
  const BlockPattern& block_pattern() const;

  /// Gives the system other elements on the same particles: `model` has as many particles as before, with the
  /// same masses and fixed ones. Not to be called while anything evaluates the system; references to
  /// elements and pattern end, a splitting splits the new elements. Throws InputError for a bad model, and the
  /// system stays as it is.
  void change_elements(MassSpringModel model);
  /// How often the elements have been changed.
  std::uint64_t element_revision() const { return element_revision_; }
  /// How often the structure of the matrices has changed: those of another revision do not fit.
  std::uint64_t pattern_revision() const { return pattern_revision_; }
  Index particle_count() const { return static_cast<Index>(model_.mass.size()); }

  // OdeSystem
  Index size() const override;
  void rhs(double t, ConstVectorRef y, VectorRef dydt) const override;
  void rhs(const Float128& t, std::span<const Float128> y, std::span<Float128> dydt) const override;
  void rhs(double t, std::span<const Complex> y, std::span<Complex> dydt) const override;
  SparseMatrix jacobian_pattern() const override;
  /// Throws InputError if `J` is not of `jacobian_pattern()`'s size. The tangent is the exact one.
  void jacobian(double t, ConstVectorRef y, SparseMatrix& J) const override;
  void jacobian_product(double t, ConstVectorRef y, ConstVectorRef w, VectorRef out) const override;
  const SecondOrderSystem* second_order() const override { return this; }
  /// Contact with and release by obstacles, ropes that become taut or slack, corners of tables over time; null
  /// without any.
  const SwitchingSurfaces* switching_surfaces() const override;

  // SecondOrderSystem
  Index degrees_of_freedom() const override;
  const Vector& mass() const override { return mass_; }
  const std::vector<char>& fixed() const override { return fixed_; }
  ForceClass force_class() const override { return force_class_; }
  bool has_springs() const override { return true; }
  void force(double t, ConstVectorRef q, ConstVectorRef v, VectorRef f) const override;
  SparseMatrix tangent_pattern() const override;
  /// `model` acts per element: see `spring_tangent` and `obstacle_tangent`. Under `psd_projection` −K is
  /// symmetric positive semi-definite on the free degrees of freedom (a fixed row is zeroed, its column is
  /// not). Throws InputError if `K` is not of `tangent_pattern()`'s size; so does `damping`.
  void stiffness(double t, ConstVectorRef q, ConstVectorRef v, TangentModel model,
                 SparseMatrix& K) const override;
  void damping(double t, ConstVectorRef q, ConstVectorRef v, SparseMatrix& D) const override;
  void tangent_product(double t, ConstVectorRef q, ConstVectorRef v, ConstVectorRef dq, ConstVectorRef dv,
                       VectorRef out) const override;
  /// Stiff and soft springs, see `SpringSplitting`; null where no spring has a positive stiffness.
  const ForceSplitting* force_splitting() const override;

  /// Whether forces or supports depend on time: energy comes from outside.
  bool is_driven() const { return driving_ != nullptr; }
  /// What depends on time; null where nothing does.
  const Driving* driving() const { return driving_.get(); }
  /// Whether no force is known to have kinks or jumps, in space or time.
  bool is_smooth() const;
  /// Adds to f [N] what depends on time alone, for schemes that sum the elements themselves; fixed particles
  /// get nothing.
  void add_driving_force(double t, VectorRef f) const;

  /// Energies of the state (q, v) at the time t [s]; it matters where supports move.
  Energies energies(double t, ConstVectorRef q, ConstVectorRef v) const;
  /// The same at t = 0, for systems whose supports stand.
  Energies energies(ConstVectorRef q, ConstVectorRef v) const { return energies(0.0, q, v); }
  /// Σ m v over all particles [kg·m/s].
  Vec3<double> linear_momentum(ConstVectorRef v) const;
  /// Σ x × m v about the origin [kg·m²/s].
  Vec3<double> angular_momentum(ConstVectorRef q, ConstVectorRef v) const;
  /// Power that dampers, drag, anchors' and obstacles' damping take out of the system [W], ≥ 0, so that
  /// d(kinetic + potential)/dt = external_power − dissipated_power. A contact whose force is clamped to zero
  /// loses its stored energy: see `obstacle_dissipated_power`.
  double dissipated_power(double t, ConstVectorRef q, ConstVectorRef v) const;
  /// The same at t = 0, for systems whose supports stand.
  double dissipated_power(ConstVectorRef q, ConstVectorRef v) const { return dissipated_power(0.0, q, v); }
  /// Power that forces over time and moving supports put into the system [W]; zero where there are none.
  double external_power(double t, ConstVectorRef q, ConstVectorRef v) const;

  /// How often a spring of length zero (direction undefined, force defined as zero) was met in an evaluation
  /// of forces, tangents or dissipated power since the system was made; one evaluation counts each such
  /// spring once.
  std::uint64_t degenerate_spring_evaluations() const { return degenerate_.load(std::memory_order_relaxed); }

 private:
  void count_degenerate(std::uint64_t springs) const {
    if (springs > 0) degenerate_.fetch_add(springs, std::memory_order_relaxed);
  }
  std::uint64_t evaluate_elements(const double* q, const double* v, double* f) const {
    return (kernel_ != nullptr ? *kernel_ : static_cast<const ForceKernel&>(*elements_)).force(q, v, f);
  }
  template <class Scalar>
  std::uint64_t evaluate_elements(const Scalar* q, const Scalar* v, Scalar* f) const {
    return elements_->force(q, v, f);
  }
  template <class Time, class Scalar>
  void evaluate_force(const Time& t, const Scalar* q, const Scalar* v, Scalar* f) const;
  template <class Time, class Scalar>
  void evaluate_rhs(const Time& t, const Scalar* y, Scalar* dydt) const;
  void make_elements();

  /// What is made of the elements on first use.
  struct Derived {
    std::once_flag pattern_once, splitting_once;
    std::unique_ptr<const BlockPattern> pattern;
    std::unique_ptr<SpringSplitting> splitting;
  };

  MassSpringModel model_;
  SystemParts parts_;
  Vector mass_;              ///< 3n, model_.mass repeated
  std::vector<char> fixed_;  ///< 3n
  std::unique_ptr<const ElementAssembly> elements_;
  std::unique_ptr<const ForceKernel> kernel_;  ///< null: the elements' own
  std::shared_ptr<const Driving> driving_;     ///< null: nothing depends on time
  std::unique_ptr<Derived> derived_;
  std::unique_ptr<const SwitchingSurfaces> surfaces_;
  ForceClass force_class_ = ForceClass::position;
  std::uint64_t element_revision_ = 0, pattern_revision_ = 0;
  mutable std::atomic<std::uint64_t> degenerate_{0};
};

}  // namespace fw::mechanics
