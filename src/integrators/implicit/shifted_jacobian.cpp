#include "integrators/implicit/shifted_jacobian.hpp"

#include "integrators/implicit/step_matrix.hpp"

namespace fw::integrators {

namespace {

class FirstOrderShift final : public ShiftedJacobian {
 public:
  FirstOrderShift(const OdeSystem& system, Work& work)
      : work_(work), solver_(linalg::default_direct_solver()), matrix_(system), right_side_(system.size()) {}

  Status factorise(double t, ConstVectorRef y, double eta) override {
    ++work_.jacobian_evaluations;
    return solver_->factorise(matrix_.assemble(t, y, eta), work_);
  }
  Status solve(VectorRef r) override {
    right_side_ = r;
    return solver_->solve(right_side_, r, work_).status;
  }
  void forget_matrix() override { solver_->forget(); }
  void serialise(StateArchive& archive) override { solver_->serialise(archive); }

 private:
  Work& work_;
  std::unique_ptr<linalg::LinearSolver> solver_;
  ShiftedMatrix matrix_;
  Vector right_side_;
};

class SecondOrderShift final : public ShiftedJacobian {
 public:
  SecondOrderShift(const SecondOrderSystem& system, Work& work)
      : system_(system),
        work_(work),
        solver_(linalg::default_direct_solver()),
        matrix_(system),
        right_side_(system.degrees_of_freedom()),
        velocity_(system.degrees_of_freedom()) {}

  Status factorise(double t, ConstVectorRef y, double eta) override {
    const Index n = velocity_.size();
    eta_ = eta;
    ++work_.jacobian_evaluations;
    return solver_->factorise(matrix_.assemble(t, y.head(n), y.tail(n), eta, TangentModel::exact), work_);
  }
  Status solve(VectorRef r) override {
    const Index n = velocity_.size();
    right_side_.noalias() = matrix_.stiffness() * r.head(n);
    right_side_ = system_.mass().cwiseProduct(r.tail(n)) + eta_ * right_side_;
    Status status = solver_->solve(right_side_, velocity_, work_).status;
    r.head(n) += eta_ * velocity_;
    r.tail(n) = velocity_;
    const std::vector<char>& fixed = system_.fixed();
    for (Index i = 0; i < n; ++i) {
      if (fixed[static_cast<std::size_t>(i)] != 0) r[i] = r[n + i] = 0.0;
    }
    return status;
  }
  void forget_matrix() override { solver_->forget(); }
  void serialise(StateArchive& archive) override { solver_->serialise(archive); }

 private:
  const SecondOrderSystem& system_;
  Work& work_;
  std::unique_ptr<linalg::LinearSolver> solver_;
  StepMatrix matrix_;
  Vector right_side_, velocity_;
  double eta_ = 0.0;
};

}  // namespace

std::unique_ptr<ShiftedJacobian> make_shifted_jacobian(const OdeSystem& system, Work& work) {
  if (system.second_order() != nullptr)
    return std::make_unique<SecondOrderShift>(*system.second_order(), work);
  return std::make_unique<FirstOrderShift>(system, work);
}

}  // namespace fw::integrators
