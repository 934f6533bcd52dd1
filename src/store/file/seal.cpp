#include "store/file/seal.hpp"

#include <string>
#include <string_view>

#include "system/sha256.hpp"

namespace fw::store {

namespace {

constexpr std::string_view seal_prefix = "federwerk sha256 ";
static_assert(seal_size == seal_prefix.size() + 64 + 1);

std::string content(const DriverFile& file) {
  std::string text(file.size(), '\0');
  if (!file.read(0, text.data(), text.size())) throw SystemError("the file cannot be read");
  return text;
}

}  // namespace

void append_seal(DriverFile& file) {
  const std::string seal = std::string(seal_prefix) + sha256_hex(content(file)) + "\n";
  file.write(file.size(), seal.data(), seal.size());
}

SealState check_seal(const DriverFile& file) {
  if (file.size() < seal_size) return SealState::absent;
  const std::uint64_t size = file.size() - seal_size;
  std::string seal(seal_size, '\0');
  if (!file.read(size, seal.data(), seal.size())) throw SystemError("the file cannot be read");
  if (!seal.starts_with(seal_prefix)) return SealState::absent;
  const std::string text = content(file);
  const std::string digest = sha256_hex(std::string_view(text).substr(0, size));
  return seal == std::string(seal_prefix) + digest + "\n" ? SealState::intact : SealState::broken;
}

}  // namespace fw::store
