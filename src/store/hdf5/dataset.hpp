#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "record/column.hpp"
#include "store/hdf5/hdf5_library.hpp"

namespace fw::store {

using Shape = std::vector<hsize_t>;

/// Writes a whole dataset with its attribute `unit`; an empty shape is a scalar. Row-major, little-endian.
/// Throws LibraryError.
void write_dataset(hid_t parent, const std::string& name, const std::string& unit, const Shape& shape,
                   std::span<const double> values);
void write_dataset(hid_t parent, const std::string& name, const std::string& unit, const Shape& shape,
                   std::span<const std::int64_t> values);
void write_dataset(hid_t parent, const std::string& name, const std::string& unit, const Shape& shape,
                   std::span<const std::int32_t> values);
void write_dataset(hid_t parent, const std::string& name, const std::string& unit, const Shape& shape,
                   std::span<const std::string> values);

/// A dataset with its unit and further text attributes; `shape` stays empty for one dimension. Floating-point
/// numbers of any width become double, integers int64. Throws LibraryError, also for what is no dataset of
/// numbers or text and for one that claims to be larger than its file.
record::Column read_dataset(hid_t parent, const std::string& name);

/// The shape of a dataset. Throws LibraryError.
Shape dataset_shape(hid_t parent, const std::string& name);

/// One row (first index) of a dataset of doubles. Throws LibraryError.
std::vector<double> read_row(hid_t parent, const std::string& name, hsize_t row);

}  // namespace fw::store
