#include "app/method_list.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>

#include "app/method_json.hpp"
#include "core/error.hpp"
#include "text/json_writer.hpp"
#include "text/text_table.hpp"
#include "text/wrapped_lines.hpp"

namespace fw::app {

namespace {

using catalog::MethodEntry;
using text::TextTable;

const std::string oracle_family = "oracle";

std::string lower_case(std::string text) {
  std::ranges::transform(text, text.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

bool is_in_family(const MethodInfo& info, const std::string& part) {
  return lower_case(info.family).find(lower_case(part)) != std::string::npos;
}

std::string order_text(const MethodInfo& info) {
  if (info.order == 0) return "variable";
  if (info.order == info.order_with_velocity_forces) return std::to_string(info.order);
  if (info.order_with_velocity_forces == 0) return fmt::format("{} (-)", info.order);
  return fmt::format("{} ({})", info.order, info.order_with_velocity_forces);
}

std::string yes_or_blank(bool value) {
  return value ? "yes" : "";
}

/// Families in the order of the catalogue, each with its methods.
std::vector<std::pair<std::string, std::vector<const MethodInfo*>>> families() {
  std::vector<std::pair<std::string, std::vector<const MethodInfo*>>> found;
  for (const MethodEntry& entry : catalog::methods()) {
    const MethodInfo& info = entry.info();
    auto family = std::ranges::find_if(found, [&](const auto& known) { return known.first == info.family; });
    if (family == found.end()) family = found.insert(found.end(), {info.family, {}});
    family->second.push_back(&info);
  }
  return found;
}

/// "1 to 8", "2", with "variable" where a method's order is.
std::string range_of_orders(const std::vector<const MethodInfo*>& methods) {
  int lowest = 0, highest = 0;
  bool has_variable = false;
  for (const MethodInfo* info : methods) {
    has_variable = has_variable || info->order == 0;
    if (info->order == 0) continue;
    lowest = lowest == 0 ? info->order : std::min(lowest, info->order);
    highest = std::max(highest, info->order);
  }
  if (lowest == 0) return "variable";
  const std::string range =
      lowest == highest ? std::to_string(lowest) : fmt::format("{} to {}", lowest, highest);
  return has_variable ? range + ", variable" : range;
}

}  // namespace

bool MethodFilter::asks() const {
  return !family.empty() || order || is_explicit || is_adaptive || symplectic || a_stable || l_stable;
}

bool MethodFilter::takes(const MethodInfo& info) const {
  if (only_oracles && info.family != oracle_family) return false;
  if (!family.empty() && !is_in_family(info, family)) return false;
  if (order && info.order != *order) return false;
  if (is_explicit && info.is_explicit != *is_explicit) return false;
  if (is_adaptive && !(*is_adaptive ? info.is_adaptive : info.has_fixed_step)) return false;
  // Every L-stable method is A-stable.
  return (!symplectic || info.is_symplectic) && (!a_stable || info.is_a_stable || info.is_l_stable) &&
         (!l_stable || info.is_l_stable);
}

std::vector<const MethodEntry*> chosen_methods(const MethodFilter& filter) {
  const auto& all = catalog::methods();
  if (!filter.family.empty() && std::ranges::none_of(all, [&](const MethodEntry& entry) {
        return is_in_family(entry.info(), filter.family);
      })) {
    std::vector<std::string> names;
    for (const auto& [family, methods] : families()) names.push_back(family);
    throw InputError(fmt::format("--family: found \"{}\", expected a part of one of \"{}\"", filter.family,
                                 fmt::join(names, "\", \"")));
  }
  std::vector<const MethodEntry*> chosen;
  for (const MethodEntry& entry : all) {
    if (filter.takes(entry.info())) chosen.push_back(&entry);
  }
  return chosen;
}

std::string methods_overview(std::size_t width) {
  std::string out = "Start here\n";
  TextTable first;
  std::vector<std::string> names, orders, titles;
  for (const std::string& name : catalog::first_methods()) {
    const MethodInfo& info = catalog::find_method(name).info();
    names.push_back(info.name);
    orders.push_back(info.order == 0 ? "variable" : std::to_string(info.order));
    titles.push_back(info.title);
  }
  first.add_column("name", TextTable::Align::left, names);
  first.add_column("order", TextTable::Align::right, orders);
  first.add_column("title", TextTable::Align::left, titles);
  out += first.text(width);

  std::vector<std::string> family_names, counts, ranges, examples;
  std::size_t total = 0;
  for (const auto& [family, methods] : families()) {
    total += methods.size();
    family_names.push_back(family);
    counts.push_back(std::to_string(methods.size()));
    ranges.push_back(range_of_orders(methods));
    constexpr std::size_t most_examples = 2;
    std::vector<std::string> some;
    for (std::size_t k = 0; k < std::min(most_examples, methods.size()); ++k)
      some.push_back(methods[k]->name);
    examples.push_back(
        fmt::format("{}{}", fmt::join(some, ", "), methods.size() > some.size() ? ", ..." : ""));
  }
  TextTable table;
  table.add_column("family", TextTable::Align::left, family_names);
  table.add_column("methods", TextTable::Align::right, counts);
  table.add_column("orders", TextTable::Align::left, ranges);
  table.add_column("examples", TextTable::Align::left, examples);
  out += fmt::format("\n{} methods in {} families\n{}\n", total, family_names.size(), table.text(width));
  out += text::wrapped_paragraph("",
                                 "More: --all lists every method; --family TEXT, --order P, --explicit, "
                                 "--implicit, --adaptive, --fixed, "
                                 "--symplectic, --a-stable and --l-stable list those that are so; "
                                 "\"federwerk describe NAME\" tells all of one.",
                                 width, 0);
  return out;
}

std::string methods_table(const std::vector<const MethodEntry*>& methods, std::size_t width) {
  if (methods.empty()) return "no method is like that; \"federwerk list methods\" shows the families\n";
  std::vector<std::string> name, order, kind, steps, symplectic, stable, title;
  for (const MethodEntry* entry : methods) {
    const MethodInfo& info = entry->info();
    name.push_back(info.name);
    order.push_back(order_text(info));
    kind.push_back(info.is_explicit ? "explicit" : "implicit");
    steps.push_back(!info.is_adaptive ? "fixed" : info.has_fixed_step ? "both" : "adaptive");
    symplectic.push_back(yes_or_blank(info.is_symplectic));
    stable.push_back(info.is_l_stable ? "L" : info.is_a_stable ? "A" : "");
    title.push_back(info.title);
  }
  TextTable table;
  table.add_column("name", TextTable::Align::left, name);
  table.add_column("order", TextTable::Align::left, order);
  table.add_column("kind", TextTable::Align::left, kind);
  table.add_column("step", TextTable::Align::left, steps);
  table.add_column("symplectic", TextTable::Align::left, symplectic);
  table.add_column("stable", TextTable::Align::left, stable);
  table.add_column("title", TextTable::Align::left, title);
  return table.text(width) +
         fmt::format("\n{} method{}; in parentheses the order with dampers, where another; - none\n",
                     methods.size(), methods.size() == 1 ? "" : "s");
}

std::string methods_json(const std::vector<const MethodEntry*>& methods) {
  text::JsonWriter json;
  json.begin_array();
  for (const MethodEntry* entry : methods) {
    const MethodInfo& info = entry->info();
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

}  // namespace fw::app
