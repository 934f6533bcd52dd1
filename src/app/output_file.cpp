#include "app/output_file.hpp"

#include <fmt/format.h>

#include <cstdio>

#include "core/error.hpp"
#include "store/write_target.hpp"

namespace fw::app {

void prepare_output_file(const std::filesystem::path& path, const OutputPlan& plan) {
  const std::filesystem::path xdmf = std::filesystem::path(path).replace_extension(".xdmf");
  if (plan.xdmf && xdmf == path) {
    throw InputError(
        fmt::format("--xdmf would overwrite the result file \"{}\", expected another ending", path.string()));
  }
  store::make_directory_of(path);
  store::check_writable_target(path);
  if (plan.xdmf) store::check_writable_place(xdmf);
  std::error_code error;
  if (!plan.continues && std::filesystem::exists(path, error)) {
    fmt::print(stderr, "federwerk: note: \"{}\" is there already and is replaced\n", path.string());
  }
}

}  // namespace fw::app
