#pragma once

#include <sys/types.h>

#include <chrono>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace fw::app::test {

/// How a program ended.
struct ProcessResult {
  int exit_code = -1;    ///< -1 if a signal ended it
  int signal = 0;        ///< that signal, or 0
  std::string out;       ///< standard output
  std::string err;       ///< standard error
  long peak_memory = 0;  ///< largest resident set [KiB]
  double seconds = 0.0;  ///< wall clock
};

/// The executable `federwerk` with some arguments, running in some directory. Its streams are no terminals.
class Process {
 public:
  /// `prepare` runs in the child before the program takes its place, for limits and mounts; if it returns
  /// false the exit code is `not_prepared`.
  Process(const std::filesystem::path& directory, const std::vector<std::string>& arguments,
          const std::function<bool()>& prepare = {});
  ~Process();
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;

  static constexpr int not_prepared = 77;

  void send(int signal) const;
  /// Waits for the end.
  ProcessResult wait();

 private:
  using Clock = std::chrono::steady_clock;
  pid_t id_ = -1;
  int out_ = -1, err_ = -1;
  Clock::time_point start_;
};

/// Runs `federwerk` to its end.
ProcessResult run(const std::filesystem::path& directory, const std::vector<std::string>& arguments,
                  const std::function<bool()>& prepare = {});

}  // namespace fw::app::test
