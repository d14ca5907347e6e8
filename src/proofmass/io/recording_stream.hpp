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

/// A recording that is read a piece at a time, in memory that does not grow with it. What
/// read_recording() decides by all samples, units and the time base, is decided by the first ones;
/// stamps are mended as there.
class RecordingStream {
 public:
  class Reading;
  explicit RecordingStream(std::unique_ptr<Reading> reading);
  RecordingStream(RecordingStream&&) noexcept;
  RecordingStream& operator=(RecordingStream&&) noexcept;
  ~RecordingStream();

  /// Channels without values, in the units they have; time without stamps_s. Notes, first_line and
  /// labels are complete once next() has returned no row.
  [[nodiscard]] const Recording& head() const;
  /// Whether the blocks bring stamps; else the base is uniform, or there is none.
  [[nodiscard]] bool has_stamps() const;
  /// About how many samples there will be, if the file says.
  [[nodiscard]] std::optional<std::uint64_t> expected_samples() const;
  /// The next samples; none only at the end. The block's views hold until the next call.
  /// Errors: as read_recording(), naming the file.
  [[nodiscard]] Result<Block> next();

 private:
  std::unique_ptr<Reading> reading_;
};

/// Reads a recording whole if its table fits into `most_bytes`, else opens it as a stream. Several
/// tables that are joined, and what is resampled, are always read whole.
/// Errors: those of read_recording().
[[nodiscard]] Result<std::variant<Recording, RecordingStream>> open_recording(
    const std::string& path, const ReadOptions& options, std::uint64_t most_bytes);

}  // namespace proofmass::io
