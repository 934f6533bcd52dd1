#include "integrators/loop/starting_steps.hpp"

#include <algorithm>
#include <vector>

#include "integrators/implicit/implicit_update.hpp"

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

  /// A step depends on (t, y) only.
  void restart(double, ConstVectorRef) override {}
  void serialise(StateArchive&) override {}

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

  void restart(double, ConstVectorRef) override { update_->forget_matrix(); }
  void serialise(StateArchive& archive) override { update_->serialise(archive); }

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

void extended_fixed_point(const OdeSystem& system, const Float128& t, const std::vector<Float128>& known,
                          const Float128& weight, std::vector<Float128>& y, std::vector<Float128>& slope) {
  constexpr int most_iterations = 200;
  for (int iteration = 0; iteration < most_iterations; ++iteration) {
    system.rhs(t, y, slope);
    Float128 change = 0, size = 0;
    for (std::size_t i = 0; i < y.size(); ++i) {
      const Float128 next = known[i] + weight * slope[i];
      change = std::max(change, Float128(abs(next - y[i])));
      size = std::max(size, Float128(abs(next)));
      y[i] = next;
    }
    if (change <= 1e-31 * size) return;
  }
}

void extended_starting_step(const OdeSystem& system, bool is_explicit, int order, const Float128& t,
                            const Float128& h, std::vector<Float128>& y) {
  const std::size_t n = y.size();
  const int columns = is_explicit ? (order + 1) / 2 : order;
  std::vector<std::vector<Float128>> row(static_cast<std::size_t>(columns), y);
  std::vector<Float128> value(n), slope(n), first_slope(n), previous(n);
  system.rhs(t, y, first_slope);
  const auto substeps = [&](int j) { return is_explicit ? 2 * (j + 1) : j + 1; };
  for (int j = 0; j < columns; ++j) {
    const int count = substeps(j);
    const Float128 length = h / count;
    value = y;
    if (is_explicit) {
      previous = y;
      for (std::size_t k = 0; k < n; ++k) value[k] += length * first_slope[k];
      for (int i = 1; i < count; ++i) {
        system.rhs(Float128(t + i * length), value, slope);
        for (std::size_t k = 0; k < n; ++k) {
          const Float128 next = previous[k] + 2 * length * slope[k];
          previous[k] = value[k];
          value[k] = next;
        }
      }
    } else {
      for (int i = 1; i <= count; ++i) {
        previous = value;
        extended_fixed_point(system, Float128(t + i * length), previous, length, value, slope);
      }
    }
    for (int k = 0; k < j; ++k) {
      Float128 ratio = Float128(substeps(j)) / substeps(j - k - 1);
      if (is_explicit) ratio *= ratio;
      auto& kept = row[static_cast<std::size_t>(k)];
      for (std::size_t i = 0; i < n; ++i) {
        const Float128 improved = value[i] + (value[i] - kept[i]) / (ratio - 1);
        kept[i] = value[i];
        value[i] = improved;
      }
    }
    row[static_cast<std::size_t>(j)] = value;
  }
  y = row.back();
}

}  // namespace fw::integrators
