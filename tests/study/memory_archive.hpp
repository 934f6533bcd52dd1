#pragma once

#include <map>
#include <mutex>
#include <optional>

#include "study/case_archive.hpp"

namespace fw::study {

/// Keeps finished cases in memory.
class MemoryArchive final : public CaseArchive {
 public:
  std::optional<CaseResult> find(const std::string& key) override {
    const std::lock_guard lock(mutex_);
    const auto entry = cases_.find(key);
    if (entry == cases_.end()) return std::nullopt;
    return entry->second;
  }
  void keep(const CaseResult& result) override {
    const std::lock_guard lock(mutex_);
    cases_[result.key] = result;
  }
  std::size_t size() const { return cases_.size(); }

 private:
  std::mutex mutex_;
  std::map<std::string, CaseResult> cases_;
};

}  // namespace fw::study
