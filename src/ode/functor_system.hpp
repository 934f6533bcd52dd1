#pragma once

#include <utility>
#include <vector>

#include "ode/complex_step.hpp"
#include "ode/first_order_jacobian.hpp"
#include "ode/not_applicable.hpp"
#include "ode/ode_system.hpp"

namespace fw {

/// A small dense first-order system given by a functor with
/// `template <class S> void operator()(const S& t, std::span<const S> y, std::span<S> dydt) const`.
/// Its Jacobian is obtained by complex steps (exact to rounding), its pattern is dense.
template <class Functor>
class FunctorSystem final : public OdeSystem {
 public:
  FunctorSystem(Index size, Functor functor) : size_(size), functor_(std::move(functor)) {}

  Index size() const override { return size_; }

  void rhs(double t, ConstVectorRef y, VectorRef dydt) const override {
    functor_(t, std::span<const double>(y.data(), count()), std::span<double>(dydt.data(), count()));
  }
  void rhs(const Float128& t, std::span<const Float128> y, std::span<Float128> dydt) const override {
    functor_(t, y, dydt);
  }
  void rhs(double t, std::span<const Complex> y, std::span<Complex> dydt) const override {
    functor_(Complex(t), y, dydt);
  }

  SparseMatrix jacobian_pattern() const override {
    SparseMatrix pattern = Matrix::Ones(size_, size_).sparseView();
    pattern.makeCompressed();
    pattern.coeffs().setZero();
    return pattern;
  }

  void jacobian(double t, ConstVectorRef y, SparseMatrix& J) const override {
    complex_step_jacobian(y, count(), 0, size_, evaluate_at(t),
                          [&](Index i, Index j, double value) { J.valuePtr()[j * size_ + i] = value; });
  }

  void jacobian_product(double t, ConstVectorRef y, ConstVectorRef w, VectorRef out) const override {
    complex_step_product(y, w, evaluate_at(t), out);
  }

 private:
  std::size_t count() const { return static_cast<std::size_t>(size_); }
  /// The right-hand side of complex numbers.
  auto evaluate_at(double t) const {
    return [this, t](const std::vector<Complex>& y, std::vector<Complex>& dydt) {
      functor_(Complex(t), std::span<const Complex>(y), std::span<Complex>(dydt));
    };
  }

  Index size_;
  Functor functor_;
};

/// A small dense second-order system M q̈ = f(t, q, v) given by its diagonal masses and a functor with
/// `template <class S> void operator()(const S& t, std::span<const S> q, std::span<const S> v,
/// std::span<S> f) const`. K and D are obtained by complex steps (exact to rounding), their pattern is dense.
template <class Functor>
class FunctorSecondOrderSystem final : public OdeSystem, public SecondOrderSystem {
 public:
  FunctorSecondOrderSystem(Vector mass, ForceClass force_class, Functor functor)
      : mass_(std::move(mass)),
        fixed_(static_cast<std::size_t>(mass_.size()), 0),
        force_class_(force_class),
        functor_(std::move(functor)),
        blocks_(FunctorSecondOrderSystem::tangent_pattern()) {}

  Index size() const override { return 2 * mass_.size(); }
  void rhs(double t, ConstVectorRef y, VectorRef dydt) const override {
    evaluate(t, std::span<const double>(y.data(), 2 * count()), std::span<double>(dydt.data(), 2 * count()));
  }
  void rhs(const Float128& t, std::span<const Float128> y, std::span<Float128> dydt) const override {
    evaluate(t, y, dydt);
  }
  void rhs(double t, std::span<const Complex> y, std::span<Complex> dydt) const override {
    evaluate(Complex(t), y, dydt);
  }

