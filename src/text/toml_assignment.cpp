#include "text/toml_assignment.hpp"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <cctype>

#include "core/error.hpp"
#include "text/checked_table_section.hpp"
#include "text/toml_writer.hpp"

namespace fw {

namespace {

/// One step of a path: a key, or an index into an array.
using Step = std::variant<std::string, std::size_t>;

std::vector<Step> split(const std::string& path) {
  const auto fail = [&]() -> std::vector<Step> {
    throw InputError(
        fmt::format("found the path \"{}\", expected keys and indices such as \"springs.stiffness\" or "
                    "\"problem[0].parameters.mass\"",
                    path));
  };
  std::vector<Step> steps;
  std::size_t at = 0;
  while (at < path.size()) {
    if (path[at] == '[') {
      const std::size_t end = path.find(']', at);
      const std::string digits = end == path.npos ? "" : path.substr(at + 1, end - at - 1);
      if (steps.empty() || digits.empty() || digits.size() > 9 ||
          digits.find_first_not_of("0123456789") != digits.npos) {
        return fail();
      }
      steps.emplace_back(static_cast<std::size_t>(std::stoul(digits)));
      at = end + 1;
      continue;
    }
    if (!steps.empty()) {
      if (path[at] != '.') return fail();
      ++at;
    }
    const std::size_t end = std::min(path.find_first_of(".[", at), path.size());
    const std::string key = path.substr(at, end - at);
    for (const char letter : key) {
      if (std::isalnum(static_cast<unsigned char>(letter)) == 0 && letter != '_' && letter != '-')
        return fail();
    }
    if (key.empty()) return fail();
    steps.emplace_back(key);
    at = end;
  }
  if (steps.empty() || std::holds_alternative<std::size_t>(steps.back())) {
    if (steps.size() < 2) return fail();
  }
  return steps;
}

template <class Value>
void set_at(toml::node* place, const std::vector<Step>& steps, const std::string& name,
            const std::string& path, const Value& value) {
  const auto fail = [&](std::string_view why) {
    throw InputError(fmt::format("{}: cannot set \"{}\": {}", name, path, why));
  };
  for (std::size_t k = 0; k < steps.size(); ++k) {
    const bool is_last = k + 1 == steps.size();
    if (const auto* index = std::get_if<std::size_t>(&steps[k])) {
      toml::array* array = place->as_array();
      if (array == nullptr) fail(fmt::format("the entry before [{}] is no list", *index));
      if (*index >= array->size()) {
        fail(fmt::format("found index {}, expected less than {}", *index, array->size()));
      }
      if (is_last) {
        array->replace(array->cbegin() + static_cast<std::ptrdiff_t>(*index), value);
      } else {
        place = array->get(*index);
      }
      continue;
    }
    const std::string& key = std::get<std::string>(steps[k]);
    toml::table* table = place->as_table();
    if (table == nullptr) fail(fmt::format("what should hold \"{}\" is not a table", key));
    if (is_last) {
      table->insert_or_assign(key, value);
    } else {
      if (!table->contains(key) && std::holds_alternative<std::size_t>(steps[k + 1])) {
        fail(fmt::format("there is no list \"{}\"", key));
      }
      place = &table->insert(key, toml::table{}).first->second;
    }
  }
}

}  // namespace

std::string TomlAssignment::text() const {
  const auto written = [](const auto& given) -> std::string {
    using Value = std::decay_t<decltype(given)>;
    if constexpr (std::is_same_v<Value, double>) return toml_float(given);
    if constexpr (std::is_same_v<Value, std::int64_t>) return fmt::format("{}", given);
    if constexpr (std::is_same_v<Value, bool>) return given ? "true" : "false";
    if constexpr (std::is_same_v<Value, std::string>) return toml_quoted(given);
  };
  return path + " = " + std::visit(written, value);
}

void assign(toml::node& root, const std::string& name, const std::vector<TomlAssignment>& assignments) {
  for (const TomlAssignment& assignment : assignments) {
    const std::vector<Step> steps = split(assignment.path);
    std::visit([&](const auto& value) { set_at(&root, steps, name, assignment.path, value); },
               assignment.value);
  }
}

toml::table& section_at(toml::table& root, const std::string& path) {
  toml::node* place = &root;
  for (const Step& step : path.empty() ? std::vector<Step>{} : split(path)) {
    const auto* index = std::get_if<std::size_t>(&step);
    place = index ? place->as_array()->get(*index) : place->as_table()->get(std::get<std::string>(step));
  }
  return *place->as_table();
}

}  // namespace fw
