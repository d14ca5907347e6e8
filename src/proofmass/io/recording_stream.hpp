#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <variant>

#include "proofmass/core/block.hpp"
#include "proofmass/core/recording.hpp"
#include "proofmass/core/result.hpp"
#include "proofmass/io/read_recording.hpp"

namespace proofmass::io {

/// A recording that is read in blocks, in memory independent of its length. Units and time base,
/// which read_recording() determines from all samples, are determined from the first ones; stamps
/// are corrected in the same way.
class RecordingStream {
 public:
  class Reading;
  explicit RecordingStream(std::unique_ptr<Reading> reading);
  RecordingStream(RecordingStream&&) noexcept;
  RecordingStream& operator=(RecordingStream&&) noexcept;
  ~RecordingStream();

  /// Channels without values, in their units; time without stamps_s. Notes, first_line and labels
  /// are complete once next() has returned no row.
  [[nodiscard]] const Recording& head() const;
  /// True if the blocks have stamps; else the base is uniform, or there is none.
  [[nodiscard]] bool has_stamps() const;
  /// Approximate number of samples, if the file states it.
  [[nodiscard]] std::optional<std::uint64_t> expected_samples() const;
  /// The next samples; none only at the end. The block's views are valid until the next call.
  /// Errors: as read_recording(), naming the file.
  [[nodiscard]] Result<Block> next();

 private:
  std::unique_ptr<Reading> reading_;
};

/// Reads a whole recording if its table fits into `most_bytes`, else opens it as a stream. Joined
/// tables and resampled recordings are always read as a whole.
/// Errors: those of read_recording().
[[nodiscard]] Result<std::variant<Recording, RecordingStream>> open_recording(
    const std::string& path, const ReadOptions& options, std::uint64_t most_bytes);

}  // namespace proofmass::io
