#include "settings/identity_text.hpp"

namespace fw::settings {

void ValueWriter::visit(const Setting& setting) {
  if (setting.info().selects_cases) return;
  if (const std::optional<TomlValue> value = setting.value()) levels_.back().set(setting.info().name, *value);
}

void ValueWriter::visit_section(const SectionInfo& info, const std::function<void()>& inside) {
  levels_.push_back(levels_.back().table(info.name));
  inside();
  levels_.pop_back();
}

void ValueWriter::visit_section_of_list(const SectionInfo& info, std::size_t index,
                                        const std::function<void()>& inside) {
  levels_.push_back(levels_.back().table(info.name, index));
  inside();
  levels_.pop_back();
}

void ValueWriter::visit_one_of(const std::vector<Form>& forms) {
  for (const Form& form : forms) form.declare();  // the variables of the forms that were not chosen are empty
}

void ValueWriter::visit_by(const Setting& setting, const std::vector<Form>& forms) {
  visit(setting);
  const std::optional<TomlValue> value = setting.value();
  for (const Form& form : forms) {
    if (value && form.name == std::get<std::string>(*value)) form.declare();
  }
}

}  // namespace fw::settings
