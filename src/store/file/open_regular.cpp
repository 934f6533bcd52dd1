#include "store/file/open_regular.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>

#include <cerrno>
#include <system_error>

#include "core/error.hpp"

namespace fw::store {

std::shared_ptr<DriverFile> open_regular(const std::filesystem::path& path) {
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (descriptor < 0) {
    throw InputError(
        fmt::format("cannot read \"{}\": {}", path.string(), std::generic_category().message(errno)));
  }
  auto file = std::make_shared<DriverFile>(descriptor);
  struct stat status {};
  if (::fstat(descriptor, &status) != 0 || !S_ISREG(status.st_mode)) {
    throw InputError(fmt::format("cannot read \"{}\": it is not a regular file", path.string()));
  }
  return file;
}

}  // namespace fw::store
