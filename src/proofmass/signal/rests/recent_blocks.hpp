#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "proofmass/core/view.hpp"
#include "proofmass/signal/audit/lsb_detector.hpp"
#include "proofmass/signal/rests.hpp"
#include "proofmass/signal/rests/blocks.hpp"
#include "proofmass/signal/rests/noise.hpp"

namespace proofmass::signal {

/// The most recent blocks of a stream of samples.
class RecentBlocks {
 public:
  static constexpr std::size_t most = 512;
  struct Span {
    double start_s, end_s;
  };

  RecentBlocks(std::size_t axes, const RestOptions& options) : axes_(axes), options_(options) {}

  /// Returns the number of blocks completed since the last call.
  ///
  /// - If the rate is unknown, rows wait until two seconds of stamps determine it.
  /// - Stamps that jump by more than a window, or backwards, count as a gap: more than a window of
  ///   missing blocks.
  /// - A block that is noisy relative to `noise` (which may be unknown) but quiet without one
  ///   outlier is stored without it.
  [[nodiscard]] std::size_t add(double time_s,
                                View<double> values,
                                const std::optional<RestNoise>& noise);

  [[nodiscard]] const RestBlocks& blocks() const { return blocks_; }
  [[nodiscard]] const std::vector<Span>& spans() const { return spans_; }
  [[nodiscard]] std::size_t shortest() const { return shortest_; }

 private:
  std::size_t add_row(double time_s, View<double> values, const std::optional<RestNoise>& noise);
  void begin();
  void close(const std::optional<RestNoise>& noise);
  void push(const RestBlock& block, Span span);

  std::size_t axes_;
  RestOptions options_;
  std::vector<double> waiting_s_, waiting_;  ///< pending rows until the rate is known
  bool begun_ = false;
  std::size_t shortest_ = 0;  ///< minimum length of a rest, in samples
  double window_s_ = 0.0;
  RestBlocks blocks_;
  std::vector<Span> spans_;
  std::array<std::vector<double>, most_axes> open_;  ///< the incomplete block
  Span open_span_{};
  std::array<LsbDetector, most_axes> seekers_{LsbDetector(0), LsbDetector(0), LsbDetector(0)};
  PerAxis largest_{};
  std::size_t samples_ = 0;
  double last_s_ = 0.0;
};

}  // namespace proofmass::signal
