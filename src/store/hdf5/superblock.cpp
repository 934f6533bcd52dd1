#include "store/hdf5/superblock.hpp"

#include <array>
#include <string_view>

namespace fw::store {

std::optional<Superblock> read_superblock(const DriverFile& file) {
  constexpr std::string_view signature = "\x89HDF\r\n\x1a\n";
  std::array<char, 64> start{};
  if (!file.read(0, start.data(), start.size())) return std::nullopt;
  if (std::string_view(start.data(), signature.size()) != signature) return std::nullopt;
  const int version = start[8];
  const bool is_old = version == 0 || version == 1;
  const int width_of_addresses = is_old ? start[13] : start[9];
  if (version < 0 || version > 3 || width_of_addresses != 8) return Superblock{};
  // After the base address and one more address, all of 8 bytes; version 1 has four bytes more before them.
  const std::size_t at = is_old ? (version == 0 ? 40 : 44) : 28;
  std::uint64_t end = 0;
  for (std::size_t k = 8; k-- > 0;) end = end << 8 | static_cast<unsigned char>(start[at + k]);
  return Superblock{end};
}

}  // namespace fw::store
