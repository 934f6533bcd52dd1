#pragma once

#include <sys/types.h>

#include <atomic>
#include <functional>
#include <optional>
#include <string>

namespace fw {

/// A forked copy of this process that does tasks one after the other, so that a crash, a hang or a task that
/// runs out of memory takes nothing else with it. It dies with its parent, however that ends. Only the thread
/// that forks lives on in it: the parent must have no other threads that matter.
class WorkerProcess {
 public:
  /// What a worker is asked to do: a number, and whether it is to stay on one processor meanwhile.
  struct Task {
    std::size_t index = 0;
    bool pinned = false;
  };
  /// Does a task and returns the answer; runs in the worker. `interrupted` is set by `interrupt`.
  using Work = std::function<std::string(std::size_t index, const std::atomic<bool>& interrupted)>;

  /// Called in a worker while it works: sends a note to the parent, which `note` gives there. Elsewhere it does
  /// nothing.
  static void tell(const std::string& note);

  /// Throws std::system_error where the machine has no room for another process.
  explicit WorkerProcess(const Work& work);
  /// Ends it at once, whatever it does.
  ~WorkerProcess();
  WorkerProcess(const WorkerProcess&) = delete;
  WorkerProcess& operator=(const WorkerProcess&) = delete;

  void assign(Task task);
  /// Readable when something of an answer is there, or when the worker has ended.
  int descriptor() const { return socket_; }
  /// Reads what is there; the answer if it is complete. After the worker's end, see `has_ended`.
  std::optional<std::string> receive();
  /// The last note that the worker has sent about its present task; empty: none.
  const std::string& note() const { return note_; }
  bool has_ended() const { return has_ended_; }
  /// Why, in words: "ended by signal 11 (Segmentation fault)". Only after `has_ended`.
  const std::string& how_it_ended() const { return how_it_ended_; }

  /// Sets the flag that the work sees.
  void interrupt() const;
  void kill() const;
  /// Kills it and waits until it has ended.
  void end();

 private:
  void reap();

  pid_t id_ = -1;
  int socket_ = -1;
  std::string received_, note_;
  bool has_ended_ = false;
  std::string how_it_ended_;
};

/// Runs `ask` in a process of its own and returns its answer, so that what it does to the state of the
/// process (libraries that cannot be started twice, or not before a fork) stays there. Throws
/// std::runtime_error that says how the process ended where there is no answer.
std::string answer_of_a_process(const std::function<std::string()>& ask);

}  // namespace fw
