#include "mechanics/spring_splitting.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace fw::mechanics {

std::vector<std::vector<bool>> stiff_elements(const std::vector<std::vector<double>>& rates) {
  double smallest = std::numeric_limits<double>::infinity(), largest = 0.0;
  for (const std::vector<double>& batch : rates) {
    for (const double k : batch) {
      if (k > 0.0) smallest = std::min(smallest, k);
      largest = std::max(largest, k);
    }
  }
  const double bound = std::sqrt(smallest) * std::sqrt(largest);
  std::vector<std::vector<bool>> stiff(rates.size());
  for (std::size_t b = 0; b < rates.size(); ++b) {
    for (const double k : rates[b]) stiff[b].push_back(k > 0.0 && (smallest == largest || k > bound));
  }
  return stiff;
}

bool SpringSplitting::is_possible(const ElementAssembly& elements) {
  const auto is_positive = [](double k) { return k > 0.0; };
  return std::ranges::any_of(elements.rates(), [&](const std::vector<double>& batch) {
    return std::ranges::any_of(batch, is_positive);
  });
}

SpringSplitting::SpringSplitting(const ElementAssembly& elements, const BlockPattern& pattern,
                                 std::atomic<std::uint64_t>& degenerate,
                                 std::shared_ptr<const Driving> driving)
    : degenerate_(degenerate) {
  split(elements, pattern, std::move(driving));
}

void SpringSplitting::split(const ElementAssembly& elements, const BlockPattern& pattern,
                            std::shared_ptr<const Driving> driving) {
  driving_ = std::move(driving);
  elements_ = &elements;
  pattern_ = &pattern;
  stiff_.assign(elements.batch_count(), {});
  soft_.assign(elements.batch_count(), {});
  const std::vector<std::vector<bool>> stiff = stiff_elements(elements.rates());
  for (std::size_t b = 0; b < stiff.size(); ++b) {
    if (stiff[b].empty()) {
      stiff_[b].part = BatchChoice::Part::none;
      continue;
    }
    std::vector<std::size_t>& stiff_ones = stiff_[b].elements.emplace();
    std::vector<std::size_t>& soft_ones = soft_[b].elements.emplace();
    for (std::size_t e = 0; e < stiff[b].size(); ++e) (stiff[b][e] ? stiff_ones : soft_ones).push_back(e);
  }
}

void SpringSplitting::stiff_force(double, ConstVectorRef q, ConstVectorRef v, VectorRef f) const {
  count_degenerate(elements_->force(stiff_, q.data(), v.data(), f.data()));
}

void SpringSplitting::soft_force(double t, ConstVectorRef q, ConstVectorRef v, VectorRef f) const {
  count_degenerate(elements_->force(soft_, q.data(), v.data(), f.data()));
  if (driving_ != nullptr) driving_->add_force(t, f.data());
}

void SpringSplitting::stiff_stiffness(double, ConstVectorRef q, ConstVectorRef v, SparseMatrix& K) const {
  pattern_->require_tangent(K, "K of the stiff springs");
  count_degenerate(
      elements_->fill_stiffness(&stiff_, *pattern_, q.data(), v.data(), TangentModel::exact, K.valuePtr()));
}

void SpringSplitting::stiff_damping(double, ConstVectorRef q, ConstVectorRef v, SparseMatrix& D) const {
  pattern_->require_tangent(D, "D of the stiff springs");
  count_degenerate(elements_->fill_damping(&stiff_, *pattern_, q.data(), v.data(), D.valuePtr()));
}

}  // namespace fw::mechanics
