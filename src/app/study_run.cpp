#include "app/study_run.hpp"

#include <fmt/format.h>
#include <sys/auxv.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <fstream>
#include <iterator>

#include "analysis/reference/reference_cache.hpp"
#include "app/progress_bar.hpp"
#include "core/error.hpp"
#include "store/study_store.hpp"
#include "study/runner.hpp"
#include "system/sha256.hpp"
#include "system/terminal.hpp"
#include "text/text_table.hpp"
#include "text/utf8.hpp"
#include "text/wrapped_lines.hpp"

namespace fw::app {

namespace {

using study::Verdict;

/// The verdicts at the end: some are reached from all cases together.
void count(const study::CaseResult& result, Tally& tally) {
  tally.holds += result.verdict == Verdict::holds;
  tally.fails += result.verdict == Verdict::fails;
  tally.not_applicable += result.verdict == Verdict::not_applicable;
  tally.done += result.verdict == Verdict::done;
  if (result.verdict == Verdict::fails)
    tally.failures.push_back(fmt::format("{}: {}", result.id, result.reason));
}

/// The line of a finished case; a reason that does not fit stands beneath it.
std::string case_line(const study::CaseReport& report, std::size_t done, std::size_t width) {
  const std::string name =
      fmt::format("[{}/{}] {:<14} {}", done, report.total, to_string(report.result.verdict),
                  text::printable_line(report.result.id));
  const std::string time = report.kept ? "(kept)" : fmt::format("({:.1f} s)", report.seconds);
  const std::string reason = text::printable_line(report.result.reason);
  const std::string line =
      reason.empty() ? fmt::format("  {}  {}", name, time) : fmt::format("  {}  {}  {}", name, reason, time);
  if (text::displayed_width(line) <= width) return line + '\n';
  constexpr std::size_t indent = 6;
  std::string out = text::wrapped_paragraph("  ", fmt::format("{}  {}", name, time), width, indent);
  if (!reason.empty()) out += text::wrapped_paragraph(std::string(indent, ' '), reason, width, indent);
  return out;
}

}  // namespace

std::string program_identity() {
  // Without /proc (a bare chroot) the kernel still tells the path that was executed.
  const auto* executed = reinterpret_cast<const char*>(getauxval(AT_EXECFN));
  std::string bytes;
  for (const char* path : {"/proc/self/exe", executed}) {
    if (path == nullptr || !bytes.empty()) continue;
    std::ifstream file(path, std::ios::binary);
    bytes.assign(std::istreambuf_iterator<char>(file), {});
  }
  if (bytes.empty()) throw SystemError("cannot read the executable to identify the program");
  return sha256_hex(bytes);
}

Tally run_study(const PlannedStudy& planned, const StudyRunOptions& run,
                const std::atomic<bool>& interrupted) {
  using Earlier = store::StudyStore::Earlier;
  store::StudyStore store(planned.output, run.force         ? Earlier::forget
                                          : planned.repeats ? Earlier::unfinished
                                                            : Earlier::reuse);
  fmt::print("{} ({} cases)\n", planned.plan.title, planned.plan.cases.size());
  std::fflush(stdout);
  ProgressBar bar("cases");
  Tally tally;
  std::size_t done = 0;
  study::RunOptions options;
  options.context = {.stop = StopToken(interrupted),
                     .reference_cache = analysis::ReferenceCache::default_directory()};
  options.program = run.program;
  options.force = run.force;
  options.jobs = run.jobs;
  options.time_limit = run.time_limit;
  options.waiting = [&](const study::RunProgress& progress) {
    // Kept cases took no time and tell nothing about what is left.
    const auto fresh = static_cast<double>(progress.done - tally.kept);
    const auto all = static_cast<double>(progress.total - tally.kept);
    bar.update(fresh / all, fresh, running_text(progress.running));
  };
  options.finished = [&](const study::CaseReport& report) {
    bar.clear();
    tally.kept += report.kept;
    tally.not_computed += !report.computed;
    ++done;
    fmt::print("{}", case_line(report, done, terminal_width(STDOUT_FILENO)));
    std::fflush(stdout);
  };
  const auto start = std::chrono::steady_clock::now();
  const study::StudyResult result = study::run_plan(planned.plan, store, options);
  tally.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  bar.clear();
  for (const study::CaseResult& finished : result.cases) count(finished, tally);
  store.write(run.command_line, result);
  tally.complete = result.complete;
  const std::string ended = fmt::format(
      "{}: {} hold, {} fail, {} not applicable{}{}", planned.output.string(), tally.holds, tally.fails,
      tally.not_applicable, tally.done > 0 ? fmt::format(", {} done", tally.done) : "",
      tally.kept > 0 ? fmt::format(" ({} kept from an earlier run)", tally.kept) : "");
  fmt::print("{}\n", text::wrapped_paragraph("", ended, terminal_width(STDOUT_FILENO), 2));
  std::fflush(stdout);
  return tally;
}

void print_summary(const std::vector<PlannedStudy>& studies, const std::vector<Tally>& tallies) {
  using Align = text::TextTable::Align;
  std::vector<std::string> names, cases, holds, fails, not_applicable, ran, kept, seconds, verdicts;
  for (std::size_t k = 0; k < tallies.size(); ++k) {
    const Tally& tally = tallies[k];
    names.push_back(studies[k].output.string());
    cases.push_back(fmt::format("{}", studies[k].plan.cases.size()));
    holds.push_back(fmt::format("{}", tally.holds));
    fails.push_back(fmt::format("{}", tally.fails));
    not_applicable.push_back(fmt::format("{}", tally.not_applicable));
    ran.push_back(fmt::format("{}", tally.done));
    kept.push_back(fmt::format("{}", tally.kept));
    seconds.push_back(fmt::format("{:.1f}", tally.seconds));
    verdicts.push_back(tally.fails > 0   ? "fails"
                       : !tally.complete ? "incomplete"
                       : tally.holds > 0 ? "holds"
                       : tally.done > 0  ? "done"
                                         : "not applicable");
  }
  text::TextTable table;
  table.add_column("study", Align::left, names);
  table.add_column("cases", Align::right, cases);
  table.add_column("hold", Align::right, holds);
  table.add_column("fail", Align::right, fails);
  table.add_column("not applicable", Align::right, not_applicable);
  table.add_column("done", Align::right, ran);
  table.add_column("kept", Align::right, kept);
  table.add_column("time [s]", Align::right, seconds);
  table.add_column("verdict", Align::left, verdicts);
  const std::size_t width = terminal_width(STDOUT_FILENO);
  fmt::print("{}", table.text(width));
  for (std::size_t k = 0; k < tallies.size(); ++k) {
    if (tallies[k].failures.empty()) continue;
    fmt::print("\n{} fails in\n", names[k]);
    for (const std::string& failure : tallies[k].failures) {
      fmt::print("{}", text::wrapped_paragraph("  ", text::printable_line(failure), width, 4));
    }
  }
}

}  // namespace fw::app
