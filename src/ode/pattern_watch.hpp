#pragma once

#include <cstdint>

namespace fw {

/// Tells the keeper of a matrix when the pattern that it was made with is out of date: systems change their
/// `pattern_revision` then.
class PatternWatch {
 public:
  explicit PatternWatch(std::uint64_t revision) : revision_(revision) {}

  /// Whether `revision` differs from the one seen last; it is the one seen last from now on.
  bool has_changed(std::uint64_t revision) {
    if (revision == revision_) return false;
    revision_ = revision;
    return true;
  }
  std::uint64_t revision() const { return revision_; }

 private:
  std::uint64_t revision_;
};

}  // namespace fw
