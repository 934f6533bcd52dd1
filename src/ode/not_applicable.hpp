#pragma once

#include "core/error.hpp"

namespace fw {

/// A method cannot run on a system: a condition on the system is not met (`why_not_applicable`, or one that
/// only a look into the system tells). The message names the method and the condition. A study answers with
/// the verdict "not applicable", since nothing is said of the method; the command line with exit code 2.
class NotApplicable : public InputError {
 public:
  using InputError::InputError;
};

}  // namespace fw
