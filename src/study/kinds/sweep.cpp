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
#include "text/toml_assignment.hpp"

namespace fw::study {

namespace {

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
  SummaryCell cell{"parameter_" + parameter.name, parameter.unit, parameter.texts[index]};
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

bool holds_strings(const CheckedTable& section) {
  try {
    section.strings("values");
    return true;
  } catch (const InputError&) {
    return false;
  }
}

/// The resolved scenes of a parameter that names their files; the specification keeps them as `scene_texts`.
std::vector<std::string> read_scenes(const CheckedTable& section, const std::vector<Value>& files) {
  std::vector<std::string> scenes;
  if (!section.has("scene_texts")) {
    const std::filesystem::path directory = std::filesystem::path(section.source_name()).parent_path();
    for (std::size_t k = 0; k < files.size(); ++k) {
      const auto* file = std::get_if<std::string>(&files[k]);
      if (file == nullptr) section.fail("values", {k}, "expected the file name of a scene");
      scenes.push_back(scene::read_scene(directory / *file).resolved_toml);
    }
  }
  scenes = section.strings_or("scene_texts", scenes);
  if (scenes.size() != files.size()) {
    section.fail("scene_texts", fmt::format("found {} scenes for {} values", scenes.size(), files.size()));
  }
  return scenes;
}

Parameter read_parameter(const CheckedTable& section) {
  Parameter parameter;
  parameter.path = section.string("path");
  std::string last = parameter.path.substr(parameter.path.find_last_of('.') + 1);
  last.erase(std::min(last.find('['), last.size()));
  parameter.name = section.string_or("name", last.empty() ? "value" : last);
  parameter.unit = section.string_or("unit", "1");
  if (section.has("values") && holds_strings(section)) {
    for (const std::string& text : section.strings("values")) parameter.values.emplace_back(text);
    parameter.unit = "";
  } else {
    for (const double number : read_parameter_values(section))
      parameter.values.push_back(number_value(number));
  }
  if (parameter.values.empty()) section.fail("values", "found an empty list, expected at least one value");
  const auto is_fit = [](char letter) {
    return std::isalnum(static_cast<unsigned char>(letter)) != 0 || letter == '_' || letter == '-';
  };
  if (parameter.name.empty() || !std::all_of(parameter.name.begin(), parameter.name.end(), is_fit)) {
    section.fail("name", fmt::format("found \"{}\", expected letters, digits, _ and -: it names a column",
                                     parameter.name));
  }
  if (parameter.path.ends_with(".scene")) parameter.scenes = read_scenes(section, parameter.values);
  return parameter;
}

/// At most `count` of the values, the first and the last among them.
template <class Entry>
void thin_out(std::vector<Entry>& values, std::size_t count) {
  if (values.size() <= count) return;
  std::vector<Entry> kept;
  for (std::size_t k = 0; k < count; ++k) {
    kept.push_back(values[count == 1 ? 0 : k * (values.size() - 1) / (count - 1)]);
  }
  values = std::move(kept);
}

std::vector<Parameter> read_parameters(const CheckedTable& spec, bool quick) {
  std::vector<Parameter> parameters;
  std::set<std::string> names;
  const auto points =
      static_cast<std::size_t>(spec.table_or_empty("quick").integer_or("values", 2, 1, 10'000));
  for (const CheckedTable& section : spec.tables("parameter")) {
    Parameter& parameter = parameters.emplace_back(read_parameter(section));
    if (!names.insert(parameter.name).second) {
      section.fail("path", fmt::format("another parameter is called \"{}\" as well; give one a \"name\"",
                                       parameter.name));
    }
    if (quick) {
      thin_out(parameter.values, points);
      thin_out(parameter.scenes, points);
    }
    parameter.texts = texts_of(parameter.values, section);
  }
  std::size_t product = 1;
  for (const Parameter& parameter : parameters) {
    product *= parameter.values.size();
    if (product > most_points) {
      throw InputError(fmt::format("{}: the grid of the [[parameter]] sections has more than {} points",
                                   spec.source_name(), most_points));
    }
  }
  if (parameters.empty()) {
    throw InputError(fmt::format("{}: found no [[parameter]], expected at least one", spec.source_name()));
  }
  return parameters;
}

/// Marks everything in a section as read: another reader checks it.
void accept_everything(const CheckedTable& section) {
  for (const std::string& key : section.keys()) {
    if (!section.has(key)) continue;
    if (section.is_table(key)) {
      accept_everything(section.table(key));
      continue;
    }
    try {
      for (const CheckedTable& inner : section.tables(key)) accept_everything(inner);
    } catch (const InputError&) {
      // a plain value
    }
  }
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
void record_scenes(const CheckedTable& study, const Plan& inner, const std::vector<Parameter>& parameters) {
  const CheckedTable resolved = CheckedTable::parse_text(inner.spec, study.source_name());
  const std::vector<CheckedTable> sections = study.tables("problem"), with_text = resolved.tables("problem");
  for (std::size_t k = 0; k < std::min(sections.size(), with_text.size()); ++k) {
    if (with_text[k].has("scene_text") && !chooses_scene(parameters, k))
      sections[k].string_or("scene_text", with_text[k].string("scene_text"));
  }
}

/// The case of the inner study with the parameters before its own columns.
PlannedCase with_parameters(PlannedCase inner, const std::string& point, std::vector<SummaryCell> cells) {
  inner.id = group_name(point + "-" + inner.id);
  inner.identity = "sweep\n" + point + "\n" + inner.identity;
  inner.facts.insert(inner.facts.begin(), cells.begin(), cells.end());
  inner.run = [run = std::move(inner.run), cells = std::move(cells)](const RunContext& context) {
    CaseResult result = run(context);
    result.summary.insert(result.summary.begin(), cells.begin(), cells.end());
    return result;
  };
  return inner;
}

/// The inner study with the values of a point; a path that leads nowhere is a mistake of the parameters.
std::string assigned(const std::string& text, const std::string& where,
                     const std::vector<TomlAssignment>& assignments, const CheckedTable& spec) {
  try {
    return toml_with(text, where, assignments);
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: [[parameter]] path: {}", spec.source_name(), error.what()));
  }
}

/// What the inner study concludes from the cases of one point.
struct Conclusion {
  std::map<std::string, std::string> inner_ids;  ///< by the ids in the sweep
  std::vector<SummaryCell> cells;                ///< of the parameters
  std::function<void(StudyResult&)> conclude;
};

/// Lets the inner study see the cases of its point as if it had run by itself.
void conclude_point(StudyResult& sweep, const Conclusion& point) {
  const auto parameters = static_cast<std::ptrdiff_t>(point.cells.size());
  StudyResult inner;
  std::vector<CaseResult*> places;
  for (CaseResult& result : sweep.cases) {
    const auto found = point.inner_ids.find(result.id);
    if (found == point.inner_ids.end() || result.key.empty()) continue;
    places.push_back(&result);
    CaseResult& seen = inner.cases.emplace_back(result);
    seen.id = found->second;
    seen.summary.erase(seen.summary.begin(), seen.summary.begin() + parameters);
  }
  point.conclude(inner);
  for (std::size_t k = 0; k < places.size(); ++k) {
    std::string id = places[k]->id;
    *places[k] = std::move(inner.cases[k]);
    places[k]->id = std::move(id);
    places[k]->summary.insert(places[k]->summary.begin(), point.cells.begin(), point.cells.end());
  }
}

void read_sweep(const CheckedTable& spec, const std::vector<StudyKind>& kinds, const Catalog& catalog,
                bool quick, Plan& plan) {
  const std::vector<Parameter> parameters = read_parameters(spec, quick);
  spec.strings_or("quantities", {});  // what the plot shows
  const CheckedTable study = spec.table("study");
  study.string_or("title", plan.title);
  // The resolved specification has it in both places.
  if (study.has("seed") && study.integer("seed") != plan.seed)
    study.fail("seed", "expected at the top of the file, where it counts for every point");
  study.integer_or("seed", plan.seed);
  accept_everything(study);
  const std::string text = study.to_toml_text();
  bool is_first = true;
  std::vector<Conclusion> conclusions;
  for (const std::vector<std::size_t>& point : grid_points(parameters)) {
    std::vector<TomlAssignment> assignments;
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
    const CheckedTable inner_spec = CheckedTable::parse_text(assigned(text, where, assignments, spec), where);
    Plan inner = read_plan(inner_spec, kinds, catalog, quick);
    if (is_first) {
      record_scenes(study, inner, parameters);
      plan.warnings = inner.warnings;
      if (plan.time_limit == 0.0) plan.time_limit = inner.time_limit;
    }
    is_first = false;
    if (inner.conclude) {
      Conclusion& conclusion = conclusions.emplace_back(Conclusion{{}, cells, inner.conclude});
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
  return {.name = "sweep",
          .title = "A study over a grid of parameters",
          .description = "any other kind of study at every combination of values for some of its keys",
          .read = [kinds = std::move(kinds)](const CheckedTable& spec, const Catalog& catalog, bool quick,
                                             Plan& plan) { read_sweep(spec, kinds, catalog, quick, plan); }};
}

}  // namespace fw::study
