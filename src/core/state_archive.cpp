#include "core/state_archive.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>

#include "core/error.hpp"

namespace fw {

namespace {

constexpr std::uint64_t longest_name = 255;
constexpr std::uint64_t largest_index = 2'147'483'647;

std::string describe(char type, std::string_view name, std::uint64_t entries) {
  return fmt::format("\"{}\" (type {}, {} entries)", name, type, entries);
}

}  // namespace

std::uint64_t StateArchive::head(std::string_view name, Type type, std::uint64_t entries,
                                 std::uint64_t entry_size, Size size) {
  return head(name, static_cast<char>(type), entries, entry_size, size == Size::fixed);
}

void StateArchive::visit(std::string_view name, double& value) {
  head(name, Type::number, 1, sizeof(double), Size::fixed);
  data(&value, sizeof(double));
}

void StateArchive::visit(std::string_view name, bool& value) {
  head(name, Type::flag, 1, 1, Size::fixed);
  char flag = value ? 1 : 0;
  data(&flag, 1);
  if (flag != 0 && flag != 1) {
    throw InputError(fmt::format("saved state: \"{}\": found the flag {}, expected 0 or 1", name, int{flag}));
  }
  value = flag == 1;
}

void StateArchive::visit(std::string_view name, std::uint64_t& value) {
  head(name, Type::count, 1, sizeof(value), Size::fixed);
  data(&value, sizeof(value));
}

void StateArchive::visit(std::string_view name, std::string& value) {
  value.resize(head(name, Type::text, value.size(), 1, Size::free));
  data(value.data(), value.size());
}

void StateArchive::visit(std::string_view name, Vector& value) {
  const auto size = static_cast<std::uint64_t>(value.size());
  head(name, Type::vector, size, sizeof(double), Size::fixed);
  data(value.data(), size * sizeof(double));
}

void StateArchive::visit(std::string_view name, Matrix& value) {
  const auto size = static_cast<std::uint64_t>(value.size());
  head(name, Type::vector, size, sizeof(double), Size::fixed);
  data(value.data(), size * sizeof(double));
}

void StateArchive::visit(std::string_view name, std::vector<double>& value) {
  head(name, Type::vector, value.size(), sizeof(double), Size::fixed);
  data(value.data(), value.size() * sizeof(double));
}

void StateArchive::visit_any_size(std::string_view name, std::vector<double>& value) {
  value.resize(head(name, Type::vector, value.size(), sizeof(double), Size::free));
  data(value.data(), value.size() * sizeof(double));
}

void StateArchive::visit(std::string_view name, std::vector<Vector>& value) {
  for (Vector& vector : value) visit(name, vector);
}

void StateArchive::visit(std::string_view name, SparseMatrix& value) {
  if (!is_loading() && !value.isCompressed()) value.makeCompressed();
  auto rows = static_cast<std::uint64_t>(value.rows());
  visit(name, rows);
  const auto own_ends = static_cast<std::uint64_t>(value.cols()) + 1;
  const std::uint64_t ends = head(name, Type::indices, own_ends, sizeof(int), Size::free);
  const auto fail = [&] {
    throw InputError(fmt::format("saved state: \"{}\" is no compressed matrix", name));
  };
  if (ends == 0 || ends > largest_index || rows > largest_index) fail();
  if (is_loading()) value.resize(static_cast<Index>(rows), static_cast<Index>(ends - 1));
  data(value.outerIndexPtr(), ends * sizeof(int));
  const auto own_entries =
      static_cast<std::uint64_t>(value.isCompressed() ? value.outerIndexPtr()[ends - 1] : 0);
  const std::uint64_t entries = head(name, Type::indices, own_entries, sizeof(int), Size::free);
  if (is_loading()) {
    const int* end = value.outerIndexPtr();
    if (end[0] != 0 || entries > largest_index || !std::is_sorted(end, end + ends) ||
        static_cast<std::uint64_t>(end[ends - 1]) != entries) {
      fail();
    }
    value.resizeNonZeros(static_cast<Index>(entries));
  }
  data(value.innerIndexPtr(), entries * sizeof(int));
  if (is_loading() && !std::all_of(value.innerIndexPtr(), value.innerIndexPtr() + entries, [&](int row) {
        return row >= 0 && static_cast<std::uint64_t>(row) < rows;
      })) {
    fail();
  }
  head(name, Type::vector, entries, sizeof(double), Size::fixed);
  data(value.valuePtr(), entries * sizeof(double));
}

void StateArchive::require_equal(std::string_view name, const std::string& value) {
  std::string found = value;
  visit(name, found);
  if (found != value) {
    throw InputError(fmt::format("saved state: the {} is \"{}\", expected \"{}\"", name, found, value));
  }
}

void StateArchive::require_equal(std::string_view name, double value) {
  double found = value;
  visit(name, found);
  if (std::memcmp(&found, &value, sizeof(double)) != 0) {
    throw InputError(fmt::format("saved state: the {} is {}, expected {}", name, found, value));
  }
}

std::uint64_t StateWriter::head(std::string_view name, char type, std::uint64_t entries, std::uint64_t,
                                bool) {
  const auto length = static_cast<unsigned char>(std::min<std::uint64_t>(name.size(), longest_name));
  bytes_.push_back(type);
  bytes_.push_back(static_cast<char>(length));
  bytes_.append(name.substr(0, length));
  data(&entries, sizeof(entries));
  return entries;
}

void StateWriter::data(void* bytes, std::size_t size) {
  if (size > 0) bytes_.append(static_cast<const char*>(bytes), size);
}

std::uint64_t StateReader::head(std::string_view name, char type, std::uint64_t entries,
                                std::uint64_t entry_size, bool is_fixed) {
  char found_type = 0;
  unsigned char length = 0;
  data(&found_type, 1);
  data(&length, 1);
  std::string found_name(length, '\0');
  data(found_name.data(), length);
  std::uint64_t found = 0;
  data(&found, sizeof(found));
  if (found_name != name.substr(0, longest_name) || found_type != type || (is_fixed && found != entries)) {
    throw InputError(
        fmt::format("saved state: found {}, expected {}: it belongs to another method, problem or version",
                    describe(found_type, found_name, found), describe(type, name, entries)));
  }
  if (found > (bytes_.size() - place_) / entry_size) {
    throw InputError(
        fmt::format("saved state: \"{}\" has {} entries, more than there are bytes left", name, found));
  }
  return found;
}

void StateReader::data(void* bytes, std::size_t size) {
  if (size > bytes_.size() - place_) {
    throw InputError(fmt::format("saved state: it ends after {} bytes, where {} more are expected",
                                 bytes_.size(), size - (bytes_.size() - place_)));
  }
  if (size > 0) std::memcpy(bytes, bytes_.data() + place_, size);
  place_ += size;
}

void StateReader::finish() const {
  if (place_ != bytes_.size()) {
    throw InputError(
        fmt::format("saved state: {} bytes are left over: it belongs to another method, problem or version",
                    bytes_.size() - place_));
  }
}

}  // namespace fw
