#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "analysis/reference/reference_solution.hpp"

namespace fw::analysis {

/// Keeps certified references on disk, one small text file each, so that a study pays for them once.
///
/// The file's name is the SHA-256 of everything the digits depend on: the identity text, t₀ and y₀, the
/// times, the options and the version of the algorithm. A file holds 36 significant digits per number, which
/// read back exactly, and a checksum; what does not check out is computed again. Files appear under their
/// name complete or not at all. A directory that cannot be written is no error: nothing is kept then.
class ReferenceCache {
 public:
  explicit ReferenceCache(std::filesystem::path directory = default_directory());

  /// $FEDERWERK_CACHE, else $XDG_CACHE_HOME/federwerk, else $HOME/.cache/federwerk; empty (no cache) where
  /// none of them is set.
  static std::filesystem::path default_directory();

  /// `certified_reference(ivp, times, options)` from the cache, or computed and then kept if it succeeded.
  /// `identity` has to tell the system apart from every other: a problem's name and parameters, or the
  /// resolved text of a scene.
  ReferenceSolution certified(std::string_view identity, const Ivp& ivp, std::span<const double> times,
                              const ReferenceOptions& options = {}) const;

  /// `reference(problem, times, options)` in the same way; closed forms are evaluated and not kept.
  ReferenceSolution of(const Problem& problem, std::span<const double> times,
                       const ReferenceOptions& options = {}) const;

  /// Where `certified` keeps this reference.
  std::filesystem::path file(std::string_view identity, const Ivp& ivp, std::span<const double> times,
                             const ReferenceOptions& options = {}) const;

 private:
  std::filesystem::path directory_;
};

}  // namespace fw::analysis
