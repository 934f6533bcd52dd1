#include "store/file/output_file.hpp"

#include <fmt/format.h>

#include "store/file/seal.hpp"

namespace fw::store {

OutputFile::OutputFile(const std::filesystem::path& target) : temporary_(target) {
  guarded([&] {
    const Handle access = access_through(temporary_.file());
    Handle creation(H5Pcreate(H5P_FILE_CREATE), H5Pclose, "file creation properties");
    const unsigned order = H5P_CRT_ORDER_TRACKED | H5P_CRT_ORDER_INDEXED;
    require(H5Pset_link_creation_order(creation, order), "file creation properties");
    require(H5Pset_attr_creation_order(creation, order), "file creation properties");
    file_ =
        Handle(H5Fcreate(temporary_.path().c_str(), H5F_ACC_TRUNC, creation, access), H5Fclose, "new file");
  });
}

OutputFile::~OutputFile() {
  discard();
}

void OutputFile::check() {
  if (temporary_.file() && temporary_.file()->error_number() != 0) {
    file_.reset();
    temporary_.check();
  }
}

void OutputFile::fail(const std::string& reason) {
  file_.reset();
  temporary_.check();  // a disk that refused is the better explanation
  temporary_.discard();
  throw SystemError(fmt::format("cannot write \"{}\": {}", temporary_.target().string(), reason));
}

void OutputFile::publish() {
  guarded([&] {
    if (!file_.reset()) throw LibraryError("closing: " + take_error_stack());
  });
  append_seal(*temporary_.file());
  temporary_.publish();
}

void OutputFile::discard() noexcept {
  file_.reset();
  temporary_.discard();
}

}  // namespace fw::store
