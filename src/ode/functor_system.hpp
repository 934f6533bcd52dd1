#pragma once

#include <limits>
#include <utility>
#include <vector>

#include "core/error.hpp"
#include "ode/first_order_jacobian.hpp"
#include "ode/ode_system.hpp"

namespace fw {

namespace detail {

/// Column j of the Jacobian of `f` at y by a complex step, Im f(y + i·h·e_j)/h with h = 1e-200: exact to
/// rounding, since nothing is subtracted [Squire, Trapp 1998].
inline constexpr double complex_step = 1e-200;

}  // namespace detail

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
    std::vector<Complex> state(y.data(), y.data() + size_);
    std::vector<Complex> slope(count());
    for (Index j = 0; j < size_; ++j) {
      auto& perturbed = state[static_cast<std::size_t>(j)];
      perturbed.imag(detail::complex_step);
      functor_(Complex(t), std::span<const Complex>(state), std::span<Complex>(slope));
      perturbed.imag(0.0);
      for (Index i = 0; i < size_; ++i) {
        J.valuePtr()[j * size_ + i] = slope[static_cast<std::size_t>(i)].imag() / detail::complex_step;
      }
    }
  }

  void jacobian_product(double t, ConstVectorRef y, ConstVectorRef w, VectorRef out) const override {
    std::vector<Complex> state(count());
    std::vector<Complex> slope(count());
    for (std::size_t i = 0; i < count(); ++i) {
      const auto k = static_cast<Index>(i);
      state[i] = {y[k], detail::complex_step * w[k]};
    }
    functor_(Complex(t), std::span<const Complex>(state), std::span<Complex>(slope));
    for (std::size_t i = 0; i < count(); ++i) {
      out[static_cast<Index>(i)] = slope[i].imag() / detail::complex_step;
    }
  }

 private:
  std::size_t count() const { return static_cast<std::size_t>(size_); }

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
      force_derivative(t, y.head(n), y.tail(n), j, [&](Index i, double df) {
        values[blocks_.stiffness(j * n + static_cast<int>(i), j)] = df / mass_[i];
      });
      force_derivative(t, y.head(n), y.tail(n), n + j, [&](Index i, double df) {
        values[blocks_.damping(j * n + static_cast<int>(i), j)] = df / mass_[i];
      });
    }
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
      throw InputError(
          "this system has no spring elements: its tangent stiffness is available as \"exact\" only");
    }
    const Index n = mass_.size();
    for (Index j = 0; j < n; ++j) {
      force_derivative(t, q, v, j, [&](Index i, double df) { K.valuePtr()[j * n + i] = df; });
    }
  }
  void damping(double t, ConstVectorRef q, ConstVectorRef v, SparseMatrix& D) const override {
    const Index n = mass_.size();
    for (Index j = 0; j < n; ++j) {
      force_derivative(t, q, v, n + j, [&](Index i, double df) { D.valuePtr()[j * n + i] = df; });
    }
  }
  void tangent_product(double t, ConstVectorRef q, ConstVectorRef v, ConstVectorRef dq, ConstVectorRef dv,
                       VectorRef out) const override {
    std::vector<Complex> q_step(count()), v_step(count()), f(count());
    for (std::size_t i = 0; i < count(); ++i) {
      const auto k = static_cast<Index>(i);
      q_step[i] = {q[k], detail::complex_step * dq[k]};
      v_step[i] = {v[k], detail::complex_step * dv[k]};
    }
    functor_(Complex(t), std::span<const Complex>(q_step), std::span<const Complex>(v_step),
             std::span<Complex>(f));
    for (std::size_t i = 0; i < count(); ++i) {
      out[static_cast<Index>(i)] = f[i].imag() / detail::complex_step;
    }
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

  /// Calls `sink(i, ∂f_i/∂y_j)` for all i, with y = (q, v).
  template <class Sink>
  void force_derivative(double t, ConstVectorRef q, ConstVectorRef v, Index j, Sink sink) const {
    const Index n = mass_.size();
    std::vector<Complex> q_step(q.data(), q.data() + n), v_step(v.data(), v.data() + n), f(count());
    (j < n ? q_step[static_cast<std::size_t>(j)] : v_step[static_cast<std::size_t>(j - n)])
        .imag(detail::complex_step);
    functor_(Complex(t), std::span<const Complex>(q_step), std::span<const Complex>(v_step),
             std::span<Complex>(f));
    for (Index i = 0; i < n; ++i) sink(i, f[static_cast<std::size_t>(i)].imag() / detail::complex_step);
  }

  Vector mass_;
  std::vector<char> fixed_;
  ForceClass force_class_;
  Functor functor_;
  FirstOrderJacobian blocks_;  ///< of a dense tangent
};

}  // namespace fw
