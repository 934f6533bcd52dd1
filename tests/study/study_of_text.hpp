#pragma once

#include <stdexcept>
#include <string>

#include "catalog/study_kinds.hpp"
#include "core/error.hpp"
#include "memory_archive.hpp"
#include "paths.hpp"
#include "study/runner.hpp"

namespace fw::study {

/// Runs a study given as text; scenes are found as from a folder of studies/.
inline StudyResult run_study(const std::string& text, const Catalog& catalog, bool quick = false) {
  const Plan plan =
      read_plan(CheckedTable::parse_text(text, fw::test::source_directory() + "/studies/energy/test.toml"),
                catalog::study_kinds(), catalog, quick);
  MemoryArchive archive;
  return run_plan(plan, archive, {});
}

/// A figure of a case's row in the summary.
template <class Value = double>
Value figure(const CaseResult& result, const std::string& name) {
  for (const SummaryCell& cell : result.summary) {
    if (cell.name == name) return std::get<Value>(cell.value);
  }
  throw std::logic_error("no figure " + name);
}

template <class Value = double>
const std::vector<Value>& column(const CaseResult& result, const std::string& name) {
  for (const Column& entry : result.columns) {
    if (entry.name == name) return std::get<std::vector<Value>>(entry.values);
  }
  throw std::logic_error("no column " + name);
}

/// What an input is refused with; "accepted" where it is not.
inline std::string refusal_of(const std::string& text, const Catalog& catalog) {
  try {
    read_plan(CheckedTable::parse_text(text, "bad.toml"), catalog::study_kinds(), catalog, false);
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

}  // namespace fw::study
