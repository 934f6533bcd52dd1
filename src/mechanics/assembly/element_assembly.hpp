#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/extended_precision.hpp"
#include "core/types.hpp"
#include "mechanics/assembly/block_pattern.hpp"
#include "mechanics/assembly/discrete_step.hpp"
#include "mechanics/assembly/element_choice.hpp"
#include "mechanics/assembly/force_kernel.hpp"
#include "mechanics/elements/element_labels.hpp"
#include "ode/energies.hpp"
#include "ode/second_order_system.hpp"
#include "ode/switching_surfaces.hpp"

namespace fw::mechanics {

/// The sums over all force elements of a system: forces, energies, matrices. Elements come in batches of one
/// type, summed in the order of the batches and of the elements in each. One virtual call per sum, none per
/// element; `AssemblyOf` implements it for a closed list of types.
///
/// Arrays hold xyz after xyz. Rows of fixed particles are zero. What returns a number counts the elements
/// that had no direction (springs of length zero). Immutable, safe to share, and nothing is allocated by
/// evaluations.
class ElementAssembly : public ForceKernel {
 public:
  virtual std::size_t batch_count() const = 0;
  virtual ElementLabels labels(std::size_t batch) const = 0;

  virtual ForceClass force_class() const = 0;
  /// Of one batch.
  virtual ForceClass force_class(std::size_t batch) const = 0;
  /// Whether a force or a derivative of it jumps somewhere.
  virtual bool has_kinks() const = 0;
  /// Whether some elements announce where their forces switch.
  virtual bool has_switches() const = 0;
  /// See `SwitchingSurfaces`; one mass per particle.
  virtual void find_switches(const StatePath<double>& path, const std::vector<double>& mass,
                             SwitchSink<double>& sink) const = 0;
  virtual void find_switches(const StatePath<Float128>& path, const std::vector<double>& mass,
                             SwitchSink<Float128>& sink) const = 0;
  virtual void find_acting(const double* y, const std::vector<double>& mass, SwitchSink<double>& sink) const = 0;
  /// Whether forces and torques sum to zero: momenta are conserved where no particle is fixed.
  virtual bool is_internal() const = 0;
  /// The nodes of each batch's elements, for a `BlockPattern`.
  virtual std::vector<Cliques> cliques() const = 0;
  /// How stiff each element is [N/m], batch by batch; empty for batches that do not say.
  virtual std::vector<std::vector<double>> rates() const = 0;

  using ForceKernel::force;
  virtual std::uint64_t force(const Float128* q, const Float128* v, Float128* f) const = 0;
  virtual std::uint64_t force(const Complex* q, const Complex* v, Complex* f) const = 0;
  /// The forces of a choice of elements.
  virtual std::uint64_t force(const ElementChoice& choice, const double* q, const double* v,
                              double* f) const = 0;

  /// Adds the potential energies at q by their names.
  virtual void add_energies(const double* q, Energies& energies) const = 0;
  /// Power that the elements take out of the system [W]; see `MassSpringSystem::dissipated_power`.
  virtual double dissipated_power(const double* q, const double* v, std::uint64_t& degenerate) const = 0;

  /// out = K·dq + D·dv.
  virtual std::uint64_t tangent_product(const double* q, const double* v, const double* dq, const double* dv,
                                        double* out) const = 0;
  /// K into the values of a matrix of `pattern`'s tangent; `choice` null stands for all elements.
  virtual std::uint64_t fill_stiffness(const ElementChoice* choice, const BlockPattern& pattern,
                                       const double* q, const double* v, TangentModel model,
                                       double* values) const = 0;
  /// D likewise.
  virtual std::uint64_t fill_damping(const ElementChoice* choice, const BlockPattern& pattern,
                                     const double* q, const double* v, double* values) const = 0;
  /// Adds M⁻¹K and M⁻¹D to the values of a matrix of `pattern`'s Jacobian; one mass per particle.
  virtual std::uint64_t fill_jacobian(const BlockPattern& pattern, const std::vector<double>& mass,
                                      const double* q, const double* v, double* values) const = 0;

  /// The forces over a step of an energy-momentum scheme.
  virtual void discrete_force(const DiscreteStep& step, double* f) const = 0;
  /// Adds their weighted derivatives to the values of a matrix of `pattern`'s tangent.
  virtual void fill_discrete(const BlockPattern& pattern, const DiscreteStep& step,
                             const DiscreteWeights& weights, double* values) const = 0;
};

}  // namespace fw::mechanics
