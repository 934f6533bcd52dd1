#include "system/worker_process.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <sched.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <stdexcept>
#include <thread>

namespace fw {
namespace {

using testing::HasSubstr;

/// The next answer; nothing if the worker ends or says nothing for ten seconds.
std::optional<std::string> answer_of(WorkerProcess& worker) {
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(10);
  while (!worker.has_ended() && std::chrono::steady_clock::now() < deadline) {
    pollfd watched{worker.descriptor(), POLLIN, 0};
    ::poll(&watched, 1, 100);
    if (std::optional<std::string> answer = worker.receive()) return answer;
  }
  return std::nullopt;
}

TEST(WorkerProcess, DoesTasksOneAfterTheOther) {
  int calls = 0;  // of the worker's own copy
  WorkerProcess worker([&](std::size_t index, const std::atomic<bool>&) {
    return std::to_string(index * index) + " " + std::to_string(++calls);
  });
  worker.assign({.index = 3});
  EXPECT_EQ(answer_of(worker), "9 1");
  worker.assign({.index = 12});
  EXPECT_EQ(answer_of(worker), "144 2");
  EXPECT_FALSE(worker.has_ended());
  EXPECT_EQ(calls, 0);
}

TEST(WorkerProcess, RunsInAnotherProcess) {
  WorkerProcess worker([](std::size_t, const std::atomic<bool>&) { return std::to_string(::getpid()); });
  worker.assign({});
  const std::optional<std::string> id = answer_of(worker);
  ASSERT_TRUE(id.has_value());
  EXPECT_NE(*id, std::to_string(::getpid()));
}

TEST(WorkerProcess, PassesNotesOnBeforeTheAnswerAndForgetsThemWithTheTask) {
  WorkerProcess worker([](std::size_t index, const std::atomic<bool>&) {
    for (std::size_t k = 0; k < index; ++k) WorkerProcess::tell("note " + std::to_string(k));
    return std::to_string(index);
  });
  worker.assign({.index = 1000});
  EXPECT_EQ(answer_of(worker), "1000");
  EXPECT_EQ(worker.note(), "note 999");
  worker.assign({.index = 0});
  EXPECT_EQ(answer_of(worker), "0");
  EXPECT_EQ(worker.note(), "");
  WorkerProcess::tell("by no worker");  // goes nowhere
}

TEST(WorkerProcess, SendsAnswersThatAreEmptyOrLargerThanAPipe) {
  WorkerProcess worker([](std::size_t index, const std::atomic<bool>&) {
    std::string text(index, '.');
    for (std::size_t k = 0; k < index; ++k) text[k] = static_cast<char>(k % 251);
    return text;
  });
  for (const std::size_t size : {0, 1, 65'536, 3'000'001}) {
    worker.assign({.index = size});
    const std::optional<std::string> answer = answer_of(worker);
    ASSERT_TRUE(answer.has_value()) << size;
    ASSERT_EQ(answer->size(), size);
    for (std::size_t k = 0; k < size; ++k) ASSERT_EQ((*answer)[k], static_cast<char>(k % 251)) << k;
  }
}

TEST(WorkerProcess, NamesTheSignalThatEndedIt) {
  WorkerProcess worker([](std::size_t, const std::atomic<bool>&) -> std::string {
    std::signal(SIGTERM, SIG_DFL);
    std::raise(SIGTERM);
    return "never";
  });
  worker.assign({});
  EXPECT_EQ(answer_of(worker), std::nullopt);
  ASSERT_TRUE(worker.has_ended());
  EXPECT_EQ(worker.how_it_ended(), "ended by signal 15 (Terminated)");
}

TEST(WorkerProcess, NamesTheExitCodeThatEndedIt) {
  WorkerProcess worker([](std::size_t, const std::atomic<bool>&) -> std::string { ::_exit(7); });
  worker.assign({});
  EXPECT_EQ(answer_of(worker), std::nullopt);
  ASSERT_TRUE(worker.has_ended());
  EXPECT_EQ(worker.how_it_ended(), "ended with exit code 7");
}

TEST(WorkerProcess, SeesAnInterruptAndIgnoresTheTerminals) {
  WorkerProcess worker([](std::size_t, const std::atomic<bool>& interrupted) -> std::string {
    std::raise(SIGINT);  // ^C goes to all processes of a terminal: for the parent to decide
    for (int wait = 0; wait < 10'000 && !interrupted; ++wait) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return interrupted ? "interrupted" : "never interrupted";
  });
  worker.assign({});
  std::this_thread::sleep_for(std::chrono::milliseconds(20));
  EXPECT_EQ(worker.receive(), std::nullopt) << "it waits";
  worker.interrupt();
  EXPECT_EQ(answer_of(worker), "interrupted");
}

TEST(WorkerProcess, IsEndedWhateverItDoes) {
  WorkerProcess worker([](std::size_t, const std::atomic<bool>&) -> std::string {
    while (true) ::pause();
  });
  worker.assign({});
  worker.end();
  ASSERT_TRUE(worker.has_ended());
  EXPECT_THAT(worker.how_it_ended(), HasSubstr("signal 9"));
}

TEST(WorkerProcess, StaysOnOneProcessorDuringAPinnedTaskOnly) {
  cpu_set_t here;
  CPU_ZERO(&here);
  ASSERT_EQ(::sched_getaffinity(0, sizeof here, &here), 0);
  WorkerProcess worker([](std::size_t, const std::atomic<bool>&) {
    cpu_set_t set;
    CPU_ZERO(&set);
    ::sched_getaffinity(0, sizeof set, &set);
    return std::to_string(CPU_COUNT(&set));
  });
  worker.assign({.pinned = true});
  EXPECT_EQ(answer_of(worker), "1");
  worker.assign({.pinned = false});
  EXPECT_EQ(answer_of(worker), std::to_string(CPU_COUNT(&here)));
}

TEST(AnswerOfAProcess, IsItsAnswerOrHowItEnded) {
  EXPECT_EQ(answer_of_a_process([] { return std::string("forty-two"); }), "forty-two");
  try {
    answer_of_a_process([]() -> std::string { ::_exit(3); });
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_STREQ(error.what(), "a process ended with exit code 3");
  }
}

}  // namespace
}  // namespace fw