  SparseMatrix jacobian_pattern() const override { return blocks_.pattern(); }
  void jacobian(double t, ConstVectorRef y, SparseMatrix& J) const override {
    const auto n = static_cast<int>(mass_.size());
    double* values = J.valuePtr();
    for (int j = 0; j < n; ++j) {
      values[blocks_.diagonal(j)] = 0.0;
      values[blocks_.unit(j)] = 1.0;
    }
    complex_step_jacobian(y, count(), 0, 2 * n, evaluate_at(t), [&](Index row, Index column, double df) {
      const auto i = static_cast<int>(row), j = static_cast<int>(column);
      values[j < n ? blocks_.stiffness(j * n + i, j) : blocks_.damping((j - n) * n + i, j - n)] =
          df / mass_[i];
    });
  }
  void jacobian_product(double t, ConstVectorRef y, ConstVectorRef w, VectorRef out) const override {
    first_order_product(*this, t, y, w, out);
  }
  const SecondOrderSystem* second_order() const override { return this; }

  Index degrees_of_freedom() const override { return mass_.size(); }
  const Vector& mass() const override { return mass_; }
  const std::vector<char>& fixed() const override { return fixed_; }
  ForceClass force_class() const override { return force_class_; }
  void force(double t, ConstVectorRef q, ConstVectorRef v, VectorRef f) const override {
    functor_(t, std::span<const double>(q.data(), count()), std::span<const double>(v.data(), count()),
             std::span<double>(f.data(), count()));
  }
  SparseMatrix tangent_pattern() const override {
    const Index n = mass_.size();
    SparseMatrix pattern = Matrix::Ones(n, n).sparseView();
    pattern.makeCompressed();
    pattern.coeffs().setZero();
    return pattern;
  }
  void stiffness(double t, ConstVectorRef q, ConstVectorRef v, TangentModel model,
                 SparseMatrix& K) const override {
    if (model != TangentModel::exact) {
      throw NotApplicable(
          "this system has no spring elements: its tangent stiffness is available as \"exact\" only");
    }
    const Index n = mass_.size();
    complex_step_jacobian(stacked(q, v), count(), 0, n, evaluate_at(t),
                          [&](Index i, Index j, double df) { K.valuePtr()[j * n + i] = df; });
  }
  void damping(double t, ConstVectorRef q, ConstVectorRef v, SparseMatrix& D) const override {
    const Index n = mass_.size();
    complex_step_jacobian(stacked(q, v), count(), n, 2 * n, evaluate_at(t),
                          [&](Index i, Index j, double df) { D.valuePtr()[(j - n) * n + i] = df; });
  }
  void tangent_product(double t, ConstVectorRef q, ConstVectorRef v, ConstVectorRef dq, ConstVectorRef dv,
                       VectorRef out) const override {
    complex_step_product(stacked(q, v), stacked(dq, dv), evaluate_at(t), out);
  }

 private:
  std::size_t count() const { return static_cast<std::size_t>(mass_.size()); }

  template <class S>
  void evaluate(const S& t, std::span<const S> y, std::span<S> dydt) const {
    const std::size_t n = count();
    for (std::size_t i = 0; i < n; ++i) dydt[i] = y[n + i];
    functor_(t, y.first(n), y.last(n), dydt.last(n));
    for (std::size_t i = 0; i < n; ++i) dydt[n + i] /= S(mass_[static_cast<Index>(i)]);
  }

  static Vector stacked(ConstVectorRef q, ConstVectorRef v) {
    Vector y(q.size() + v.size());
    y << q, v;
    return y;
  }
  /// The force at complex y = (q, v).
  auto evaluate_at(double t) const {
    return [this, t](const std::vector<Complex>& y, std::vector<Complex>& f) {
      const std::span<const Complex> state(y);
      functor_(Complex(t), state.first(count()), state.last(count()), std::span<Complex>(f));
    };
  }

  Vector mass_;
  std::vector<char> fixed_;
  ForceClass force_class_;
  Functor functor_;
  FirstOrderJacobian blocks_;  ///< of a dense tangent
};

}  // namespace fw
