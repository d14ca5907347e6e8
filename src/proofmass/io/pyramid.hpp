#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "proofmass/core/block.hpp"
#include "proofmass/core/recording.hpp"
#include "proofmass/core/result.hpp"

namespace proofmass::io {

/// What a channel does within each bin of samples.
struct PyramidChannel {
  std::vector<double> min;  ///< of the finite values; NaN where there is none
  std::vector<double> max;
  std::vector<std::uint32_t> nonfinite;  ///< how many values are none
};

/// Bins of equally many samples, the last of those that are left.
struct PyramidLevel {
  std::uint64_t bin_samples = 0;
  std::vector<double> start_s;  ///< time of each bin's first sample, since the recording's first
  std::vector<PyramidChannel> channels;

  [[nodiscard]] std::size_t bins() const { return start_s.size(); }
};

/// A recording's smallest and largest values at every scale: what a picture of any stretch of it is
/// drawn from without reading its samples.
struct Pyramid {
  std::vector<std::string> names;  ///< of the channels
  std::vector<std::string> units;
  std::uint64_t samples = 0;
  double end_s = 0.0;                ///< time of the last sample
  std::vector<PyramidLevel> levels;  ///< from the finest on; each bin is four of the level before

  /// The coarsest level with a bin a pixel between two times; the finest if none has so many.
  /// Expects one level at least, and from_s < to_s.
  [[nodiscard]] const PyramidLevel& level_for(double from_s, double to_s, std::size_t pixels) const;
};

/// Builds a pyramid from a recording that comes in pieces. Memory: 20 bytes a channel and bin of
/// 256 samples. Cost: O(N).
class PyramidBuilder {
 public:
  static constexpr std::uint64_t finest_bin = 256;
  static constexpr std::uint64_t factor = 4;

  /// Takes names, units and the rate of a recording whose channels may be without values.
  explicit PyramidBuilder(const Recording& head);

  /// The samples behind those added before. Expects as many channels as in the head.
  void add(const Block& block);
  /// All levels, up to one of not more than four bins. The builder is empty afterwards.
  [[nodiscard]] Pyramid finish();

 private:
  void add_to_bins(const Block& block, std::size_t first, std::size_t count);

  TimeBase time_;
  Pyramid out_;
};

/// Stores a pyramid beside the file that it was built from, as "<path>.pyramid.npz", which NumPy
/// opens; pyramid_file.hpp says what is in it.
/// Errors: unreadable (no such file, or it is none; cannot be written), unsupported (4 GiB or
/// more).
[[nodiscard]] Status store_pyramid(const Pyramid& pyramid, const std::string& recording_path);
/// The pyramid that lies beside a recording. Errors: corrupt, unreadable; unsupported (built from
/// another state of the file, so that it is to be built anew).
[[nodiscard]] Result<Pyramid> read_pyramid(const std::string& recording_path);

}  // namespace proofmass::io
