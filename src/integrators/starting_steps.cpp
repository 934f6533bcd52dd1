#include "integrators/starting_steps.hpp"

#include <vector>

#include "integrators/implicit_update.hpp"

namespace fw::integrators {

namespace {

/// The last row of an Aitken–Neville table for the limit h → 0 of values with an expansion in h^power.
class ExtrapolationTable {
 public:
  ExtrapolationTable(int columns, int power, Index size)
      : power_(power),
        row_(static_cast<std::size_t>(columns), Vector(size)),
        value_(size),
        difference_(size) {}

  int columns() const { return static_cast<int>(row_.size()); }
  /// Where the value of the next row's basic scheme is to be written.
  Vector& value() { return value_; }

  /// Takes `value` as the basic scheme's with `substeps[j]` substeps, j = 0, 1, ….
  void add(int j, const std::vector<int>& substeps) {
    const auto last = static_cast<std::size_t>(j);
    for (std::size_t k = 0; k < last; ++k) {
      double ratio = static_cast<double>(substeps[last]) / substeps[last - k - 1];
      if (power_ == 2) ratio *= ratio;
      difference_ = value_ - row_[k];
      row_[k] = value_;  // T_{j,k}
      value_ += difference_ / (ratio - 1.0);
    }
    row_[last] = value_;
  }
  const Vector& limit() const { return row_.back(); }

 private:
  int power_;
  std::vector<Vector> row_;
  Vector value_, difference_;
};

class ExplicitStartingSteps final : public Stepper {
 public:
  ExplicitStartingSteps(const Ivp& ivp, int order, Work& work)
      : system_(*ivp.system),
        work_(work),
        table_((order + 1) / 2, 2, ivp.y0.size()),
        slope_(ivp.y0.size()),
        first_slope_(ivp.y0.size()),
        previous_(ivp.y0.size()),
        next_(ivp.y0.size()) {
    for (int j = 0; j < table_.columns(); ++j) substeps_.push_back(2 * (j + 1));
  }

  Status step(double t, double h, VectorRef y) override {
    system_.rhs(t, y, first_slope_);
    ++work_.rhs_evaluations;
    for (int j = 0; j < table_.columns(); ++j) {
      const int count = substeps_[static_cast<std::size_t>(j)];
      const double length = h / count;
      Vector& value = table_.value();
      previous_ = y;
      value = y + length * first_slope_;
      for (int i = 1; i < count; ++i) {
        system_.rhs(t + i * length, value, slope_);
        ++work_.rhs_evaluations;
        next_ = previous_ + (2.0 * length) * slope_;
        previous_ = value;
        value = next_;
      }
      table_.add(j, substeps_);
    }
    y = table_.limit();
    return {};
  }

 private:
  const OdeSystem& system_;
  Work& work_;
  ExtrapolationTable table_;
  std::vector<int> substeps_;
  Vector slope_, first_slope_, previous_, next_;
};

class ImplicitStartingSteps final : public Stepper {
 public:
  ImplicitStartingSteps(const Ivp& ivp, int order, Work& work)
      : update_(make_implicit_update(*ivp.system, work)),
        table_(order, 1, ivp.y0.size()),
        slope_(ivp.y0.size()),
        start_(ivp.y0.size()) {
    for (int j = 0; j < table_.columns(); ++j) substeps_.push_back(j + 1);
  }

  Status step(double t, double h, VectorRef y) override {
    for (int j = 0; j < table_.columns(); ++j) {
      const int count = substeps_[static_cast<std::size_t>(j)];
      const double length = h / count;
      Vector& value = table_.value();
      value = y;
      for (int i = 1; i <= count; ++i) {
        start_ = value;
        if (Status status = update_->solve(t + i * length, length, start_, value, slope_); !status.ok())
          return status;
      }
      table_.add(j, substeps_);
    }
    y = table_.limit();
    return {};
  }

 private:
  std::unique_ptr<ImplicitUpdate> update_;
  ExtrapolationTable table_;
  std::vector<int> substeps_;
  Vector slope_, start_;
};

}  // namespace

std::unique_ptr<Stepper> make_explicit_starting_steps(const Ivp& ivp, int order, Work& work) {
  return std::make_unique<ExplicitStartingSteps>(ivp, order, work);
}

std::unique_ptr<Stepper> make_implicit_starting_steps(const Ivp& ivp, int order, Work& work) {
  return std::make_unique<ImplicitStartingSteps>(ivp, order, work);
}

}  // namespace fw::integrators
