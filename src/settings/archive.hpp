#pragma once

#include <cstddef>
#include <functional>
#include <initializer_list>
#include <optional>
#include <string>
#include <vector>

#include "settings/setting.hpp"

namespace fw::settings {

/// What a declaration says of a section [name] or of the sections [[name]].
struct SectionInfo {
  std::string name;
  std::string doc{};         ///< a sentence, in Markdown
  bool is_required = false;  ///< the section, or at least one of the sections, has to be there
};

/// One of several forms of a section, and what it declares.
struct Form {
  std::string name;
  std::function<void()> declare;
};

/// Whoever walks over a declaration.
///
/// A settings struct S is declared once, by a function that names every setting with all that is known of it:
/// ```
/// void declare(Archive& a, S& s) {
///   a(setting("ratio", s.ratio).unit("1").above(1.0).doc("of successive steps"));
///   a.section({"limits", "…"}, s.limits);
/// }
/// ```
/// From it come the reader of a file with its checks and messages (`Reader`), the resolved text, the text
/// that identifies a case (`identity_text`), the table in the documentation and the JSON schema (`describe`).
/// The model is Drake's `Serialize(Archive*)`.
class Archive {
 public:
  virtual ~Archive() = default;

  void operator()(const Setting& setting) { visit(setting); }

  /// [name]; where a file has none, all its settings have their defaults.
  template <class S>
  void section(const SectionInfo& info, S& s) {
    visit_section(info, [&] { declare(*this, s); });
  }

  /// [name] that a file may leave out, which is something else than a section of defaults. `fresh`: what its
  /// settings are before they are read.
  template <class S>
  void optional_section(const SectionInfo& info, std::optional<S>& s, const S& fresh = {}) {
    if (!has_section(info, s.has_value())) return;
    if (!s) s = fresh;
    visit_section(info, [&] { declare(*this, *s); });
  }

  /// [[name]], any number of them.
  template <class S>
  void sections(const SectionInfo& info, std::vector<S>& list, const S& fresh = {}) {
    list.resize(section_count(info, list.size()), fresh);
    for (std::size_t k = 0; k < list.size(); ++k) {
      visit_section_of_list(info, k, [&] { declare(*this, list[k]); });
    }
  }

  /// [name] or any number of [[name]].
  template <class S, class Entry>
  void section_or_sections(const SectionInfo& one, std::optional<S>& s, const S& fresh,
                           const SectionInfo& many, std::vector<Entry>& list, const Entry& fresh_entry) {
    const std::optional<bool> is_list = gives_list(one.name);
    if (!is_list.value_or(false)) optional_section(one, s, fresh);
    if (is_list.value_or(true)) sections(many, list, fresh_entry);
  }

  /// [name] that holds a whole study of another kind, which its own declaration checks.
  void free_section(const SectionInfo& info) { visit_free_section(info); }

  /// Forms that differ in their keys: a section has exactly one of the keys that the forms are named after.
  void one_of(const std::vector<Form>& forms) { visit_one_of(forms); }

  /// A setting whose value says what else there is.
  void by(const Setting& setting, const std::vector<Form>& forms) { visit_by(setting, forms); }

  /// The section [quick], which holds the keys of all settings declared before it that have a quick rule, and
  /// those that `declare_more` names.
  void quick_section(const std::function<void()>& declare_more = {}) { visit_quick(declare_more); }

  /// Whether a declaration that depends on what a file gives is to be walked all the same: the archive
  /// describes what there can be.
  virtual bool is_description() const { return false; }

 protected:
  virtual void visit(const Setting& setting) = 0;
  virtual void visit_section(const SectionInfo& info, const std::function<void()>& inside) = 0;
  virtual void visit_section_of_list(const SectionInfo& info, std::size_t index,
                                     const std::function<void()>& inside) = 0;
  virtual void visit_free_section(const SectionInfo& info) = 0;
  virtual void visit_one_of(const std::vector<Form>& forms) = 0;
  virtual void visit_by(const Setting& setting, const std::vector<Form>& forms) = 0;
  virtual void visit_quick(const std::function<void()>& declare_more) = 0;
  virtual bool has_section(const SectionInfo& info, bool has_value) = 0;
  virtual std::size_t section_count(const SectionInfo& info, std::size_t have) = 0;
  /// Whether a file gives [[name]] and not [name]; nothing where there is no file.
  virtual std::optional<bool> gives_list(const std::string& name) const {
    (void)name;
    return std::nullopt;
  }
};

}  // namespace fw::settings
