#include "system/worker_process.hpp"

#include <fmt/format.h>
#include <poll.h>
#include <sched.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <stdexcept>
#include <system_error>

namespace fw {

namespace {

std::atomic<bool> worker_interrupted{false};

/// Whether this process is a worker, whose socket has the descriptor 3.
bool is_worker = false;

/// In the length of a message: it is a note and no answer.
constexpr std::uint64_t note_flag = std::uint64_t{1} << 63;

void on_interrupt(int) {
  worker_interrupted.store(true);
}

/// Reads exactly `size` bytes; false at the end of the stream.
bool read_all(int socket, void* data, std::size_t size) {
  auto* at = static_cast<char*>(data);
  while (size > 0) {
    const ssize_t got = ::read(socket, at, size);
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return false;
    at += got;
    size -= static_cast<std::size_t>(got);
  }
  return true;
}

bool send_all(int socket, const void* data, std::size_t size) {
  const auto* at = static_cast<const char*>(data);
  while (size > 0) {
    const ssize_t sent = ::send(socket, at, size, MSG_NOSIGNAL);
    if (sent < 0 && errno == EINTR) continue;
    if (sent <= 0) return false;
    at += sent;
    size -= static_cast<std::size_t>(sent);
  }
  return true;
}

/// Keeps the worker on the processor it is on, for as long as this lives.
class Pinned {
 public:
  explicit Pinned(bool wanted) {
    if (!wanted || ::sched_getaffinity(0, sizeof before_, &before_) != 0) return;
    const int processor = ::sched_getcpu();
    if (processor < 0 || processor >= CPU_SETSIZE) return;
    cpu_set_t one;
    CPU_ZERO(&one);
    CPU_SET(static_cast<unsigned>(processor), &one);
    pinned_ = ::sched_setaffinity(0, sizeof one, &one) == 0;
  }
  ~Pinned() {
    if (pinned_) ::sched_setaffinity(0, sizeof before_, &before_);
  }
  Pinned(const Pinned&) = delete;
  Pinned& operator=(const Pinned&) = delete;

 private:
  cpu_set_t before_{};
  bool pinned_ = false;
};

/// The life of a worker: tasks until there are no more.
[[noreturn]] void serve(int socket, pid_t parent, const WorkerProcess::Work& work) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != parent) ::_exit(0);  // it died before that
  // The user's ^C goes to all processes of the terminal; the parent passes it on where it should count.
  for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGPIPE, SIGXFSZ}) std::signal(signal, SIG_IGN);
  std::signal(SIGUSR1, on_interrupt);
  // Files and locks of the parent are not the worker's to hold.
  ::dup2(socket, 3);
  ::close_range(4, ~0U, 0);
  is_worker = true;
  WorkerProcess::Task task;
  while (read_all(3, &task, sizeof task)) {
    const Pinned pinned(task.pinned);
    const std::string answer = work(task.index, worker_interrupted);
    const std::uint64_t size = answer.size();
    if (!send_all(3, &size, sizeof size) || !send_all(3, answer.data(), answer.size())) break;
  }
  std::fflush(stdout);
  ::_exit(0);
}

}  // namespace

WorkerProcess::WorkerProcess(const Work& work) {
  int sockets[2];
  if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, sockets) != 0) {
    throw std::system_error(errno, std::generic_category(), "cannot connect to a worker process");
  }
  // What is buffered would be written by both processes.
  std::fflush(nullptr);
  const pid_t parent = ::getpid();
  id_ = ::fork();
  if (id_ < 0) {
    const int reason = errno;
    ::close(sockets[0]);
    ::close(sockets[1]);
    throw std::system_error(reason, std::generic_category(), "cannot start a worker process");
  }
  if (id_ == 0) {
    ::close(sockets[0]);
    serve(sockets[1], parent, work);
  }
  ::close(sockets[1]);
  socket_ = sockets[0];
}

WorkerProcess::~WorkerProcess() {
  if (!has_ended_) {
    kill();
    ::waitpid(id_, nullptr, 0);
  }
  ::close(socket_);
}

void WorkerProcess::tell(const std::string& note) {
  if (!is_worker) return;
  const std::uint64_t size = note.size() | note_flag;
  if (send_all(3, &size, sizeof size)) send_all(3, note.data(), note.size());
}

void WorkerProcess::assign(Task task) {
  note_.clear();
  send_all(socket_, &task, sizeof task);  // a worker that has died shows at the next `receive`
}

std::optional<std::string> WorkerProcess::receive() {
  char buffer[1 << 16];
  while (true) {
    const ssize_t got = ::recv(socket_, buffer, sizeof buffer, MSG_DONTWAIT);
    if (got > 0) {
      received_.append(buffer, static_cast<std::size_t>(got));
      continue;
    }
    if (got < 0 && errno == EINTR) continue;
    if (got == 0 || (errno != EAGAIN && errno != EWOULDBLOCK)) reap();
    break;
  }
  while (true) {
    std::uint64_t size = 0;
    if (received_.size() < sizeof size) return std::nullopt;
    std::memcpy(&size, received_.data(), sizeof size);
    const bool is_note = (size & note_flag) != 0;
    size &= ~note_flag;
    if (received_.size() < sizeof size + size) return std::nullopt;
    std::string message = received_.substr(sizeof size, size);
    received_.erase(0, sizeof size + size);
    if (!is_note) return message;
    note_ = std::move(message);
  }
}

void WorkerProcess::reap() {
  if (has_ended_) return;
  has_ended_ = true;
  int status = 0;
  kill();  // it may have closed its socket without ending
  while (::waitpid(id_, &status, 0) < 0 && errno == EINTR) {
  }
  if (WIFSIGNALED(status)) {
    const int signal = WTERMSIG(status);
    how_it_ended_ = fmt::format("ended by signal {} ({}){}", signal, ::strsignal(signal),
                                signal == SIGKILL ? ", perhaps for lack of memory" : "");
  } else {
    how_it_ended_ = fmt::format("ended with exit code {}", WEXITSTATUS(status));
  }
}

void WorkerProcess::interrupt() const {
  if (!has_ended_) ::kill(id_, SIGUSR1);
}

void WorkerProcess::kill() const {
  if (id_ > 0) ::kill(id_, SIGKILL);
}

void WorkerProcess::end() {
  kill();
  while (!has_ended_) {
    pollfd watched{socket_, POLLIN, 0};
    ::poll(&watched, 1, 100);
    receive();
  }
}

std::string answer_of_a_process(const std::function<std::string()>& ask) {
  WorkerProcess worker([&](std::size_t, const std::atomic<bool>&) { return ask(); });
  worker.assign({});
  while (true) {
    pollfd watched{worker.descriptor(), POLLIN, 0};
    ::poll(&watched, 1, -1);
    if (std::optional<std::string> answer = worker.receive()) return *answer;
    if (worker.has_ended()) throw std::runtime_error("a process " + worker.how_it_ended());
  }
}

}  // namespace fw
