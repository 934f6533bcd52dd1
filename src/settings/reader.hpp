#pragma once

#include <string>
#include <vector>

#include "settings/archive.hpp"

namespace fw::settings {

/// Reads what a declaration names from a TOML table into its variables.
///
/// Throws InputError of the form `file:line: [section] key[index]: found X, expected Y` for a value of the
/// wrong type, size or range, a number that is not finite, a missing key or section; `finish` does for the
/// first key in the file that no declaration names. The table itself is not changed: `resolved` is what was
/// read with all defaults.
class Reader final : public Archive {
 public:
  /// `is_quick`: the keys of [quick] take effect; they are read and checked in any case.
  explicit Reader(const CheckedTable& table, bool is_quick = false);

  /// Refuses keys that no declaration names.
  void finish();
  /// The values of the file as they stand there and the defaults of the others.
  TomlTree resolved() const { return levels_.front().resolved; }

 private:
  /// A section that is being read.
  struct Level {
    CheckedTable table;
    TomlTree resolved;
    std::vector<std::string> known{};
    /// The first required key that the file does not give, and what is expected.
    std::optional<std::pair<std::string, std::string>> missing{};
    std::string missing_list{};  ///< the first required [[name]]
  };

  void visit(const Setting& setting) override;
  void visit_section(const SectionInfo& info, const std::function<void()>& inside) override;
  void visit_section_of_list(const SectionInfo& info, std::size_t index,
                             const std::function<void()>& inside) override;
  void visit_free_section(const SectionInfo& info) override;
  void visit_one_of(const std::vector<Form>& forms) override;
  void visit_by(const Setting& setting, const std::vector<Form>& forms) override;
  void visit_quick(const std::function<void()>& declare_more) override;
  bool has_section(const SectionInfo& info, bool has_value) override;
  std::size_t section_count(const SectionInfo& info, std::size_t have) override;
  std::optional<bool> gives_list(const std::string& name) const override;

  void read(const SettingInfo& info, const std::function<void(const TomlValue&)>& assign,
            const std::optional<TomlValue>& default_value);
  void leave();

  bool is_quick_;
  std::vector<Level> levels_;
  std::vector<Setting> shrinkable_{};  ///< settings with a quick rule
  std::optional<CheckedTable::UnknownKey> unknown_{};
};

/// Reads a struct from a table that holds nothing else; the resolved table.
template <class S>
TomlTree read(const CheckedTable& table, S& s, bool is_quick = false) {
  Reader reader(table, is_quick);
  declare(reader, s);
  reader.finish();
  return reader.resolved();
}

}  // namespace fw::settings
