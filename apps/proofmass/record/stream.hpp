#pragma once

#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "proofmass/core/block.hpp"
#include "proofmass/core/recording.hpp"
#include "proofmass/core/recording_log.hpp"
#include "proofmass/serve/live/line_pipe.hpp"
#include "proofmass/serve/live/lines.hpp"
#include "proofmass/serve/live/monitor.hpp"

namespace proofmass::app {

/// `record --stream`: what is recorded, as lines of JSON on standard output, which nothing else
/// writes to from here on. A reader that is slow loses lines and delays nothing.
class RecordStream {
 public:
  /// Throws Failure where standard output cannot be taken over.
  RecordStream();
  RecordStream(const RecordStream&) = delete;
  RecordStream& operator=(const RecordStream&) = delete;
  ~RecordStream();

  /// `file` is empty where none is written.
  void opened(const Recording& head, const std::string& file);
  void estimating(const std::vector<Channel>& columns) { lines_.estimating(columns); }
  void samples(const Block& block);
  void estimates(const Block& rows) { lines_.estimates(rows); }
  void event(const RecordEvent& event) { lines_.event(event); }
  /// Writes the state of a procedure, JSON, if it is due or the last.
  void guide(const std::function<std::string()>& picture, bool is_last = false);
  /// Writes what is due.
  void refresh();
  void ended(const RecordSummary& summary);
  /// True once nobody reads any more: the recording ends.
  [[nodiscard]] bool is_broken() const { return pipe_.is_broken(); }

 private:
  int descriptor_;
  serve::LinePipe pipe_;
  serve::LiveLines lines_;
  std::unique_ptr<serve::LiveMonitor> monitor_{};
  serve::LiveLines::Clock::time_point guided_{};
};

}  // namespace proofmass::app
