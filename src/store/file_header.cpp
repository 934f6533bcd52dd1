#include "store/file_header.hpp"

#include "system/provenance.hpp"
#include "system/sha256.hpp"

namespace fw::store {

void write_header(hid_t file, const FileHeader& header) {
  const Provenance origin = provenance();
  write_attribute(file, "format", format_name);
  write_attribute(file, "format_version", format_version);
  write_attribute(file, "seal", "sha256");
  write_attribute(file, "kind", header.kind);
  write_attribute(file, "title", header.title);
  write_attribute(file, "created", timestamp_utc());
  write_attribute(file, "command_line", header.command_line);
  write_attribute(file, "git_commit", origin.git_commit);
  write_attribute(file, "git_dirty", std::int64_t{origin.git_dirty});
  write_attribute(file, "compiler", origin.compiler);
  write_attribute(file, "compiler_flags", origin.compiler_flags);
  write_attribute(file, "cpu", origin.cpu);
  write_attribute(file, "libraries", origin.libraries);
  write_attribute(file, "spec", header.spec);
  write_attribute(file, "spec_sha256", sha256_hex(header.spec));
  write_attribute(file, "seed", header.seed);
  write_attribute(file, "quick", std::int64_t{header.quick});
}

void write_status(hid_t file, bool complete) {
  write_attribute(file, "status", complete ? "complete" : "incomplete");
}

}  // namespace fw::store
