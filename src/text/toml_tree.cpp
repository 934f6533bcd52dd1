#include "text/toml_tree.hpp"

#include <stdexcept>

#include "text/checked_table_section.hpp"
#include "text/toml_writer.hpp"

namespace fw {
namespace {

toml::array array_of(const Vec3<double>& value) {
  return toml::array{value.x, value.y, value.z};
}

/// An entry as toml++ stores it.
template <class Value>
auto stored(const Value& value) {
  return value;
}
auto stored(const Vec3<double>& value) {
  return array_of(value);
}
template <class Entry>
toml::array stored(const std::vector<Entry>& values) {
  toml::array array;
  array.reserve(values.size());
  for (const Entry& value : values) {
    if constexpr (std::is_same_v<Entry, std::array<int, 2>>) {
      array.push_back(toml::array{value[0], value[1]});
    } else if constexpr (std::is_same_v<Entry, std::variant<int, std::string>>) {
      std::visit([&array](const auto& held) { array.push_back(held); }, value);
    } else {
      array.push_back(stored(value));
    }
  }
  return array;
}

}  // namespace

std::string toml_text(const TomlValue& value) {
  TomlTree tree;
  tree.set("x", value);
  const std::string text = tree.text();
  return text.starts_with("x = ") ? text.substr(4, text.size() - 5) : "{}";
}

struct TomlTree::Node {
  std::shared_ptr<toml::table> root;
  toml::table* table = nullptr;
};

TomlTree::TomlTree() : node_(std::make_shared<Node>()) {
  node_->root = std::make_shared<toml::table>();
  node_->table = node_->root.get();
}

TomlTree::TomlTree(std::shared_ptr<Node> node) : node_(std::move(node)) {}

void TomlTree::set(std::string_view key, const TomlValue& value) {
  const auto* numbers = std::get_if<NumberTable>(&value);
  if (numbers != nullptr && numbers->contains("")) return set(key, numbers->at(""));
  if (numbers != nullptr) {
    const TomlTree inner = table(key);
    for (const auto& [name, number] : *numbers) inner.node_->table->insert_or_assign(name, number);
    return;
  }
  std::visit(
      [&]<class Held>(const Held& held) {
        if constexpr (!std::is_same_v<Held, NumberTable>) node_->table->insert_or_assign(key, stored(held));
      },
      value);
}

void TomlTree::copy(std::string_view key, const CheckedTable& from) {
  if (const toml::node* given = from.section_->table->get(key)) {
    given->visit([&](const auto& entry) { node_->table->insert_or_assign(key, entry); });
  }
}

void TomlTree::copy_all(const CheckedTable& from) {
  for (const std::string& key : from.keys()) copy(key, from);
}

bool TomlTree::has(std::string_view key) const {
  return node_->table->contains(key);
}

TomlTree TomlTree::table(std::string_view key) {
  toml::node& entry = node_->table->insert(key, toml::table{}).first->second;
  if (!entry.is_table()) throw std::logic_error("\"" + std::string(key) + "\" is not a table");
  return TomlTree(std::make_shared<Node>(Node{node_->root, entry.as_table()}));
}

TomlTree TomlTree::table(std::string_view key, std::size_t index) {
  toml::node& entry = node_->table->insert(key, toml::array{}).first->second;
  toml::array* list = entry.as_array();
  if (list == nullptr || index > list->size()) {
    throw std::logic_error("\"" + std::string(key) + "\" has no such section");
  }
  if (index == list->size()) list->push_back(toml::table{});
  return TomlTree(std::make_shared<Node>(Node{node_->root, list->get(index)->as_table()}));
}

std::string TomlTree::text() const {
  return to_toml_text(*node_->table);
}

}  // namespace fw
