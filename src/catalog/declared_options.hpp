#pragma once

#include <string>
#include <vector>

#include "catalog/method_call.hpp"
#include "settings/archive.hpp"

namespace fw::catalog {

/// Reads options in brackets, which are texts, into the variables that a declaration names. Throws InputError
/// "option NAME: found …, expected …" for a text that is not of the setting's type or range. Whether an
/// option is known is checked before.
class OptionReader final : public settings::Archive {
 public:
  explicit OptionReader(const MethodOptions& given) : given_(given) {}

 private:
  void visit(const settings::Setting& setting) override;
  void visit_section(const settings::SectionInfo&, const std::function<void()>&) override {}
  void visit_section_of_list(const settings::SectionInfo&, std::size_t,
                             const std::function<void()>&) override {}
  void visit_free_section(const settings::SectionInfo&) override {}
  void visit_one_of(const std::vector<settings::Form>&) override {}
  void visit_by(const settings::Setting& setting, const std::vector<settings::Form>&) override {
    visit(setting);
  }
  void visit_quick(const std::function<void()>&) override {}
  bool has_section(const settings::SectionInfo&, bool) override { return false; }
  std::size_t section_count(const settings::SectionInfo&, std::size_t) override { return 0; }

  const MethodOptions& given_;
};

/// What a description of settings says as a list of options.
std::vector<OptionInfo> option_list(const settings::SectionDescription& description);

/// The options that `declare(Archive&, Options&)` names, with the defaults of `options`.
template <class Options>
std::vector<OptionInfo> declared_options(Options options = {}) {
  settings::Describer describer({.name = "options"});
  declare(describer, options);
  return option_list(describer.description());
}

/// The options that a call gives, the others as they are in `options`.
template <class Options>
Options read_options(const MethodOptions& given, Options options = {}) {
  OptionReader reader(given);
  declare(reader, options);
  return options;
}

/// The same with the defaults of a fresh struct, as a function to hand on.
template <class Options>
Options read_declared(const MethodOptions& given) {
  return read_options<Options>(given, Options{});
}

}  // namespace fw::catalog
