#pragma once

#include <cstddef>
#include <optional>
#include <vector>

namespace proofmass::signal {

/// A straight line through the stamps of a recording against their sample numbers, as these come:
/// the rate of the long run and how well it is known. Stamps are gathered in blocks, at most 256 of
/// equally many, and a few neighbouring blocks may err alike: a clock that wanders, packets that
/// are late.
class RateLine {
 public:
  /// number: of the sample, missing ones counted.
  void add(double number, double stamp_s);

  struct Rate {
    double hz = 0.0;
    double std_hz = 0.0;
  };
  /// None of fewer than 16 stamps, or where time does not ascend.
  /// Source: W. K. Newey, K. D. West, Econometrica 55 (1987) 703, for the variance of a slope under
  /// correlated residuals.
  [[nodiscard]] std::optional<Rate> rate() const;

 private:
  struct Block {
    double count = 0.0, number = 0.0, stamp_s = 0.0;  ///< mean number and stamp
  };
  static void add_to(Block& block, const Block& more);

  std::vector<Block> blocks_;
  double size_ = 1.0;  ///< samples of a block; the last one is under way
};

}  // namespace proofmass::signal
