#pragma once

#include <hdf5.h>

#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "core/error.hpp"

namespace fw::store {

/// A call of the HDF5 library failed; the message holds its error stack on one line. Readers turn it into an
/// InputError and writers into a SystemError that name the file.
class LibraryError : public SystemError {
 public:
  using SystemError::SystemError;
};

/// Holds the HDF5 library for one public operation: the library is not thread-safe in the flavour that PETSc
/// links, and studies keep their cases from several threads. Also switches the library's own printing of
/// errors off.
class LibraryLock {
 public:
  LibraryLock();

 private:
  std::lock_guard<std::recursive_mutex> guard_;
};

/// Owns one identifier of the library and closes it.
class Handle {
 public:
  using Close = herr_t (*)(hid_t);

  Handle() = default;
  /// Takes `id`; throws LibraryError "<what>: <error stack>" if the call that made it failed.
  Handle(hid_t id, Close close, const std::string& what);
  Handle(Handle&& other) noexcept : id_(std::exchange(other.id_, H5I_INVALID_HID)), close_(other.close_) {}
  Handle& operator=(Handle&& other) noexcept {
    std::swap(id_, other.id_);
    std::swap(close_, other.close_);
    return *this;
  }
  ~Handle() { reset(); }

  hid_t get() const { return id_; }
  operator hid_t() const { return id_; }

  /// Closes the identifier now; true if the library agreed.
  bool reset() noexcept;

 private:
  hid_t id_ = H5I_INVALID_HID;
  Close close_ = nullptr;
};

/// Throws LibraryError "<what>: <error stack>" if `result` is negative.
void require(herr_t result, const std::string& what);

/// The current error stack on one line, the outermost reason first; clears the stack.
std::string take_error_stack();

/// The names of the links of a group in the order in which they were made (by name if that is not recorded).
std::vector<std::string> link_names(hid_t group);

/// True if `name` is a link of `group`.
bool has_link(hid_t group, const std::string& name);

/// Opens a group; throws LibraryError.
Handle open_group(hid_t parent, const std::string& name);

/// Makes a group that remembers the order of its links and attributes; throws LibraryError.
Handle make_group(hid_t parent, const std::string& name);

}  // namespace fw::store
