#pragma once

#include <atomic>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "study/plan.hpp"

namespace fw::app {

/// A study that has been read, and where its result goes.
struct PlannedStudy {
  std::string source;            ///< the study file, or the result file whose study is repeated
  std::filesystem::path output;  ///< result file
  study::Plan plan;
  bool repeats = false;  ///< `source` is a result file
};

/// SHA-256 of the executable: cases that other code computed are not taken for finished. Throws SystemError.
std::string program_identity();

/// What `run` was asked to do with every study.
struct StudyRunOptions {
  std::string command_line;
  std::string program;  ///< identity of the executable
  int jobs = 1;
  std::optional<double> time_limit{};  ///< [s] of one case; absent: the study's own
  bool force = false;
};

/// How the cases of a study ended.
struct Tally {
  std::size_t holds = 0, fails = 0, not_applicable = 0, done = 0, kept = 0;
  std::size_t not_computed = 0;         ///< of those that fail: exceptions, crashes, time limits
  std::vector<std::string> failures{};  ///< one line per case that fails
  bool complete = true;
  double seconds = 0.0;

  std::size_t cases() const { return holds + fails + not_applicable + done; }
};

/// Runs a study with a progress bar and one line per finished case, and writes its result file.
Tally run_study(const PlannedStudy& study, const StudyRunOptions& options,
                const std::atomic<bool>& interrupted);

/// The table of all studies of a run, and the cases that fail.
void print_summary(const std::vector<PlannedStudy>& studies, const std::vector<Tally>& tallies);

}  // namespace fw::app
