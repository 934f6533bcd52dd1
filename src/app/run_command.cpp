#include <fmt/format.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <optional>
#include <set>

#include "app/commands.hpp"
#include "app/input_kind.hpp"
#include "app/interrupt.hpp"
#include "app/study_run.hpp"
#include "catalog/builtin_catalog.hpp"
#include "catalog/study_kinds.hpp"
#include "core/error.hpp"
#include "store/study_file.hpp"
#include "store/write_target.hpp"
#include "study/comparison.hpp"
#include "system/sha256.hpp"

namespace fw::app {

namespace {

struct RunArguments {
  std::vector<std::string> studies;
  std::string directory = "results";
  int jobs = 1;
  std::optional<double> time_limit;
  bool quick = false, force = false, strict = false, directory_given = false;
};

/// Whether the argument is a result file, whose study is repeated; what HDF5 cannot open is a study file.
bool is_result_file(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  char start[8] = {};
  file.read(start, sizeof start);
  return file.gcount() == sizeof start && std::string_view(start, sizeof start) == "\x89HDF\r\n\x1a\n";
}

/// The study that made a result file; its own directory receives the repetition unless another one was named.
PlannedStudy read_result_file(const std::filesystem::path& path, const RunArguments& arguments,
                              const catalog::BuiltinCatalog& catalog) {
  if (arguments.quick) {
    throw InputError(
        fmt::format("{}: a result file is repeated as it was made, expected no --quick", path.string()));
  }
  const store::StudyFile file = store::read_study(path);
  if (file.result.spec.empty() ||
      sha256_hex(file.result.spec) != store::text_of(file.attributes, "spec_sha256")) {
    throw InputError(fmt::format("\"{}\" is damaged: its attribute \"spec\" does not match \"spec_sha256\"",
                                 path.string()));
  }
  const CheckedTable spec =
      CheckedTable::parse_text(file.result.spec, fmt::format("{} (spec)", path.string()));
  const std::filesystem::path directory =
      arguments.directory_given ? std::filesystem::path(arguments.directory) : path.parent_path();
  PlannedStudy study{.source = path.string(),
                     .output = directory / path.stem().concat(".repeated.h5"),
                     .plan = study::read_plan(spec, catalog::study_kinds(), catalog, file.result.quick),
                     .repeats = true};
  if (study.plan.kind != file.result.kind) {
    throw InputError(
        fmt::format("\"{}\" is damaged: its kind is \"{}\", that of its attribute \"spec\" is \"{}\"",
                    path.string(), file.result.kind, study.plan.kind));
  }
  return study;
}

/// Reads every study before the first one runs, so that a mistake in the last is found at once.
std::vector<PlannedStudy> read_studies(const RunArguments& arguments) {
  const catalog::BuiltinCatalog catalog;
  std::vector<PlannedStudy> studies;
  std::set<std::filesystem::path> outputs;
  for (const std::string& path : arguments.studies) {
    PlannedStudy study;
    if (is_result_file(path)) {
      study = read_result_file(path, arguments, catalog);
    } else {
      const CheckedTable spec = CheckedTable::parse_file(path);
      refuse_scene(spec, path);
      study = {.source = path,
               .output = std::filesystem::path(arguments.directory) /
                         std::filesystem::path(path).stem().concat(".h5"),
               .plan = study::read_plan(spec, catalog::study_kinds(), catalog, arguments.quick),
               .repeats = false};
    }
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

/// Says in what a repeated study differs from the file it comes from; whether it differs.
bool report_differences(const PlannedStudy& planned) {
  constexpr std::size_t most_lines = 20;
  const study::StudyResult before = store::read_study(planned.source).result;
  const study::Comparison comparison = study::compare(before, store::read_study(planned.output).result);
  if (comparison.differences.empty()) {
    fmt::print("{}: repeated, {} columns of {} cases are the same bit for bit\n\n", planned.source,
               comparison.columns, comparison.cases);
    return false;
  }
  fmt::print("{}: repeated, {} of {} columns of {} cases differ\n", planned.source,
             comparison.differences.size(), comparison.columns, comparison.cases);
  for (std::size_t k = 0; k < std::min(most_lines, comparison.differences.size()); ++k) {
    fmt::print("  {}\n", comparison.differences[k]);
  }
  if (comparison.differences.size() > most_lines) {
    fmt::print("  and {} more\n", comparison.differences.size() - most_lines);
  }
  fmt::print("\n");
  return true;
}

int run(const RunArguments& arguments, const std::string& command_line) {
  if (arguments.jobs < 1)
    throw InputError(fmt::format("--jobs: found {}, expected at least 1", arguments.jobs));
  if (arguments.time_limit && !(*arguments.time_limit >= 0.0)) {
    throw InputError(fmt::format("--time-limit: found {}, expected at least 0", *arguments.time_limit));
  }
  const std::vector<PlannedStudy> studies = read_studies(arguments);
  for (const PlannedStudy& planned : studies) store::make_directory_of(planned.output);
  for (const PlannedStudy& planned : studies) store::check_writable_target(planned.output);
  const std::atomic<bool>& interrupted = install_interrupt_flag();
  const StudyRunOptions options{.command_line = command_line,
                                .program = program_identity(),
                                .jobs = arguments.jobs,
                                .time_limit = arguments.time_limit,
                                .force = arguments.force};
  std::vector<Tally> tallies;
  bool differs = false;
  for (const PlannedStudy& planned : studies) {
    tallies.push_back(run_study(planned, options, interrupted));
    if (tallies.back().complete && planned.repeats) differs |= report_differences(planned);
    const bool is_last = tallies.size() == studies.size();
    if (interrupted && !(tallies.back().complete && is_last)) {
      fmt::print(stderr,
                 "federwerk: interrupted; finished cases are saved; run the same command again to resume\n");
      return exit_failure;
    }
  }
  print_summary(studies, tallies);
  std::size_t fails = 0, not_applicable = 0, not_computed = 0;
  for (const Tally& tally : tallies) {
    fails += tally.fails;
    not_applicable += tally.not_applicable;
    not_computed += tally.not_computed;
  }
  if (not_computed > 0) {
    fmt::print(stderr,
               "federwerk: {} case{} could not be computed; the same command tries {} again, finished cases "
               "are kept\n",
               not_computed, not_computed == 1 ? "" : "s", not_computed == 1 ? "it" : "them");
    return exit_failure;
  }
  const bool is_open = arguments.strict && not_applicable > 0;
  return fails > 0 || differs || is_open ? exit_verdict_fails : exit_success;
}

}  // namespace

void add_run_command(CLI::App& app, Action& action, const std::string& command_line) {
  CLI::App* command = app.add_subcommand("run", "Runs studies; finished cases are kept and not run again");
  auto arguments = std::make_shared<RunArguments>();
  command
      ->add_option("study", arguments->studies,
                   "Study files (TOML), or result files (HDF5), whose studies are repeated and compared")
      ->required()
      ->type_name("STUDY.toml");
  CLI::Option* directory =
      command->add_option("-o,--output", arguments->directory, "Directory for result files")
          ->capture_default_str()
          ->type_name("DIR");
  command->add_option("--time-limit", arguments->time_limit, "Ends a case that runs longer [s]; 0: never")
      ->type_name("S");
  command
      ->add_option("--jobs", arguments->jobs,
                   "Cases that run at the same time; cases that are timed run alone")
      ->check(whole_number())
      ->capture_default_str()
      ->type_name("N");
  command->add_flag("--quick", arguments->quick, "Shrink each study by its own [quick] section");
  command->add_flag("--force", arguments->force, "Run also the cases that are finished");
  command->add_flag(
      "--strict", arguments->strict,
      "End with exit code 1 also where a verdict is \"not applicable\", not only where one \"fails\"");
  command->callback([arguments, directory, &action, command_line] {
    arguments->directory_given = directory->count() > 0;
    action = [arguments, command_line] { return run(*arguments, command_line); };
  });
}

}  // namespace fw::app
