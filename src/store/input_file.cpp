#include "store/input_file.hpp"

#include <fmt/format.h>

#include "store/file/open_regular.hpp"
#include "store/file/seal.hpp"
#include "store/file/untrusted_file.hpp"
#include "store/file_header.hpp"
#include "store/hdf5/superblock.hpp"

namespace fw::store {

InputFile::InputFile(const std::filesystem::path& path) : path_(path), source_(open_regular(path)) {
  const std::string name = fmt::format("\"{}\"", path.string());
  const std::optional<Superblock> start = read_superblock(*source_);
  if (!start) throw InputError(name + " is not an HDF5 file");
  if (!start->end_of_content) {
    throw InputError(name +
                     " has an HDF5 superblock of another version, expected 0 to 3 with addresses of 8 bytes");
  }
  const std::uint64_t size = source_->size(), content = *start->end_of_content;
  if (size < content) {
    throw InputError(fmt::format("{} is truncated: it has {} bytes, its content {}", name, size, content));
  }
  const SealState seal = check_seal(*source_);
  if (seal == SealState::broken || (seal == SealState::intact && size != content + seal_size)) {
    throw InputError(name + " is damaged: its content does not match its SHA-256");
  }
  if (seal == SealState::absent && size != content) {
    throw InputError(fmt::format(
        "{}: the seal is damaged or missing: found {} bytes after the content, expected the {} of a seal; "
        "the file was cut or changed",
        name, size - content, seal_size));
  }
  sealed_ = seal == SealState::intact;
  if (!sealed_) {
    const std::string fault = fault_of_untrusted(path, size);
    if (!fault.empty()) throw InputError(fmt::format("{} is damaged: {}", name, fault));
  }
  try {
    const Handle access = access_through(source_);
    file_ = Handle(H5Fopen(path.c_str(), H5F_ACC_RDONLY, access), H5Fclose, "opening");
    attributes_ = read_attributes(file_);
  } catch (const LibraryError& error) {
    throw InputError(name + " is damaged: " + error.what());
  }
  if (text_of(attributes_, "format") != format_name) {
    throw InputError(
        name +
        " is an HDF5 file, but not a federwerk result (its attribute \"format\" is not \"federwerk\")");
  }
  const std::int64_t version = integer_of(attributes_, "format_version", 0);
  if (version != format_version) {
    throw InputError(fmt::format("{} has format_version {}; this program reads version {}", name, version,
                                 format_version));
  }
  // Studies have always been sealed, trajectories since their attribute says so.
  if (!sealed_ && (kind() != "trajectory" || !text_of(attributes_, "seal").empty())) {
    throw InputError(name +
                     ": the seal is missing: the file was interrupted, cut, or changed by another program");
  }
}

}  // namespace fw::store
