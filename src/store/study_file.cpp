#include "store/study_file.hpp"

#include <fmt/format.h>

#include "store/case_groups.hpp"
#include "store/file/output_file.hpp"
#include "store/input_file.hpp"

namespace fw::store {

void write_study(const std::filesystem::path& path, const std::string& command_line,
                 const study::StudyResult& result) {
  const LibraryLock lock;
  OutputFile file(path);
  file.guarded([&] {
    write_header(file.id(), {.kind = result.kind,
                             .title = result.title,
                             .command_line = command_line,
                             .spec = result.spec,
                             .seed = result.seed,
                             .quick = result.quick});
    write_cases(file.id(), result.cases);
    write_status(file.id(), result.complete);
  });
  file.publish();
}

StudyFile read_study(const std::filesystem::path& path) {
  const LibraryLock lock;
  const InputFile file(path);
  if (!has_link(file.id(), "cases")) {
    throw InputError(fmt::format("\"{}\" holds no study (its kind is \"{}\")", path.string(), file.kind()));
  }
  StudyFile study;
  study.attributes = file.attributes();
  study.result.kind = file.kind();
  study.result.title = text_of(file.attributes(), "title");
  study.result.spec = text_of(file.attributes(), "spec");
  study.result.seed = integer_of(file.attributes(), "seed", 0);
  study.result.quick = integer_of(file.attributes(), "quick", 0) != 0;
  study.result.complete = text_of(file.attributes(), "status") == "complete";
  try {
    study.result.cases = read_cases(file.id());
  } catch (const LibraryError& error) {
    throw InputError(fmt::format("\"{}\" is damaged: {}", path.string(), error.what()));
  }
  return study;
}

}  // namespace fw::store
