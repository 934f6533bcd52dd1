#pragma once

#include <memory>
#include <string>
#include <string_view>

namespace fw {

/// SHA-256 of bytes that come piece by piece [FIPS 180-4].
class Sha256 {
 public:
  /// Throws SystemError where libcrypto has none.
  Sha256();
  ~Sha256();
  Sha256(const Sha256&) = delete;
  Sha256& operator=(const Sha256&) = delete;

  void update(std::string_view bytes);
  /// 64 lower-case hexadecimal digits. Once, at the end.
  std::string hex();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// SHA-256 of the bytes of `text` as 64 lower-case hexadecimal digits [FIPS 180-4].
std::string sha256_hex(std::string_view text);

}  // namespace fw
