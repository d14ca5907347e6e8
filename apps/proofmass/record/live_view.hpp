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

/// What a recording looks like while it is made: on a terminal a few lines that are drawn anew in
/// place, at most ten times a second; elsewhere only what is worth a line of its own.
class LiveView {
 public:
  LiveView(std::string source, std::string file, const OutputFlags& flags);

  void opened(const std::vector<Channel>& channels);
  /// Columns of the estimates, once they are known.
  void estimating(std::vector<Channel> columns);
  void samples(const Block& block);
  void estimates(const Block& rows);
  void event(const RecordEvent& event);
  /// A line that stays.
  void say(const std::string& line);
  /// The line that stands last, drawn anew with the others.
  void guide(std::string line) { guide_ = std::move(line); }
  /// Draws what has changed, if it is time.
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
  std::deque<std::pair<Clock::time_point, std::uint64_t>> pace_;  ///< of the last seconds
};

}  // namespace proofmass::app
