#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace proofmass::io {

/// The range of a wrapping counter, in the unit of the column.
struct Wrap {
  double bottom = 0.0;
  double top = 0.0;
  std::string words;         ///< "32 bits", "the day's end"
  bool needs_whole = false;  ///< only integer values can result from it

  [[nodiscard]] double range() const { return top - bottom; }
};

/// The ranges of common clocks, for values in a unit of `unit_s` seconds: 16, 24, 31 and 32 bits of
/// the value itself, signed or not; 31 and 32 bits of ticks of a thousandth, a millionth or a
/// billionth of it ("micros() / 1e6"); a day, a week.
class WrapFinder {
 public:
  WrapFinder() = default;
  explicit WrapFinder(double unit_s);

  /// The range whose wrap takes a clock from `last` to the smaller value `next` with the shortest
  /// distance. Steps up to `usual` are not gaps. A wrap that implies a longer gap is accepted up to
  /// 100 usual steps, or up to 1/64 of the range of a count of ticks; up to half of a range that
  /// has been `seen` to wrap.
  [[nodiscard]] std::optional<std::size_t> find(double last,
                                                double next,
                                                double usual,
                                                std::optional<std::size_t> seen) const;
  [[nodiscard]] const Wrap& operator[](std::size_t index) const { return all_[index]; }

 private:
  std::vector<Wrap> all_;
};

}  // namespace proofmass::io
