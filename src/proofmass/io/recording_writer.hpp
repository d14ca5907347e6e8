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

/// Data written beside the samples if the format supports it.
struct WriteOptions {
  std::map<std::string, std::string> metadata{};  ///< "command": "proofmass convert …"
  std::string sensor_file{};                      ///< text of the sensor file applied; empty: none
  std::string duckdb_library{};  ///< path of libduckdb.so, for Parquet; empty: the system's
};

/// Writes a recording in blocks into a file that has no name yet.
class RecordingWriter {
 public:
  RecordingWriter() = default;
  RecordingWriter(const RecordingWriter&) = delete;
  RecordingWriter& operator=(const RecordingWriter&) = delete;
  virtual ~RecordingWriter() = default;

  /// Writes the next samples; stamps_s is empty if head.time.is_uniform().
  [[nodiscard]] virtual Status write(const Block& block) = 0;
  /// Completes the file. `recording` has the labels and other data known only at the end; its
  /// channels may be without values.
  [[nodiscard]] virtual Status finish(const Recording& recording) = 0;
};

/// Data given to a writer before the first sample.
struct WriterHead {
  /// Channels without values, time (stamps_s empty; rate, start_ns), format of the source, notes.
  const Recording& recording;
  bool has_stamps =
      false;  ///< the blocks have stamps_s; else the base is uniform, or there is none
};

}  // namespace proofmass::io
