#pragma once

#include <cstddef>
#include <string>
#include <variant>
#include <vector>

#include "cli/common_flags.hpp"
#include "proofmass/core/block.hpp"
#include "proofmass/core/progress.hpp"
#include "proofmass/core/recording.hpp"
#include "proofmass/io/recording_stream.hpp"
#include "proofmass/sensor/sensor_file.hpp"

// Sequential reading of recordings larger than memory.
namespace proofmass::app {

/// A recording in pieces, cut to --from and --to and calibrated.
class PieceSource {
 public:
  /// `flags` and `models` must outlive this. Throws Failure.
  PieceSource(io::RecordingStream stream,
              const InputFlags& flags,
              const std::vector<sensor::SensorModel>& models);

  /// Channels without values, in the units of the blocks, and time without stamps; the notes are
  /// complete after the last block.
  [[nodiscard]] const Recording& head() const { return head_; }
  [[nodiscard]] bool has_stamps() const { return stream_.has_stamps(); }
  [[nodiscard]] std::optional<std::uint64_t> expected_samples() const {
    return stream_.expected_samples();
  }
  /// The next samples; empty at the end. Throws Failure.
  [[nodiscard]] Block next();

 private:
  [[nodiscard]] Block next_in_window();
  void keep_window(const Block& raw);
  void calibrate_block(Block& block);

  io::RecordingStream stream_;
  const InputFlags& flags_;
  const std::vector<sensor::SensorModel>& models_;
  Recording head_;
  Recording piece_;  ///< the piece being cut or calibrated
  Block first_;
  bool has_first_ = false;
  std::size_t given_ = 0;        ///< samples in the window so far
  double window_start_s_ = 0.0;  ///< time of its first sample
};

/// A file of the input: whole, or in pieces if its table is larger than --memory.
[[nodiscard]] std::variant<Recording, io::RecordingStream> open_input(const std::string& file,
                                                                      const InputFlags& flags,
                                                                      const Progress& progress);

}  // namespace proofmass::app
