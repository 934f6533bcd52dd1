#include "app/process.hpp"

#include <fcntl.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <stdexcept>

#include "paths.hpp"

namespace fw::app::test {

namespace {

std::string content_of(int descriptor) {
  std::string text;
  char buffer[65536];
  off_t offset = 0;
  for (ssize_t count; (count = ::pread(descriptor, buffer, sizeof buffer, offset)) > 0; offset += count) {
    text.append(buffer, static_cast<std::size_t>(count));
  }
  return text;
}

}  // namespace

Process::Process(const std::filesystem::path& directory, const std::vector<std::string>& arguments,
                 const std::function<bool()>& prepare)
    : out_(::memfd_create("out", MFD_CLOEXEC)),
      err_(::memfd_create("err", MFD_CLOEXEC)),
      start_(Clock::now()) {
  std::vector<std::string> words{fw::test::federwerk_executable()};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  id_ = ::fork();
  if (id_ < 0) throw std::runtime_error("fork failed");
  if (id_ > 0) return;
  const int nothing = ::open("/dev/null", O_RDONLY);
  const bool ready = ::dup2(nothing, STDIN_FILENO) >= 0 && ::dup2(out_, STDOUT_FILENO) >= 0 &&
                     ::dup2(err_, STDERR_FILENO) >= 0 && ::setenv("FEDERWERK_CACHE", "", 1) == 0 &&
                     ::setenv("XDG_CACHE_HOME", "", 1) == 0 && ::setenv("HOME", "", 1) == 0 &&
                     (!prepare || prepare()) && ::chdir(directory.c_str()) == 0;
  if (ready) ::execv(argv[0], argv.data());
  ::_exit(not_prepared);
}

Process::~Process() {
  if (id_ > 0) {
    ::kill(id_, SIGKILL);
    wait();
  }
  ::close(out_);
  ::close(err_);
}

void Process::send(int signal) const {
  ::kill(id_, signal);
}

ProcessResult Process::wait() {
  int status = 0;
  rusage usage{};
  while (::wait4(id_, &status, 0, &usage) < 0 && errno == EINTR) {
  }
  id_ = -1;
  ProcessResult result;
  if (WIFEXITED(status)) result.exit_code = WEXITSTATUS(status);
  if (WIFSIGNALED(status)) result.signal = WTERMSIG(status);
  result.out = content_of(out_);
  result.err = content_of(err_);
  result.peak_memory = usage.ru_maxrss;
  result.seconds = std::chrono::duration<double>(Clock::now() - start_).count();
  return result;
}

ProcessResult run(const std::filesystem::path& directory, const std::vector<std::string>& arguments,
                  const std::function<bool()>& prepare) {
  return Process(directory, arguments, prepare).wait();
}

}  // namespace fw::app::test
