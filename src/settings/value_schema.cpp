#include "settings/value_schema.hpp"

#include <cmath>

namespace fw::settings {
namespace {

using text::JsonWriter;

class ValueSchemaWriter {
 public:
  ValueSchemaWriter(const SchemaContext& context, JsonWriter& json) : context_(context), json_(json) {}

  void value(const SettingDescription& setting) {
    const SettingInfo& info = setting.info;
    std::string doc = info.doc;
    if (!info.unit.empty() && info.unit != "1") doc += (doc.empty() ? "[" : " [") + info.unit + "]";
    if (!doc.empty()) json_.key("description").value(doc);
    if (!info.unit.empty()) json_.key("unit").value(info.unit);
    switch (info.type) {
      case Type::integer:
        if (!info.word.empty()) {
          json_.key("anyOf").begin_array().begin_object();
          entry(info);
          json_.end_object().begin_object().key("const").value(info.word).end_object().end_array();
          break;
        }
        entry(info);
        break;
      case Type::number:
      case Type::boolean:
      case Type::string:
        entry(info);
        break;
      case Type::vector:
        tuple("number", 3);
        break;
      case Type::numbers:
      case Type::integers:
      case Type::strings:
        list(info);
        break;
      case Type::numbers_or_strings:
        json_.key("anyOf").begin_array();
        for (const Type type : {Type::numbers, Type::strings}) {
          SettingInfo one = info;
          one.type = type;
          json_.begin_object();
          list(one);
          json_.end_object();
        }
        json_.end_array();
        break;
      case Type::vectors:
        json_.key("type").value("array");
        if (info.fewest > 0) json_.key("minItems").value(static_cast<std::uint64_t>(info.fewest));
        json_.key("items").begin_object();
        tuple("number", 3);
        json_.end_object();
        break;
      case Type::number_or_list:
        json_.key("anyOf").begin_array().begin_object();
        entry(info);
        json_.end_object().begin_object();
        list(info);
        json_.end_object().end_array();
        break;
      case Type::number_or_table:
        json_.key("anyOf").begin_array().begin_object();
        entry(info);
        json_.end_object().begin_object().key("type").value("object").key("properties").begin_object();
        for (const std::string& name : info.choices) {
          json_.key(name).begin_object();
          entry(info);
          json_.end_object();
        }
        json_.end_object().key("additionalProperties").value(false).end_object().end_array();
        break;
      case Type::indices:
        list(info);
        json_.key("uniqueItems").value(true);
        break;
      case Type::index_pairs:
        json_.key("type").value("array").key("items").begin_object();
        tuple("integer", 2);
        json_.end_object();
        break;
      case Type::points:
        points(info);
        break;
      case Type::sequence:
        json_.key("anyOf").begin_array().begin_object();
        list(info);
        json_.end_object();
        sequence();
        json_.end_array();
        break;
      case Type::number_table:
        json_.key("type").value("object").key("additionalProperties").begin_object();
        json_.key("type").begin_array().value("number").value("object").end_array().end_object();
        break;
    }
    if (setting.default_value && info.default_text.empty()) default_of(*setting.default_value);
  }

 private:
  void tuple(const char* type, std::int64_t count) {
    json_.key("type").value("array").key("minItems").value(count).key("maxItems").value(count);
    json_.key("items").begin_object().key("type").value(type);
    if (type == std::string("integer")) json_.key("minimum").value(std::int64_t{0});
    json_.end_object();
  }

  /// An index or a name, or a list of these.
  void points(const SettingInfo& info) {
    const auto one = [&] {
      json_.begin_object().key("type").value("integer").key("minimum").value(std::int64_t{0}).end_object();
      json_.begin_object().key("type").value("string");
      names(info);
      json_.end_object();
    };
    json_.key("anyOf").begin_array();
    one();
    json_.begin_object().key("type").value("array").key("items").begin_object().key("anyOf").begin_array();
    one();
    json_.end_array().end_object().end_object().end_array();
  }

