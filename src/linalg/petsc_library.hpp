#pragma once

#include <petscts.h>

#include <mutex>
#include <stdexcept>
#include <string>
#include <utility>

#include "core/status.hpp"

namespace fw::linalg {

/// A PETSc call that failed: PETSc's number and its own words. Never leaves the folders that call PETSc: it
/// becomes a Status (`status_of`) or an InputError.
class PetscFailure : public std::runtime_error {
 public:
  PetscFailure(PetscErrorCode code, const std::string& what) : std::runtime_error(what), code_(code) {}
  PetscErrorCode code() const { return code_; }

 private:
  PetscErrorCode code_;
};

/// Throws PetscFailure with the messages that PETSc has given since the call, unless `code` is 0.
void petsc_check(PetscErrorCode code);

/// matrix_singular, newton_failed, step_too_small, ... or library_failure, with PETSc's own words.
Status status_of(const PetscFailure& failure);

/// Whether the failure tells of a value or a name that PETSc does not know, so that the options are wrong.
bool is_bad_option(const PetscFailure& failure);

/// Options of one object in PETSc's notation, "-ksp_type cg -pc_type gamg". PETSc's own data base (of the
/// environment variable PETSC_OPTIONS) stays as it is, so that runs do not influence each other (decision
/// 0025).
class PetscOptionText {
 public:
  /// Throws InputError for text that is no option, such as a value too many or a missing "-".
  explicit PetscOptionText(const std::string& text);
  ~PetscOptionText();
  PetscOptionText(const PetscOptionText&) = delete;
  PetscOptionText& operator=(const PetscOptionText&) = delete;

  /// Whether the option (with its "-") is there. Does not count as use of it.
  bool has(const std::string& name) const;

  /// Throws InputError that names the first option which nobody has asked for.
  void check_all_used() const;

  const std::string& text() const { return text_; }

 private:
  friend class PetscSession;
  std::string text_;
  PetscOptions options_ = nullptr;
};

/// The right to call PETSc and SLEPc: holds the process-wide lock (they are not safe for threads), starts the
/// libraries at the first time, and lets `options` be the ones that every object reads meanwhile, sub-objects
/// included. May be nested in one thread.
///
/// The libraries start without arguments, without ~/.petscrc, without PETSc's signal handlers, with MPI where
/// nobody has started that before (under mpirun or without), and end once at the end of the program; MPI ends
/// with them only if it was started by them. Error messages are kept for `petsc_check` and not printed.
class PetscSession {
 public:
  /// Throws SystemError if the libraries cannot be started, or have been ended.
  explicit PetscSession(const PetscOptionText* options = nullptr);
  ~PetscSession();
  PetscSession(const PetscSession&) = delete;
  PetscSession& operator=(const PetscSession&) = delete;

 private:
  std::unique_lock<std::recursive_mutex> lock_;
  bool pushed_ = false;
};

/// Throws InputError where `PetscOptionText(text)` does. Starts PETSc for that in a process of its own where
/// it is not running yet: MPI does not survive a fork, and `federwerk run` forks workers after it has read
/// its studies.
void check_petsc_options(const std::string& text);

/// Turns PETSc's failures inside `call` to InputError where the options are to blame. `options` are named.
template <class Call>
void with_options_to_blame(const PetscOptionText& options, Call call);

namespace detail {
/// Whether PETSc is running, so that objects may be destroyed.
bool petsc_is_running();
[[noreturn]] void throw_bad_option(const PetscOptionText& options, const PetscFailure& failure);
}  // namespace detail

template <class Call>
void with_options_to_blame(const PetscOptionText& options, Call call) {
  try {
    call();
  } catch (const PetscFailure& failure) {
    if (!is_bad_option(failure)) throw;
    detail::throw_bad_option(options, failure);
  }
}

/// Owner of a PETSc object.
template <class Object, PetscErrorCode (*destroy)(Object*)>
class PetscOwner {
 public:
  PetscOwner() = default;
  ~PetscOwner() { reset(); }
  PetscOwner(PetscOwner&& other) noexcept : object_(std::exchange(other.object_, nullptr)) {}
  PetscOwner& operator=(PetscOwner&& other) noexcept {
    std::swap(object_, other.object_);
    return *this;
  }

  Object get() const { return object_; }
  operator Object() const { return object_; }
  /// Where a creating call writes the object.
  Object* out() {
    reset();
    return &object_;
  }
  void reset() {
    if (object_ == nullptr) return;
    if (detail::petsc_is_running()) {
      const PetscSession session;
      destroy(&object_);
    }
    object_ = nullptr;
  }

 private:
  Object object_ = nullptr;
};

using PetscVec = PetscOwner<Vec, VecDestroy>;
using PetscMat = PetscOwner<Mat, MatDestroy>;
using PetscKsp = PetscOwner<KSP, KSPDestroy>;
using PetscSnes = PetscOwner<SNES, SNESDestroy>;
using PetscTs = PetscOwner<TS, TSDestroy>;
using PetscIndexSet = PetscOwner<IS, ISDestroy>;
using PetscNullSpace = PetscOwner<MatNullSpace, MatNullSpaceDestroy>;

}  // namespace fw::linalg
