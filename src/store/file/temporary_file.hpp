#pragma once

#include <filesystem>
#include <memory>

#include "store/hdf5/file_driver.hpp"

namespace fw::store {

/// A file that appears under its final name only when it is whole: written as ".<name>.<pid>.tmp" in the same
/// directory, made durable, then renamed. Removed by the destructor if it was not published. What a killed
/// process left behind is removed by the next one that writes the same target.
class TemporaryFile {
 public:
  /// Throws SystemError ("disk full: …" where that is the reason).
  explicit TemporaryFile(std::filesystem::path target);
  ~TemporaryFile();
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;

  /// Whether a temporary file for `target` can be made; the reason as an errno if not.
  static bool can_be_made(const std::filesystem::path& target, int& error_number);

  const std::filesystem::path& target() const { return target_; }
  const std::filesystem::path& path() const { return path_; }
  const std::shared_ptr<DriverFile>& file() const { return file_; }

  /// Throws SystemError if a write has failed, and removes the file then.
  void check();
  /// fsync, rename to the target, fsync of the directory. Throws SystemError.
  void publish();
  /// Closes and removes the file; nothing to do after `publish`.
  void discard() noexcept;

 private:
  std::filesystem::path target_;
  std::filesystem::path path_;
  std::shared_ptr<DriverFile> file_;
};

/// "disk full: cannot write "<path>": <reason of errno>", or without the first part for other errors.
std::string write_failure(const std::filesystem::path& path, int error_number);

}  // namespace fw::store
