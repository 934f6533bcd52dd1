#include "study/comparison.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace fw::study {

namespace {

bool same(double a, double b) {
  return (std::isnan(a) && std::isnan(b)) || (a == b && std::signbit(a) == std::signbit(b));
}

/// What differs, in words; empty if nothing does.
template <class Value>
std::string difference(const std::vector<Value>& before, const std::vector<Value>& after) {
  if (before.size() != after.size()) {
    return fmt::format("{} values before, {} now", before.size(), after.size());
  }
  std::size_t count = 0;
  double largest = 0.0;
  for (std::size_t k = 0; k < before.size(); ++k) {
    if constexpr (std::is_same_v<Value, double>) {
      if (same(before[k], after[k])) continue;
      const double scale = std::max(std::abs(before[k]), std::abs(after[k]));
      const double relative = std::abs(before[k] - after[k]) / scale;
      largest = std::max(largest, std::isnan(relative) ? INFINITY : relative);
    } else if (before[k] == after[k]) {
      continue;
    }
    ++count;
  }
  if (count == 0) return "";
  std::string text = fmt::format("{} of {} values differ", count, before.size());
  if constexpr (std::is_same_v<Value, double>)
    text += fmt::format(", by at most {:.3g} of the larger", largest);
  return text;
}

class Comparing {
 public:
  void cases(const CaseResult& before, const CaseResult& after) {
    if (before.key.empty() || after.key.empty()) {
      note(before.id, "case",
           before.key.empty() ? "could not be computed before" : "could not be computed now");
      return;
    }
    ++result_.cases;
    // Before there was "done", what ran through and claimed nothing was said to hold or to be not applicable.
    const bool is_renamed = after.verdict == Verdict::done && before.verdict != Verdict::fails;
    if (before.verdict != after.verdict && !is_renamed) {
      note(before.id, "verdict",
           fmt::format("{} before, {} now", to_string(before.verdict), to_string(after.verdict)));
    }
    for (const Column& column : before.columns) {
      const auto found = std::find_if(after.columns.begin(), after.columns.end(),
                                      [&](const Column& other) { return other.name == column.name; });
      if (found == after.columns.end()) {
        note(before.id, column.name, "is missing now");
      } else {
        values(before.id, column.name, column.values, found->values);
        if (column.unit != found->unit || column.attributes != found->attributes ||
            (column.shape != found->shape && !is_measured(column.name))) {
          note(before.id, column.name, "has another unit, shape or attribute now");
        }
      }
    }
    for (const Column& column : after.columns) {
      if (std::none_of(before.columns.begin(), before.columns.end(),
                       [&](const Column& other) { return other.name == column.name; })) {
        note(before.id, column.name, "was not there before");
      }
    }
    summaries(before, after);
  }

  void note(const std::string& id, const std::string& column, const std::string& what) {
    result_.differences.push_back(fmt::format("{}: {}: {}", id, column, what));
  }

  Comparison take() { return std::move(result_); }

 private:
  void summaries(const CaseResult& before, const CaseResult& after) {
    compare_rows(before, before.parameters, after.parameters);
    compare_rows(before, before.summary, after.summary);
  }

  void compare_rows(const CaseResult& before, const std::vector<SummaryCell>& old_row,
                    const std::vector<SummaryCell>& new_row) {
    for (const SummaryCell& cell : old_row) {
      const auto found = std::find_if(new_row.begin(), new_row.end(),
                                      [&](const SummaryCell& other) { return other.name == cell.name; });
      if (found == new_row.end()) {
        note(before.id, "summary/" + cell.name, "is missing now");
        continue;
      }
      const auto as_column = []<class... Values>(const std::variant<Values...>& value) {
        return std::visit([](const auto& held) { return ColumnValues(std::vector{held}); }, value);
      };
      values(before.id, "summary/" + cell.name, as_column(cell.value), as_column(found->value));
    }
  }

  void values(const std::string& id, const std::string& name, const ColumnValues& before,
              const ColumnValues& after) {
    if (is_measured(name)) return;
    ++result_.columns;
    std::string what = "has another type now";
    if (before.index() == after.index()) {
      what = std::visit(
          [&]<class Values>(const Values& old) { return difference(old, std::get<Values>(after)); }, before);
    }
    if (!what.empty()) note(id, name, what);
  }

  Comparison result_;
};

}  // namespace

bool is_measured(std::string_view column) {
  return column.find("seconds") != column.npos || column.find("memory") != column.npos;
}

Comparison compare(const StudyResult& before, const StudyResult& after) {
  Comparing comparing;
  std::map<std::string_view, const CaseResult*> now;
  for (const CaseResult& result : after.cases) now[result.id] = &result;
  for (const CaseResult& result : before.cases) {
    const auto found = now.find(result.id);
    if (found == now.end()) {
      comparing.note(result.id, "case", "is missing now");
      continue;
    }
    comparing.cases(result, *found->second);
    now.erase(found);
  }
  if (before.complete) {
    for (const auto& [id, result] : now) comparing.note(std::string(id), "case", "was not there before");
  }
  return comparing.take();
}

}  // namespace fw::study
