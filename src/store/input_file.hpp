#pragma once

#include <filesystem>
#include <string>

#include "store/hdf5/attribute.hpp"
#include "store/hdf5/file_driver.hpp"

namespace fw::store {

/// A federwerk result opened for reading. The caller holds a LibraryLock.
class InputFile {
 public:
  /// Throws InputError that names the path: not there, no permission, no HDF5 file, truncated, changed since
  /// it was sealed, without the seal that it should have, not of this program, or of a later version of it.
  /// The library sees nothing of a file before its seal is checked, or before a process of its own has read
  /// it whole where it has none (trajectories of earlier versions).
  explicit InputFile(const std::filesystem::path& path);

  hid_t id() const { return file_; }
  const std::filesystem::path& path() const { return path_; }
  const Attributes& attributes() const { return attributes_; }
  std::string kind() const { return text_of(attributes_, "kind"); }
  bool sealed() const { return sealed_; }

 private:
  std::filesystem::path path_;
  std::shared_ptr<DriverFile> source_;
  Handle file_;
  Attributes attributes_;
  bool sealed_ = false;
};

}  // namespace fw::store
