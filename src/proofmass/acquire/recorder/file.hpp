#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "proofmass/acquire/recorder/disk_writer.hpp"
#include "proofmass/acquire/recorder/event.hpp"
#include "proofmass/acquire/source.hpp"
#include "proofmass/core/block.hpp"
#include "proofmass/core/rows.hpp"
#include "proofmass/io/mcap/recording.hpp"
#include "proofmass/signal/audit.hpp"
#include "proofmass/signal/running_audit.hpp"

namespace proofmass::acquire {

using RecordWords = std::map<std::string, std::string>;

/// Contents at the beginning of a file of a recording.
struct RecordFileHead {
  const SourceHead& source;
  const std::vector<Channel>& estimates;  ///< columns; empty without an analysis
  RecordWords metadata{};
  const std::vector<std::string>& sensor_files;
};

/// One file of a recording: its contents, and when they are synced to the disk. Its times are the
/// recording's, counted from its own first row.
class RecordFile {
 public:
  /// The beginning of the file is written when this returns. Errors: those of the creation;
  /// unreadable.
  [[nodiscard]] static Result<std::unique_ptr<RecordFile>> create(DiskWriter& disk,
                                                                  std::unique_ptr<PartFile> part,
                                                                  const RecordFileHead& head);

  /// Called before the first row: its time on the recording's clock, and time of day.
  void begin(double origin_s, std::int64_t start_ns);
  [[nodiscard]] bool has_begun() const { return has_begun_; }
  [[nodiscard]] double origin_s() const { return origin_s_; }
  /// Rows with their stamps on the recording's clock; Block::first is ignored.
  void add_rows(const Block& block);
  void add_estimates(const Block& rows);
  void add_event(const RecordEvent& event, const HostTimes& now);
  void add_clock(double time_s, const HostTimes& arrived);
  /// Starts a new segment with this name, separate from the rows before.
  void begin_stretch(const std::string& name);

  /// Passes data to the disk that have waited long enough.
  void tick(std::int64_t now_ns);
  /// Writes the audit's summary and the end of the file.
  void close(RecordWords summary);
  /// The same after a disk failure: the data written so far are kept, with an end if possible.
  [[nodiscard]] Status close_after(const DiskWriter::Failure& failure,
                                   const RecordEvent& event,
                                   RecordWords summary);

  [[nodiscard]] std::uint64_t rows() const { return rows_; }
  [[nodiscard]] double last_s() const { return last_s_; }  ///< time of the last row
  [[nodiscard]] std::uint64_t bytes() const { return mcap_.bytes(); }
  /// The audit's notes; valid after close.
  [[nodiscard]] const std::vector<Note>& notes() const { return found_->notes; }
  [[nodiscard]] const std::shared_ptr<PartFile>& part() const { return part_; }
  /// Called while the disk has no room.
  std::function<void()> while_waiting{};

 private:
  /// Rows of a topic that are not yet in a message.
  struct Waiting {
    io::mcap::RecordingEncoder::Topic topic = 0;
    Rows rows{};
    std::uint64_t written = 0;  ///< rows in messages
    std::int64_t since_ns = 0;
  };
  RecordFile(DiskWriter& disk, std::shared_ptr<PartFile> part, const RecordFileHead& head);
  [[nodiscard]] std::string front(const RecordFileHead& head);
  void append(Waiting& waiting, const Block& block);
  void flush(Waiting& waiting);
  void flush_chunk();
  void pump();
  void note_chunk();
  void audit(const Block& block);
  void add_audit(RecordWords& summary);
  void add_ends(const RecordWords& summary);
  [[nodiscard]] std::uint64_t log_ns(double time_s) const;

  DiskWriter& disk_;
  std::shared_ptr<PartFile> part_;
  io::mcap::RecordingEncoder mcap_;
  Recording head_;
  std::vector<Channel> estimate_columns_;
  signal::RunningAudit audit_;
  std::optional<signal::RecordingAudit> found_;
  DiskPiece front_;

  bool has_begun_ = false;
  double origin_s_ = 0.0;
  std::int64_t start_ns_ = 0;
  double last_s_ = 0.0;
  std::uint64_t rows_ = 0;
  double between_stretches_s_ = 0.0;
  bool begins_stretch_ = false;
  Waiting samples_, estimates_;
  std::vector<double> shifted_s_;  ///< stamps for the audit
  io::mcap::RecordingEncoder::Topic events_ = 0, clock_ = 0;
  std::optional<std::int64_t> chunk_since_ns_;
};

}  // namespace proofmass::acquire
