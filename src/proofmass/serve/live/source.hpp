#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "proofmass/core/result.hpp"
#include "proofmass/serve/child_process.hpp"
#include "proofmass/serve/live/frame.hpp"

namespace proofmass::serve {

/// A recorder, `record --stream`, in a process of its own: its crash ends it and nothing else, and
/// it never waits for a browser. What it wrote lately is kept for those who come later.
class LiveSource {
 public:
  /// The command's descriptors are set here. Errors: unreadable (no process can be started).
  [[nodiscard]] static Result<std::unique_ptr<LiveSource>> start(std::uint64_t id,
                                                                 ChildCommand command);
  LiveSource(const LiveSource&) = delete;
  LiveSource& operator=(const LiveSource&) = delete;
  /// Asks the recorder to close its file, and waits for that.
  ~LiveSource();

  /// Hands the frames kept so far to a listener, and then all that come.
  void listen(const std::shared_ptr<LiveListener>& listener);
  void forget(const LiveListener* listener);
  /// Asks the recorder to close its file and end.
  void stop() { stops_ = true; }
  /// Writes a line to the recorder's standard input; false if it does not take it.
  [[nodiscard]] bool say(std::string_view line);

  struct Status {
    std::map<std::string, std::string> latest{};  ///< last line of each kind that is kept: JSON
    std::vector<std::string> messages{};          ///< lines of its standard error
    std::optional<ChildEnd> end{};                ///< once the process has ended
    bool stops = false;                           ///< asked to end
  };
  [[nodiscard]] Status status() const;

 private:
  struct Pipes {
    int lines = -1, words = -1;  ///< our ends of its standard output and input
  };
  LiveSource(std::uint64_t id, ChildProcess process, Pipes pipes);
  void read_lines();
  void follow();
  void take_line(std::string line);
  void keep(const std::shared_ptr<const LiveFrame>& frame);

  const std::uint64_t id_;
  ChildProcess process_;
  Pipes pipes_;
  std::atomic<bool> stops_ = false;
  mutable std::mutex mutex_;
  std::map<std::string, std::shared_ptr<const LiveFrame>> latest_;
  std::deque<std::shared_ptr<const LiveFrame>> events_, noise_, recent_;
  std::vector<std::weak_ptr<LiveListener>> listeners_;
  std::vector<std::string> messages_;
  std::optional<ChildEnd> end_;
  std::thread reader_, follower_;
};

}  // namespace proofmass::serve
