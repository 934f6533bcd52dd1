#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>
#include <memory>

#include "app/commands.hpp"
#include "store/show.hpp"
#include "store/show_table.hpp"
#include "system/terminal.hpp"

namespace fw::app {

namespace {

struct ShowArguments {
  std::string path;
  bool json = false, csv = false, markdown = false, latex = false;
  store::TableChoice table;
};

int show(ShowArguments& arguments) {
  if (arguments.json) {
    fmt::print("{}", store::show_json(arguments.path));
  } else if (arguments.csv || arguments.markdown || arguments.latex) {
    arguments.table.format = arguments.csv        ? store::TableFormat::csv
                             : arguments.markdown ? store::TableFormat::markdown
                                                  : store::TableFormat::latex;
    fmt::print("{}", store::show_table(arguments.path, arguments.table));
  } else {
    fmt::print("{}", store::show(arguments.path, arguments.table.columns, terminal_width(STDOUT_FILENO)));
  }
  return exit_success;
}

}  // namespace

void add_show_command(CLI::App& app, Action& action) {
  CLI::App* command = app.add_subcommand("show", "Prints the tables and verdicts in a result file");
  auto arguments = std::make_shared<ShowArguments>();
  command->add_option("file", arguments->path, "Result file")->required()->type_name("FILE.h5");
  CLI::Option_group* formats =
      command->add_option_group("format", "How; without one: for people at a terminal");
  formats->add_flag("--json", arguments->json, "All attributes and the summary as JSON");
  CLI::Option* csv = formats->add_flag("--csv", arguments->csv, "The table for other programs");
  CLI::Option* markdown = formats->add_flag("--markdown", arguments->markdown, "The table for a page");
  CLI::Option* latex =
      formats->add_flag("--latex", arguments->latex, "The table for a paper (package booktabs)");
  formats->require_option(0, 1);
  command->add_option("--columns", arguments->table.columns, "These columns, in this order")
      ->delimiter(',')
      ->type_name("NAME,...");
  command->add_option("--case", arguments->table.of_case, "The raw columns of this case")->type_name("ID");
  command->callback([arguments, csv, markdown, latex, &action] {
    const bool has_table = csv->count() + markdown->count() + latex->count() > 0;
    if (!has_table && !arguments->table.of_case.empty()) {
      throw CLI::ValidationError("--case", "expected with one of --csv, --markdown and --latex");
    }
    if (arguments->json && !arguments->table.columns.empty()) {
      throw CLI::ValidationError("--columns", "expected without --json, which has all");
    }
    action = [arguments] { return show(*arguments); };
  });
}

}  // namespace fw::app
