#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <memory>
#include <numeric>

#include "app/commands.hpp"
#include "app/describe_scene.hpp"
#include "app/method_json.hpp"
#include "catalog/declared_options.hpp"
#include "catalog/methods.hpp"
#include "catalog/problems.hpp"
#include "catalog/study_kinds.hpp"
#include "core/error.hpp"
#include "scene/generators.hpp"
#include "schemes/property_list.hpp"
#include "schemes/splitting_scheme.hpp"
#include "system/terminal.hpp"
#include "text/closest_name.hpp"
#include "text/json_writer.hpp"
#include "text/wrapped_lines.hpp"

namespace fw::app {

namespace {

using text::JsonWriter;

/// A line "  label   value", wrapped beside its label to the width of the terminal.
std::string labelled_line(const std::string& label, const std::string& value) {
  constexpr std::size_t indent = 27;
  return text::wrapped_paragraph(fmt::format("  {:<24} ", label), value, terminal_width(STDOUT_FILENO),
                                 indent);
}

/// A method with the options of a call.
struct DescribedMethod {
  std::string call;
  const catalog::MethodEntry& entry;
  MethodInfo info;
  schemes::SchemeData coefficients;

  explicit DescribedMethod(const std::string& text)
      : call(text),
        entry(catalog::find_method(catalog::parse_method_call(text).name)),
        info(catalog::make_method(text)->info()),
        coefficients(catalog::theory_of_call(text).coefficients) {}
};

std::string describe_method(const DescribedMethod& method) {
  const MethodInfo& info = method.info;
  const std::vector<settings::SettingDescription>& options = method.entry.options;
  std::string text = fmt::format("{}\n{}\n\n", method.call, info.title);
  const auto line = [&](const char* label, const std::string& value) { text += labelled_line(label, value); };
  line("family", info.family);
  line("one step", info.formula);
  line("order", info.order == 0 ? "variable" : std::to_string(info.order));
  line("order with dampers",
       info.order_with_velocity_forces == 0 ? "variable" : std::to_string(info.order_with_velocity_forces));
  line("stages", std::to_string(info.stages));
  line("kind", info.is_explicit ? "explicit" : "implicit");
  if (const auto* splitting = std::get_if<schemes::SplittingScheme>(&method.coefficients)) {
    const std::vector<Float128> parts = schemes::implicit_parts(*splitting);
    const auto solved =
        std::ranges::count_if(parts, [](const Float128& part) { return abs(part) > Float128(1e-30); });
    line("with dampers", solved == 0 ? "explicit"
                                     : fmt::format("{} of {} kicks solve{} a sparse system for the velocity",
                                                   solved, parts.size(), solved == 1 ? "s" : ""));
  }
  line("step", info.is_adaptive && info.has_fixed_step ? "fixed (--step) or adaptive (--rtol, --atol)"
               : info.is_adaptive                      ? "adaptive (--rtol, --atol)"
               : info.is_multistep ? "fixed, the interval has to be a whole number of steps"
                                   : "fixed (--step)");
  line("inside a step", to_string(info.dense_output));
  line("symplectic", info.is_symplectic ? "yes (forces that depend on position)" : "no");
  line("linear stability", info.order == 0    ? "depends on the order in use"
                           : info.is_l_stable ? "A-stable, L-stable"
                           : info.is_a_stable ? "A-stable"
                                              : "conditional");
  line("works on", works_on(info.needs));
  line("literature", info.reference);
  if (!options.empty()) {
    text += fmt::format("\nOptions, as in \"{}[{}={}]\"\n", method.entry.name, options.front().info.name,
                        catalog::default_text(options.front()));
    for (const settings::SettingDescription& option : options) {
      const std::string standard = catalog::default_text(option);
      text += labelled_line(option.info.name, settings::expectation(option.info) +
                                                  (standard.empty() ? "" : " (default " + standard + ")"));
      text += labelled_line("", option.info.doc);
    }
  }
  const std::vector<schemes::NamedProperty> derived =
      schemes::property_list(schemes::derive(method.coefficients));
  if (!derived.empty()) {
    text += "\nDerived from the coefficients\n";
    for (const schemes::NamedProperty& property : derived) line(property.label.c_str(), to_text(property));
    text += '\n' + schemes::coefficients_text(method.coefficients);
  }
  return text;
}

std::string describe_problem(const ProblemEntry& entry) {
  const Problem problem = entry.make({});
  std::string text = fmt::format("{}\n{}\n\n", problem.name, problem.title);
  const auto line = [&](const char* label, const std::string& value) { text += labelled_line(label, value); };
  line("equations", problem.description);
  line("unknowns", std::to_string(problem.ivp.system->size()));
  line("interval", fmt::format("[{}, {}] s", problem.ivp.t0, problem.ivp.t1));
  line("largest |eigenvalue|", fmt::format("{:.6g} 1/s", problem.stiffness()));
  line("right-hand side", problem.is_smooth ? "smooth" : "has kinks");
  line("solution", problem.exact ? "closed form" : "certified reference in binary128");
  std::string names;
  for (const Invariant& invariant : problem.invariants) names += (names.empty() ? "" : ", ") + invariant.name;
  line("invariants", names.empty() ? "none" : names);
  line("literature", problem.source);
  if (!entry.defaults.empty()) {
    text += "\nParameters\n";
    for (const auto& [name, value] : entry.defaults) text += fmt::format("  {:<24} {}\n", name, value);
  }
  return text;
}

void write_row(JsonWriter& json, const schemes::CoefficientRow& row, std::size_t size) {
  json.begin_array();
  for (std::size_t j = 0; j < size; ++j) {
    json.value(j < row.size() ? schemes::as<double>(row[j]) : 0.0);
  }
  json.end_array();
}

void write_tableau(JsonWriter& json, const schemes::SchemeData& data) {
  const auto* tableau = std::get_if<schemes::ButcherTableau>(&data);
  if (tableau == nullptr) return;
  const std::size_t s = tableau->b.size();
  json.key("tableau").begin_object().key("A").begin_array();
  for (const schemes::CoefficientRow& row : tableau->A) write_row(json, row, s);
  json.end_array().key("b");
  write_row(json, tableau->b, s);
  if (!tableau->b_embedded.empty()) {
    json.key("b_embedded");
    write_row(json, tableau->b_embedded, s);
  }
  json.key("c").begin_array();
  for (const double c : schemes::values<double>(*tableau).c) json.value(c);
  json.end_array().end_object();
}

std::string method_json(const DescribedMethod& method) {
  const MethodInfo& info = method.info;
  JsonWriter json;
  json.begin_object();
  json.key("type").value("method").key("name").value(info.name).key("call").value(method.call);
  json.key("title").value(info.title);
  json.key("family").value(info.family).key("formula").value(info.formula);
  write_method_properties(json, info);
  json.key("reference").value(info.reference);
  json.key("options").begin_array();
  for (const settings::SettingDescription& option : method.entry.options) {
    json.begin_object().key("name").value(option.info.name);
    json.key("default").value(catalog::default_text(option));
    json.key("expected").value(settings::expectation(option.info)).key("meaning").value(option.info.doc);
    if (!option.info.choices.empty()) {
      json.key("choices").begin_array();
      for (const std::string& name : option.info.choices) json.value(name);
      json.end_array();
    }
    json.end_object();
  }
  json.end_array();
  json.key("derived").begin_object();
  for (const schemes::NamedProperty& property :
       schemes::property_list(schemes::derive(method.coefficients))) {
    json.key(property.key);
    std::visit([&](const auto& value) { json.value(value); }, property.value);
  }
  json.end_object();
  write_tableau(json, method.coefficients);
  json.end_object();
  return json.text() + "\n";
}

std::string problem_json(const ProblemEntry& entry) {
  const Problem problem = entry.make({});
  JsonWriter json;
  json.begin_object();
  json.key("type").value("problem").key("name").value(problem.name).key("title").value(problem.title);
  json.key("description").value(problem.description).key("reference").value(problem.source);
  json.key("size").value(std::int64_t{problem.ivp.system->size()});
  json.key("t0").value(problem.ivp.t0).key("t1").value(problem.ivp.t1);
  json.key("stiffness").value(problem.stiffness()).key("smooth").value(problem.is_smooth);
  json.key("exact_solution").value(static_cast<bool>(problem.exact));
  json.key("invariants").begin_array();
  for (const Invariant& invariant : problem.invariants) json.value(invariant.name);
  json.end_array().key("parameters").begin_object();
  for (const auto& [name, value] : entry.defaults) json.key(name).value(value);
  json.end_object().end_object();
  return json.text() + "\n";
}

/// An entry of which no more is known than its title and description.
std::string entry_text(const char* type, const std::string& name, const std::string& title,
                       const std::string& description, bool as_json) {
  if (!as_json) {
    return fmt::format("{}\n{}\n\n{}", name, title,
                       text::wrapped_paragraph("  ", description, terminal_width(STDOUT_FILENO), 2));
  }
  JsonWriter json;
  json.begin_object().key("type").value(type).key("name").value(name).key("title").value(title);
  json.key("description").value(description).end_object();
  return json.text() + "\n";
}

std::string describe(const std::string& name, bool as_json) {
  const std::string called = name.substr(0, name.find('['));  // a method may have options
  std::vector<std::string> names;
  for (const catalog::MethodEntry& entry : catalog::methods()) {
    if (entry.name == called) {
      const DescribedMethod method(name);
      return as_json ? method_json(method) : describe_method(method);
    }
    names.push_back(entry.name);
  }
  if (name.ends_with(".toml")) return describe_scene(name, as_json);
  for (const ProblemEntry& entry : catalog::problems()) {
    if (entry.name == name) return as_json ? problem_json(entry) : describe_problem(entry);
    names.push_back(entry.name);
  }
  for (const study::StudyKind& kind : catalog::study_kinds()) {
    if (kind.name == name) {
      return entry_text("study", kind.name, kind.title, kind.description, as_json);
    }
    names.push_back(kind.name);
  }
  for (const scene::GeneratorInfo& generator : scene::generators()) {
    if (generator.name == name) {
      return entry_text("scene", generator.name, generator.title, generator.description, as_json);
    }
    names.push_back(generator.name);
  }
  const std::string ours = catalog::our_name_of(called);
  throw InputError(fmt::format(
      "unknown name \"{}\"{}; \"federwerk list methods --all\" and \"federwerk list problems\" show all",
      name, ours.empty() ? did_you_mean(name, names) : fmt::format("; it is called \"{}\" here", ours)));
}

/// The entries of several names, a blank line between them; as JSON an array.
std::string describe_all(const std::vector<std::string>& names, bool as_json) {
  if (names.size() == 1) return describe(names.front(), as_json);
  std::vector<std::string> entries;
  for (const std::string& name : names) entries.push_back(describe(name, as_json));
  return as_json ? fmt::format("[\n{}]\n", fmt::join(entries, ",\n"))
                 : fmt::format("{}", fmt::join(entries, "\n"));
}

}  // namespace

void add_describe_command(CLI::App& app, Action& action) {
  CLI::App* command =
      app.add_subcommand("describe", "Prints all that is known of a method, problem, scene or study kind");
  auto names = std::make_shared<std::vector<std::string>>();
  auto json = std::make_shared<bool>(false);
  command->add_option("name", *names, "Its name, or several; of a scene also its file")
      ->required()
      ->type_name("NAME");
  command->add_flag("--json", *json, "As JSON; of several names an array");
  command->callback([names, json, &action] {
    action = [names, json] {
      fmt::print("{}", describe_all(*names, *json));
      return exit_success;
    };
  });
}

}  // namespace fw::app
