#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "core/status.hpp"
#include "core/work.hpp"
#include "integrators/loop/continuous_extension.hpp"
#include "integrators/loop/slope_polynomial.hpp"
#include "integrators/loop/stepper.hpp"
#include "ode/integrator.hpp"

namespace fw::integrators {

/// Makes a step of a scheme from (t, y) that ends at `t_end` and writes the state there into `out`. It must
/// depend on nothing that went before, and change nothing that the run reads.
using SideStep = std::function<Status(double t, double t_end, ConstVectorRef y, VectorRef out)>;

/// Side steps by a stepper of their own, which `make` makes before the first of them and which starts anew
/// for each.
SideStep side_step_of(std::function<std::unique_ptr<Stepper>()> make);

/// Dense output by side steps (`DenseOutput::side_steps`, `DenseOutput::side_step_polynomial`): steps of the
/// scheme itself from the start of the last step to places inside it.
///
/// Without nodes each state is a side step: local error O(h^{p+1}) with the constant of the scheme times
/// θ^{p+1}, for schemes that solve equations in every stage and for stiff problems. With m nodes the states
/// are those of the polynomial of degree 2m + 3 that has values and slopes of both ends and of side steps to m
/// places in between, which are computed when the first state of a step is asked for. The places are the zeros
/// of a Chebyshev polynomial, stretched so that the outer ones are the ends: they make the largest value of
/// the error's factor ∏(θ − θ_i)² small.
///
/// A scheme that has continuous weights of an order p − 1 (Dormand–Prince 5(4), Tsitouras 5(4)) needs no side
/// steps for its polynomial: its slopes at two places, f(t + θh, y(t + θh)), are good to O(h^p), which a
/// polynomial through them and both ends integrates to O(h^{p+1}) (`SlopePolynomial`).
///
/// A side step that fails is tried in 2, 4, … 256 parts; where all fail the state is NaN.
class SideSteps {
 public:
  /// `system`, `work` and `extension` outlive it; `extension` may be null. With one node and continuous
  /// weights the polynomial is made of these.
  SideSteps(const OdeSystem& system, int nodes, SideStep step, Work& work,
            ContinuousExtension* extension = nullptr);

  /// The step from (t, start) to (t_end, end). Both states have to stay where they are until the next call.
  void set_step(double t, double t_end, ConstVectorRef start, ConstVectorRef end);

  /// y(t), t inside the step; exactly the states of the step at its ends.
  void operator()(double t, VectorRef out);

 private:
  bool reach(double t, VectorRef out);
  bool reach_in_parts(double t, int parts, VectorRef out);
  void prepare();
  void evaluate(double theta, VectorRef out) const;

  const OdeSystem& system_;
  SideStep step_;
  Work& work_;
  ContinuousExtension* extension_;  ///< null: none
  double start_time_ = 0.0, end_time_ = 0.0;
  const double* start_ = nullptr;
  const double* end_ = nullptr;
  Vector from_;
  std::vector<double> places_;           ///< θ of the ends and of the nodes; empty: no polynomial
  std::vector<Vector> states_, slopes_;  ///< at the places
  bool is_prepared_ = false, has_polynomial_ = false;  ///< of this step
};

/// How many nodes the polynomials of a method have: so many that their degree 2m + 3 is its order at least. 0 where it
/// has none.
int side_step_nodes(const MethodInfo& info);

}  // namespace fw::integrators
