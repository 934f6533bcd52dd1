#include "study/kinds/sweep.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <map>
#include <memory>
#include <set>

#include "core/error.hpp"
#include "scene/scene.hpp"
#include "study/parameter_values.hpp"
#include "text/closest_name.hpp"
#include "text/toml_assignment.hpp"

namespace fw::study {

namespace {

using settings::Archive;
using settings::setting;

using Value = decltype(TomlAssignment::value);

/// One key of the inner study that takes several values.
struct Parameter {
  std::string path;  ///< in [study]
  std::string name;
  std::string unit;
  std::vector<Value> values;
  std::vector<std::string> texts{};   ///< of the values, as they stand in names of cases
  std::vector<std::string> scenes{};  ///< of paths that end in ".scene": the resolved scenes themselves
};

constexpr std::size_t most_points = 10'000;

std::string text_of(const Value& value, int digits) {
  if (const auto* text = std::get_if<std::string>(&value)) return *text;
  if (const auto* whole = std::get_if<std::int64_t>(&value)) return fmt::format("{}", *whole);
  return fmt::format("{:.{}g}", std::get<double>(value), digits);
}

/// With as few digits, but at least six, as tell the values apart. Throws InputError where a value is there
/// twice.
std::vector<std::string> texts_of(const std::vector<Value>& values, const CheckedTable& section) {
  constexpr int all_digits = 17;
  for (int digits = 6; digits <= all_digits; ++digits) {
    std::vector<std::string> texts;
    texts.reserve(values.size());
    for (const Value& value : values) texts.push_back(text_of(value, digits));
    if (std::set<std::string>(texts.begin(), texts.end()).size() == texts.size()) return texts;
  }
  section.fail("values", "found the same value twice, expected different ones");
}

/// A column has one type: numbers are floating-point numbers, whether or not a value is whole.
SummaryCell cell_of(const Parameter& parameter, std::size_t index) {
  const Value& value = parameter.values[index];
  SummaryCell cell{std::string(parameter_prefix) + parameter.name, parameter.unit, parameter.texts[index]};
  if (const auto* number = std::get_if<double>(&value)) cell.value = *number;
  if (const auto* whole = std::get_if<std::int64_t>(&value)) cell.value = static_cast<double>(*whole);
  return cell;
}

/// Whole numbers as integers: keys that take numbers take those as well, and counts take nothing else.
Value number_value(double number) {
  constexpr double largest = 9007199254740992.0;  // 2^53
  if (number == std::floor(number) && std::abs(number) <= largest) return static_cast<std::int64_t>(number);
  return number;
}

/// One section [[parameter]].
struct ParameterSpec {
  std::string path;
  std::optional<std::string> name;
  std::string unit = "1";
  std::optional<settings::NumbersOrStrings> values;
  ParameterValues sequence;
  std::optional<std::vector<std::string>> scene_texts;
};

void declare(Archive& a, ParameterSpec& parameter) {
  a(setting("path", parameter.path)
        .required()
        .doc("of the key in `[study]`, such as `problem[0].parameters.stiffness` or `energy.step_count`"));
  a(setting("name", parameter.name)
        .default_text("the last key of the path")
        .doc("of the column `parameter_NAME` and in the names of cases: letters, digits, _ and -"));
  a(setting("unit", parameter.unit).doc("of the column; strings have none"));
  a.one_of(
      {{"values",
        [&] { a(setting("values", parameter.values).not_empty().doc("numbers or strings, all different")); }},
       {"from", [&] { declare_sequence(a, parameter.sequence); }}});
  a(setting("scene_texts", parameter.scene_texts)
        .default_text("the texts of the scenes")
        .doc("of a path that ends in `.scene`: the scenes themselves, which go before the files; a result "
             "file "
             "keeps them in its `spec`"));
}

struct SweepSpec {
  std::vector<ParameterSpec> parameters;
  std::vector<std::string> quantities;
  std::int64_t quick_values = 2;
};

void declare(Archive& a, SweepSpec& spec) {
  a(setting("quantities", spec.quantities)
        .selects_cases()
        .doc("columns of the summary that the plot shows; none: the first number that varies"));
  a.sections({.name = "parameter",
              .doc = "A key of the inner study that takes several values.",
              .is_required = true},
             spec.parameters);
  a.free_section({.name = "study",
                  .doc = "The study that runs at every point, of any kind but `sweep`; without `title`.",
                  .is_required = true});
  a.quick_section([&] {
    a(setting("values", spec.quick_values)
          .integers(1, 10'000)
          .doc("at most so many values per parameter, first and last among them; the inner study's own "
               "`[study.quick]` counts as well"));
  });
}

/// The resolved scenes of a parameter that names their files; the specification keeps them as `scene_texts`.
std::vector<std::string> scenes_of(const ParameterSpec& spec, const CheckedTable& section,
                                   const std::vector<Value>& files, TomlTree resolved) {
  if (spec.scene_texts) {
    if (spec.scene_texts->size() != files.size()) {
      section.fail("scene_texts",
                   fmt::format("found {} scenes for {} values", spec.scene_texts->size(), files.size()));
    }
    return *spec.scene_texts;
  }
  std::vector<std::string> scenes;
  const std::filesystem::path directory = std::filesystem::path(section.source_name()).parent_path();
  for (std::size_t k = 0; k < files.size(); ++k) {
    const auto* file = std::get_if<std::string>(&files[k]);
    if (file == nullptr) section.fail("values", {k}, "expected the file name of a scene");
    scenes.push_back(scene::read_scene(directory / *file).resolved_toml);
  }
  resolved.set("scene_texts", scenes);
  return scenes;
}

Parameter make_parameter(const ParameterSpec& spec, const CheckedTable& section, TomlTree resolved) {
  Parameter parameter;
  parameter.path = spec.path;
  std::string last = parameter.path.substr(parameter.path.find_last_of('.') + 1);
  last.erase(std::min(last.find('['), last.size()));
  parameter.name = spec.name.value_or(last.empty() ? "value" : last);
  if (!spec.name) resolved.set("name", parameter.name);
  parameter.unit = spec.unit;
  ParameterValues numbers = spec.sequence;
  if (spec.values) {
    if (const auto* texts = std::get_if<std::vector<std::string>>(&*spec.values)) {
      for (const std::string& text : *texts) parameter.values.emplace_back(text);
      parameter.unit = "";
    } else {
      numbers.values = std::get<std::vector<double>>(*spec.values);
    }
  }
  if (parameter.values.empty()) {
    for (const double number : sorted_values(numbers, section))
      parameter.values.push_back(number_value(number));
  }
  const auto is_fit = [](char letter) {
    return std::isalnum(static_cast<unsigned char>(letter)) != 0 || letter == '_' || letter == '-';
  };
  if (parameter.name.empty() || !std::all_of(parameter.name.begin(), parameter.name.end(), is_fit)) {
    section.fail("name", fmt::format("found \"{}\", expected letters, digits, _ and -: it names a column",
                                     parameter.name));
  }
  if (parameter.path.ends_with(".scene")) {
    parameter.scenes = scenes_of(spec, section, parameter.values, resolved);
  } else if (spec.scene_texts) {
    section.fail(
        "scene_texts",
        fmt::format("found with the path \"{}\", expected one that ends in \".scene\"", parameter.path));
  }
  return parameter;
}

std::vector<Parameter> make_parameters(const SweepSpec& spec, const StudyInput& input) {
  std::vector<Parameter> parameters;
  std::set<std::string> names;
  const std::vector<CheckedTable> sections = input.file.tables("parameter");
  for (std::size_t k = 0; k < spec.parameters.size(); ++k) {
    const CheckedTable& section = sections[k];
    Parameter& parameter = parameters.emplace_back(
        make_parameter(spec.parameters[k], section, TomlTree(input.resolved).table("parameter", k)));
    if (!names.insert(parameter.name).second) {
      section.fail("path", fmt::format("another parameter is called \"{}\" as well; give one a \"name\"",
                                       parameter.name));
    }
    if (input.is_quick) {
      parameter.values = thinned_out(std::move(parameter.values), spec.quick_values);
      parameter.scenes = thinned_out(std::move(parameter.scenes), spec.quick_values);
    }
    parameter.texts = texts_of(parameter.values, section);
  }
  std::size_t product = 1;
  for (const Parameter& parameter : parameters) {
    product *= parameter.values.size();
    if (product > most_points) {
      throw InputError(fmt::format("{}: the grid of the [[parameter]] sections has more than {} points",
                                   input.file.source_name(), most_points));
    }
  }
  return parameters;
}

/// One point of the grid: an index into the values of each parameter.
std::vector<std::vector<std::size_t>> grid_points(const std::vector<Parameter>& parameters) {
  std::vector<std::vector<std::size_t>> points{{}};
  for (const Parameter& parameter : parameters) {
    std::vector<std::vector<std::size_t>> longer;
    for (const std::vector<std::size_t>& point : points) {
      for (std::size_t k = 0; k < parameter.values.size(); ++k) {
        longer.push_back(point);
        longer.back().push_back(k);
      }
    }
    points = std::move(longer);
  }
  return points;
}

/// Whether a parameter chooses the scene of problem `k` of the inner study.
bool chooses_scene(const std::vector<Parameter>& parameters, std::size_t k) {
  return std::any_of(parameters.begin(), parameters.end(), [k](const Parameter& parameter) {
    return parameter.path == fmt::format("problem[{}].scene", k);
  });
}

/// Puts the texts of the scenes that the first point has read into the resolved specification, which then
/// needs no other file.
void record_scenes(TomlTree study, const CheckedTable& given, const Plan& inner,
                   const std::vector<Parameter>& parameters) {
  const CheckedTable resolved = CheckedTable::parse_text(inner.spec, given.source_name());
  const std::vector<CheckedTable> sections = given.tables("problem"), with_text = resolved.tables("problem");
  for (std::size_t k = 0; k < std::min(sections.size(), with_text.size()); ++k) {
    if (!with_text[k].has("scene_text") || sections[k].has("scene_text") || chooses_scene(parameters, k)) {
      continue;
    }
    study.table("problem", k).set("scene_text", with_text[k].string("scene_text"));
  }
}

/// The case of the inner study with the parameters of its point.
PlannedCase with_parameters(PlannedCase inner, const std::string& point,
                            const std::vector<SummaryCell>& parameters) {
  inner.id = group_name(point + "-" + inner.id);
  inner.identity = "sweep\n" + point + "\n" + inner.identity;
  inner.parameters = parameters;
  return inner;
}

/// The inner study with the values of a point; a path that leads nowhere is a mistake of the parameters.
CheckedTable assigned(const CheckedTable& study, const std::string& name,
                      const std::vector<TomlAssignment>& assignments) {
  try {
    return study.with(assignments, name);
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: [[parameter]] path: {}", study.source_name(), error.what()));
  }
}

/// What the inner study concludes from the cases of one point.
struct Conclusion {
  std::map<std::string, std::string> inner_ids;  ///< by the ids in the sweep
  std::function<void(StudyResult&)> conclude;
};

/// Lets the inner study see the cases of its point as if it had run by itself.
void conclude_point(StudyResult& sweep, const Conclusion& point) {
  StudyResult inner;
  std::vector<CaseResult*> places;
  for (CaseResult& result : sweep.cases) {
    const auto found = point.inner_ids.find(result.id);
    if (found == point.inner_ids.end() || result.key.empty()) continue;
    places.push_back(&result);
    CaseResult& seen = inner.cases.emplace_back(result);
    seen.id = found->second;
  }
  point.conclude(inner);
  for (std::size_t k = 0; k < places.size(); ++k) {
    std::string id = places[k]->id;
    *places[k] = std::move(inner.cases[k]);
    places[k]->id = std::move(id);
  }
}

/// What [study] may leave out since the sweep has it.
std::vector<TomlAssignment> inherited(const CheckedTable& study, const Plan& plan, TomlTree resolved) {
  std::vector<TomlAssignment> assignments;
  if (!study.has("title")) {
    assignments.push_back({"title", plan.title});
    resolved.set("title", plan.title);
  }
  // The resolved specification has it in both places.
  if (study.has("seed") && study.integer("seed") != plan.seed)
    study.fail("seed", "expected at the top of the file, where it counts for every point");
  if (!study.has("seed")) {
    assignments.push_back({"seed", plan.seed});
    resolved.set("seed", plan.seed);
  }
  return assignments;
}

/// Throws InputError where `quantities` names what the plot cannot show: a name that is no column of the summary, or
/// one of texts.
void check_quantities(const SweepSpec& sweep, const CheckedTable& spec, const Plan& plan,
                      const std::vector<Parameter>& parameters) {
  std::vector<std::string> known;
  for (const SummaryColumn& column : plan.summary)
    if (column.type != CellType::text) known.push_back(column.name);
  for (const Parameter& parameter : parameters) {
    const SummaryCell cell = cell_of(parameter, 0);
    if (!std::holds_alternative<std::string>(cell.value)) known.push_back(cell.name);
  }
  for (std::size_t k = 0; k < sweep.quantities.size(); ++k) {
    const std::string& name = sweep.quantities[k];
    if (std::find(known.begin(), known.end(), name) != known.end()) continue;
    spec.fail("quantities", {k},
              fmt::format("found \"{}\", expected numbers of the summary ({}){}", name,
                          fmt::join(known, ", "), did_you_mean(name, known)));
  }
}

void plan_sweep(const SweepSpec& sweep, const StudyInput& input, const std::vector<StudyKind>& kinds,
                Plan& plan) {
  const CheckedTable& spec = input.file;
  const std::vector<Parameter> parameters = make_parameters(sweep, input);
  const CheckedTable study = spec.table("study");
  const TomlTree resolved_study = TomlTree(input.resolved).table("study");
  const std::vector<TomlAssignment> for_all = inherited(study, plan, resolved_study);
  bool is_first = true;
  std::vector<Conclusion> conclusions;
  for (const std::vector<std::size_t>& point : grid_points(parameters)) {
    std::vector<TomlAssignment> assignments = for_all;
    std::vector<SummaryCell> cells;
    std::string name;
    for (std::size_t k = 0; k < parameters.size(); ++k) {
      const Value& value = parameters[k].values[point[k]];
      assignments.push_back({parameters[k].path, value});
      if (!parameters[k].scenes.empty()) {
        assignments.push_back({parameters[k].path + "_text", parameters[k].scenes[point[k]]});
      }
      cells.push_back(cell_of(parameters[k], point[k]));
      name += fmt::format("{}{}={}", k > 0 ? "," : "", parameters[k].name, parameters[k].texts[point[k]]);
    }
    const std::string where = fmt::format("{} ([study] with {})", spec.source_name(), group_name(name));
    // The directory stays that of the file, so that scenes are found.
    Plan inner = read_plan(assigned(study, where, assignments), kinds, input.catalog, input.is_quick);
    if (is_first) {
      record_scenes(resolved_study, study, inner, parameters);
      plan.warnings = inner.warnings;
      plan.summary = inner.summary;
      check_quantities(sweep, spec, plan, parameters);
      if (plan.time_limit == 0.0) plan.time_limit = inner.time_limit;
    }
    is_first = false;
    if (inner.conclude) {
      Conclusion& conclusion = conclusions.emplace_back(Conclusion{{}, inner.conclude});
      for (const PlannedCase& planned : inner.cases) {
        conclusion.inner_ids[group_name(name + "-" + planned.id)] = planned.id;
      }
    }
    for (PlannedCase& planned : inner.cases)
      plan.cases.push_back(with_parameters(std::move(planned), name, cells));
  }
  if (conclusions.empty()) return;
  plan.conclude = [conclusions = std::move(conclusions)](StudyResult& result) {
    for (const Conclusion& point : conclusions) conclude_point(result, point);
  };
}

}  // namespace

StudyKind sweep_kind(std::vector<StudyKind> kinds) {
  return declared_kind<SweepSpec>(
      {.name = "sweep",
       .title = "A study over a grid of parameters",
       .description = "any other kind of study at every combination of values for some of its keys"},
      [kinds = std::move(kinds)](const SweepSpec& spec, const StudyInput& input, Plan& plan) {
        plan_sweep(spec, input, kinds, plan);
      });
}

}  // namespace fw::study
