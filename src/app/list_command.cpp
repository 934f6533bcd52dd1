#include <fmt/format.h>

#include <cstdio>
#include <memory>

#include "app/commands.hpp"
#include "app/method_json.hpp"
#include "app/methods_page.hpp"
#include "catalog/methods.hpp"
#include "catalog/problems.hpp"
#include "catalog/study_kinds.hpp"
#include "core/error.hpp"
#include "scene/generators.hpp"
#include "text/json_writer.hpp"
#include "text/text_table.hpp"

namespace fw::app {

namespace {

using text::JsonWriter;
using text::TextTable;

const std::string oracle_family = "oracle";

std::string order_text(const MethodInfo& info) {
  if (info.order == 0) return "variable";
  if (info.order == info.order_with_velocity_forces) return std::to_string(info.order);
  if (info.order_with_velocity_forces == 0) return fmt::format("{} (f(t, q) only)", info.order);
  return fmt::format("{} ({} with dampers)", info.order, info.order_with_velocity_forces);
}

std::string yes_or_blank(bool value) {
  return value ? "yes" : "";
}

std::string methods_json(bool only_oracles) {
  JsonWriter json;
  json.begin_array();
  for (const catalog::MethodEntry& entry : catalog::methods()) {
    const MethodInfo& info = entry.info();
    if (only_oracles && info.family != oracle_family) continue;
    json.begin_object();
    json.key("name").value(info.name).key("title").value(info.title).key("family").value(info.family);
    write_method_properties(json, info);
    json.key("needs_second_order").value(info.needs.has(Capability::second_order));
    json.key("reference").value(info.reference);
    json.end_object();
  }
  json.end_array();
  return json.text() + "\n";
}

std::string methods_table(bool only_oracles) {
  std::vector<std::string> name, order, stages, kind, steps, symplectic, stable, title;
  for (const catalog::MethodEntry& entry : catalog::methods()) {
    const MethodInfo& info = entry.info();
    if (only_oracles && info.family != oracle_family) continue;
    name.push_back(info.name);
    order.push_back(order_text(info));
    stages.push_back(std::to_string(info.stages));
    kind.push_back(info.is_explicit ? "explicit" : "implicit");
    steps.push_back(!info.is_adaptive ? "fixed" : info.has_fixed_step ? "both" : "adaptive");
    symplectic.push_back(yes_or_blank(info.is_symplectic));
    stable.push_back(info.is_l_stable ? "L" : info.is_a_stable ? "A" : "");
    title.push_back(info.title);
  }
  TextTable table;
  table.add_column("name", TextTable::Align::left, name);
  table.add_column("order", TextTable::Align::left, order);
  table.add_column("stages", TextTable::Align::right, stages);
  table.add_column("kind", TextTable::Align::left, kind);
  table.add_column("step", TextTable::Align::left, steps);
  table.add_column("symplectic", TextTable::Align::left, symplectic);
  table.add_column("stable", TextTable::Align::left, stable);
  table.add_column("title", TextTable::Align::left, title);
  return table.text();
}

/// Entries of name, title and description, as JSON or as a table.
struct Line {
  std::string name, title, description;
};

std::string lines_text(const std::vector<Line>& lines, bool as_json) {
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
  return table.text();
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

std::string list(const std::string& what, bool as_json) {
  if (what == "methods") return as_json ? methods_json(false) : methods_table(false);
  if (what == "oracles") return as_json ? methods_json(true) : methods_table(true);
  if (what == "problems") return lines_text(problem_lines(), as_json);
  if (what == "scenes") return lines_text(scene_lines(), as_json);
  return lines_text(study_lines(), as_json);
}

}  // namespace

void add_list_command(CLI::App& app, Action& action) {
  CLI::App* command = app.add_subcommand("list", "Lists methods, problems, scenes, studies or oracles");
  auto what = std::make_shared<std::string>();
  auto json = std::make_shared<bool>(false);
  command->add_option("what", *what, "What to list")
      ->required()
      ->check(CLI::IsMember({"methods", "problems", "scenes", "studies", "oracles"}))
      ->type_name("methods|problems|scenes|studies|oracles");
  auto* json_flag = command->add_flag("--json", *json, "As JSON");
  auto markdown = std::make_shared<bool>(false);
  command
      ->add_flag("--markdown", *markdown,
                 "Methods as tables in Markdown, with formulas, limits and literature")
      ->excludes(json_flag);
  command->callback([what, json, markdown, &action] {
    action = [what, json, markdown] {
      if (*markdown && *what != "methods") {
        throw InputError(fmt::format("--markdown: found \"{}\", expected \"methods\"", *what));
      }
      fmt::print("{}", *markdown ? methods_page() : list(*what, *json));
      return exit_success;
    };
  });
}

}  // namespace fw::app
