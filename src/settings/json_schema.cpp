#include "settings/json_schema.hpp"

#include <set>

#include "settings/value_schema.hpp"
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
    write_value_schema(setting, context_, json_);
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
      write_value_schema(setting, context_, alone.json_);
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

  const SchemaContext& context_;
  JsonWriter json_;
  bool is_lenient_ = false;
};

}  // namespace

std::string json_schema(const SectionDescription& description, const SchemaContext& context) {
  return SchemaWriter(context).text(description) + "\n";
}

}  // namespace fw::settings
