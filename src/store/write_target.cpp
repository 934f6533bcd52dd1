#include "store/write_target.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

#include "core/error.hpp"
#include "store/file/temporary_file.hpp"
#include "store/input_file.hpp"

namespace fw::store {

namespace fs = std::filesystem;

void make_directory_of(const fs::path& path) {
  const fs::path directory = path.parent_path();
  std::error_code error;
  if (directory.empty() || fs::exists(directory, error)) return;
  fs::create_directories(directory, error);
  if (!error) return;
  const std::string message =
      fmt::format("cannot make the directory \"{}\": {}", directory.string(), error.message());
  if (error == std::errc::no_space_on_device || error == std::errc::io_error) throw SystemError(message);
  throw InputError(message);
}

void check_writable_place(const fs::path& path) {
  const std::string name = path.string();
  if (name.empty() || !path.has_filename() || path.filename() == "." || path.filename() == "..") {
    throw InputError(fmt::format("cannot write \"{}\": it does not name a file", name));
  }
  const fs::path directory = path.has_parent_path() ? path.parent_path() : fs::path(".");
  std::error_code error;
  const fs::file_status place = fs::status(directory, error);
  if (place.type() == fs::file_type::not_found) {
    throw InputError(
        fmt::format("cannot write \"{}\": there is no directory \"{}\"", name, directory.string()));
  }
  if (fs::exists(place) && !fs::is_directory(place)) {
    throw InputError(fmt::format("cannot write \"{}\": \"{}\" is no directory", name, directory.string()));
  }
  const fs::file_status present = fs::status(path, error);
  if (fs::is_directory(present)) {
    throw InputError(
        fmt::format("cannot write \"{}\": it is a directory; expected the name of a file", name));
  }
  if (fs::exists(present)) {
    if (!fs::is_regular_file(present)) {
      throw InputError(fmt::format("cannot write \"{}\": it is not a regular file", name));
    }
    if (::access(path.c_str(), W_OK) != 0) {
      throw InputError(fmt::format("cannot write \"{}\": {}", name, std::generic_category().message(errno)));
    }
  }
  // The only sure test of permissions, quotas, read-only file systems and lengths of names.
  int error_number = 0;
  if (!TemporaryFile::can_be_made(path, error_number)) {
    const std::string message = write_failure(path, error_number);
    if (error_number == ENOSPC || error_number == EDQUOT || error_number == EIO) throw SystemError(message);
    throw InputError(message);
  }
}

void check_writable_target(const fs::path& path) {
  check_writable_place(path);
  std::error_code error;
  if (!fs::exists(path, error)) return;
  const LibraryLock lock;
  try {
    const InputFile present(path);
  } catch (const InputError& reason) {
    throw InputError(fmt::format("will not overwrite a file that is no federwerk result: {}", reason.what()));
  }
}

}  // namespace fw::store
