#include "settings/json_schema.hpp"

#include <cmath>
#include <set>

#include "text/json_writer.hpp"

namespace fw::settings {
namespace {

using text::JsonWriter;

class SchemaWriter {
 public:
  explicit SchemaWriter(const SchemaContext& context) : context_(context) {}

  std::string text(const SectionDescription& root) {
    json_.begin_object();
    json_.key("$schema").value("https://json-schema.org/draft/2020-12/schema");
    json_.key("title").value(context_.title);
    object(root);
    if (!context_.kinds.empty()) {
      is_lenient_ = true;
      json_.key("$defs").begin_object();
      for (const auto& [name, kind] : context_.kinds) {
        json_.key(name).begin_object();
        object(kind);
        json_.end_object();
      }
      json_.end_object();
    }
    json_.end_object();
    return json_.text();
  }

 private:
  void object(const SectionDescription& section) {
    if (!section.info.doc.empty()) json_.key("description").value(section.info.doc);
    json_.key("type").value("object");
    if (section.is_free) return free_section();
    json_.key("properties").begin_object();
    std::set<std::string> written;
    properties(section, written);
    json_.end_object();
    rules(section);
    json_.key("additionalProperties").value(false);
  }

  /// The study of another kind: what is checked depends on its `kind`.
  void free_section() {
    json_.key("properties").begin_object().key("kind").begin_object().key("enum").begin_array();
    for (const auto& [name, kind] : context_.kinds) json_.value(name);
    json_.end_array().end_object().end_object();
    json_.key("required").begin_array().value("kind").end_array();
    json_.key("allOf").begin_array();
    for (const auto& [name, kind] : context_.kinds) {
      json_.begin_object();
      condition("kind", name);
      json_.key("then").begin_object().key("$ref").value("#/$defs/" + name).end_object();
      json_.end_object();
    }
    json_.end_array();
  }

  void condition(const std::string& key, const std::string& value) {
    json_.key("if").begin_object().key("properties").begin_object();
    json_.key(key).begin_object().key("const").value(value).end_object().end_object();
    json_.key("required").begin_array().value(key).end_array().end_object();
  }

  /// Every key that the section can have, in whatever form; a key that forms give different values says
  /// nothing here but in `rules`.
  void properties(const SectionDescription& section, std::set<std::string>& written) {
    for (const SettingDescription& setting : section.settings) property(setting, written);
    for (const SectionDescription& inner : section.sections) property(section, inner, written);
    std::map<std::string, std::set<std::string>> variants;
    for (const SectionChoice& choice : section.choices) {
      for (const SectionForm& form : choice.forms) collect(form.keys, variants);
    }
    for (const auto& [name, texts] : variants) {
      if (texts.size() > 1 && written.insert(name).second) {
        json_.key(name).begin_object().end_object();
      }
    }
    for (const SectionChoice& choice : section.choices) {
      for (const SectionForm& form : choice.forms) properties(form.keys, written);
    }
  }

  void property(const SettingDescription& setting, std::set<std::string>& written) {
    if (!written.insert(setting.info.name).second) return;
    json_.key(setting.info.name).begin_object();
    value(setting);
    json_.end_object();
  }

  /// Sections of the same name are a table and a list of tables: a file has one or the other.
  void property(const SectionDescription& parent, const SectionDescription& inner,
                std::set<std::string>& written) {
    if (!written.insert(inner.info.name).second) return;
    std::vector<const SectionDescription*> same;
    for (const SectionDescription& other : parent.sections) {
      if (other.info.name == inner.info.name) same.push_back(&other);
    }
    json_.key(inner.info.name).begin_object();
    if (same.size() == 1) {
      section(inner);
    } else {
      json_.key("anyOf").begin_array();
      for (const SectionDescription* other : same) {
        json_.begin_object();
        section(*other);
        json_.end_object();
      }
      json_.end_array();
    }
    json_.end_object();
  }

  void section(const SectionDescription& inner) {
    if (!inner.is_list) return object(inner);
    json_.key("type").value("array");
    if (inner.info.is_required) json_.key("minItems").value(std::int64_t{1});
    json_.key("items").begin_object();
    object(inner);
    json_.end_object();
  }

  /// The schema texts that the keys of a form have, over all its own forms.
  void collect(const SectionDescription& keys, std::map<std::string, std::set<std::string>>& variants) const {
    for (const SettingDescription& setting : keys.settings) {
      SchemaWriter alone(context_);
      alone.json_.begin_object();
      alone.value(setting);
      variants[setting.info.name].insert(alone.json_.text());
    }
    for (const SectionDescription& inner : keys.sections) variants[inner.info.name].insert("section");
    for (const SectionChoice& choice : keys.choices) {
      for (const SectionForm& form : choice.forms) collect(form.keys, variants);
    }
  }

  /// "required", and what the forms demand.
  void rules(const SectionDescription& section) {
    if (!is_lenient_) {
      std::vector<std::string> required;
      for (const SettingDescription& setting : section.settings) {
        if (setting.info.is_required) required.push_back(setting.info.name);
      }
      for (const SectionDescription& inner : section.sections) {
        if (inner.info.is_required) required.push_back(inner.info.name);
      }
      if (!required.empty()) {
        json_.key("required").begin_array();
        for (const std::string& name : required) json_.value(name);
        json_.end_array();
      }
    }
    if (section.choices.empty() || is_lenient_) return;
    json_.key("allOf").begin_array();
    for (const SectionChoice& choice : section.choices) {
      if (choice.key.empty()) {
        json_.begin_object().key("oneOf").begin_array();
        for (const SectionForm& form : choice.forms) {
          json_.begin_object();
          this->form(choice, form);
          json_.end_object();
        }
        json_.end_array().end_object();
        continue;
      }
      for (const SectionForm& form : choice.forms) {
        json_.begin_object();
        condition(choice.key, form.name);
        json_.key("then").begin_object();
        this->form(choice, form);
        json_.end_object().end_object();
      }
    }
    json_.end_array();
  }

  /// The keys of a form, and none of another's.
  void form(const SectionChoice& choice, const SectionForm& form) {
    std::map<std::string, std::set<std::string>> own, all;
    collect(form.keys, own);
    for (const SectionForm& other : choice.forms) collect(other.keys, all);
    json_.key("properties").begin_object();
    std::set<std::string> written;
    for (const SettingDescription& setting : form.keys.settings) {
      if (all[setting.info.name].size() > 1) property(setting, written);
    }
    for (const SectionChoice& nested : form.keys.choices) {
      for (const SectionForm& inner : nested.forms) {
        for (const SettingDescription& setting : inner.keys.settings) {
          if (all[setting.info.name].size() > 1) property(setting, written);
        }
      }
    }
    for (const auto& [name, texts] : all) {
      if (!own.contains(name)) json_.key(name).value(false);
    }
    json_.end_object();
    rules(form.keys);
  }

  void value(const SettingDescription& setting) {
    const SettingInfo& info = setting.info;
    std::string doc = info.doc;
    if (!info.unit.empty() && info.unit != "1") doc += (doc.empty() ? "[" : " [") + info.unit + "]";
    if (!doc.empty()) json_.key("description").value(doc);
    if (!info.unit.empty()) json_.key("unit").value(info.unit);
    switch (info.type) {
      case Type::number:
      case Type::integer:
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
  JsonWriter json_;
  bool is_lenient_ = false;
};

}  // namespace

std::string json_schema(const SectionDescription& description, const SchemaContext& context) {
  return SchemaWriter(context).text(description) + "\n";
}

}  // namespace fw::settings
