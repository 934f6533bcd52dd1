#include "store/hdf5/file_driver.hpp"

#if H5_VERSION_GE(1, 14, 0)
#include <H5FDdevelop.h>
#endif
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstring>

namespace fw::store {

DriverFile::DriverFile(int descriptor) : descriptor_(descriptor) {
  struct stat status {};
  if (::fstat(descriptor_, &status) == 0) size_ = static_cast<std::uint64_t>(status.st_size);
}

DriverFile::~DriverFile() {
  ::close(descriptor_);
}

bool DriverFile::read(std::uint64_t offset, void* buffer, std::size_t bytes) const {
  auto* out = static_cast<char*>(buffer);
  while (bytes > 0) {
    const ssize_t count = ::pread(descriptor_, out, bytes, static_cast<off_t>(offset));
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return false;
    if (count == 0) {  // beyond the end: zeros, as the library expects
      std::memset(out, 0, bytes);
      return true;
    }
    out += count;
    offset += static_cast<std::uint64_t>(count);
    bytes -= static_cast<std::size_t>(count);
  }
  return true;
}

void DriverFile::write(std::uint64_t offset, const void* buffer, std::size_t bytes) {
  size_ = std::max(size_, offset + bytes);
  const auto* in = static_cast<const char*>(buffer);
  while (bytes > 0 && error_number_ == 0) {
    const ssize_t count = ::pwrite(descriptor_, in, bytes, static_cast<off_t>(offset));
    if (count < 0) {
      if (errno != EINTR) error_number_ = errno;
      continue;
    }
    in += count;
    offset += static_cast<std::uint64_t>(count);
    bytes -= static_cast<std::size_t>(count);
  }
}

void DriverFile::truncate(std::uint64_t bytes) {
  size_ = bytes;
  if (error_number_ == 0 && ::ftruncate(descriptor_, static_cast<off_t>(bytes)) != 0) error_number_ = errno;
}

void DriverFile::synchronise() {
  if (error_number_ == 0 && ::fsync(descriptor_) != 0) error_number_ = errno;
}

namespace {

/// What H5Pset_driver copies: a pointer to the owner's pointer, read while the file is being opened.
struct DriverInfo {
  const std::shared_ptr<DriverFile>* file;
};

/// The library's view of one open file; shares the file, so that it stays valid until the library lets go.
struct OpenedFile : H5FD_t {
  std::shared_ptr<DriverFile> file;
  haddr_t end_of_allocation;
};

const OpenedFile& opened(const H5FD_t* file) {
  return *static_cast<const OpenedFile*>(file);
}
OpenedFile& opened(H5FD_t* file) {
  return *static_cast<OpenedFile*>(file);
}

H5FD_t* driver_open(const char*, unsigned flags, hid_t access, haddr_t) {
  const auto* info = static_cast<const DriverInfo*>(H5Pget_driver_info(access));
  if (info == nullptr) return nullptr;
  if ((flags & H5F_ACC_TRUNC) != 0) (*info->file)->truncate(0);
  auto* file = new OpenedFile{};
  file->file = *info->file;
  return file;
}

herr_t driver_close(H5FD_t* file) {
  delete static_cast<OpenedFile*>(file);
  return 0;
}

int driver_compare(const H5FD_t* a, const H5FD_t* b) {
  const auto *first = opened(a).file.get(), *second = opened(b).file.get();
  return first == second ? 0 : std::less<>{}(first, second) ? -1 : 1;
}

herr_t driver_query(const H5FD_t*, unsigned long* features) {
  *features = H5FD_FEAT_AGGREGATE_METADATA | H5FD_FEAT_ACCUMULATE_METADATA | H5FD_FEAT_DATA_SIEVE |
              H5FD_FEAT_AGGREGATE_SMALLDATA | H5FD_FEAT_DEFAULT_VFD_COMPATIBLE;
  return 0;
}

haddr_t driver_end_of_allocation(const H5FD_t* file, H5FD_mem_t) {
  return opened(file).end_of_allocation;
}

herr_t driver_set_end_of_allocation(H5FD_t* file, H5FD_mem_t, haddr_t address) {
  opened(file).end_of_allocation = address;
  return 0;
}

haddr_t driver_end_of_file(const H5FD_t* file, H5FD_mem_t) {
  return opened(file).file->size();
}

herr_t driver_read(H5FD_t* file, H5FD_mem_t, hid_t, haddr_t address, std::size_t size, void* buffer) {
  return opened(file).file->read(address, buffer, size) ? 0 : -1;
}

herr_t driver_write(H5FD_t* file, H5FD_mem_t, hid_t, haddr_t address, std::size_t size, const void* buffer) {
  opened(file).file->write(address, buffer, size);
  return 0;
}

herr_t driver_truncate(H5FD_t* base, hid_t, hbool_t) {
  OpenedFile& file = opened(base);
  if (file.end_of_allocation != file.file->size()) file.file->truncate(file.end_of_allocation);
  return 0;
}

H5FD_class_t driver_class() {
  H5FD_class_t driver{};
#if H5_VERSION_GE(1, 14, 0)
  driver.version = H5FD_CLASS_VERSION;
  driver.value = 600;  // any number from the range for use inside one program
#endif
  driver.name = "federwerk";
  driver.maxaddr = (haddr_t{1} << 62) - 1;
  driver.fc_degree = H5F_CLOSE_STRONG;
  driver.fapl_size = sizeof(DriverInfo);
  driver.open = driver_open;
  driver.close = driver_close;
  driver.cmp = driver_compare;
  driver.query = driver_query;
  driver.get_eoa = driver_end_of_allocation;
  driver.set_eoa = driver_set_end_of_allocation;
  driver.get_eof = driver_end_of_file;
  driver.read = driver_read;
  driver.write = driver_write;
  driver.truncate = driver_truncate;
  const H5FD_mem_t kinds[] = H5FD_FLMAP_DICHOTOMY;
  std::copy(std::begin(kinds), std::end(kinds), driver.fl_map);
  return driver;
}

hid_t register_driver() {
  // A limit on file sizes shall be an error with a message like a full disk, not the death of the process.
  struct sigaction action {};
  if (::sigaction(SIGXFSZ, nullptr, &action) == 0 && action.sa_handler == SIG_DFL) {
    std::signal(SIGXFSZ, SIG_IGN);
  }
  static const H5FD_class_t driver = driver_class();
  return H5FDregister(&driver);
}

}  // namespace

Handle access_through(const std::shared_ptr<DriverFile>& file) {
  static const hid_t driver = register_driver();
  Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose, "file access properties");
  const DriverInfo info{&file};
  require(H5Pset_driver(access, driver, &info), "file driver");
  require(H5Pset_fclose_degree(access, H5F_CLOSE_STRONG), "file access properties");
  require(H5Pset_libver_bounds(access, H5F_LIBVER_V18, H5F_LIBVER_V18), "file access properties");
  return access;
}

}  // namespace fw::store
