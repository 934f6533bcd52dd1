#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sys/stat.h>

#include <algorithm>
#include <map>
#include <string>
#include <vector>

#include "app/process.hpp"
#include "store/scratch_directory.hpp"

namespace fw::app::test {

/// A command that has to be refused.
struct BadInput {
  std::string name;                                        ///< of the case, letters and digits
  std::vector<std::string> arguments;                      ///< of `federwerk`
  std::vector<std::pair<std::string, std::string>> files;  ///< name/ is a directory, name| a pipe
  std::vector<std::string> message;                        ///< what the message has to contain
};

inline std::ostream& operator<<(std::ostream& out, const BadInput& bad) {
  return out << bad.name;
}

inline std::string name_of(const ::testing::TestParamInfo<BadInput>& bad) {
  return bad.param.name;
}

/// Every file below a directory with its bytes, directories with "/".
inline std::map<std::string, std::string> snapshot(const std::filesystem::path& directory) {
  std::map<std::string, std::string> content;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(directory)) {
    const std::string name = entry.path().lexically_relative(directory).string();
    content[name] = entry.is_directory()       ? "/"
                    : !entry.is_regular_file() ? "|"
                                               : store::test::read_bytes(entry.path());
  }
  return content;
}

/// Exit code 2, nothing on standard output, one message that contains the fragments, nothing written.
inline void expect_refused(const BadInput& bad) {
  const store::test::ScratchDirectory scratch;
  for (const auto& [name, content] : bad.files) {
    if (name.ends_with('/')) {
      std::filesystem::create_directory(scratch / name);
    } else if (name.ends_with('|')) {
      // A pipe of the test's own, not a device of the machine, which a program without the check would
      // replace.
      ASSERT_EQ(::mkfifo((scratch / name.substr(0, name.size() - 1)).c_str(), 0600), 0);
    } else {
      store::test::write_bytes(scratch / name, content);
    }
  }
  const auto before = snapshot(scratch.path());
  const ProcessResult result = run(scratch.path(), bad.arguments);
  EXPECT_EQ(result.exit_code, 2) << result.signal;
  EXPECT_EQ(result.out, "");
  EXPECT_THAT(result.err, ::testing::StartsWith("federwerk: "));
  EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
  EXPECT_THAT(result.err, ::testing::EndsWith("\n"));
  for (const std::string& fragment : bad.message) EXPECT_THAT(result.err, ::testing::HasSubstr(fragment));
  EXPECT_TRUE(snapshot(scratch.path()) == before) << "files were written or changed";
}

}  // namespace fw::app::test
