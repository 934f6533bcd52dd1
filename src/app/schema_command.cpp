#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <memory>

#include "app/commands.hpp"
#include "catalog/methods.hpp"
#include "catalog/problems.hpp"
#include "catalog/study_kinds.hpp"
#include "core/error.hpp"
#include "scene/scene_spec.hpp"
#include "settings/json_schema.hpp"
#include "settings/settings_page.hpp"
#include "text/closest_name.hpp"

namespace fw::app {

namespace {

const study::StudyKind& find_kind(const std::string& name) {
  std::vector<std::string> names;
  for (const study::StudyKind& kind : catalog::study_kinds()) {
    if (kind.name == name) return kind;
    names.push_back(kind.name);
  }
  names.emplace_back("scene");
  names.emplace_back("method-options");
  throw InputError(fmt::format("unknown schema \"{}\"{}; \"federwerk list studies\" shows the kinds", name,
                               did_you_mean(name, names)));
}

settings::SectionDescription scene_description() {
  return settings::describe<scene::SceneSpec>(
      {.name = "scene", .doc = "A mass-spring system and its state at the start."});
}

/// The methods with their options in brackets, as if they were tables.
settings::SectionDescription options_description() {
  settings::SectionDescription all;
  all.info = {"method-options", "Options of methods, as in `newmark[beta=0.3]`."};
  for (const catalog::MethodEntry& entry : catalog::methods()) {
    if (entry.options.empty()) continue;
    settings::SectionDescription& options = all.sections.emplace_back();
    options.info = {entry.name, entry.info().title};
    options.settings = entry.options;
  }
  return all;
}

/// The options as tables in Markdown, of methods with the same ones once.
std::string options_page() {
  std::vector<std::pair<std::string, std::string>> tables;  // and the names of the methods
  for (const settings::SectionDescription& method : options_description().sections) {
    const std::string table = settings::markdown_table(method, "option");
    const auto same =
        std::find_if(tables.begin(), tables.end(), [&](const auto& one) { return one.first == table; });
    if (same == tables.end()) {
      tables.emplace_back(table, fmt::format("`{}`", method.info.name));
    } else {
      same->second += fmt::format(", `{}`", method.info.name);
    }
  }
  std::string page;
  for (const auto& [table, names] : tables) page += fmt::format("\n{}:\n\n{}", names, table);
  return page;
}

std::string schema_of(const study::StudyKind& kind) {
  settings::SchemaContext context{.title = fmt::format("federwerk: study of kind {}", kind.name)};
  for (const catalog::MethodEntry& entry : catalog::methods()) context.names["methods"].push_back(entry.name);
  for (const auto& entry : catalog::problems()) context.names["problems"].push_back(entry.name);
  if (kind.name == "sweep") {
    for (const study::StudyKind& inner : catalog::study_kinds()) {
      if (inner.name != kind.name) context.kinds.emplace_back(inner.name, inner.describe());
    }
  }
  return settings::json_schema(kind.describe(), context);
}

/// The tables of a section and of those in it, each after a mark that names it.
void add_tables(const settings::SectionDescription& section, const std::string& path, std::string& text) {
  const bool is_top = path.empty();
  const std::string brackets = section.is_list ? fmt::format("`[[{}]]`", path) : fmt::format("`[{}]`", path);
  const std::string table = settings::markdown_table(section, is_top ? "key" : "key of " + brackets);
  text += fmt::format("<!-- section: {} -->\n{}\n", is_top ? "top" : path, table);
  for (const settings::SectionDescription& inner : section.sections) {
    if (!inner.is_free) add_tables(inner, is_top ? inner.info.name : path + "." + inner.info.name, text);
  }
}

std::string settings_page(const settings::SectionDescription& description) {
  std::string text;
  add_tables(description, "", text);
  return text;
}

std::string summary_page(const study::StudyKind& kind) {
  std::string text = "| dataset | shape | type | unit | present | meaning |\n|---|---|---|---|---|---|\n";
  const auto add = [&text](const std::string& name, const char* type, const std::string& unit,
                           const std::string& meaning) {
    text += fmt::format("| `/summary/{}` | (R) | {} | {}| always |{} |\n", name, type,
                        unit.empty() ? "" : "`" + unit + "` ", meaning.empty() ? "" : " " + meaning);
  };
  add("case", "text", "", "the ids");
  for (const study::SummaryColumn& column : kind.summary) {
    constexpr const char* types[] = {"float64", "int64", "text"};
    add(column.name, types[static_cast<std::size_t>(column.type)], column.unit, column.meaning);
  }
  add("verdict", "text", "", kind.verdict_meaning);
  add("reason", "text", "", kind.reason_meaning);
  return text;
}

/// What the command prints.
std::string text_of(const std::string& name, const std::string& form) {
  if (name == "scene" && form == "json") {
    return settings::json_schema(scene_description(), {.title = "federwerk: scene"});
  }
  if (name == "scene" && form == "settings") return settings_page(scene_description());
  if (name == "method-options" && form == "json") {
    return settings::json_schema(options_description(), {.title = "federwerk: options of methods"});
  }
  if (name == "method-options" && form == "settings") return options_page();
  if (name == "scene" || name == "method-options") {
    throw InputError(fmt::format("found --form {}, which \"{}\" does not have", form, name));
  }
  const study::StudyKind& kind = find_kind(name);
  if (form == "json") return schema_of(kind);
  return form == "settings" ? settings_page(kind.describe()) : summary_page(kind);
}

void write(const std::string& text, const std::string& output) {
  if (output.empty()) {
    fmt::print("{}", text);
    return;
  }
  std::ofstream file(output, std::ios::binary);
  file << text;
  if (!file.flush()) throw SystemError(fmt::format("{}: cannot be written", output));
}

}  // namespace

void add_schema_command(CLI::App& app, Action& action) {
  CLI::App* command = app.add_subcommand(
      "schema", "Print what a file may say: a JSON schema, with which editors complete and check TOML files");
  const auto name = std::make_shared<std::string>();
  const auto output = std::make_shared<std::string>();
  const auto form = std::make_shared<std::string>("json");
  command->add_option("name", *name, "A kind of study, scene or method-options")
      ->required()
      ->type_name("NAME");
  command->add_option("-o,--output", *output, "Write to this file")->type_name("FILE");
  command
      ->add_option("--form", *form,
                   "json: the schema; settings: its keys as tables in Markdown; summary: the "
                   "columns of the summary of result files likewise")
      ->check(CLI::IsMember({"json", "settings", "summary"}));
  command->callback([=, &action] {
    action = [=] {
      write(text_of(*name, *form), *output);
      return exit_success;
    };
  });
}

}  // namespace fw::app
