#pragma once

#include <Eigen/Dense>
#include <memory>
#include <set>
#include <utility>
#include <vector>

#include "ode/first_order_jacobian.hpp"
#include "ode/integrator.hpp"
#include "sparse/sparse_slots.hpp"

namespace fw {

/// How a `ChangingNetwork` shows its matrices.
enum class PatternKind {
  sparse,  ///< the pattern follows the contacts and has a revision
  dense,   ///< every entry, always: nothing changes but values
};

/// Particles on a line joined to their neighbours by cubic springs with dampers (the stiff forces) and to the
/// ground by soft ones, and by *contacts*: springs and dampers between any two particles, which come and go
/// between the steps of a run and change the pattern of the matrices. A test double.
class ChangingNetwork final : public OdeSystem, public SecondOrderSystem, private ForceSplitting {
 public:
  using Pairs = std::vector<std::pair<int, int>>;

  /// `is_second_order`: whether schemes get to see M q̈ = f.
  ChangingNetwork(int particles, PatternKind kind, bool is_second_order = true)
      : particles_(particles),
        kind_(kind),
        is_second_order_(is_second_order),
        fixed_(static_cast<std::size_t>(particles), 0) {
    mass_.resize(particles);
    for (int i = 0; i < particles; ++i) mass_[i] = 1.0 + 0.1 * i;
  }

  /// Other contacts from now on. Never called during a step.
  void set_contacts(Pairs contacts) {
    contacts_ = std::move(contacts);
    if (kind_ == PatternKind::sparse) ++revision_;
  }

  /// How many patterns solvers have asked for.
  int patterns() const { return patterns_; }

  // OdeSystem
  Index size() const override { return 2 * particles_; }
  void rhs(double, ConstVectorRef y, VectorRef dydt) const override { slope(y.data(), dydt.data()); }
  void rhs(const Float128&, std::span<const Float128> y, std::span<Float128> dydt) const override {
    slope(y.data(), dydt.data());
  }
  void rhs(double, std::span<const Complex> y, std::span<Complex> dydt) const override {
    slope(y.data(), dydt.data());
  }
  SparseMatrix jacobian_pattern() const override { return FirstOrderJacobian(tangent_pattern()).pattern(); }
  void jacobian(double t, ConstVectorRef y, SparseMatrix& J) const override {
    const int before = patterns_;
    SparseMatrix K = tangent_pattern(), D = K;
    patterns_ = before;
    stiffness(t, y.head(particles_), y.tail(particles_), TangentModel::exact, K);
    damping(t, y.head(particles_), y.tail(particles_), D);
    FirstOrderJacobian(K).fill(K, D, mass_, J);
  }
  void jacobian_product(double t, ConstVectorRef y, ConstVectorRef w, VectorRef out) const override {
    first_order_product(*this, t, y, w, out);
  }
  const SecondOrderSystem* second_order() const override { return is_second_order_ ? this : nullptr; }
  std::uint64_t pattern_revision() const override { return revision_; }

  // SecondOrderSystem
  Index degrees_of_freedom() const override { return particles_; }
  const Vector& mass() const override { return mass_; }
  const std::vector<char>& fixed() const override { return fixed_; }
  ForceClass force_class() const override { return ForceClass::velocity; }
  void force(double, ConstVectorRef q, ConstVectorRef v, VectorRef f) const override {
    f.setZero();
    add_stiff(q.data(), v.data(), f.data());
    add_soft(q.data(), f.data());
  }
  SparseMatrix tangent_pattern() const override {
    ++patterns_;
    Matrix entries = Matrix::Ones(particles_, particles_);
    if (kind_ == PatternKind::sparse) {
      entries.setIdentity();
      for_each_pair([&](int i, int j, bool) { entries(i, j) = entries(j, i) = 1.0; });
    }
    SparseMatrix pattern = entries.sparseView();
    pattern.makeCompressed();
    pattern.coeffs().setZero();
    return pattern;
  }
  void stiffness(double t, ConstVectorRef q, ConstVectorRef v, TangentModel, SparseMatrix& K) const override {
    stiff_stiffness(t, q, v, K);
    for (int i = 0; i < particles_; ++i) at(K, i, i) -= soft * (1.0 + 3.0 * q[i] * q[i]);
  }
  void damping(double t, ConstVectorRef q, ConstVectorRef v, SparseMatrix& D) const override {
    stiff_damping(t, q, v, D);
  }
  void tangent_product(double t, ConstVectorRef q, ConstVectorRef v, ConstVectorRef dq, ConstVectorRef dv,
                       VectorRef out) const override {
    const int before = patterns_;
    SparseMatrix K = tangent_pattern(), D = K;
    patterns_ = before;
    stiffness(t, q, v, TangentModel::exact, K);
    damping(t, q, v, D);
    out = K * dq + D * dv;
  }
  const ForceSplitting* force_splitting() const override { return this; }

 private:
  static constexpr double stiff = 40.0, cubic = 15.0, damper = 0.3, contact = 60.0, soft = 2.0;

