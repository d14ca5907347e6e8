#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <string>
#include <utility>
#include <vector>

#include "cli/console.hpp"
#include "proofmass/core/block.hpp"
#include "proofmass/core/recording.hpp"
#include "proofmass/core/recording_log.hpp"

namespace proofmass::app {

/// Live view of a recording: on a terminal several lines redrawn in place, at most ten times a
/// second; elsewhere only events, one line each.
class LiveView {
 public:
  LiveView(std::string source, std::string file, const OutputFlags& flags);

  void opened(const std::vector<Channel>& channels);
  /// Columns of the estimates, once they are known.
  void estimating(std::vector<Channel> columns);
  void samples(const Block& block);
  void estimates(const Block& rows);
  void event(const RecordEvent& event);
  /// Prints a permanent line.
  void say(const std::string& line);
  /// Sets the last line of the redrawn ones.
  void guide(std::string line) { guide_ = std::move(line); }
  /// Redraws if enough time has passed.
  void refresh();

 private:
  [[nodiscard]] std::vector<std::string> lines() const;
  [[nodiscard]] std::string state_line() const;

  using Clock = std::chrono::steady_clock;
  std::string source_, file_, guide_;
  const OutputFlags& flags_;
  Panel panel_;
  std::vector<Channel> channels_, columns_;
  std::vector<double> last_, last_estimates_;
  std::uint64_t rows_ = 0, lost_ = 0, gaps_ = 0;
  double time_s_ = 0.0;
  Clock::time_point drawn_{};
  std::deque<std::pair<Clock::time_point, std::uint64_t>> pace_;  ///< over the last seconds
};

}  // namespace proofmass::app
