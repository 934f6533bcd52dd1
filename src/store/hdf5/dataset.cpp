#include "store/hdf5/dataset.hpp"

#include <algorithm>

#include "store/hdf5/attribute.hpp"

namespace fw::store {

namespace {

void write(hid_t parent, const std::string& name, const std::string& unit, const Shape& shape,
           hid_t file_type, hid_t memory_type, const void* values) {
  const std::string what = "dataset \"" + name + "\"";
  const Handle space(shape.empty() ? H5Screate(H5S_SCALAR)
                                   : H5Screate_simple(static_cast<int>(shape.size()), shape.data(), nullptr),
                     H5Sclose, what);
  const Handle creation(H5Pcreate(H5P_DATASET_CREATE), H5Pclose, what);
  require(H5Pset_obj_track_times(creation, false), what);  // the same result gives the same bytes
  require(H5Pset_attr_creation_order(creation, H5P_CRT_ORDER_TRACKED | H5P_CRT_ORDER_INDEXED), what);
  const Handle dataset(H5Dcreate2(parent, name.c_str(), file_type, space, H5P_DEFAULT, creation, H5P_DEFAULT),
                       H5Dclose, what);
  write_attribute(dataset, "unit", unit);
  if (H5Sget_simple_extent_npoints(space) > 0) {
    require(H5Dwrite(dataset, memory_type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values), what);
  }
}

Handle open_dataset(hid_t parent, const std::string& name) {
  return Handle(H5Dopen2(parent, name.c_str(), H5P_DEFAULT), H5Dclose, "dataset \"" + name + "\"");
}

Shape shape_of(hid_t space) {
  const int rank = H5Sget_simple_extent_ndims(space);
  if (rank < 0) throw LibraryError("shape: " + take_error_stack());
  Shape shape(static_cast<std::size_t>(rank));
  if (rank > 0) H5Sget_simple_extent_dims(space, shape.data(), nullptr);
  return shape;
}

/// Number of entries, after checking that the file can hold them: nothing federwerk writes is compressed.
std::size_t checked_count(hid_t dataset, hid_t type, const Shape& shape, const std::string& name) {
  hsize_t count = 1, size = 0;
  const Handle file(H5Iget_file_id(dataset), H5Fclose, "file");
  require(H5Fget_filesize(file, &size), "size of the file");
  for (const hsize_t extent : shape) {
    if (extent > 0 && count > size / extent) {
      throw LibraryError("dataset \"" + name + "\": larger than the file that holds it");
    }
    count *= extent;
  }
  if (count > size / std::max<std::size_t>(H5Tget_size(type), 1)) {
    throw LibraryError("dataset \"" + name + "\": larger than the file that holds it");
  }
  return count;
}

std::vector<std::string> read_text(hid_t dataset, hid_t type, hid_t space, std::size_t count) {
  std::vector<std::string> values(count);
  if (count == 0) return values;
  if (H5Tis_variable_str(type) > 0) {
    std::vector<char*> texts(count, nullptr);
    require(H5Dread(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, texts.data()), "text");
    for (std::size_t i = 0; i < count; ++i) values[i] = texts[i] != nullptr ? texts[i] : "";
    H5Dvlen_reclaim(type, space, H5P_DEFAULT, texts.data());
  } else {
    const std::size_t size = H5Tget_size(type);
    std::string texts(count * size, '\0');
    require(H5Dread(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, texts.data()), "text");
    for (std::size_t i = 0; i < count; ++i) {
      values[i] = texts.substr(i * size, size);
      values[i].resize(std::min(values[i].size(), values[i].find('\0')));
    }
  }
  return values;
}

}  // namespace

void write_dataset(hid_t parent, const std::string& name, const std::string& unit, const Shape& shape,
                   std::span<const double> values) {
  write(parent, name, unit, shape, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, values.data());
}

void write_dataset(hid_t parent, const std::string& name, const std::string& unit, const Shape& shape,
                   std::span<const std::int64_t> values) {
  write(parent, name, unit, shape, H5T_STD_I64LE, H5T_NATIVE_INT64, values.data());
}

void write_dataset(hid_t parent, const std::string& name, const std::string& unit, const Shape& shape,
                   std::span<const std::int32_t> values) {
  write(parent, name, unit, shape, H5T_STD_I32LE, H5T_NATIVE_INT32, values.data());
}

void write_dataset(hid_t parent, const std::string& name, const std::string& unit, const Shape& shape,
                   std::span<const std::string> values) {
  std::vector<std::string> texts;
  std::vector<const char*> characters;
  for (const std::string& value : values) texts.push_back(without_nul(value));
  for (const std::string& text : texts) characters.push_back(text.c_str());
  const Handle type = text_type();
  write(parent, name, unit, shape, type, type, characters.data());
}

record::Column read_dataset(hid_t parent, const std::string& name) {
  const Handle dataset = open_dataset(parent, name);
  const Handle type(H5Dget_type(dataset), H5Tclose, "type of \"" + name + "\"");
  const Handle space(H5Dget_space(dataset), H5Sclose, "shape of \"" + name + "\"");
  const Shape shape = shape_of(space);
  const std::size_t count = checked_count(dataset, type, shape, name);
  record::Column column;
  column.name = name;
  if (shape.size() > 1) column.shape.assign(shape.begin(), shape.end());
  switch (H5Tget_class(type)) {
    case H5T_FLOAT: {
      std::vector<double> values(count);
      require(H5Dread(dataset, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()), name);
      column.values = std::move(values);
      break;
    }
    case H5T_INTEGER: {
      std::vector<std::int64_t> values(count);
      require(H5Dread(dataset, H5T_NATIVE_INT64, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()), name);
      column.values = std::move(values);
      break;
    }
    case H5T_STRING:
      column.values = read_text(dataset, type, space, count);
      break;
    default:
      throw LibraryError("dataset \"" + name + "\": neither numbers nor text");
  }
  for (auto& [key, value] : read_attributes(dataset)) {
    if (!std::holds_alternative<std::string>(value)) continue;
    if (key == "unit") {
      column.unit = std::get<std::string>(value);
    } else {
      column.attributes.emplace_back(key, std::get<std::string>(value));
    }
  }
  return column;
}

Shape dataset_shape(hid_t parent, const std::string& name) {
  const Handle dataset = open_dataset(parent, name);
  const Handle space(H5Dget_space(dataset), H5Sclose, "shape of \"" + name + "\"");
  return shape_of(space);
}

std::vector<double> read_row(hid_t parent, const std::string& name, hsize_t row) {
  const Handle dataset = open_dataset(parent, name);
  const Handle space(H5Dget_space(dataset), H5Sclose, "shape of \"" + name + "\"");
  Shape count = shape_of(space);
  if (count.empty() || row >= count[0]) throw LibraryError("dataset \"" + name + "\": no such row");
  count[0] = 1;
  Shape start(count.size(), 0);
  start[0] = row;
  require(H5Sselect_hyperslab(space, H5S_SELECT_SET, start.data(), nullptr, count.data(), nullptr), name);
  const Handle type(H5Dget_type(dataset), H5Tclose, "type of \"" + name + "\"");
  std::vector<double> values(checked_count(dataset, type, count, name));
  const Handle memory(H5Screate_simple(static_cast<int>(count.size()), count.data(), nullptr), H5Sclose,
                      name);
  require(H5Dread(dataset, H5T_NATIVE_DOUBLE, memory, space, H5P_DEFAULT, values.data()), name);
  return values;
}

}  // namespace fw::store
