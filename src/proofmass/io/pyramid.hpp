#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "proofmass/core/block.hpp"
#include "proofmass/core/recording.hpp"
#include "proofmass/core/result.hpp"

namespace proofmass::io {

/// Statistics of a channel in each bin of samples.
struct PyramidChannel {
  std::vector<double> min;  ///< minimum of the finite values; NaN if there are none
  std::vector<double> max;
  std::vector<std::uint32_t> nonfinite;  ///< number of values that are not finite
};

/// Bins of equal size; the last holds the remaining samples.
struct PyramidLevel {
  std::uint64_t bin_samples = 0;
  std::vector<double> start_s;  ///< time of each bin's first sample, from the recording's first
  std::vector<PyramidChannel> channels;

  [[nodiscard]] std::size_t bins() const { return start_s.size(); }
};

/// A recording's minima and maxima at every scale, from which any part of it can be plotted without
/// reading its samples.
struct Pyramid {
  std::vector<std::string> names;  ///< channel names
  std::vector<std::string> units;
  std::uint64_t samples = 0;
  double end_s = 0.0;                ///< time of the last sample
  std::vector<PyramidLevel> levels;  ///< finest first; each bin is four of the previous level

  /// The coarsest level with one bin per pixel between two times; the finest if none has that many.
  /// Expects at least one level, and from_s < to_s.
  [[nodiscard]] const PyramidLevel& level_for(double from_s, double to_s, std::size_t pixels) const;
};

/// Builds a pyramid from a recording in blocks. Memory: 20 bytes per channel and bin of 256
/// samples. Cost: O(N).
class PyramidBuilder {
 public:
  static constexpr std::uint64_t finest_bin = 256;
  static constexpr std::uint64_t factor = 4;

  /// Takes names, units and the rate from a recording; its channels may be without values.
  explicit PyramidBuilder(const Recording& head);

  /// Adds the next samples. Expects as many channels as in the head.
  void add(const Block& block);
  /// All levels, up to one of at most four bins. The builder is empty afterwards.
  [[nodiscard]] Pyramid finish();

 private:
  void add_to_bins(const Block& block, std::size_t first, std::size_t count);

  TimeBase time_;
  Pyramid out_;
};

/// Stores a pyramid beside its recording, as "<path>.pyramid.npz", which NumPy opens; see
/// pyramid/file.hpp for its contents.
/// Errors: unreadable (no such file, or not a regular one; cannot be written), unsupported (4 GiB
/// or more).
[[nodiscard]] Status store_pyramid(const Pyramid& pyramid, const std::string& recording_path);
/// The pyramid beside a recording. Errors: corrupt, unreadable; unsupported (built from another
/// state of the file, so that it has to be rebuilt).
[[nodiscard]] Result<Pyramid> read_pyramid(const std::string& recording_path);

}  // namespace proofmass::io
