#include "mechanics/spring_splitting.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "mechanics/mass_spring_tangent.hpp"
#include "mechanics/tangent_fill.hpp"

namespace fw::mechanics {

namespace {

std::vector<double> rates(const Springs& springs) {
  return with_spring_law(springs.law, [&](auto law) {
    std::vector<double> result(springs.size());
    for (std::size_t e = 0; e < springs.size(); ++e) {
      result[e] = spring_rate<law()>(spring_parameters(springs, e));
    }
    return result;
  });
}

void append(Springs& to, const Springs& from, std::size_t e) {
  to.first.push_back(from.first[e]);
  to.second.push_back(from.second[e]);
  to.stiffness.push_back(from.stiffness[e]);
  to.damping.push_back(from.damping[e]);
  to.rest_length.push_back(from.rest_length[e]);
}

/// Fills a matrix of the whole system's pattern from the springs of a part of it.
template <class Fill>
struct PartFill {
  Fill fill;
  const std::vector<std::size_t>& index;

  void point(int i, const auto& tangent) const { fill.point(i, tangent); }
  void pair(std::size_t e, int i, int j, const CentralForceTangent& tangent) const {
    fill.pair(index[e], i, j, tangent);
  }
};

}  // namespace

std::vector<bool> stiff_springs(const Springs& springs) {
  const std::vector<double> rate = rates(springs);
  double smallest = std::numeric_limits<double>::infinity(), largest = 0.0;
  for (const double k : rate) {
    if (k > 0.0) smallest = std::min(smallest, k);
    largest = std::max(largest, k);
  }
  const double bound = std::sqrt(smallest) * std::sqrt(largest);
  std::vector<bool> stiff(rate.size());
  for (std::size_t e = 0; e < rate.size(); ++e) {
    stiff[e] = rate[e] > 0.0 && (smallest == largest || rate[e] > bound);
  }
  return stiff;
}

bool SpringSplitting::is_possible(const MassSpringModel& model) {
  return std::ranges::any_of(model.springs.stiffness, [](double k) { return k > 0.0; });
}

SpringSplitting::SpringSplitting(const MassSpringModel& model, const BlockPattern& pattern,
                                 const std::vector<char>& fixed, std::atomic<std::uint64_t>& degenerate)
    : soft_(model), pattern_(pattern), fixed_(fixed), degenerate_(degenerate) {
  stiff_.mass = model.mass;
  stiff_.fixed = model.fixed;
  soft_.springs = {};
  stiff_.springs.law = soft_.springs.law = model.springs.law;
  const std::vector<bool> stiff = stiff_springs(model.springs);
  for (std::size_t e = 0; e < stiff.size(); ++e) {
    append(stiff[e] ? stiff_.springs : soft_.springs, model.springs, e);
    if (stiff[e]) stiff_index_.push_back(e);
  }
}

void SpringSplitting::stiff_force(double, ConstVectorRef q, ConstVectorRef v, VectorRef f) const {
  count_degenerate(mass_spring_force(stiff_, q.data(), v.data(), f.data()));
}

void SpringSplitting::soft_force(double, ConstVectorRef q, ConstVectorRef v, VectorRef f) const {
  count_degenerate(mass_spring_force(soft_, q.data(), v.data(), f.data()));
}

template <class Block>
void SpringSplitting::fill(ConstVectorRef q, ConstVectorRef v, SparseMatrix& matrix, const char* name,
                           Block block) const {
  require_pattern(matrix, 3 * pattern_.particles(), pattern_.tangent_nonzeros(), name);
  std::fill_n(matrix.valuePtr(), matrix.nonZeros(), 0.0);
  const TangentFill<Block> whole{pattern_, fixed_, matrix.valuePtr(), block};
  count_degenerate(visit_tangents(stiff_, q.data(), v.data(), TangentModel::exact,
                                  PartFill<TangentFill<Block>>{whole, stiff_index_}));
}

void SpringSplitting::stiff_stiffness(double, ConstVectorRef q, ConstVectorRef v, SparseMatrix& K) const {
  fill(q, v, K, "K of the stiff springs", [](const auto& tangent) { return tangent.position_block(); });
}

void SpringSplitting::stiff_damping(double, ConstVectorRef q, ConstVectorRef v, SparseMatrix& D) const {
  fill(q, v, D, "D of the stiff springs", [](const auto& tangent) { return tangent.velocity_block(); });
}

}  // namespace fw::mechanics
