#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <span>
#include <vector>

#include "proofmass/acquire/source.hpp"

namespace proofmass::acquire {

/// Lays beside each other what several sensors of one device measured, each at its own instants:
/// a row is a sample of the first, the leader, with what the others had at its instant, on the
/// line between their samples before and behind. Samples at the very instant are taken as they
/// are; a hole of more than a second is not bridged.
class SensorMerge {
 public:
  /// How many values a sample of each sensor has.
  explicit SensorMerge(const std::vector<std::size_t>& widths);

  /// Clocks are read within ±146 years, so that two readings can be subtracted.
  static constexpr std::int64_t largest_ns = 4'611'686'018'427'387'903;

  /// A sample, with the device's clock, which may be set back; else in its order.
  void add(std::size_t sensor, std::int64_t device_ns, std::span<const double> values);
  /// Appends to `out` the rows that are settled: those for which each sensor has a sample behind.
  /// Nobody is waited for longer than a second of the leader's time: NaN stands for its values.
  void take(Arrival& out);

  /// Samples from before all sensors had begun, which are in no row; rows with NaN for want of a
  /// sensor: told the first, tenth, hundredth … time.
  [[nodiscard]] std::vector<Note> take_notes();

 private:
  /// An instant: readings of the clock between two of its jumps back, and which they are.
  struct Instant {
    std::uint64_t era = 0;
    std::int64_t ns = 0;
    friend auto operator<=>(const Instant&, const Instant&) = default;
  };
  struct Track {
    std::size_t width = 0;
    std::deque<Instant> instants{};
    std::deque<double> values{};  ///< `width` for each
    Instant newest{0, -largest_ns};
    void drop_first();
  };

  [[nodiscard]] std::uint64_t era_of(const Track& track, std::int64_t ns) const;
  [[nodiscard]] bool is_settled(const Instant& row) const;
  [[nodiscard]] bool is_too_late(const Instant& row) const;
  [[nodiscard]] bool have_all_begun(const Instant& row) const;
  void put_row(const Instant& row, Arrival& out);
  [[nodiscard]] static bool put_values(const Track& track,
                                       const Instant& row,
                                       Arrival& out,
                                       std::size_t column);

  std::vector<Track> tracks_;
  bool has_begun_ = false;
  std::uint64_t passed_over_ = 0, incomplete_ = 0, told_at_ = 1;
};

}  // namespace proofmass::acquire
