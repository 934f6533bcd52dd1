#include "store/show.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/error.hpp"
#include "store/show_content.hpp"
#include "store/show_table.hpp"
#include "text/json_writer.hpp"
#include "text/text_table.hpp"
#include "text/utf8.hpp"

namespace fw::store {

namespace {

std::string number_text(double value) {
  return fmt::format("{:.6g}", value);
}

std::string origin(const std::filesystem::path& path, const Attributes& attributes) {
  std::string out = text::printable_line(path.string()) + '\n';
  const auto line = [&](const char* label, const std::string& text) {
    if (!text.empty()) out += fmt::format("  {:<9} {}\n", label, text::printable_line(text));
  };
  const bool dirty = integer_of(attributes, "git_dirty", 0) != 0;
  line("kind", text_of(attributes, "kind"));
  line("title", text_of(attributes, "title"));
  line("status", text_of(attributes, "status"));
  line("solver", text_of(attributes, "solver_status"));
  line("created", text_of(attributes, "created"));
  line("command", text_of(attributes, "command_line"));
  line("commit", text_of(attributes, "git_commit") + (dirty ? " with local changes" : ""));
  line("compiler", text_of(attributes, "compiler"));
  line("processor", text_of(attributes, "cpu"));
  line("seed", fmt::format("{}", integer_of(attributes, "seed", 0)));
  // Its numbers are those of a coarser study than the title tells of.
  if (integer_of(attributes, "quick", 0) != 0) line("quick", "yes: shrunk by the [quick] section");
  return out;
}

/// Whether a column is left out of the table for people: `case` repeats problem and method, and what ends in
/// _position or _velocity details a column without that ending (its essence is in `reason`).
bool is_detail(const record::Column& column, const std::vector<record::Column>& columns) {
  const auto has = [&](std::string_view name) {
    return std::any_of(columns.begin(), columns.end(),
                       [&](const record::Column& other) { return other.name == name; });
  };
  if (column.name == "case") return has("problem") && has("method") && !has("step");
  for (std::string_view ending : {"_position", "_velocity"}) {
    if (column.name.ends_with(ending) && has(column.name.substr(0, column.name.size() - ending.size())))
      return true;
  }
  return false;
}

std::string words(const StudySummary& summary, const std::vector<std::string>& wanted,
                  const std::string& file) {
  text::TextTable table;
  std::size_t cases = 0, left_out = 0;
  const std::vector<record::Column> columns =
      wanted.empty() ? summary.columns : pick_columns(summary.columns, wanted, file);
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
  return fmt::format("\n{}{}\n{} case{}: {} hold{}, {} fail{}, {} not applicable{}\n", table.text(), more,
                     cases, cases == 1 ? "" : "s", summary.verdicts[0], summary.verdicts[0] == 1 ? "s" : "",
                     summary.verdicts[1], summary.verdicts[1] == 1 ? "s" : "", summary.verdicts[2], done);
}

std::string words(const TrajectorySummary& summary, const std::vector<std::string>& wanted,
                  const std::string& file) {
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
  out += energies.text();
  out += fmt::format("\nenergy {} {} J, at most {} J", summary.is_driven ? "change" : "drift",
                     number_text(summary.drift), number_text(summary.largest_drift));
  if (summary.is_driven) {
    out += ", forces or supports over time do work";
  } else if (summary.total_start() != 0.0) {
    const double scale = std::abs(summary.total_start());
    out += fmt::format(" (relative {}, at most {})", number_text(summary.drift / scale),
                       number_text(summary.largest_drift / scale));
  }
  text::TextTable work;
  std::vector<std::string> names, counts;
  for (const auto& [name, count] : summary.counters) {
    names.push_back(name == "seconds" ? "seconds [s]" : name);
    counts.push_back(name == "seconds" ? number_text(count) : fmt::format("{:.0f}", count));
  }
  work.add_column("work", Align::left, std::move(names));
  work.add_column("", Align::right, std::move(counts));
  return out + "\n\n" + work.text();
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

std::string show(const std::filesystem::path& path, const std::vector<std::string>& columns) {
  return std::visit(
      [&](const auto& content) {
        return origin(path, content.attributes) + words(content, columns, path.string());
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
