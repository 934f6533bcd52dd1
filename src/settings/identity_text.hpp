#pragma once

#include <string>

#include "settings/archive.hpp"

namespace fw::settings {

/// Puts the values of a declaration's variables into a table: all that a file would have to say for the same
/// settings. What only selects cases stays out.
class ValueWriter final : public Archive {
 public:
  std::string text() const { return levels_.front().text(); }

 private:
  void visit(const Setting& setting) override;
  void visit_section(const SectionInfo& info, const std::function<void()>& inside) override;
  void visit_section_of_list(const SectionInfo& info, std::size_t index,
                             const std::function<void()>& inside) override;
  void visit_free_section(const SectionInfo& info) override { (void)info; }
  void visit_one_of(const std::vector<Form>& forms) override;
  void visit_by(const Setting& setting, const std::vector<Form>& forms) override;
  void visit_quick(const std::function<void()>&) override {}  // its keys have taken effect, or have none
  bool has_section(const SectionInfo&, bool has_value) override { return has_value; }
  std::size_t section_count(const SectionInfo&, std::size_t have) override { return have; }

  std::vector<TomlTree> levels_{TomlTree()};
};

/// The values in force as TOML text: what makes two cases with these settings the same case. No setting can
/// be forgotten here, since all are declared.
template <class S>
std::string identity_text(S s) {
  ValueWriter writer;
  declare(writer, s);
  return writer.text();
}

}  // namespace fw::settings
