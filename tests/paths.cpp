#include "paths.hpp"

namespace fw::test {

std::string source_directory() {
  return FEDERWERK_SOURCE_DIR;
}

std::string federwerk_executable() {
  return FEDERWERK_EXECUTABLE;
}

std::string python_command() {
  return "'" + source_directory() + "/scripts/python'";
}

}  // namespace fw::test
