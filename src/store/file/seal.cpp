#include "store/file/seal.hpp"

#include <algorithm>
#include <string>
#include <string_view>

#include "system/sha256.hpp"

namespace fw::store {

namespace {

constexpr std::string_view seal_prefix = "federwerk sha256 ";
static_assert(seal_size == seal_prefix.size() + 64 + 1);

/// The seal of the first `size` bytes of the file.
std::string seal_of(const DriverFile& file, std::uint64_t size) {
  std::string block(std::size_t{1} << 20, '\0');
  Sha256 digest;
  for (std::uint64_t at = 0; at < size;) {
    const auto bytes = static_cast<std::size_t>(std::min<std::uint64_t>(block.size(), size - at));
    if (!file.read(at, block.data(), bytes)) throw SystemError("the file cannot be read");
    digest.update(std::string_view(block).substr(0, bytes));
    at += bytes;
  }
  return std::string(seal_prefix) + digest.hex() + "\n";
}

}  // namespace

void append_seal(DriverFile& file) {
  const std::string seal = seal_of(file, file.size());
  file.write(file.size(), seal.data(), seal.size());
}

SealState check_seal(const DriverFile& file) {
  if (file.size() < seal_size) return SealState::absent;
  const std::uint64_t size = file.size() - seal_size;
  std::string seal(seal_size, '\0');
  if (!file.read(size, seal.data(), seal.size())) throw SystemError("the file cannot be read");
  if (!seal.starts_with(seal_prefix)) return SealState::absent;
  return seal == seal_of(file, size) ? SealState::intact : SealState::broken;
}

}  // namespace fw::store
