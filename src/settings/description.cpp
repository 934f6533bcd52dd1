#include "settings/description.hpp"

namespace fw::settings {

namespace {

SectionDescription section_of(SectionInfo info, bool is_list = false, bool is_free = false) {
  SectionDescription section;
  section.info = std::move(info);
  section.is_list = is_list;
  section.is_free = is_free;
  return section;
}

}  // namespace

Describer::Describer(SectionInfo root) : root_(section_of(std::move(root))), places_{&root_} {}

void Describer::visit(const Setting& setting) {
  const SettingInfo& info = setting.info();
  places_.back()->settings.push_back({info, info.is_required ? std::nullopt : setting.value()});
  if (info.quick.kind != QuickRule::Kind::none) shrinkable_.push_back(setting);
}

SectionDescription Describer::inside_of(SectionDescription section, const std::function<void()>& inside) {
  places_.push_back(&section);
  inside();
  places_.pop_back();
  return section;
}

void Describer::visit_section(const SectionInfo& info, const std::function<void()>& inside) {
  SectionDescription section = inside_of(section_of(info), inside);
  places_.back()->sections.push_back(std::move(section));
}

void Describer::visit_section_of_list(const SectionInfo& info, std::size_t,
                                      const std::function<void()>& inside) {
  SectionDescription section = inside_of(section_of(info, true), inside);
  places_.back()->sections.push_back(std::move(section));
}

void Describer::visit_free_section(const SectionInfo& info) {
  places_.back()->sections.push_back(section_of(info, false, true));
}

void Describer::add_choice(std::string key, const std::vector<Form>& forms) {
  SectionChoice choice{std::move(key)};
  std::string names;
  for (const Form& form : forms) names += (names.empty() ? "one of `" : ", `") + form.name + "`";
  for (const Form& form : forms) {
    choice.forms.push_back({form.name, inside_of({}, form.declare)});
    if (!choice.key.empty()) continue;
    for (SettingDescription& setting : choice.forms.back().keys.settings) {
      if (setting.info.name != form.name) continue;
      setting.info.is_required = true;
      setting.info.default_text = names;
    }
  }
  places_.back()->choices.push_back(std::move(choice));
}

void Describer::visit_one_of(const std::vector<Form>& forms) {
  add_choice("", forms);
}

void Describer::visit_by(const Setting& setting, const std::vector<Form>& forms) {
  visit(setting);
  add_choice(setting.info().name, forms);
}

void Describer::visit_quick(const std::function<void()>& declare_more) {
  visit_section({"quick", "What `--quick` puts in place of the values above."}, [&] {
    for (const Setting& setting : shrinkable_) places_.back()->settings.push_back({setting.quick_info(), {}});
    shrinkable_.clear();
    if (declare_more) declare_more();
  });
}

}  // namespace fw::settings
