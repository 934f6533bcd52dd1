#pragma once

#include <filesystem>

#include "store/file/temporary_file.hpp"

namespace fw::store {

/// An HDF5 file in the making, published whole or not at all. The caller holds a LibraryLock.
class OutputFile {
 public:
  /// Throws SystemError.
  explicit OutputFile(const std::filesystem::path& target);
  ~OutputFile();

  hid_t id() const { return file_; }
  bool is_open() const { return file_.get() >= 0; }

  /// Runs `write`, a function of no arguments that writes to the file. If the disk refuses, or the library
  /// fails, the file is removed and SystemError names it.
  template <class Write>
  void guarded(const Write& write) {
    try {
      write();
    } catch (const LibraryError& error) {
      fail(error.what());
    }
    check();
  }

  /// Closes the file, appends the SHA-256 of its content behind it (which HDF5 readers do not see), so that
  /// damage is noticed before the library parses it, and gives it its final name. Costs a second pass over
  /// the file. Throws SystemError.
  void publish();
  /// Removes the file.
  void discard() noexcept;

 private:
  void check();
  [[noreturn]] void fail(const std::string& reason);

  TemporaryFile temporary_;
  Handle file_;
};

}  // namespace fw::store
