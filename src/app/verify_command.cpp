#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <filesystem>
#include <memory>
#include <optional>
#include <thread>

#include "analysis/reference/reference_cache.hpp"
#include "app/commands.hpp"
#include "app/interrupt.hpp"
#include "app/progress_bar.hpp"
#include "app/study_run.hpp"
#include "catalog/builtin_catalog.hpp"
#include "catalog/study_kinds.hpp"
#include "core/error.hpp"
#include "store/study_store.hpp"
#include "store/write_target.hpp"
#include "study/runner.hpp"
#include "system/terminal.hpp"
#include "text/json_writer.hpp"
#include "text/text_table.hpp"
#include "text/toml_writer.hpp"

namespace fw::app {

namespace {

using study::CaseResult;
using study::StudyResult;

struct VerifyArguments {
  std::vector<std::string> methods{};
  std::string output{};
  std::optional<double> time_limit{};
  bool json = false;
  bool all = false;
  int jobs = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
};

/// The study that the command line asks for.
study::Plan plan_of(const VerifyArguments& arguments) {
  std::string text = "kind = \"verify\"\ntitle = \"Verification of schemes\"\n";
  if (!arguments.methods.empty()) {
    std::vector<std::string> quoted;
    for (const std::string& call : arguments.methods) quoted.push_back(toml_quoted(call));
    text += fmt::format("methods = [{}]\n", fmt::join(quoted, ", "));
  }
  return study::read_plan(CheckedTable::parse_text(text, "verify"), catalog::study_kinds(),
                          catalog::BuiltinCatalog(), false);
}

/// Of a verification whose result goes to the terminal only.
class NothingKept final : public study::CaseArchive {
 public:
  std::optional<CaseResult> find(const std::string&) override { return std::nullopt; }
  void keep(const CaseResult&) override {}
};

/// One property of one method, as it is printed.
struct Row {
  std::string method, property, claimed, derived, measured, verdict, reason;
};

/// A method that could not be verified has one row, which says why.
std::vector<Row> rows_of(const StudyResult& result) {
  std::vector<Row> rows;
  for (const CaseResult& method : result.cases) {
    const auto cell = std::find_if(method.summary.begin(), method.summary.end(),
                                   [](const study::SummaryCell& known) { return known.name == "method"; });
    const std::string call = cell != method.summary.end() ? std::get<std::string>(cell->value) : method.id;
    if (method.columns.empty()) {
      rows.push_back({call, "runs", "", "", "", std::string(to_string(method.verdict)), method.reason});
      continue;
    }
    const auto texts = [&](const char* name) -> const std::vector<std::string>& {
      return std::get<std::vector<std::string>>(study::column_of(method, name).values);
    };
    for (std::size_t k = 0; k < texts("property").size(); ++k) {
      rows.push_back({call, texts("property")[k], texts("claimed")[k], texts("derived")[k],
                      texts("measured")[k], texts("verdict")[k], texts("reason")[k]});
    }
  }
  return rows;
}

std::string table(const StudyResult& result, bool all) {
  using text::TextTable;
  const std::vector<Row> rows = rows_of(result);
  const auto count = [&](Verdict verdict) {
    return std::count_if(rows.begin(), rows.end(),
                         [verdict](const Row& row) { return row.verdict == to_string(verdict); });
  };
  std::string out;
  // A table per method: its name stands above it, whole.
  for (auto first = rows.begin(); first != rows.end();) {
    const auto last =
        std::find_if(first, rows.end(), [&](const Row& row) { return row.method != first->method; });
    TextTable text;
    const auto add = [&](const char* name, std::string Row::*cell) {
      std::vector<std::string> cells;
      for (auto row = first; row != last; ++row) {
        if (all || row->verdict != to_string(Verdict::not_applicable)) cells.push_back((*row).*cell);
      }
      text.add_column(name, TextTable::Align::left, cells);
    };
    add("property", &Row::property);
    add("claimed", &Row::claimed);
    add("derived", &Row::derived);
    add("measured", &Row::measured);
    add("verdict", &Row::verdict);
    add("reason", &Row::reason);
    out += fmt::format("{}\n{}\n", first->method, text.text(terminal_width(STDOUT_FILENO)));
    first = last;
  }
  return out + fmt::format("{} method{}: {} verdicts hold, {} fail, {} not applicable\n", result.cases.size(),
                           result.cases.size() == 1 ? "" : "s", count(Verdict::holds), count(Verdict::fails),
                           count(Verdict::not_applicable));
}

std::string json(const StudyResult& result) {
  text::JsonWriter writer;
  writer.begin_array();
  for (const Row& row : rows_of(result)) {
    writer.begin_object().key("method").value(row.method).key("property").value(row.property);
    writer.key("claimed").value(row.claimed).key("derived").value(row.derived);
    writer.key("measured").value(row.measured).key("verdict").value(row.verdict);
    writer.key("reason").value(row.reason).end_object();
  }
  writer.end_array();
  return writer.text() + "\n";
}

StudyResult run(const study::Plan& plan, study::CaseArchive& archive, const VerifyArguments& arguments,
                const std::string& program, const std::atomic<bool>& interrupted) {
  ProgressBar bar("schemes");
  study::RunOptions options;
  options.context = {.stop = StopToken(interrupted),
                     .reference_cache = analysis::ReferenceCache::default_directory()};
  options.program = program;
  options.jobs = arguments.jobs;
  options.time_limit = arguments.time_limit;
  options.waiting = [&](const study::RunProgress& progress) {
    const auto done = static_cast<double>(progress.done);
    bar.update(done / static_cast<double>(progress.total), done, running_text(progress.running));
  };
  StudyResult result = study::run_plan(plan, archive, options);
  bar.clear();
  return result;
}

int verify(const VerifyArguments& arguments, const std::string& command_line) {
  if (arguments.time_limit && !(*arguments.time_limit >= 0.0))
    throw InputError(fmt::format("--time-limit: found {}, expected at least 0", *arguments.time_limit));
  for (const std::string& call : arguments.methods)
    catalog::make_method(call);  // an unknown name ends before anything runs
  const study::Plan plan = plan_of(arguments);
  const std::atomic<bool>& interrupted = install_interrupt_flag();
  StudyResult result;
  if (arguments.output.empty()) {
    NothingKept archive;
    result = run(plan, archive, arguments, "", interrupted);
  } else {
    store::make_directory_of(arguments.output);
    store::StudyStore archive(arguments.output);
    result = run(plan, archive, arguments, program_identity(), interrupted);
    archive.write(command_line, result);
  }
  fmt::print("{}", arguments.json ? json(result) : table(result, arguments.all));
  if (!result.complete) {
    fmt::print(stderr, "federwerk: interrupted: {} of {} methods were verified\n", result.cases.size(),
               plan.cases.size());
    return exit_failure;
  }
  const auto not_computed = std::count_if(result.cases.begin(), result.cases.end(),
                                          [](const CaseResult& method) { return method.key.empty(); });
  if (not_computed > 0) {
    fmt::print(stderr, "federwerk: {} of {} methods could not be verified\n", not_computed,
               result.cases.size());
    return exit_failure;
  }
  const bool fails = std::any_of(result.cases.begin(), result.cases.end(),
                                 [](const CaseResult& method) { return method.verdict == Verdict::fails; });
  return fails ? exit_verdict_fails : exit_success;
}

}  // namespace

void add_verify_command(CLI::App& app, Action& action, const std::string& command_line) {
  CLI::App* command = app.add_subcommand(
      "verify",
      "Checks the claimed properties of the schemes: order, stability, symplecticity, conservation, ...");
  auto arguments = std::make_shared<VerifyArguments>();
  command
      ->add_option("--method", arguments->methods,
                   "Only these methods, with their options (default: all our own; oracles only if named)")
      ->type_name("NAME");
  command
      ->add_option("-o,--output", arguments->output,
                   "Result file of the study; methods that it holds already are not verified again")
      ->type_name("FILE.h5");
  command->add_option("--time-limit", arguments->time_limit, "Ends a method that takes longer [s]; 0: never")
      ->type_name("S");
  command->add_flag("--json", arguments->json, "As JSON");
  command->add_flag("--all", arguments->all, "Prints properties that do not apply as well");
  command->add_option("--jobs", arguments->jobs, "Schemes checked at the same time")
      ->check(whole_number())
      ->check(CLI::Range(1, 1024))
      ->type_name("N");
  command->callback([arguments, &action, command_line] {
    action = [arguments, command_line] { return verify(*arguments, command_line); };
  });
}

}  // namespace fw::app
