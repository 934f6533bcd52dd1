#pragma once

#include <exception>
#include <utility>

namespace fw::oracles::detail {

/// Keeps exceptions out of the frames of a C library: `call` runs the body of a callback, keeps the first
/// exception and answers with the library's code for a failure from which it must not try to recover;
/// `rethrow` hands the exception on once the library has returned. One guard per run.
class CallbackGuard {
 public:
  /// SUNDIALS: 0 success, > 0 recoverable (a smaller step may help), < 0 not recoverable.
  template <class Body>
  int call(Body&& body) noexcept {
    try {
      return std::forward<Body>(body)();
    } catch (...) {
      if (!exception_) exception_ = std::current_exception();
      return -1;
    }
  }

  void rethrow() {
    if (exception_) std::rethrow_exception(std::exchange(exception_, nullptr));
  }

 private:
  std::exception_ptr exception_;
};

}  // namespace fw::oracles::detail
