#include "proofmass/estimate/wheel/doubts.hpp"

#include <cstddef>

namespace proofmass::estimate {
namespace {

/// Whether an encoder counted through an interval.
class Counted {
 public:
  Counted(const WheelReadings& readings,
          const std::vector<signal::CountSlip>& missed,
          const WheelFit& fit)
      : encoder_(*readings.encoder), time_s_(readings.time_s), missed_(missed), fit_(fit) {}

  bool operator()(const WheelDoubt& doubt) const {
    constexpr std::size_t nearby = 8;
    if (doubt.first < 2 * nearby || doubt.last + 2 * nearby >= time_s_.size()) return false;
    const std::size_t before = at_or_before(doubt.first - 1), after = at_or_after(doubt.last);
    if (before < nearby || after + nearby >= time_s_.size()) return false;
    const std::size_t first = at_or_before(before - nearby), last = at_or_after(after + nearby);
    if (!encoder_.has(first) || !encoder_.has(last) || misses(first, last)) return false;
    const double speed = speed_over(before, after);
    return fit_turned(before, after, speed) &&
           is_between(speed, speed_over(first, before), speed_over(after, last));
  }

 private:
  // The nearest epochs with an angle of the encoder.
  [[nodiscard]] std::size_t at_or_before(std::size_t k) const {
    while (k > 0 && !encoder_.has(k)) --k;
    return k;
  }
  [[nodiscard]] std::size_t at_or_after(std::size_t k) const {
    while (k + 1 < time_s_.size() && !encoder_.has(k)) ++k;
    return k;
  }
  [[nodiscard]] double speed_over(std::size_t from, std::size_t to) const {
    return encoder_.direction * (encoder_.angle_rad[to] - encoder_.angle_rad[from]) /
           (time_s_[to] - time_s_[from]);
  }
  [[nodiscard]] bool misses(std::size_t from, std::size_t to) const {
    return std::ranges::any_of(missed_, [&](const signal::CountSlip& slip) {
      return slip.end_s > time_s_[from] && slip.start_s < time_s_[to];
    });
  }
  [[nodiscard]] bool fit_turned(std::size_t from, std::size_t to, double speed_radps) const {
    constexpr double same_rad = 0.5;
    const double turned_rad = fit_.series.angle_rad[to] - fit_.series.angle_rad[from];
    return std::abs(turned_rad - speed_radps * (time_s_[to] - time_s_[from])) < same_rad;
  }
  // Standing is between as well: the wheel may have stopped meanwhile.
  static bool is_between(double speed, double before, double after) {
    constexpr double more_radps = 0.5, more_share = 0.3;
    const double margin = more_radps + more_share * std::max(std::abs(before), std::abs(after));
    return speed > std::min({before, after, 0.0}) - margin &&
           speed < std::max({before, after, 0.0}) + margin;
  }

  const EncoderReadings& encoder_;
  const std::vector<double>& time_s_;
  const std::vector<signal::CountSlip>& missed_;
  const WheelFit& fit_;
};

}  // namespace

void drop_counted_doubts(const WheelReadings& readings,
                         const std::vector<signal::CountSlip>& missed,
                         WheelFit& fit) {
  std::erase_if(fit.doubts, Counted(readings, missed, fit));
}

}  // namespace proofmass::estimate
