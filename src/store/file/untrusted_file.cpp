#include "store/file/untrusted_file.hpp"

#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <stdexcept>
#include <vector>

#include "store/file/open_regular.hpp"
#include "store/hdf5/attribute.hpp"
#include "system/worker_process.hpp"

namespace fw::store {

namespace {

/// Bytes of address space that are in use: libraries alone map more than a gigabyte, a sanitizer terabytes.
rlim_t mapped_bytes() {
  std::ifstream pages("/proc/self/statm");
  rlim_t count = 0;
  pages >> count;
  return count * static_cast<rlim_t>(::sysconf(_SC_PAGESIZE));
}

/// Memory and processor time that reading so many bytes may cost at most, in the child.
void bound_this_process(std::uint64_t file_size) {
  const auto bound = [](__rlimit_resource_t resource, rlim_t value) {
    rlimit limit{};
    ::getrlimit(resource, &limit);
    limit.rlim_cur = std::min(limit.rlim_max, value);
    ::setrlimit(resource, &limit);
  };
  bound(RLIMIT_AS, mapped_bytes() + (rlim_t{1} << 30) + 4 * file_size);
  bound(RLIMIT_CPU, 10 + file_size / 20'000'000);
  bound(RLIMIT_CORE, 0);
}

class Examination {
 public:
  explicit Examination(std::uint64_t file_size) : file_size_(file_size) {}

  void group(hid_t group, int depth) const {
    constexpr int deepest = 16;  // ours are 4 deep; a group that contains itself has no end
    if (depth > deepest) throw LibraryError(fmt::format("groups are nested more than {} deep", deepest));
    read_attributes(group);
    for (const std::string& name : link_names(group)) {
      H5L_info_t link;
      require(H5Lget_info(group, name.c_str(), &link, H5P_DEFAULT), "a link");
      if (link.type != H5L_TYPE_HARD) throw LibraryError(fmt::format("\"{}\" is a link to elsewhere", name));
      const Handle object(H5Oopen(group, name.c_str(), H5P_DEFAULT), H5Oclose, "an object");
      switch (H5Iget_type(object)) {
        case H5I_GROUP:
          this->group(object, depth + 1);
          break;
        case H5I_DATASET:
          dataset(object, name);
          break;
        default:
          throw LibraryError(fmt::format("\"{}\" is neither a group nor a dataset", name));
      }
    }
  }

 private:
  void dataset(hid_t dataset, const std::string& name) const {
    read_attributes(dataset);
    const Handle space(H5Dget_space(dataset), H5Sclose, "a shape");
    const Handle type(H5Dget_type(dataset), H5Tclose, "a type");
    const hssize_t points = H5Sget_simple_extent_npoints(space);
    const std::size_t width = H5Tget_size(type);
    if (points < 0 || width == 0) throw LibraryError(fmt::format("\"{}\" has no size", name));
    // Compression by deflate gains a factor of 1032 at the most.
    const std::uint64_t most = 1032 * file_size_;
    if (static_cast<std::uint64_t>(points) > most / width) {
      throw LibraryError(fmt::format("\"{}\" claims {} values of {} bytes in a file of {} bytes", name,
                                     points, width, file_size_));
    }
    std::vector<char> values(static_cast<std::size_t>(points) * width);
    // Texts of variable length stay allocated: the process ends soon.
    require(H5Dread(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()), name);
  }

  std::uint64_t file_size_;
};

}  // namespace

std::string fault_of_untrusted(const std::filesystem::path& path, std::uint64_t file_size) {
  try {
    return answer_of_a_process([&]() -> std::string {
      bound_this_process(file_size);
      try {
        const auto own = open_regular(path);  // the parent's descriptors are closed here
        const Handle access = access_through(own);
        const Handle opened(H5Fopen(path.c_str(), H5F_ACC_RDONLY, access), H5Fclose, "opening");
        const Handle root = open_group(opened, "/");
        Examination(own->size()).group(root, 0);
      } catch (const std::exception& error) {
        return *error.what() == '\0' ? "unknown error" : error.what();
      }
      return "";
    });
  } catch (const std::runtime_error& error) {
    return fmt::format("while it was read, {}", error.what());
  }
}

}  // namespace fw::store