  void sequence() {
    json_.begin_object().key("type").value("object").key("properties").begin_object();
    for (const char* key : {"from", "to"}) {
      json_.key(key).begin_object().key("type").value("number");
      json_.key("exclusiveMinimum").value(std::int64_t{0}).end_object();
    }
    json_.key("count").begin_object().key("type").value("integer").key("minimum").value(std::int64_t{2});
    json_.key("maximum").value(std::int64_t{10'000}).end_object().end_object();
    json_.key("required").begin_array().value("from").value("to").value("count").end_array();
    json_.key("additionalProperties").value(false).end_object();
  }

  void list(const SettingInfo& info) {
    json_.key("type").value("array");
    if (info.fewest > 0) json_.key("minItems").value(static_cast<std::uint64_t>(info.fewest));
    if (info.most != std::numeric_limits<std::size_t>::max()) {
      json_.key("maxItems").value(static_cast<std::uint64_t>(info.most));
    }
    json_.key("items").begin_object();
    entry(info);
    json_.end_object();
  }

  void entry(const SettingInfo& info) {
    switch (info.type) {
      case Type::number:
      case Type::numbers:
      case Type::sequence:
      case Type::number_or_list:
      case Type::number_or_table:
        json_.key("type").value("number");
        if (std::isfinite(info.range.lowest)) {
          json_.key(info.range.excludes_lowest ? "exclusiveMinimum" : "minimum").value(info.range.lowest);
        }
        if (std::isfinite(info.range.highest)) {
          json_.key(info.range.excludes_highest ? "exclusiveMaximum" : "maximum").value(info.range.highest);
        }
        break;
      case Type::integer:
      case Type::integers:
        json_.key("type").value("integer");
        if (info.lowest != std::numeric_limits<std::int64_t>::min()) json_.key("minimum").value(info.lowest);
        if (info.highest != std::numeric_limits<std::int64_t>::max())
          json_.key("maximum").value(info.highest);
        break;
      case Type::indices:
        json_.key("type").value("integer").key("minimum").value(std::int64_t{0});
        break;
      case Type::boolean:
        json_.key("type").value("boolean");
        break;
      default:
        json_.key("type").value("string");
        names(info);
    }
  }

  void names(const SettingInfo& info) {
    if (!info.choices.empty()) {
      json_.key("enum").begin_array();
      for (const std::string& name : info.choices) json_.value(name);
      json_.end_array();
    }
    const auto known = context_.names.find(info.names_of);
    if (known == context_.names.end()) return;
    json_.key("anyOf").begin_array().begin_object().key("enum").begin_array();
    for (const std::string& name : known->second) json_.value(name);
    json_.end_array().end_object();
    json_.begin_object().key("pattern").value("[\\[* ]").end_object().end_array();
  }

  void default_of(const TomlValue& held) {
    const auto list_of = [this](const auto& list) {
      json_.begin_array();
      for (const auto& entry : list) json_.value(entry);
      json_.end_array();
    };
    json_.key("default");
    std::visit(
        [&]<class Held>(const Held& value) {
          if constexpr (std::is_same_v<Held, Vec3<double>>) {
            list_of(std::vector<double>{value.x, value.y, value.z});
          } else if constexpr (std::is_same_v<Held, NumberTable>) {
            if (value.contains("")) {
              json_.value(value.at(""));
            } else {
              json_.begin_object().end_object();
            }
          } else if constexpr (std::is_same_v<Held, std::vector<Vec3<double>>> ||
                               std::is_same_v<Held, IndexPairs> || std::is_same_v<Held, PointList>) {
            json_.begin_array().end_array();  // defaults of these are empty
          } else if constexpr (requires { value.size(); } && !std::is_same_v<Held, std::string>) {
            list_of(value);
          } else {
            json_.value(value);
          }
        },
        held);
  }

  const SchemaContext& context_;
  JsonWriter& json_;
};

}  // namespace

void write_value_schema(const SettingDescription& setting, const SchemaContext& context, JsonWriter& json) {
  ValueSchemaWriter(context, json).value(setting);
}

}  // namespace fw::settings
