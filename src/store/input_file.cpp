#include "store/input_file.hpp"

#include <fmt/format.h>

#include "store/file/open_regular.hpp"
#include "store/file/seal.hpp"
#include "store/file_header.hpp"

namespace fw::store {

InputFile::InputFile(const std::filesystem::path& path) : path_(path), source_(open_regular(path)) {
  const std::string name = fmt::format("\"{}\"", path.string());
  const SealState seal = check_seal(*source_);
  if (seal == SealState::broken) {
    throw InputError(name + " is damaged: its content does not match its SHA-256");
  }
  sealed_ = seal == SealState::intact;
  try {
    const Handle access = access_through(source_);
    file_ = Handle(H5Fopen(path.c_str(), H5F_ACC_RDONLY, access), H5Fclose, "opening");
    attributes_ = read_attributes(file_);
  } catch (const LibraryError& error) {
    const std::string reason = error.what();
    if (reason.find("truncated file") != std::string::npos) throw InputError(name + " is truncated");
    if (reason.find("signature") != std::string::npos) throw InputError(name + " is not an HDF5 file");
    throw InputError(name + " is not an HDF5 file, or is damaged: " + reason);
  }
  if (text_of(attributes_, "format") != format_name) {
    throw InputError(
        name + " is an HDF5 file, but no federwerk result (its attribute \"format\" is not \"federwerk\")");
  }
  const std::int64_t version = integer_of(attributes_, "format_version", 0);
  if (version != format_version) {
    throw InputError(fmt::format("{} has format_version {}; this program reads version {}", name, version,
                                 format_version));
  }
}

}  // namespace fw::store
