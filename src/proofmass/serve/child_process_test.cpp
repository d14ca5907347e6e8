#include "proofmass/serve/child_process.hpp"

#include <chrono>
#include <csignal>
#include <fstream>
#include <gtest/gtest.h>
#include <thread>

#include "proofmass/serve/job_queue.hpp"

namespace proofmass::serve::child_process_test {
namespace {

ChildCommand shell(const std::string& script) {
  return {{"/bin/sh", "-c", script}, testing::TempDir(), {"PATH=/usr/bin:/bin"}};
}

JobStatus ended(const JobQueue& queue, std::uint64_t id) {
  using namespace std::chrono_literals;
  for (int k = 0; k < 6000; ++k) {
    const JobStatus status = queue.status(id).value();
    if (status.state != JobState::waiting && status.state != JobState::running) return status;
    std::this_thread::sleep_for(10ms);
  }
  return {};
}

const auto never = [] { return false; };

TEST(ChildProcess, HandsOverLinesAndExitStatus) {
  std::vector<std::string> lines;
  auto child = ChildProcess::start(shell("echo one >&2; printf 'two' >&2; exit 3")).value();
  const ChildEnd end =
      child.follow([&](std::string_view line) { lines.emplace_back(line); }, never);
  EXPECT_EQ(lines, (std::vector<std::string>{"one", "two"}));
  EXPECT_EQ(end.status, 3);
  EXPECT_EQ(end.signal, 0);
}

TEST(ChildProcess, InheritsNoDescriptor) {
  const std::ifstream held("/dev/null");
  std::vector<std::string> lines;
  auto child = ChildProcess::start(shell("ls /proc/self/fd >&2")).value();
  (void)child.follow([&](std::string_view line) { lines.emplace_back(line); }, never);
  EXPECT_EQ(lines, (std::vector<std::string>{"0", "1", "2", "3"}));  // 3 is what ls reads
}

TEST(ChildProcess, SaysThatThereIsNoSuchProgram) {
  EXPECT_FALSE(ChildProcess::start({{"/no/such/program"}, "/", {}}));
}

TEST(JobQueue, ACrashEndsItsJobOnly) {
  JobQueue queue(2);
  const auto crash = queue.add(shell("kill -SEGV $$"), JobUrgency::asked);
  const auto fine = queue.add(shell("echo warning: odd >&2"), JobUrgency::asked);
  EXPECT_EQ(ended(queue, crash).state, JobState::failed);
  EXPECT_EQ(ended(queue, crash).end.signal, SIGSEGV);
  EXPECT_EQ(ended(queue, fine).state, JobState::done);
  EXPECT_EQ(ended(queue, fine).messages, std::vector<std::string>{"warning: odd"});
}

TEST(JobQueue, CancelsWhatRunsAndWhatWaits) {
  JobQueue queue(1);
  // The first ignores the polite request.
  const auto stubborn =
      queue.add(shell("trap '' TERM; echo up >&2; while :; do sleep 1; done"), JobUrgency::asked);
  const auto waiting = queue.add(shell("true"), JobUrgency::asked);
  while (queue.status(stubborn)->messages.empty()) std::this_thread::yield();
  queue.cancel(waiting);
  EXPECT_EQ(queue.status(waiting)->state, JobState::cancelled);
  queue.cancel(stubborn);
  EXPECT_EQ(ended(queue, stubborn).state, JobState::cancelled);
  EXPECT_EQ(ended(queue, stubborn).end.signal, SIGKILL);
}

TEST(JobQueue, RunsWhatIsAskedForBeforeTheBackground) {
  const std::string out = testing::TempDir() + "job_queue_order";
  std::remove(out.c_str());
  JobQueue queue(1);
  const auto first = queue.add(shell("sleep 0.3"), JobUrgency::asked);
  const auto last = queue.add(shell("echo background >>" + out), JobUrgency::background);
  const auto hurried = queue.add(shell("echo hurried >>" + out), JobUrgency::background);
  queue.hurry(hurried);
  (void)ended(queue, first);
  (void)ended(queue, last);
  std::ifstream in(out);
  std::string word;
  in >> word;
  EXPECT_EQ(word, "hurried");
}

TEST(JobQueue, ForgetsAJob) {
  JobQueue queue(1);
  const auto id = queue.add(shell("sleep 60"), JobUrgency::asked);
  queue.forget(id);
  EXPECT_FALSE(queue.status(id));
}

TEST(JobQueue, ReadsProgressLines) {
  JobStatus status;
  EXPECT_TRUE(take_progress("progress 42 reading a file", status));
  EXPECT_DOUBLE_EQ(status.fraction, 0.42);
  EXPECT_EQ(status.stage, "reading a file");
  EXPECT_TRUE(take_progress("progress 400", status));
  EXPECT_DOUBLE_EQ(status.fraction, 1.0);
  EXPECT_FALSE(take_progress("progress report", status));
  EXPECT_FALSE(take_progress("warning: 42", status));
}

}  // namespace
}  // namespace proofmass::serve::child_process_test
