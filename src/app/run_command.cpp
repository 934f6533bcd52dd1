#include <fmt/format.h>
#include <sys/auxv.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <set>

#include "analysis/reference_cache.hpp"
#include "app/commands.hpp"
#include "app/interrupt.hpp"
#include "app/progress_bar.hpp"
#include "catalog/builtin_catalog.hpp"
#include "catalog/study_kinds.hpp"
#include "core/error.hpp"
#include "core/sha256.hpp"
#include "store/study_store.hpp"
#include "store/write_target.hpp"
#include "study/runner.hpp"

namespace fw::app {

namespace {

struct RunArguments {
  std::vector<std::string> studies;
  std::string directory = "results";
  int jobs = 1;
  bool quick = false, force = false;
};

/// SHA-256 of the executable: cases that other code computed are not taken for finished.
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

struct PlannedStudy {
  std::filesystem::path output;  ///< result file
  study::Plan plan;
};

/// Reads every study before the first one runs, so that a mistake in the last is found at once.
std::vector<PlannedStudy> read_studies(const RunArguments& arguments) {
  const catalog::BuiltinCatalog catalog;
  std::vector<PlannedStudy> studies;
  std::set<std::filesystem::path> outputs;
  for (const std::string& path : arguments.studies) {
    const CheckedTable spec = CheckedTable::parse_file(path);
    PlannedStudy study{
        std::filesystem::path(arguments.directory) / std::filesystem::path(path).stem().concat(".h5"),
        study::read_plan(spec, catalog::study_kinds(), catalog, arguments.quick)};
    if (!outputs.insert(study.output).second) {
      throw InputError(
          fmt::format("{}: another study of this run also writes {}; expected different file names", path,
                      study.output.string()));
    }
    for (const std::string& warning : study.plan.warnings) {
      fmt::print(stderr, "federwerk: warning: {}\n", warning);
    }
    studies.push_back(std::move(study));
  }
  return studies;
}

struct Tally {
  std::size_t holds = 0, fails = 0, not_applicable = 0, kept = 0;
};

Tally run_study(const PlannedStudy& planned, const RunArguments& arguments, const std::string& command_line,
                const std::string& program, const std::atomic<bool>& interrupted, bool& complete) {
  store::StudyStore store(planned.output, arguments.force ? store::StudyStore::Earlier::forget
                                                          : store::StudyStore::Earlier::reuse);
  fmt::print("{} ({} cases)\n", planned.plan.title, planned.plan.cases.size());
  ProgressBar bar("cases");
  Tally tally;
  std::size_t done = 0;
  study::RunOptions options;
  options.context = {.interrupted = &interrupted,
                     .reference_cache = analysis::ReferenceCache::default_directory()};
  options.program = program;
  options.force = arguments.force;
  options.jobs = arguments.jobs;
  options.started = [&](std::size_t, std::size_t total, const std::string& id) {
    bar.update(static_cast<double>(done) / static_cast<double>(total), static_cast<double>(done), id);
  };
  options.finished = [&](const study::CaseReport& report) {
    bar.clear();
    ++done;
    const study::Verdict verdict = report.result.verdict;
    tally.holds += verdict == study::Verdict::holds;
    tally.fails += verdict == study::Verdict::fails;
    tally.not_applicable += verdict == study::Verdict::not_applicable;
    tally.kept += report.kept;
    fmt::print("  [{}/{}] {:<14} {}  {}{}\n", done, report.total, to_string(verdict), report.result.id,
               report.result.reason, report.kept ? "  (kept)" : fmt::format("  ({:.1f} s)", report.seconds));
    std::fflush(stdout);
  };
  const study::StudyResult result = study::run_plan(planned.plan, store, options);
  bar.clear();
  store.write(command_line, result);
  complete = result.complete;
  fmt::print("{}: {} hold, {} fail, {} not applicable{}\n\n", planned.output.string(), tally.holds,
             tally.fails, tally.not_applicable,
             tally.kept > 0 ? fmt::format(" ({} kept from an earlier run)", tally.kept) : "");
  return tally;
}

int run(const RunArguments& arguments, const std::string& command_line) {
  if (arguments.jobs < 1)
    throw InputError(fmt::format("--jobs: found {}, expected at least 1", arguments.jobs));
  const std::vector<PlannedStudy> studies = read_studies(arguments);
  std::error_code error;
  std::filesystem::create_directories(arguments.directory, error);
  if (error) {
    const std::string message =
        fmt::format("cannot make the directory \"{}\": {}", arguments.directory, error.message());
    if (error == std::errc::no_space_on_device || error == std::errc::io_error) throw SystemError(message);
    throw InputError(message);
  }
  for (const PlannedStudy& planned : studies) store::check_writable_target(planned.output);
  const std::atomic<bool>& interrupted = install_interrupt_flag();
  const std::string program = program_identity();
  std::size_t fails = 0;
  for (std::size_t k = 0; k < studies.size(); ++k) {
    const PlannedStudy& planned = studies[k];
    bool complete = true;
    fails += run_study(planned, arguments, command_line, program, interrupted, complete).fails;
    const bool is_last = k + 1 == studies.size();
    if (interrupted && !(complete && is_last)) {
      fmt::print(stderr,
                 "federwerk: interrupted; finished cases are kept, the same command goes on from here\n");
      return exit_failure;
    }
  }
  return fails > 0 ? exit_verdict_fails : exit_success;
}

}  // namespace

void add_run_command(CLI::App& app, Action& action, const std::string& command_line) {
  CLI::App* command = app.add_subcommand("run", "Runs studies; finished cases are kept and not run again");
  auto arguments = std::make_shared<RunArguments>();
  command->add_option("study", arguments->studies, "Study files (TOML)")->required()->type_name("STUDY.toml");
  command->add_option("-o,--output", arguments->directory, "Directory for result files")
      ->capture_default_str()
      ->type_name("DIR");
  command
      ->add_option("--jobs", arguments->jobs,
                   "Cases that run at the same time; timings are honest with 1 only")
      ->capture_default_str()
      ->type_name("N");
  command->add_flag("--quick", arguments->quick, "Shrink each study by its own [quick] section");
  command->add_flag("--force", arguments->force, "Run also the cases that are finished");
  command->callback([arguments, &action, command_line] {
    action = [arguments, command_line] { return run(*arguments, command_line); };
  });
}

}  // namespace fw::app
