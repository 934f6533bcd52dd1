#pragma once

#include <gtest/gtest.h>

#include <bit>

#include "study/result.hpp"

namespace fw::store::test {

inline bool same_bits(double a, double b) {
  return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}

template <class T>
bool same_values(const std::vector<T>& a, const std::vector<T>& b) {
  if constexpr (std::is_same_v<T, double>) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(), same_bits);
  } else {
    return a == b;
  }
}

/// Equal in every bit; NaN equals NaN.
inline ::testing::AssertionResult same(const study::CaseResult& a, const study::CaseResult& b) {
  const auto differ = [&] { return ::testing::AssertionFailure() << "case " << a.id << ": "; };
  if (a.id != b.id || a.key != b.key) return differ() << "id or key";
  if (a.verdict != b.verdict || a.reason != b.reason) return differ() << "verdict or reason";
  if (a.columns.size() != b.columns.size()) return differ() << "number of columns";
  for (std::size_t i = 0; i < a.columns.size(); ++i) {
    const record::Column &c = a.columns[i], &d = b.columns[i];
    if (c.name != d.name || c.unit != d.unit || c.shape != d.shape || c.attributes != d.attributes) {
      return differ() << "column " << c.name;
    }
    if (c.values.index() != d.values.index()) return differ() << "type of " << c.name;
    const bool equal = std::visit(
        [&]<class T>(const std::vector<T>& values) {
          return same_values(values, std::get<std::vector<T>>(d.values));
        },
        c.values);
    if (!equal) return differ() << "values of " << c.name;
  }
  if (a.parameters.size() != b.parameters.size()) return differ() << "number of parameters";
  if (a.summary.size() != b.summary.size()) return differ() << "number of summary cells";
  for (std::size_t i = 0; i < a.summary.size(); ++i) {
    const study::SummaryCell &c = a.summary[i], &d = b.summary[i];
    if (c.name != d.name || c.unit != d.unit || c.value.index() != d.value.index()) return differ() << c.name;
    const double* number = std::get_if<double>(&c.value);
    if (number != nullptr ? !same_bits(*number, std::get<double>(d.value)) : c.value != d.value) {
      return differ() << "value of " << c.name;
    }
  }
  return ::testing::AssertionSuccess();
}

}  // namespace fw::store::test
