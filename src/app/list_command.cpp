#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>
#include <memory>

#include "app/commands.hpp"
#include "app/method_list.hpp"
#include "app/methods_page.hpp"
#include "catalog/problems.hpp"
#include "catalog/study_kinds.hpp"
#include "core/error.hpp"
#include "scene/generators.hpp"
#include "system/terminal.hpp"
#include "text/json_writer.hpp"
#include "text/text_table.hpp"

namespace fw::app {

namespace {

using text::JsonWriter;
using text::TextTable;

/// Entries of name, title and description, as JSON or as a table.
struct Line {
  std::string name, title, description;
};

std::string lines_text(const std::vector<Line>& lines, bool as_json, std::size_t width) {
  if (as_json) {
    JsonWriter json;
    json.begin_array();
    for (const Line& line : lines) {
      json.begin_object();
      json.key("name")
          .value(line.name)
          .key("title")
          .value(line.title)
          .key("description")
          .value(line.description);
      json.end_object();
    }
    json.end_array();
    return json.text() + "\n";
  }
  std::vector<std::string> names, titles;
  for (const Line& line : lines) {
    names.push_back(line.name);
    titles.push_back(line.title);
  }
  TextTable table;
  table.add_column("name", TextTable::Align::left, names);
  table.add_column("title", TextTable::Align::left, titles);
  return table.text(width);
}

std::vector<Line> problem_lines() {
  std::vector<Line> lines;
  for (const ProblemEntry& entry : catalog::problems()) {
    const Problem problem = entry.make({});
    lines.push_back({problem.name, problem.title, problem.description});
  }
  return lines;
}

std::vector<Line> study_lines() {
  std::vector<Line> lines;
  for (const study::StudyKind& kind : catalog::study_kinds())
    lines.push_back({kind.name, kind.title, kind.description});
  return lines;
}

std::vector<Line> scene_lines() {
  std::vector<Line> lines;
  for (const scene::GeneratorInfo& generator : scene::generators()) {
    lines.push_back({generator.name, generator.title, generator.description});
  }
  return lines;
}

struct ListArguments {
  std::string what;
  bool json = false, markdown = false, all = false;
  bool explicit_only = false, implicit_only = false, adaptive_only = false, fixed_only = false;
  MethodFilter filter;
};

std::string list(const ListArguments& arguments) {
  const std::size_t width = terminal_width(STDOUT_FILENO);
  if (arguments.what == "problems") return lines_text(problem_lines(), arguments.json, width);
  if (arguments.what == "scenes") return lines_text(scene_lines(), arguments.json, width);
  if (arguments.what == "studies") return lines_text(study_lines(), arguments.json, width);
  if (arguments.json) return methods_json(chosen_methods(arguments.filter));
  const bool is_short = arguments.what == "methods" && !arguments.all && !arguments.filter.asks();
  return is_short ? methods_overview(width) : methods_table(chosen_methods(arguments.filter), width);
}

/// Throws InputError for options that say nothing of what is to be listed.
void check_list_arguments(const ListArguments& arguments) {
  if (arguments.markdown && arguments.what != "methods") {
    throw InputError(fmt::format("--markdown: found \"{}\", expected \"methods\"", arguments.what));
  }
  const bool of_methods = arguments.what == "methods" || arguments.what == "oracles";
  if (!of_methods && (arguments.all || arguments.filter.asks())) {
    throw InputError(fmt::format("found \"{}\" with a filter of methods, expected \"methods\" or \"oracles\"",
                                 arguments.what));
  }
  if (arguments.markdown && (arguments.all || arguments.filter.asks())) {
    throw InputError("found --markdown with a filter, expected it alone: the page has all methods");
  }
}

}  // namespace

void add_list_command(CLI::App& app, Action& action) {
  CLI::App* command = app.add_subcommand("list", "Lists methods, problems, scenes, studies or oracles");
  auto arguments = std::make_shared<ListArguments>();
  command->add_option("what", arguments->what, "What to list")
      ->required()
      ->check(CLI::IsMember({"methods", "problems", "scenes", "studies", "oracles"}))
      ->type_name("methods|problems|scenes|studies|oracles");
  auto* json = command->add_flag("--json", arguments->json, "As JSON");
  command
      ->add_flag("--markdown", arguments->markdown,
                 "Methods as tables in Markdown, with formulas, limits and literature")
      ->excludes(json);
  command->add_flag("--all", arguments->all, "Every method, a row each");
  MethodFilter& filter = arguments->filter;
  command->add_option("--family", filter.family, "Methods of the families with TEXT in their name")
      ->type_name("TEXT");
  command->add_option("--order", filter.order, "Methods of order P; 0: of variable order")
      ->check(CLI::Range(0, 100))
      ->type_name("P");
  auto* is_explicit = command->add_flag("--explicit", arguments->explicit_only, "Explicit methods");
  command->add_flag("--implicit", arguments->implicit_only, "Implicit methods")->excludes(is_explicit);
  auto* adaptive =
      command->add_flag("--adaptive", arguments->adaptive_only, "Methods that can choose their steps");
  command->add_flag("--fixed", arguments->fixed_only, "Methods that can take constant steps")
      ->excludes(adaptive);
  command->add_flag("--symplectic", filter.symplectic, "Symplectic methods");
  command->add_flag("--a-stable", filter.a_stable, "A-stable methods");
  command->add_flag("--l-stable", filter.l_stable, "L-stable methods");
  command->callback([arguments, &action] {
    MethodFilter& wanted = arguments->filter;
    wanted.only_oracles = arguments->what == "oracles";
    if (arguments->explicit_only || arguments->implicit_only) wanted.is_explicit = arguments->explicit_only;
    if (arguments->adaptive_only || arguments->fixed_only) wanted.is_adaptive = arguments->adaptive_only;
    action = [arguments] {
      check_list_arguments(*arguments);
      fmt::print("{}", arguments->markdown ? methods_page() : list(*arguments));
      return exit_success;
    };
  });
}

}  // namespace fw::app
