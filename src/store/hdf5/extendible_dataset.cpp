#include "store/hdf5/extendible_dataset.hpp"

#include <algorithm>

#include "store/hdf5/attribute.hpp"

namespace fw::store {

namespace {

constexpr hsize_t chunk_values = 65536;  // 512 KiB

/// The largest of `total` divided into equal parts of at most `limit`, which leaves the last part least
/// empty.
hsize_t balanced_part(hsize_t total, hsize_t limit) {
  const hsize_t parts = (total + limit - 1) / limit;
  return (total + parts - 1) / parts;
}

}  // namespace

ExtendibleDataset::ExtendibleDataset(hid_t parent, const std::string& name, const std::string& unit,
                                     Shape entry_shape, hsize_t expected_entries)
    : name_("dataset \"" + name + "\""), entry_shape_(std::move(entry_shape)) {
  for (const hsize_t extent : entry_shape_) entry_size_ *= static_cast<std::size_t>(extent);
  const hsize_t entry_values = std::max<hsize_t>(entry_size_, 1);
  entries_per_chunk_ = balanced_part(std::clamp<hsize_t>(expected_entries, 1, hsize_t{1} << 40),
                                     std::max<hsize_t>(chunk_values / entry_values, 1));

  Shape shape{0}, limit{H5S_UNLIMITED}, chunk{entries_per_chunk_};
  for (const hsize_t extent : entry_shape_) {
    shape.push_back(extent);
    limit.push_back(extent);
    chunk.push_back(std::max<hsize_t>(extent, 1));
  }
  if (entry_values > chunk_values && chunk.size() > 1) {  // split along the first axis of an entry
    chunk[1] = balanced_part(chunk[1], std::max<hsize_t>(chunk_values * chunk[1] / entry_values, 1));
  }

  const Handle space(H5Screate_simple(static_cast<int>(shape.size()), shape.data(), limit.data()), H5Sclose,
                     name_);
  const Handle creation(H5Pcreate(H5P_DATASET_CREATE), H5Pclose, name_);
  require(H5Pset_chunk(creation, static_cast<int>(chunk.size()), chunk.data()), name_);
  const double zero = 0.0;  // the unused end of a last chunk
  require(H5Pset_fill_value(creation, H5T_NATIVE_DOUBLE, &zero), name_);
  require(H5Pset_obj_track_times(creation, false), name_);
  dataset_ =
      Handle(H5Dcreate2(parent, name.c_str(), H5T_IEEE_F64LE, space, H5P_DEFAULT, creation, H5P_DEFAULT),
             H5Dclose, name_);
  write_attribute(dataset_, "unit", unit);
}

void ExtendibleDataset::append(std::span<const double> entry) {
  if (entry.size() != entry_size_) throw LibraryError(name_ + ": an entry of the wrong size");
  if (entries_per_chunk_ == 1) return write(entry.data(), 1);
  collected_.insert(collected_.end(), entry.begin(), entry.end());
  if (collected_.size() >= entries_per_chunk_ * entry_size_) flush();
}

void ExtendibleDataset::flush() {
  if (collected_.empty()) return;
  write(collected_.data(), collected_.size() / entry_size_);
  collected_.clear();
}

void ExtendibleDataset::write(const double* values, hsize_t entries) {
  Shape start{written_}, count{entries}, extent{written_ + entries};
  for (const hsize_t length : entry_shape_) {
    start.push_back(0);
    count.push_back(length);
    extent.push_back(length);
  }
  require(H5Dset_extent(dataset_, extent.data()), name_);
  const Handle space(H5Dget_space(dataset_), H5Sclose, name_);
  require(H5Sselect_hyperslab(space, H5S_SELECT_SET, start.data(), nullptr, count.data(), nullptr), name_);
  const Handle memory(H5Screate_simple(static_cast<int>(count.size()), count.data(), nullptr), H5Sclose,
                      name_);
  require(H5Dwrite(dataset_, H5T_NATIVE_DOUBLE, memory, space, H5P_DEFAULT, values), name_);
  written_ += entries;
}

}  // namespace fw::store
