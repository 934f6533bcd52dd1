#pragma once

#include <string>
#include <vector>

#include "settings/archive.hpp"

namespace fw::settings {

/// A setting as a declaration describes it.
struct SettingDescription {
  SettingInfo info;
  std::optional<TomlValue> default_value;
};

struct SectionChoice;

/// A section as a declaration describes it, or the keys of one of its forms.
struct SectionDescription {
  SectionInfo info;
  bool is_list = false;  ///< [[name]]
  bool is_free = false;  ///< holds a whole study of another kind
  std::vector<SettingDescription> settings{};
  std::vector<SectionDescription> sections{};
  std::vector<SectionChoice> choices;
};

/// Keys that go together: named after one of them, or after the value of the key that chooses.
struct SectionForm {
  std::string name;
  SectionDescription keys;
};

/// Forms of which a section has exactly one.
struct SectionChoice {
  std::string key;  ///< that chooses; empty: the presence of the key that a form is named after
  std::vector<SectionForm> forms{};
};

/// Walks over a declaration and notes all it says.
class Describer final : public Archive {
 public:
  explicit Describer(SectionInfo root);
  const SectionDescription& description() const { return root_; }
  bool is_description() const override { return true; }

 private:
  void visit(const Setting& setting) override;
  void visit_section(const SectionInfo& info, const std::function<void()>& inside) override;
  void visit_section_of_list(const SectionInfo& info, std::size_t index,
                             const std::function<void()>& inside) override;
  void visit_one_of(const std::vector<Form>& forms) override;
  void visit_by(const Setting& setting, const std::vector<Form>& forms) override;
  void visit_quick(const std::function<void()>& declare_more) override;
  void visit_free_section(const SectionInfo& info) override;
  bool has_section(const SectionInfo&, bool) override { return true; }
  std::size_t section_count(const SectionInfo&, std::size_t) override { return 1; }

  SectionDescription inside_of(SectionDescription section, const std::function<void()>& inside);
  void add_choice(std::string key, const std::vector<Form>& forms);

  SectionDescription root_;
  std::vector<SectionDescription*> places_;  ///< the sections and forms that the walk is inside of
  std::vector<Setting> shrinkable_{};
};

/// The description of a struct's declaration, with the defaults of a fresh one.
template <class S>
SectionDescription describe(SectionInfo root) {
  S s{};
  Describer describer(std::move(root));
  declare(describer, s);
  return describer.description();
}

}  // namespace fw::settings
