#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cstdint>
#include <random>

__extension__ using Binary128 = __float128;
__extension__ using Uint128 = unsigned __int128;

extern "C" {
Binary128 __real___addtf3(Binary128 a, Binary128 b);
Binary128 __real___subtf3(Binary128 a, Binary128 b);
Binary128 __real___multf3(Binary128 a, Binary128 b);
Binary128 __wrap___addtf3(Binary128 a, Binary128 b);
Binary128 __wrap___subtf3(Binary128 a, Binary128 b);
Binary128 __wrap___multf3(Binary128 a, Binary128 b);
}

namespace fw {
namespace {

using Operation = Binary128 (*)(Binary128, Binary128);

/// Numbers in which a mistake of rounding, of a carry or of a border would show.
class Numbers {
 public:
  Binary128 next() {
    Uint128 bits = word();
    const auto bit = [&] { return Uint128{1} << (random_() % 113); };
    switch (random_() % 8) {
      case 0:
        bits &= ~(bit() - 1);
        break;  // zeros at the end
      case 1:
        bits |= bit() - 1;
        break;  // ones at the end
      case 2:
        bits &= ~(bit() - 1) | 1;
        break;  // a last one after zeros: just beyond a tie
      case 3:
        bits &= ~fraction;
        break;  // powers of two
      default:
        break;
    }
    switch (random_() % 8) {
      case 0:
        break;  // of any size
      case 1:
        bits = with_exponent(bits, random_() % 3);
        break;  // subnormal, zero
      case 2:
        bits = with_exponent(bits, 0x7ffd + random_() % 3);
        break;  // up to infinity, not a number
      case 3:
        bits = with_exponent(bits, 8191 + 16384 * (random_() % 2) + random_() % 3);
        break;  // products at either border
      default:
        bits = with_exponent(bits, 16383 - 60 + random_() % 120);
        break;
    }
    if (random_() % 64 == 0) bits &= Uint128{1} << 127;
    return std::bit_cast<Binary128>(bits);
  }
  /// x but for some units in the last place, of either sign: what cancels.
  Binary128 near(Binary128 x) {
    return std::bit_cast<Binary128>((std::bit_cast<Uint128>(x) + random_() % 7 - 3) ^
                                    (Uint128{random_() & 1} << 127));
  }
  bool coin() { return random_() % 16 == 0; }

 private:
  static constexpr Uint128 fraction = (Uint128{1} << 112) - 1;
  Uint128 word() { return (Uint128{random_()} << 64) | random_(); }
  static Uint128 with_exponent(Uint128 bits, std::uint64_t exponent) {
    return (bits & ~(Uint128{0x7fff} << 112)) | (Uint128{exponent} << 112);
  }
  std::mt19937_64 random_{20261128};
};

bool is_normal(Binary128 x) {
  const auto exponent = static_cast<unsigned>(std::bit_cast<Uint128>(x) >> 112) & 0x7fff;
  return exponent != 0 && exponent != 0x7fff;
}

TEST(Binary128Arithmetic, HasTheBitsOfLibgcc) {
  const std::array<std::array<Operation, 2>, 3> operations{{{__real___addtf3, __wrap___addtf3},
                                                            {__real___subtf3, __wrap___subtf3},
                                                            {__real___multf3, __wrap___multf3}}};
  Numbers numbers;
  int normal = 0, differing = 0;
  constexpr int count = 1'000'000;
  for (int k = 0; k < count; ++k) {
    const Binary128 a = numbers.next(), b = numbers.coin() ? numbers.near(a) : numbers.next();
    for (const auto& [libgcc, own] : operations) {
      const auto expected = std::bit_cast<Uint128>(libgcc(a, b)), found = std::bit_cast<Uint128>(own(a, b));
      if (expected != found) ++differing;
      if (is_normal(std::bit_cast<Binary128>(expected))) ++normal;
    }
  }
  EXPECT_EQ(differing, 0);
  EXPECT_GT(normal, count) << "hardly anything went the fast way";
}

}  // namespace
}  // namespace fw
