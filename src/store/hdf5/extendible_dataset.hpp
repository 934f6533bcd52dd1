#pragma once

#include <span>
#include <string>
#include <vector>

#include "store/hdf5/dataset.hpp"

namespace fw::store {

/// A dataset of doubles that grows by one entry (frame) at a time. Small entries are collected to chunks of
/// about half a megabyte; an entry larger than that is written through in several chunks, so that the memory
/// needed is bounded by one chunk.
class ExtendibleDataset {
 public:
  ExtendibleDataset() = default;

  /// A dataset of shape (0, entry_shape…) with an attribute `unit`. `expected_entries` only sets the size of
  /// the chunks. Throws LibraryError.
  ExtendibleDataset(hid_t parent, const std::string& name, const std::string& unit, Shape entry_shape,
                    hsize_t expected_entries);

  /// Appends one entry. Throws LibraryError.
  void append(std::span<const double> entry);

  /// Writes what is still collected. Throws LibraryError.
  void flush();

 private:
  void write(const double* values, hsize_t entries);

  std::string name_;
  Handle dataset_;
  Shape entry_shape_;
  std::size_t entry_size_ = 1;
  hsize_t entries_per_chunk_ = 1;
  hsize_t written_ = 0;
  std::vector<double> collected_;
};

}  // namespace fw::store
