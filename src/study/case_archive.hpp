#pragma once

#include <optional>
#include <string>

#include "study/result.hpp"

namespace fw::study {

/// Where the cases of one study are kept as they finish, so that nothing finished is lost or run again.
class CaseArchive {
 public:
  virtual ~CaseArchive() = default;

  /// The finished case with this key, if an earlier run kept one.
  virtual std::optional<CaseResult> find(const std::string& key) = 0;

  /// Keeps a finished case durably before it returns. Throws SystemError (disk full, directory gone).
  virtual void keep(const CaseResult& result) = 0;
};

}  // namespace fw::study
