#include "store/show.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <string>

#include "core/error.hpp"
#include "mechanics/mass_spring_system.hpp"
#include "scene/scene.hpp"
#include "store/show_content.hpp"
#include "store/show_table.hpp"
#include "text/json_writer.hpp"
#include "text/text_table.hpp"
#include "text/utf8.hpp"
#include "text/wrapped_lines.hpp"

namespace fw::store {

namespace {

std::string number_text(double value) {
  return fmt::format("{:.6g}", value);
}

/// A line "  label     text" of what a file is; nothing without a text.
std::string labelled(const char* label, const std::string& text, std::size_t width) {
  constexpr std::size_t indent = 12;
  if (text.empty()) return "";
  return text::wrapped_paragraph(fmt::format("  {:<9} ", label), text::printable_line(text), width, indent);
}

/// What the file is: before the numbers.
std::string subject(const std::filesystem::path& path, const Attributes& attributes, std::size_t width) {
  std::string out = text::wrapped_paragraph("", text::printable_line(path.string()), width, 2);
  out += labelled("kind", text_of(attributes, "kind"), width);
  out += labelled("title", text_of(attributes, "title"), width);
  out += labelled("status", text_of(attributes, "status"), width);
  out += labelled("solver", text_of(attributes, "solver_status"), width);
  const std::string frames = text_of(attributes, "frame_origin");  // not in files of older versions
  if (!frames.empty()) {
    out += labelled("frames", frames + "; spacing " + text_of(attributes, "frame_spacing"), width);
  }
  out += labelled("stopped", text_of(attributes, "stopped_at"), width);
  std::istringstream warnings(text_of(attributes, "warnings"));
  for (std::string warning; std::getline(warnings, warning);) out += labelled("warning", warning, width);
  // Its numbers are those of a coarser study than the title tells of.
  if (integer_of(attributes, "quick", 0) != 0) {
    out += labelled("quick", "yes: shrunk by the [quick] section", width);
  }
  return out;
}

/// How the file came about: after the numbers.
std::string provenance(const Attributes& attributes, std::size_t width) {
  const bool dirty = integer_of(attributes, "git_dirty", 0) != 0;
  std::string out = "\n";
  out += labelled("created", text_of(attributes, "created"), width);
  out += labelled("command", text_of(attributes, "command_line"), width);
  out += labelled("commit", text_of(attributes, "git_commit") + (dirty ? " with local changes" : ""), width);
  out += labelled("compiler", text_of(attributes, "compiler"), width);
  out += labelled("processor", text_of(attributes, "cpu"), width);
  out += labelled("seed", fmt::format("{}", integer_of(attributes, "seed", 0)), width);
  return out;
}

/// Whether forces of the scene of a trajectory depend on velocities: dampers of any kind, drag. False where its
/// text is no scene.
bool loses_energy(const std::string& spec) {
  try {
    const mechanics::MassSpringSystem system(scene::parse_scene(spec, "spec").model);
    return system.force_class() == ForceClass::velocity;
  } catch (const InputError&) {
    return false;
  }
}

/// Whether a column is left out of the table for people: `case` repeats problem and method, and what ends in
/// _position or _velocity details a column without that ending (its essence is in `reason`). Long words on how
/// frames came about would push the reason off the screen; it tells what is unusual.
bool is_detail(const record::Column& column, const std::vector<record::Column>& columns) {
  const auto has = [&](std::string_view name) {
    return std::any_of(columns.begin(), columns.end(),
                       [&](const record::Column& other) { return other.name == name; });
  };
  if (column.name == "frame_origin" || column.name == "frame_spacing") return true;
  if (column.name == "case") return has("problem") && has("method") && !has("step");
  for (std::string_view ending : {"_position", "_velocity"}) {
    if (column.name.ends_with(ending) && has(column.name.substr(0, column.name.size() - ending.size())))
      return true;
  }
  return false;
}

/// Prose last, where a table has room for it.
void put_reason_last(std::vector<record::Column>& columns) {
  std::stable_partition(columns.begin(), columns.end(),
                        [](const record::Column& column) { return column.name != "reason"; });
}

std::string words(const StudySummary& summary, const std::vector<std::string>& wanted,
                  const std::string& file, std::size_t width) {
  text::TextTable table;
  std::size_t cases = 0, left_out = 0;
  std::vector<record::Column> columns =
      wanted.empty() ? summary.columns : pick_columns(summary.columns, wanted, file);
  if (wanted.empty()) put_reason_last(columns);
  for (const record::Column& column : columns) {
    if (wanted.empty() && is_detail(column, summary.columns)) {
      ++left_out;
      continue;
    }
    std::vector<std::string> cells;
    const bool text = std::holds_alternative<std::vector<std::string>>(column.values);
    std::visit(
        [&]<class T>(const std::vector<T>& values) {
          for (const T& value : values) {
            if constexpr (std::is_same_v<T, std::string>) {
              cells.push_back(value);
            } else if (column.lacks(value)) {
              cells.emplace_back();
            } else if constexpr (std::is_same_v<T, double>) {
              cells.push_back(number_text(value));
            } else {
              cells.push_back(fmt::format("{}", value));
            }
          }
        },
        column.values);
    cases = cells.size();
    const bool has_unit = !column.unit.empty() && column.unit != "1";
    table.add_column(has_unit ? fmt::format("{} [{}]", column.name, column.unit) : column.name,
                     text ? text::TextTable::Align::left : text::TextTable::Align::right, std::move(cells));
  }
  if (cases == 0) return "\nno finished cases\n";
  const std::string more =
      left_out > 0 ? fmt::format("({} more columns are in the file; --json shows them)\n", left_out) : "";
  const std::string done = summary.verdicts[3] > 0 ? fmt::format(", {} done", summary.verdicts[3]) : "";
  return fmt::format("\n{}{}\n{} case{}: {} hold{}, {} fail{}, {} not applicable{}\n", table.text(width),
                     more, cases, cases == 1 ? "" : "s", summary.verdicts[0],
                     summary.verdicts[0] == 1 ? "s" : "", summary.verdicts[1],
                     summary.verdicts[1] == 1 ? "s" : "", summary.verdicts[2], done);
}

std::string words(const TrajectorySummary& summary, const std::vector<std::string>& wanted,
                  const std::string& file, std::size_t width) {
  if (!wanted.empty()) {
    throw InputError(
        fmt::format("\"{}\" is a trajectory: columns are there with --csv, --markdown or --latex", file));
  }
  std::string out = fmt::format("\n{} frames of {} particles and {} springs", summary.frames,
                                summary.particles, summary.springs);
  if (summary.frames == 0) return out + '\n';
  out +=
      fmt::format(", t = {} s to {} s\n\n", number_text(summary.time_start), number_text(summary.time_end));
  text::TextTable energies;
  using Align = text::TextTable::Align;
  energies.add_column("energy [J]", Align::left, {"kinetic", "potential", "total"});
  energies.add_column("start", Align::right,
                      {number_text(summary.kinetic_start), number_text(summary.potential_start),
                       number_text(summary.total_start())});
  energies.add_column("end", Align::right,
                      {number_text(summary.kinetic_end), number_text(summary.potential_end),
                       number_text(summary.total_end())});
  out += energies.text(width);
  const bool is_damped = loses_energy(text_of(summary.attributes, "spec"));
  std::string change =
      fmt::format("{} {} J, at most {} J", is_damped || summary.is_driven ? "energy change" : "energy drift",
                  number_text(summary.drift), number_text(summary.largest_drift));
  if (summary.is_driven) {
    change += ", forces or supports over time do work";
  } else if (summary.total_start() != 0.0) {
    const double scale = std::abs(summary.total_start());
    change += fmt::format(" (relative {}, at most {})", number_text(summary.drift / scale),
                          number_text(summary.largest_drift / scale));
  }
  if (is_damped) change += "; dampers or drag take energy out, so that it is no error of the method alone";
  out += '\n' + text::wrapped_paragraph("", change, width, 0);
  text::TextTable work;
  std::vector<std::string> names, counts;
  for (const auto& [name, count] : summary.counters) {
    names.push_back(name == "seconds" ? "seconds [s]" : name);
    counts.push_back(name == "seconds" ? number_text(count) : fmt::format("{:.0f}", count));
  }
  work.add_column("work", Align::left, std::move(names));
  work.add_column("", Align::right, std::move(counts));
  return out + "\n" + work.text(width);
}

void write_json(text::JsonWriter& json, const StudySummary& summary) {
  json.key("summary").begin_array();
  const std::size_t rows =
      summary.columns.empty()
          ? 0
          : std::visit([](const auto& values) { return values.size(); }, summary.columns.front().values);
  for (std::size_t row = 0; row < rows; ++row) {
    json.begin_object();
    for (const record::Column& column : summary.columns) {
      std::visit(
          [&](const auto& values) {
            if (row >= values.size()) return;
            json.key(column.name);
            if (column.lacks(values[row])) {
              json.value(std::numeric_limits<double>::quiet_NaN());  // null
            } else {
              json.value(values[row]);
            }
          },
          column.values);
    }
    json.end_object();
  }
  json.end_array().key("units").begin_object();
  for (const record::Column& column : summary.columns) json.key(column.name).value(column.unit);
  json.end_object().key("verdicts").begin_object();
  json.key("holds").value(summary.verdicts[0]);
  json.key("fails").value(summary.verdicts[1]);
  json.key("not applicable").value(summary.verdicts[2]);
  json.key("done").value(summary.verdicts[3]).end_object();
}

void write_json(text::JsonWriter& json, const TrajectorySummary& summary) {
  json.key("trajectory").begin_object();
  json.key("frames").value(summary.frames).key("particles").value(summary.particles);
  json.key("springs").value(summary.springs);
  json.key("time_start").value(summary.time_start).key("time_end").value(summary.time_end);
  json.key("kinetic_energy_start").value(summary.kinetic_start);
  json.key("kinetic_energy_end").value(summary.kinetic_end);
  json.key("potential_energy_start").value(summary.potential_start);
  json.key("potential_energy_end").value(summary.potential_end);
  json.key("energy_drift").value(summary.drift).key("largest_energy_drift").value(summary.largest_drift);
  json.end_object().key("counters").begin_object();
  for (const auto& [name, count] : summary.counters) {
    if (name == "seconds") {
      json.key(name).value(count);
    } else {
      json.key(name).value(static_cast<std::int64_t>(count));
    }
  }
  json.end_object();
}

}  // namespace

std::string show(const std::filesystem::path& path, const std::vector<std::string>& columns,
                 std::size_t width) {
  return std::visit(
      [&](const auto& content) {
        return subject(path, content.attributes, width) + words(content, columns, path.string(), width) +
               provenance(content.attributes, width);
      },
      read_show_content(path));
}

std::string show_json(const std::filesystem::path& path) {
  text::JsonWriter json;
  json.begin_object().key("file").value(path.string());
  std::visit(
      [&](const auto& content) {
        json.key("attributes").begin_object();
        for (const auto& [name, value] : content.attributes) {
          json.key(name);
          std::visit([&](const auto& typed) { json.value(typed); }, value);
        }
        json.end_object();
        write_json(json, content);
      },
      read_show_content(path));
  json.end_object();
  return json.text();
}

}  // namespace fw::store
