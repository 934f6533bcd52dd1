#include "store/study_store.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

#include "store/file/temporary_file.hpp"
#include "store/input_file.hpp"
#include "store/study_file.hpp"
#include "store/write_target.hpp"

namespace fw::store {

namespace fs = std::filesystem;
using study::CaseResult;

namespace {

fs::path directory_of_cases(const fs::path& output) {
  const fs::path name = output.extension() == ".h5" ? output.stem() : output.filename();
  return output.parent_path() / fmt::format(".{}.cases", name.string());
}

/// The one case in a sealed case file; nothing if it is missing, damaged or another case.
std::optional<CaseResult> read_case(const fs::path& path, const std::string& key) {
  try {
    const LibraryLock lock;
    if (!InputFile(path).sealed()) return std::nullopt;
    StudyFile file = read_study(path);
    if (file.result.cases.size() != 1 || file.result.cases.front().key != key) return std::nullopt;
    return std::move(file.result.cases.front());
  } catch (const InputError&) {
    return std::nullopt;
  } catch (const SystemError&) {
    return std::nullopt;
  }
}

}  // namespace

StudyStore::StudyStore(fs::path output, Earlier earlier)
    : output_(std::move(output)), directory_(directory_of_cases(output_)) {
  check_writable_target(output_);
  std::error_code error;
  if (earlier == Earlier::reuse && fs::exists(output_, error)) {
    const LibraryLock lock;
    if (InputFile(output_).kind() != "trajectory") {
      for (CaseResult& result : read_study(output_).result.cases) {
        std::string key = result.key;
        if (key.empty()) continue;  // it could not be computed
        earlier_.insert_or_assign(std::move(key), std::move(result));
      }
    }
  }
  lock_directory();
  if (earlier == Earlier::forget) remove_kept_cases();
}

StudyStore::~StudyStore() {
  ::rmdir(directory_.c_str());  // refuses if there are cases
  if (lock_ >= 0) ::close(lock_);
}

void StudyStore::lock_directory() {
  for (int attempt = 0; attempt < 100; ++attempt) {
    if (::mkdir(directory_.c_str(), 0777) != 0 && errno != EEXIST) {
      throw SystemError(write_failure(directory_, errno));
    }
    lock_ = ::open(directory_.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (lock_ < 0 && errno == ENOENT) continue;  // removed by a run that has just ended
    if (lock_ < 0) throw SystemError(write_failure(directory_, errno));
    if (::flock(lock_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
      ::close(lock_);
      throw InputError(fmt::format("another run is working on \"{}\"", output_.string()));
    }
    struct stat status {
    }, present{};
    if (::fstat(lock_, &status) == 0 && ::stat(directory_.c_str(), &present) == 0 &&
        status.st_ino == present.st_ino) {
      return;
    }
    ::close(lock_);
    lock_ = -1;
  }
  throw SystemError(fmt::format("cannot make the directory \"{}\": it keeps vanishing", directory_.string()));
}

fs::path StudyStore::case_file(const std::string& key) const {
  if (key.empty() || key.size() > 128 ||
      key.find_first_not_of("0123456789abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ-_") != key.npos) {
    throw InputError(fmt::format("\"{}\" cannot be the key of a case: expected hexadecimal digits", key));
  }
  return directory_ / fmt::format("{}.h5", key);
}

std::optional<CaseResult> StudyStore::find(const std::string& key) {
  const std::lock_guard guard(mutex_);
  if (auto result = read_case(case_file(key), key)) return result;
  const auto found = earlier_.find(key);
  if (found == earlier_.end()) return std::nullopt;
  return found->second;
}

void StudyStore::keep(const CaseResult& result) {
  const std::lock_guard guard(mutex_);
  study::StudyResult single;
  single.kind = "case";
  single.cases = {result};
  write_study(case_file(result.key), "", single);
}

void StudyStore::write(const std::string& command_line, const study::StudyResult& result) {
  if (!result.complete) {
    auto left_out = earlier_;
    for (const CaseResult& present : result.cases) left_out.erase(present.key);
    for (const auto& [key, missing] : left_out) keep(missing);
  }
  const std::lock_guard guard(mutex_);
  write_study(output_, command_line, result);
  if (!result.complete) return;
  remove_kept_cases();
  ::rmdir(directory_.c_str());
}

void StudyStore::remove_kept_cases() {
  std::vector<fs::path> files;
  std::error_code error;
  for (fs::directory_iterator entry(directory_, error), end; !error && entry != end; entry.increment(error)) {
    const std::string name = entry->path().filename().string();
    if (name.ends_with(".h5") || name.ends_with(".tmp")) files.push_back(entry->path());
  }
  for (const fs::path& file : files) fs::remove(file, error);
}

}  // namespace fw::store
