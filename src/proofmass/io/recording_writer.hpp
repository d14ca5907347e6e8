#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <string_view>

#include "proofmass/core/block.hpp"
#include "proofmass/core/recording.hpp"
#include "proofmass/core/result.hpp"

namespace proofmass::io {

/// What is written beside the samples where a format has room for it.
struct WriteOptions {
  std::map<std::string, std::string> metadata{};  ///< "command": "proofmass convert …"
  std::string sensor_file{};  ///< text of the sensor file that was applied; empty: none
  std::string
      duckdb_library{};  ///< path of libduckdb.so, which writes Parquet; empty: the system's
};

/// Writes a recording a piece at a time into a file that does not have its name yet.
class RecordingWriter {
 public:
  RecordingWriter() = default;
  RecordingWriter(const RecordingWriter&) = delete;
  RecordingWriter& operator=(const RecordingWriter&) = delete;
  virtual ~RecordingWriter() = default;

  /// The samples that follow those written before; stamps_s is empty where head.time.is_uniform().
  [[nodiscard]] virtual Status write(const Block& block) = 0;
  /// Completes the file. Labels and what else is known at the end only are in `recording`, whose
  /// channels may be without values.
  [[nodiscard]] virtual Status finish(const Recording& recording) = 0;
};

/// What a writer is told before the first sample.
struct WriterHead {
  /// Channels without values, time (stamps_s empty; rate, start_ns), format of the source, notes.
  const Recording& recording;
  bool has_stamps =
      false;  ///< the blocks bring stamps_s; else the base is uniform, or there is none
};

}  // namespace proofmass::io
