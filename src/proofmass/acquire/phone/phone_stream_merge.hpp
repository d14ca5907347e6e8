#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <span>
#include <vector>

#include "proofmass/acquire/source.hpp"

namespace proofmass::acquire {

/// Merges the samples of several sensors of one device, each with its own sample times. A row is a
/// sample of the first sensor, the leader, with the other sensors interpolated linearly at its
/// time. Samples at exactly that time are taken unchanged; a gap of more than a second is not
/// interpolated.
class PhoneStreamMerge {
 public:
  /// Number of values per sample of each sensor.
  explicit PhoneStreamMerge(const std::vector<std::size_t>& widths);

  /// Clock values are limited to ±146 years, so that two can be subtracted.
  static constexpr std::int64_t largest_ns = 4'611'686'018'427'387'903;

  /// A sample, with the device's clock, which may be set back; otherwise in order.
  void add(std::size_t sensor, std::int64_t device_ns, std::span<const double> values);
  /// Appends to `out` the rows that are final: those for which each sensor has a later sample. No
  /// sensor is awaited for more than a second of the leader's time; its values are then NaN.
  void take(Arrival& out);

  /// Samples from before all sensors had started, which are in no row; rows with NaN because a
  /// sensor is missing: reported the first, tenth, hundredth … time.
  [[nodiscard]] std::vector<Note> take_notes();

 private:
  /// A clock value and the number of backward jumps before it.
  struct Instant {
    std::uint64_t era = 0;
    std::int64_t ns = 0;
    friend auto operator<=>(const Instant&, const Instant&) = default;
  };
  struct Track {
    std::size_t width = 0;
    std::deque<Instant> instants{};
    std::deque<double> values{};  ///< `width` per sample
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
  std::uint64_t skipped_ = 0, incomplete_ = 0, noted_at_ = 1;
};

}  // namespace proofmass::acquire
