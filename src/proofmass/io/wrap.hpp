#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace proofmass::io {

/// What a counter begins anew after: its range, in the unit of the column.
struct Wrap {
  double bottom = 0.0;
  double top = 0.0;
  std::string words;         ///< "32 bits", "the day's end"
  bool needs_whole = false;  ///< only readings that are whole numbers can come of it

  [[nodiscard]] double range() const { return top - bottom; }
};

/// The ranges that clocks have, for figures in a unit of `unit_s` seconds: 16, 24, 31 and 32 bits
/// of the figure itself, signed or not; 31 and 32 bits of ticks of a thousandth, a millionth or a
/// milliardth of it ("micros() / 1e6"); a day, a week.
class WrapFinder {
 public:
  WrapFinder() = default;
  explicit WrapFinder(double unit_s);

  /// The range that takes a clock from reading `last` to `next`, which is below it, with the
  /// shortest way in between. `usual` is what is no gap. A way that is one is believed up to 100
  /// usual steps, or up to 1/64 of the range of a count of ticks; up to half of the range that
  /// has been `seen` to run over.
  [[nodiscard]] std::optional<std::size_t> find(double last,
                                                double next,
                                                double usual,
                                                std::optional<std::size_t> seen) const;
  [[nodiscard]] const Wrap& operator[](std::size_t index) const { return all_[index]; }

 private:
  std::vector<Wrap> all_;
};

}  // namespace proofmass::io
