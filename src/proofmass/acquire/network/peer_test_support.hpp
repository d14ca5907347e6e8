#pragma once

#include <chrono>
#include <csignal>
#include <cstdio>
#include <fcntl.h>
#include <gtest/gtest.h>
#include <memory>
#include <optional>
#include <spawn.h>
#include <string>
#include <string_view>
#include <sys/wait.h>
#include <unistd.h>
#include <utility>
#include <vector>

#include "proofmass/acquire/source.hpp"

namespace proofmass::acquire {

/// A child process that runs during the lifetime of this object and prints a port on its first
/// line.
class PeerProcess {
 public:
  explicit PeerProcess(std::vector<std::string> words) {
    int in[2], out[2];
    if (pipe2(in, O_CLOEXEC) != 0 || pipe2(out, O_CLOEXEC) != 0) return;
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, in[0], STDIN_FILENO);
    posix_spawn_file_actions_adddup2(&actions, out[1], STDOUT_FILENO);
    std::vector<char*> argv;
    for (std::string& word : words) argv.push_back(word.data());
    argv.push_back(nullptr);
    if (posix_spawnp(&pid_, argv.front(), &actions, nullptr, argv.data(), environ) != 0) pid_ = -1;
    posix_spawn_file_actions_destroy(&actions);
    close(in[0]);
    close(out[1]);
    stdin_ = in[1];
    if (std::FILE* const output = fdopen(out[0], "r")) {
      if (pid_ > 0 && std::fscanf(output, "%*s %hu", &port_) != 1) port_ = 0;
      std::fclose(output);
    }
  }
  PeerProcess(const PeerProcess&) = delete;
  PeerProcess& operator=(const PeerProcess&) = delete;
  ~PeerProcess() { end(); }

  void end() {
    if (stdin_ >= 0) close(stdin_);
    stdin_ = -1;
    if (pid_ <= 0) return;
    kill(pid_, SIGKILL);
    waitpid(pid_, nullptr, 0);
    pid_ = -1;
  }
  /// 0 if it could not be started.
  [[nodiscard]] unsigned short port() const { return port_; }

 private:
  pid_t pid_ = -1;
  int stdin_ = -1;
  unsigned short port_ = 0;
};

/// rig/phones/peer.py
inline std::vector<std::string> phone_peer(const std::string& kind,
                                           std::vector<std::string> faults) {
  std::vector<std::string> words{"python3", PROOFMASS_SOURCE_DIR "/rig/phones/peer.py",
                                 "--until-stdin-ends", "--" + kind, "0"};
  words.insert(words.end(), faults.begin(), faults.end());
  return words;
}

/// A substitute for a phone's app, and the source that reads it.
class PhoneSource : public ::testing::Test {
 protected:
  explicit PhoneSource(std::string kind) : kind_(std::move(kind)) {}

  /// Errors: device (the peer could not be started), and those of open_source().
  Result<std::unique_ptr<Source>> open(std::vector<std::string> faults,
                                       const std::string& query = "") {
    peer_.emplace(phone_peer(kind_, std::move(faults)));
    if (peer_->port() == 0)
      return Error{Errc::device, "the peer does not start: is python3 there?"};
    return open_source(kind_ + "://127.0.0.1:" + std::to_string(peer_->port()) + query,
                       {.patience = std::chrono::seconds(60)});
  }
  std::optional<PeerProcess> peer_;

 private:
  std::string kind_;
};

#define OPEN(name, ...)                \
  const auto name = open(__VA_ARGS__); \
  ASSERT_TRUE(name) << name.error().message

/// Everything a source returned until it had `rows` rows, failed, or a minute was over.
struct Taken {
  std::vector<std::vector<double>> channels;
  std::vector<std::int64_t> device_ns{};
  std::uint64_t lost = 0;
  std::string notes{};  ///< one per line
  std::string error{};
};

inline Taken take_rows(Source& source, std::size_t rows) {
  Taken taken{.channels =
                  std::vector<std::vector<double>>(source.head().recording.channels.size())};
  Arrival arrival;
  const std::int64_t until_ns = host_now_ns() + 60'000'000'000;
  while (taken.device_ns.size() < rows && host_now_ns() < until_ns) {
    const auto arrived = source.read(arrival, std::chrono::milliseconds(100));
    for (const Note& note : arrival.notes) taken.notes += note.text + "\n";
    if (!arrived) {
      taken.error = arrived.error().message;
      break;
    }
    for (std::size_t c = 0; c < taken.channels.size(); ++c)
      taken.channels[c].insert(taken.channels[c].end(), arrival.channels[c].begin(),
                               arrival.channels[c].end());
    taken.device_ns.insert(taken.device_ns.end(), arrival.device_ns.begin(),
                           arrival.device_ns.end());
    taken.lost += arrival.lost_before;
  }
  return taken;
}

inline ::testing::AssertionResult says(std::string_view text, std::string_view part) {
  if (text.find(part) != std::string_view::npos) return ::testing::AssertionSuccess();
  return ::testing::AssertionFailure() << "expected \"" << part << "\" in: " << text;
}

/// Increments of the row numbers in channel 0 that are not 1; empty if all are 1.
inline std::string broken_steps(const std::vector<double>& counter) {
  std::string output;
  for (std::size_t k = 1; k < counter.size(); ++k)
    if (counter[k] != counter[k - 1] + 1.0)
      output += std::to_string(counter[k - 1]) + " to " + std::to_string(counter[k]) + "\n";
  return output;
}

}  // namespace proofmass::acquire
