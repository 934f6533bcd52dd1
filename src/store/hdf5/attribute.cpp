#include "store/hdf5/attribute.hpp"

#include "text/utf8.hpp"

namespace fw::store {

namespace {

/// The value of a scalar attribute; nothing if it is of another shape or type.
bool read_value(hid_t attribute, AttributeValue& value) {
  const Handle type(H5Aget_type(attribute), H5Tclose, "type of an attribute");
  const Handle space(H5Aget_space(attribute), H5Sclose, "shape of an attribute");
  if (H5Sget_simple_extent_npoints(space) != 1) return false;
  switch (H5Tget_class(type)) {
    case H5T_INTEGER: {
      std::int64_t number = 0;
      require(H5Aread(attribute, H5T_NATIVE_INT64, &number), "attribute");
      value = number;
      return true;
    }
    case H5T_FLOAT: {
      double number = 0.0;
      require(H5Aread(attribute, H5T_NATIVE_DOUBLE, &number), "attribute");
      value = number;
      return true;
    }
    case H5T_STRING: {
      if (H5Tis_variable_str(type) > 0) {
        char* text = nullptr;
        require(H5Aread(attribute, type, &text), "attribute");
        value = std::string(text != nullptr ? text : "");
        H5Dvlen_reclaim(type, space, H5P_DEFAULT, &text);
      } else {
        std::string text(H5Tget_size(type), '\0');
        require(H5Aread(attribute, type, text.data()), "attribute");
        value = text.substr(0, text.find('\0'));
      }
      return true;
    }
    default:
      return false;
  }
}

}  // namespace

Handle text_type() {
  Handle type(H5Tcopy(H5T_C_S1), H5Tclose, "type of text");
  require(H5Tset_size(type, H5T_VARIABLE), "type of text");
  require(H5Tset_cset(type, H5T_CSET_UTF8), "type of text");
  return type;
}

std::string without_nul(std::string text) {
  for (std::size_t at; (at = text.find('\0')) != std::string::npos;) text.replace(at, 1, "\xEF\xBF\xBD");
  return text;
}

void write_attribute(hid_t object, const std::string& name, const AttributeValue& value) {
  const std::string what = "attribute \"" + name + "\"";
  const Handle space(H5Screate(H5S_SCALAR), H5Sclose, what);
  const auto make = [&](hid_t type) {
    return Handle(H5Acreate2(object, name.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose, what);
  };
  if (const auto* integer = std::get_if<std::int64_t>(&value)) {
    require(H5Awrite(make(H5T_STD_I64LE), H5T_NATIVE_INT64, integer), what);
  } else if (const auto* number = std::get_if<double>(&value)) {
    require(H5Awrite(make(H5T_IEEE_F64LE), H5T_NATIVE_DOUBLE, number), what);
  } else {
    const Handle type = text_type();
    const std::string text = text::valid_utf8(without_nul(std::get<std::string>(value)));
    const char* characters = text.c_str();
    require(H5Awrite(make(type), type, &characters), what);
  }
}

Attributes read_attributes(hid_t object) {
  H5O_info_t info;
#if H5_VERSION_GE(1, 12, 0)
  require(H5Oget_info3(object, &info, H5O_INFO_NUM_ATTRS), "attributes");
#else
  require(H5Oget_info2(object, &info, H5O_INFO_NUM_ATTRS), "attributes");
#endif
  Attributes attributes;
  for (hsize_t i = 0; i < info.num_attrs; ++i) {
    hid_t id = H5Aopen_by_idx(object, ".", H5_INDEX_CRT_ORDER, H5_ITER_INC, i, H5P_DEFAULT, H5P_DEFAULT);
    if (id < 0) {  // the order is not recorded in files of other programs
      H5Eclear2(H5E_DEFAULT);
      id = H5Aopen_by_idx(object, ".", H5_INDEX_NAME, H5_ITER_INC, i, H5P_DEFAULT, H5P_DEFAULT);
    }
    const Handle attribute(id, H5Aclose, "attribute");
    const ssize_t length = H5Aget_name(attribute, 0, nullptr);
    if (length < 0) throw LibraryError("name of an attribute: " + take_error_stack());
    std::string name(static_cast<std::size_t>(length), '\0');
    H5Aget_name(attribute, name.size() + 1, name.data());
    AttributeValue value;
    if (read_value(attribute, value)) attributes.emplace_back(std::move(name), std::move(value));
  }
  return attributes;
}

std::string text_of(const Attributes& attributes, const std::string& name) {
  for (const auto& [key, value] : attributes) {
    if (key == name && std::holds_alternative<std::string>(value)) return std::get<std::string>(value);
  }
  return {};
}

std::int64_t integer_of(const Attributes& attributes, const std::string& name, std::int64_t otherwise) {
  for (const auto& [key, value] : attributes) {
    if (key == name && std::holds_alternative<std::int64_t>(value)) return std::get<std::int64_t>(value);
  }
  return otherwise;
}

}  // namespace fw::store
