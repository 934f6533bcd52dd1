#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <memory>

#include "app/commands.hpp"
#include "app/input_kind.hpp"
#include "catalog/builtin_catalog.hpp"
#include "catalog/study_kinds.hpp"
#include "core/error.hpp"
#include "scene/scene.hpp"
#include "study/plan.hpp"
#include "study/problem_spec.hpp"
#include "text/json_writer.hpp"
#include "text/utf8.hpp"

namespace fw::app {

namespace {

struct CheckArguments {
  std::vector<std::string> files, methods;
  bool quick = false, as_json = false;
};

/// What is said of one file or call.
struct Answer {
  std::string name;       ///< as the user gave it
  std::string what{};     ///< "study", "scene", "method"; empty where that is not known
  std::string message{};  ///< why it is refused; empty: it is valid
  std::vector<std::string> warnings{};
};

/// Reads a file as `run` or `simulate` does.
void check_file(const CheckArguments& arguments, const catalog::BuiltinCatalog& catalog, Answer& answer) {
  const CheckedTable file = CheckedTable::parse_file(answer.name);
  const InputKind kind = input_kind(file);
  if (kind == InputKind::study) {
    answer.what = "study";
    answer.warnings = study::read_plan(file, catalog::study_kinds(), catalog, arguments.quick).warnings;
  } else if (kind == InputKind::scene) {
    answer.what = "scene";
    answer.warnings = scene::read_scene(file).warnings;
  } else {
    file.fail_missing("kind", "the kind of a study, or a scene with [particles] or [generate]",
                      {"kind", "particles", "generate"});
  }
}

template <class Check>
Answer answer_to(const std::string& name, Check check) {
  Answer answer{.name = name};
  try {
    check(answer);
  } catch (const std::exception& error) {  // whatever it is, the other files get their answers
    answer.message = *error.what() == '\0' ? "unknown error" : error.what();
  }
  return answer;
}

void print(const Answer& answer) {
  for (const std::string& warning : answer.warnings) {
    fmt::print(stderr, "federwerk: warning: {}\n", text::printable_line(warning));
  }
  if (answer.message.empty()) {
    fmt::print("{}: a valid {}\n", text::printable_line(answer.name), answer.what);
  } else {
    fmt::print(stderr, "federwerk: {}\n", text::printable_line(answer.message));
  }
}

std::string json_of(const std::vector<Answer>& answers) {
  text::JsonWriter json;
  json.begin_array();
  for (const Answer& answer : answers) {
    json.begin_object().key("name").value(answer.name).key("type").value(answer.what);
    json.key("valid").value(answer.message.empty()).key("message").value(answer.message);
    json.key("warnings").begin_array();
    for (const std::string& warning : answer.warnings) json.value(warning);
    json.end_array().end_object();
  }
  json.end_array();
  return json.text() + "\n";
}

int check(const CheckArguments& arguments) {
  if (arguments.files.empty() && arguments.methods.empty()) {
    throw InputError("found nothing to check, expected a file or --method");
  }
  const catalog::BuiltinCatalog catalog;
  std::vector<Answer> answers;
  const auto add = [&](Answer answer) {
    if (!arguments.as_json) print(answer);
    answers.push_back(std::move(answer));
  };
  for (const std::string& file : arguments.files) {
    add(answer_to(file, [&](Answer& answer) { check_file(arguments, catalog, answer); }));
  }
  for (const std::string& call : arguments.methods) {
    add(answer_to(call, [&](Answer& answer) {
      answer.what = "method";
      study::check_method(call, catalog);
    }));
  }
  if (arguments.as_json) fmt::print("{}", json_of(answers));
  const bool all_valid = std::all_of(answers.begin(), answers.end(),
                                     [](const Answer& answer) { return answer.message.empty(); });
  return all_valid ? exit_success : exit_bad_input;
}

}  // namespace

void add_check_command(CLI::App& app, Action& action) {
  CLI::App* command = app.add_subcommand(
      "check",
      "Reads studies, scenes and calls of methods and says of each whether it is valid; runs nothing");
  const auto arguments = std::make_shared<CheckArguments>();
  command->add_option("file", arguments->files, "Study files and scene files (TOML)")->type_name("FILE.toml");
  command->add_option("--method", arguments->methods, "A method with options, such as newmark[beta=0.3]")
      ->type_name("NAME")
      ->allow_extra_args(false);
  command->add_flag("--quick", arguments->quick, "Check studies as run --quick reads them");
  command->add_flag("--json", arguments->as_json, "As JSON");
  command->callback([arguments, &action] { action = [arguments] { return check(*arguments); }; });
}

}  // namespace fw::app
