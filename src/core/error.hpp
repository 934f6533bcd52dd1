#pragma once

#include <stdexcept>
#include <string>

namespace fw {

/// The caller's mistake: bad input, unknown name, wrong size. The message names file, key or index, what was
/// found and what was expected. The command line answers with exit code 2.
class InputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// An operating-system failure: full disk, vanished directory, exhausted memory. The command line answers with
/// exit code 3. A numerical failure is no exception but a `Status`.
class SystemError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace fw
