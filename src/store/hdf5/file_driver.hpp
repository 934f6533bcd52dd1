#pragma once

#include <cstdint>
#include <memory>

#include "store/hdf5/hdf5_library.hpp"

namespace fw::store {

/// An open file that HDF5 reads and writes through, and what became of its writes.
///
/// HDF5's own driver reports a failed write to the library, which then keeps unwritten metadata, cannot close
/// the file and tries again when the process ends, where it crashes or hangs. This one remembers the first
/// error here, ignores all further writes and lets the library close in peace; the owner asks for
/// `error_number` and throws the file away.
class DriverFile {
 public:
  /// Takes the file descriptor; closed in the destructor.
  explicit DriverFile(int descriptor);
  ~DriverFile();
  DriverFile(const DriverFile&) = delete;
  DriverFile& operator=(const DriverFile&) = delete;

  int descriptor() const { return descriptor_; }
  /// errno of the first write that failed, 0 if none did.
  int error_number() const { return error_number_; }
  /// Size of the file as HDF5 believes it to be [bytes].
  std::uint64_t size() const { return size_; }

  bool read(std::uint64_t offset, void* buffer, std::size_t bytes) const;
  void write(std::uint64_t offset, const void* buffer, std::size_t bytes);
  void truncate(std::uint64_t bytes);
  /// Makes all written data durable.
  void synchronise();

 private:
  int descriptor_;
  int error_number_ = 0;
  std::uint64_t size_ = 0;
};

/// File access properties that make H5Fcreate and H5Fopen use `file` (the name they are given is only a
/// label). Files are in the format of HDF5 1.8, whose metadata carry checksums and which every later version
/// reads.
Handle access_through(const std::shared_ptr<DriverFile>& file);

}  // namespace fw::store
