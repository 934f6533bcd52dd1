#include <bit>
#include <cstdint>

// Sums and products of Float128, which nearly all time of a certified reference and of an order measured in binary128
// goes to. The compiler calls libgcc for each (__addtf3, __subtf3, __multf3), which reads the rounding mode, sorts its
// operands into classes and raises "inexact" by a division; nothing here asks for that. The functions below stand
// before libgcc's (the linker's option --wrap, in src/CMakeLists.txt): they do what is left, for normal numbers with a
// normal result in round-to-nearest-even, and hand all else to libgcc. Every result has the bits of libgcc's: that of
// correct rounding [IEEE 754-2019, 4.3.1].

__extension__ using Binary128 = __float128;
__extension__ using Uint128 = unsigned __int128;

extern "C" {
Binary128 __real___addtf3(Binary128 a, Binary128 b);  // libgcc's
Binary128 __real___subtf3(Binary128 a, Binary128 b);
Binary128 __real___multf3(Binary128 a, Binary128 b);
Binary128 __wrap___addtf3(Binary128 a, Binary128 b);  // what the compiler's calls lead to
Binary128 __wrap___subtf3(Binary128 a, Binary128 b);
Binary128 __wrap___multf3(Binary128 a, Binary128 b);
}

namespace {

// Sign, 15 bits of exponent, 112 bits of fraction behind a hidden one.
constexpr Uint128 sign_bit = Uint128{1} << 127;
constexpr Uint128 hidden_one = Uint128{1} << 112;
constexpr Uint128 fraction_bits = hidden_one - 1;
constexpr unsigned exponent_bits = 0x7fff;
constexpr unsigned exponent_bias = 16383;

unsigned exponent_of(Uint128 x) {
  return static_cast<unsigned>(x >> 112) & exponent_bits;
}
Uint128 significand_of(Uint128 x) {
  return (x & fraction_bits) | hidden_one;
}
bool is_normal(unsigned exponent) {
  return exponent - 1 < exponent_bits - 1;
}
/// Also after a carry out of the significand.
bool stays_normal(unsigned exponent) {
  return exponent - 1 < exponent_bits - 2;
}
std::uint64_t high(Uint128 x) {
  return static_cast<std::uint64_t>(x >> 64);
}
std::uint64_t low(Uint128 x) {
  return static_cast<std::uint64_t>(x);
}

/// The number of that sign, exponent and significand (with its hidden one, which adds to the exponent, as does a
/// carry by rounding).
Binary128 compose(Uint128 sign, unsigned exponent, Uint128 significand, bool rounds_up) {
  return std::bit_cast<Binary128>(sign | ((Uint128{exponent - 1} << 112) + significand + rounds_up));
}

/// x + y; libgcc's `fallback` for what is not a normal number.
template <class Fallback>
Binary128 add(Uint128 x, Uint128 y, Fallback fallback) {
  const bool swapped = (x & ~sign_bit) < (y & ~sign_bit);
  const Uint128 large = swapped ? y : x, small = swapped ? x : y;
  const unsigned exponent = exponent_of(large), small_exponent = exponent_of(small);
  if (!is_normal(exponent)) [[unlikely]]
    return fallback();
  if (small_exponent == 0) [[unlikely]] {
    return (small & ~sign_bit) == 0 ? std::bit_cast<Binary128>(large) : fallback();
  }
  const unsigned distance = exponent - small_exponent;
  if (distance > 120) [[unlikely]]
    return std::bit_cast<Binary128>(large);  // far below half a unit
  // 13 bits behind the significands, of which the last stands for all that the shift has lost.
  const Uint128 term = significand_of(small) << 13;
  const Uint128 kept = term >> distance;
  const Uint128 shifted = kept | static_cast<Uint128>((kept << distance) != term);
  const Uint128 opposite = -static_cast<Uint128>((high(x) ^ high(y)) >> 63);  // all ones for a difference
  Uint128 sum = (significand_of(large) << 13) + ((shifted ^ opposite) - opposite);
  if (sum == 0) [[unlikely]]
    return Binary128{};
  const auto zeros =
      static_cast<unsigned>(high(sum) != 0 ? std::countl_zero(high(sum)) : 64 + std::countl_zero(low(sum)));
  sum <<= zeros;
  const unsigned new_exponent = exponent + 2 - zeros;
  if (!stays_normal(new_exponent)) [[unlikely]]
    return fallback();
  const Uint128 significand = sum >> 15;
  const std::uint64_t rest = low(sum) & 0x7fff;
  return compose(large & sign_bit, new_exponent, significand, rest + (low(significand) & 1) > 0x4000);
}

}  // namespace

Binary128 __wrap___addtf3(Binary128 a, Binary128 b) {
  return add(std::bit_cast<Uint128>(a), std::bit_cast<Uint128>(b), [&] { return __real___addtf3(a, b); });
}

Binary128 __wrap___subtf3(Binary128 a, Binary128 b) {
  return add(std::bit_cast<Uint128>(a), std::bit_cast<Uint128>(b) ^ sign_bit,
             [&] { return __real___subtf3(a, b); });
}

Binary128 __wrap___multf3(Binary128 a, Binary128 b) {
  const auto x = std::bit_cast<Uint128>(a), y = std::bit_cast<Uint128>(b);
  const unsigned exponent = exponent_of(x) + exponent_of(y) - exponent_bias;
  if (!is_normal(exponent_of(x)) || !is_normal(exponent_of(y)) || !stays_normal(exponent) ||
      !stays_normal(exponent + 1)) [[unlikely]] {
    // Matrices and tableaus have many zeros.
    const bool is_zero = ((x & ~sign_bit) == 0 && exponent_of(y) != exponent_bits) ||
                         ((y & ~sign_bit) == 0 && exponent_of(x) != exponent_bits);
    return is_zero ? std::bit_cast<Binary128>((x ^ y) & sign_bit) : __real___multf3(a, b);
  }
  // The product of 256 bits, so shifted that its upper half has the significand, with one bit more if it is >= 2.
  const Uint128 p = significand_of(x) << 15, q = significand_of(y) << 1;
  const Uint128 low_low = Uint128{low(p)} * low(q), low_high = Uint128{low(p)} * high(q);
  const Uint128 high_low = Uint128{high(p)} * low(q), high_high = Uint128{high(p)} * high(q);
  const Uint128 middle = low_high + high(low_low);
  const Uint128 middle_sum = high_low + low(middle);
  Uint128 significand = high_high + high(middle) + high(middle_sum);
  std::uint64_t rest = low(middle_sum) | static_cast<std::uint64_t>(low(low_low) != 0);
  const auto is_two = static_cast<unsigned>(significand >> 113);
  if (is_two != 0) {
    rest = (low(significand) << 63) | (rest >> 1) | (rest & 1);
    significand >>= 1;
  }
  constexpr std::uint64_t half = std::uint64_t{1} << 63;
  const bool rounds_up = rest > half || (rest == half && (low(significand) & 1) != 0);
  return compose((x ^ y) & sign_bit, exponent + is_two, significand, rounds_up);
}
