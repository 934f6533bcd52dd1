#pragma once

#include <filesystem>
#include <map>
#include <mutex>

#include "study/case_archive.hpp"

namespace fw::store {

/// Keeps the finished cases of the study whose result goes to `<dir>/<name>.h5`: one by one and durably in
/// `<dir>/.<name>.cases/<key>.h5` while the study runs, together in the result file at its end. Each kept
/// case is a result file of its own (kind "case"), sealed by its SHA-256; a damaged one counts as not there.
/// Safe to use from several threads; a second process on the same study is refused.
class StudyStore final : public study::CaseArchive {
 public:
  /// What earlier runs left.
  enum class Earlier {
    reuse,       ///< cases of the result file and of an interrupted run
    unfinished,  ///< cases of an interrupted run only
    forget,      ///< nothing
  };

  /// Checks the target as `check_writable_target` does, before anything is computed. Throws InputError,
  /// SystemError.
  explicit StudyStore(std::filesystem::path output, Earlier earlier = Earlier::reuse);
  /// Removes the directory of cases if it is empty.
  ~StudyStore() override;
  StudyStore(const StudyStore&) = delete;
  StudyStore& operator=(const StudyStore&) = delete;

  std::optional<study::CaseResult> find(const std::string& key) override;
  void keep(const study::CaseResult& result) override;

  /// Writes the result file. If the study is complete, the kept cases are removed after that. If not, they
  /// stay, and the cases of the earlier result file that are not in this one join them. Throws SystemError,
  /// InputError.
  void write(const std::string& command_line, const study::StudyResult& result);

  const std::filesystem::path& case_directory() const { return directory_; }

 private:
  std::filesystem::path case_file(const std::string& key) const;
  void lock_directory();
  void remove_kept_cases();

  std::filesystem::path output_;
  std::filesystem::path directory_;
  std::map<std::string, study::CaseResult> earlier_;  ///< cases of the result file, by key
  std::mutex mutex_;
  int lock_ = -1;
};

}  // namespace fw::store
