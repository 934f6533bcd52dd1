#include "store/file/temporary_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

namespace fw::store {

namespace {

namespace fs = std::filesystem;

fs::path directory_of(const fs::path& path) {
  return path.has_parent_path() ? path.parent_path() : fs::path(".");
}

/// Removes the temporary files of this target whose writers are gone: a writer holds a lock as long as it
/// lives.
void remove_abandoned(const fs::path& target) {
  const std::string prefix = fmt::format(".{}.", target.filename().string());
  std::error_code ignored;
  for (fs::directory_iterator entry(directory_of(target), ignored), end; !ignored && entry != end;
       entry.increment(ignored)) {
    const std::string name = entry->path().filename().string();
    if (name.size() <= prefix.size() + 4 || !name.starts_with(prefix) || !name.ends_with(".tmp")) continue;
    const std::string middle = name.substr(prefix.size(), name.size() - prefix.size() - 4);
    if (middle.find_first_not_of("0123456789-") != std::string::npos) continue;
    const int descriptor = ::open(entry->path().c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK);
    if (descriptor < 0) continue;
    if (::flock(descriptor, LOCK_EX | LOCK_NB) == 0) ::unlink(entry->path().c_str());
    ::close(descriptor);
  }
}

/// Makes and opens ".<name>.<pid>-<attempt>.tmp"; -1 and errno if that fails.
int make_temporary(const fs::path& target, fs::path& path) {
  for (int attempt = 0;; ++attempt) {
    path =
        directory_of(target) / fmt::format(".{}.{}-{}.tmp", target.filename().string(), ::getpid(), attempt);
    const int descriptor = ::open(path.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (descriptor >= 0 || errno != EEXIST || attempt >= 1000) return descriptor;
  }
}

}  // namespace

std::string write_failure(const fs::path& path, int error_number) {
  std::string_view reason;
  if (error_number == ENOSPC) reason = "disk full: ";
  if (error_number == EDQUOT) reason = "disk full (quota): ";
  if (error_number == EFBIG) reason = "disk full (limit on file sizes): ";
  return fmt::format("{}cannot write \"{}\": {}", reason, path.string(),
                     std::generic_category().message(error_number));
}

TemporaryFile::TemporaryFile(fs::path target) : target_(std::move(target)) {
  remove_abandoned(target_);
  while (!file_) {
    const int descriptor = make_temporary(target_, path_);
    if (descriptor < 0) throw SystemError(write_failure(target_, errno));
    auto file = std::make_shared<DriverFile>(descriptor);
    ::flock(descriptor, LOCK_EX | LOCK_NB);
    struct stat status {};
    // Another process may have taken the file for abandoned between its creation and the lock.
    if (::fstat(descriptor, &status) == 0 && status.st_nlink > 0) file_ = std::move(file);
  }
}

bool TemporaryFile::can_be_made(const fs::path& target, int& error_number) {
  fs::path path;
  const int descriptor = make_temporary(target, path);
  if (descriptor < 0) {
    error_number = errno;
    return false;
  }
  ::unlink(path.c_str());
  ::close(descriptor);
  return true;
}

TemporaryFile::~TemporaryFile() {
  discard();
}

void TemporaryFile::check() {
  if (!file_ || file_->error_number() == 0) return;
  const int error_number = file_->error_number();
  discard();
  throw SystemError(write_failure(target_, error_number));
}

void TemporaryFile::publish() {
  file_->synchronise();
  check();
  if (::rename(path_.c_str(), target_.c_str()) != 0) {
    const int error_number = errno;
    discard();
    throw SystemError(write_failure(target_, error_number));
  }
  file_.reset();
  const int directory = ::open(directory_of(target_).c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (directory >= 0) {
    ::fsync(directory);  // some network file systems refuse this; the data are whole either way
    ::close(directory);
  }
}

void TemporaryFile::discard() noexcept {
  if (!file_) return;
  ::unlink(path_.c_str());
  file_.reset();
}

}  // namespace fw::store
