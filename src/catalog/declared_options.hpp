#pragma once

#include <string>
#include <utility>
#include <vector>

#include "catalog/methods.hpp"
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

/// The options that `declare(Archive&, Options&)` names, with the defaults of `options`.
template <class Options>
std::vector<settings::SettingDescription> declared_options(Options options = {}) {
  settings::Describer describer({.name = "options"});
  declare(describer, options);
  return describer.description().settings;
}

/// The options that a call gives, the others as they are in `options`.
template <class Options>
Options read_options(const MethodOptions& given, Options options = {}) {
  OptionReader reader(given);
  declare(reader, options);
  return options;
}

/// A method whose options are declared, with these defaults: both its code and its theory are made from
/// them.
template <class Options, class Make, class Theory>
MethodEntry declared_method(std::string name, const Options& defaults, Make make, Theory theory) {
  return {std::move(name), declared_options(defaults),
          [defaults, theory](const MethodOptions& given) { return theory(read_options(given, defaults)); },
          [defaults, make](const MethodOptions& given) { return make(read_options(given, defaults)); }};
}

/// The same where theory says nothing of the method.
template <class Options, class Make>
MethodEntry declared_method(std::string name, const Options& defaults, Make make) {
  return declared_method(std::move(name), defaults, make, [](const Options&) { return analysis::Theory{}; });
}

/// The default as a call in brackets has it, or what it is worked out from; nothing where there is none.
std::string default_text(const settings::SettingDescription& option);

}  // namespace fw::catalog
