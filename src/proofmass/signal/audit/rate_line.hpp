#pragma once

#include <cstddef>
#include <optional>
#include <vector>

namespace proofmass::signal {

/// Straight line through the stamps of a recording against their sample numbers, fitted online: the
/// long-run rate and its uncertainty. Stamps are grouped into at most 256 blocks of equal size. The
/// errors of a few adjacent blocks may be correlated: clock drift, late packets.
class RateLine {
 public:
  /// number: that of the sample, missing ones counted.
  void add(double number, double stamp_s);

  struct Rate {
    double hz = 0.0;
    double std_hz = 0.0;  ///< 1.96 of it on either side contain 95 %
  };
  /// No value for fewer than 16 stamps, or if time does not increase.
  /// Source: W. K. Newey, K. D. West, Econometrica 55 (1987) 703, for the variance of a slope under
  /// correlated residuals.
  [[nodiscard]] std::optional<Rate> rate() const;

 private:
  struct Block {
    double count = 0.0, number = 0.0, stamp_s = 0.0;  ///< mean number and stamp
  };
  static void add_to(Block& block, const Block& more);

  std::vector<Block> blocks_;
  double size_ = 1.0;  ///< samples per block; the last block may be incomplete
};

}  // namespace proofmass::signal
