#pragma once

#include <filesystem>

namespace fw::app {

struct OutputPlan {
  bool xdmf = false;       ///< FILE.xdmf is written as well
  bool continues = false;  ///< what is there is the first part of the same run
};

/// To be called when everything else has been checked: makes the directory of a result file, sees that the files can
/// be written and none is a stranger's, and says on standard error that a result is replaced. Throws InputError or
/// SystemError.
void prepare_output_file(const std::filesystem::path& path, const OutputPlan& plan = {});

}  // namespace fw::app
