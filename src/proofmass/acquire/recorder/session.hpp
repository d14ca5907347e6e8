#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "proofmass/acquire/clock/gap_detector.hpp"
#include "proofmass/acquire/clock/rate_watch.hpp"
#include "proofmass/acquire/clock/time_line.hpp"
#include "proofmass/acquire/recorder.hpp"
#include "proofmass/acquire/recorder/analysis_thread.hpp"
#include "proofmass/acquire/recorder/arrival_queue.hpp"
#include "proofmass/acquire/recorder/file.hpp"
#include "proofmass/acquire/recorder/latency_histogram.hpp"
#include "proofmass/acquire/recorder/level_gate.hpp"
#include "proofmass/acquire/recorder/part_file.hpp"
#include "proofmass/acquire/recorder/source_reader.hpp"
#include "proofmass/acquire/recorder/tally.hpp"

namespace proofmass::acquire {

/// One call of record(): the work of its own thread, between the reading and the writing thread.
class RecordSession {
 public:
  RecordSession(const OpenSource& open,
                const RecordOptions& options,
                const RecordWatch& watch,
                const MakeAnalysis& make_analysis,
                CreatePartFile create);

  /// Call once. See record().
  [[nodiscard]] Result<RecordSummary> run();

 private:
  // recorder/session.cpp: the main loop; recorder/end.cpp: its end.
  [[nodiscard]] Status begin();
  [[nodiscard]] bool may_try_again(const Error& error);
  [[nodiscard]] Status use(const SourceHead& head);
  void begin_watching();
  void loop();
  void take_what_is_left(QueueItem& item);
  void ask_stopped();
  void look_at_clocks();
  void work(QueueItem& item);
  void work_on_rows(QueueItem& item);
  void watch_rate(std::int64_t host_ns);
  void pair_clocks(std::int64_t host_ns);
  void reopened(const SourceHead& head);
  void end(RecordEnd how, std::string reason = {});
  void close();
  void close_file();
  void close_failed(const DiskWriter::Failure& failure);
  void forget_unwritten(const DiskWriter::Failure& failure);

  // recorder/rows.cpp: storage of rows and events.
  void keep(const Block& block, std::int64_t host_ns);
  void keep_samples(const Block& block);
  void write_estimates(const Block& rows);
  [[nodiscard]] LevelGate::Keep keepers();
  void begin_file(double origin_s);
  void rotate();
  void add_closed();
  [[nodiscard]] Status new_file(bool is_numbered);
  void report(EventKind kind, Severity severity, std::string text, std::vector<Advice> advice = {});
  void report(const RecordEvent& event);
  void report_notes(const std::vector<Note>& notes);

  // recorder/analysis.cpp: exchange with the analysis.
  void begin_analysis(std::unique_ptr<LiveAnalysis> analysis);
  void analyse(const Block& block, std::int64_t host_ns);
  void take_estimates(std::chrono::milliseconds patience);
  void keep_estimates();
  void leave_out(const Block& block);
  void report_left_out();
  void finish_analysis();
  [[nodiscard]] bool is_stop_requested() const;

  const OpenSource& open_;
  const RecordOptions& options_;
  const RecordWatch& watch_;
  const MakeAnalysis& make_analysis_;
  CreatePartFile create_;

  SourceHead head_;
  RecordTally tally_;
  LatencyHistogram latency_;
  ArrivalQueue queue_;
  std::unique_ptr<AnalysisThread> analysis_;
  std::vector<Channel> columns_;  ///< those of the analysis
  Analysed analysed_;
  std::uint64_t left_out_ = 0;  ///< rows skipped by the analysis before the next block
  DiskWriter disk_;
  std::unique_ptr<SourceReader> reader_;
  std::optional<TimeLine> line_;
  std::optional<GapDetector> hold_;
  RateWatch rate_watch_;
  std::optional<LevelGate> gate_;
  std::size_t trigger_channel_ = 0;
  std::unique_ptr<RecordFile> file_;
  /// A file passed to the disk writer in full.
  struct Closed {
    std::string path;
    std::shared_ptr<PartFile> part;
    std::uint64_t rows;
  };
  std::string file_path_;
  std::vector<Closed> closed_;

  std::optional<RecordEnd> end_;
  std::optional<std::int64_t> waiting_since_ns_;  ///< set if the source could not be opened
  std::string gone_;                              ///< reason for the loss of the source
  std::uint64_t rows_ = 0;                        ///< arrived
  std::uint64_t estimate_rows_ = 0;
  std::int64_t start_ns_ = 0;  ///< time of day of the first row
  std::int64_t next_clock_ns_ = 0, next_pair_ns_ = 0;
  std::int64_t realtime_ahead_ns_ = 0;  ///< relative to the steady clock
  std::size_t stretches_ = 0;

  std::vector<double> stamps_s_;
  std::vector<RecordEvent> events_;
};

}  // namespace proofmass::acquire