  // ForceSplitting
  void stiff_force(double, ConstVectorRef q, ConstVectorRef v, VectorRef f) const override {
    f.setZero();
    add_stiff(q.data(), v.data(), f.data());
  }
  void soft_force(double, ConstVectorRef q, ConstVectorRef, VectorRef f) const override {
    f.setZero();
    add_soft(q.data(), f.data());
  }
  void stiff_stiffness(double, ConstVectorRef q, ConstVectorRef, SparseMatrix& K) const override {
    K.coeffs().setZero();
    for_each_pair([&](int i, int j, bool is_contact) {
      const double d = q[j] - q[i];
      add_pair(K, i, j, is_contact ? contact : stiff + 3.0 * cubic * d * d);
    });
  }
  void stiff_damping(double, ConstVectorRef, ConstVectorRef, SparseMatrix& D) const override {
    D.coeffs().setZero();
    for_each_pair([&](int i, int j, bool) { add_pair(D, i, j, damper); });
  }

  static double& at(SparseMatrix& A, int i, int j) { return A.valuePtr()[sparse::slot_of(A, i, j)]; }
  static void add_pair(SparseMatrix& A, int i, int j, double rate) {
    at(A, i, i) -= rate;
    at(A, j, j) -= rate;
    at(A, i, j) += rate;
    at(A, j, i) += rate;
  }

  template <class Visit>
  void for_each_pair(Visit visit) const {
    for (int i = 0; i + 1 < particles_; ++i) visit(i, i + 1, false);
    for (const auto& [i, j] : contacts_) visit(i, j, true);
  }
  template <class S>
  void add_stiff(const S* q, const S* v, S* f) const {
    for_each_pair([&](int i, int j, bool is_contact) {
      const S d = q[j] - q[i];
      const S elastic = is_contact ? S(S(contact) * d) : S((S(stiff) + S(cubic) * d * d) * d);
      const S pull = elastic + S(damper) * (v[j] - v[i]);
      f[i] += pull;
      f[j] -= pull;
    });
  }
  template <class S>
  void add_soft(const S* q, S* f) const {
    for (int i = 0; i < particles_; ++i) f[i] -= S(soft) * (q[i] + q[i] * q[i] * q[i]);
  }
  template <class S>
  void slope(const S* y, S* dydt) const {
    const auto n = static_cast<std::size_t>(particles_);
    for (std::size_t i = 0; i < n; ++i) {
      dydt[i] = y[n + i];
      dydt[n + i] = S(0);
    }
    add_stiff(y, y + n, dydt + n);
    add_soft(y, dydt + n);
    for (std::size_t i = 0; i < n; ++i) dydt[n + i] /= S(mass_[static_cast<Index>(i)]);
  }

  int particles_;
  PatternKind kind_;
  bool is_second_order_;
  Vector mass_;
  std::vector<char> fixed_;
  Pairs contacts_;
  std::uint64_t revision_ = 0;
  mutable int patterns_ = 0;
};

/// A run over two changes of the contacts, after the first and after the second third of the steps that are
/// given.
struct ChangingRun {
  Solution solution;
  int patterns_at_start = 0;        ///< asked for up to the first change
  int patterns_for_change = 0;      ///< asked for after it
  int patterns_without_change = 0;  ///< asked for between the first step and the first change
  std::shared_ptr<ChangingNetwork> network;
};

/// Runs `method` on `network`, with other contacts after steps `first` and 2·`first`.
inline ChangingRun run_over_changes(const Integrator& method, std::shared_ptr<ChangingNetwork> network,
                                    const StepControl& control, std::uint64_t first) {
  class Changes final : public Observer {
   public:
    Changes(ChangingRun& run, std::uint64_t first) : run_(run), first_(first) {}
    bool observe(const StepView& view) override {
      ChangingNetwork& network = *run_.network;
      if (view.index == 1) after_one_step_ = network.patterns();
      if (view.index == first_) {
        run_.patterns_at_start = network.patterns();
        run_.patterns_without_change = network.patterns() - after_one_step_;
        network.set_contacts({{0, 3}, {1, 4}, {2, 5}});
      }
      if (view.index == 2 * first_) network.set_contacts({{0, 5}, {1, 4}});
      return true;
    }

   private:
    ChangingRun& run_;
    std::uint64_t first_;
    int after_one_step_ = 0;
  };
  ChangingRun run;
  run.network = std::move(network);
  Ivp ivp;
  ivp.system = run.network;
  ivp.t1 = 1.0;
  ivp.y0 = Vector::Zero(run.network->size());
  for (Index i = 0; i < ivp.y0.size(); ++i) ivp.y0[i] = 0.05 * static_cast<double>((7 * i + 3) % 5 - 2);
  Changes changes(run, first);
  run.solution = method.solve(ivp, control, changes);
  run.patterns_for_change = run.network->patterns() - run.patterns_at_start;
  return run;
}

}  // namespace fw
