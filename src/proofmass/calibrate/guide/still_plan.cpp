#include <algorithm>
#include <bit>
#include <cmath>
#include <fmt/format.h>

#include "proofmass/calibrate/guide/plan.hpp"
#include "proofmass/calibrate/multi_position/dwell_noise.hpp"
#include "proofmass/signal/audit/dyadic_allan.hpp"

namespace proofmass::calibrate {
namespace {

constexpr double least_s = 300.0, most_s = 3600.0;

std::string minutes_words(double seconds) {
  return seconds < 120.0 ? fmt::format("{:.0f} s", seconds)
                         : fmt::format("{:.0f} min", seconds / 60.0);
}

class StillPlan final : public GuidePlan {
 public:
  explicit StillPlan(const GuideOptions& options)
      : fixed_s_(options.still_s), ladders_(options.channels.size()) {}

  std::string prompt() const override {
    return fmt::format("Lay it down, let go of it, and leave it for {}.",
                       fixed_s_ ? minutes_words(*fixed_s_)
                                : minutes_words(least_s) + " at least, an hour at most");
  }
  std::optional<std::string> refusal(const Eigen::Vector3d&) const override { return std::nullopt; }
  RestVerdict judge(const signal::RunningRests& rests) override;
  std::vector<GuideStep> take(std::vector<Pose>& poses) override {
    done_ = true;
    const double length_s = *poses.back().end_s - *poses.back().start_s;
    return {{GuideKind::enough, fmt::format("{} of rest.", minutes_words(length_s))}};
  }
  std::string lost_words(double seconds) override {
    for (signal::DyadicAllan& ladder : ladders_) ladder.break_off();
    return fmt::format(
        "It was moved after {}: the time restarts. Earlier samples remain in the file.",
        minutes_words(seconds));
  }
  void skip() override { done_ = true; }
  bool done() const override { return done_; }
  std::string place_words(const Eigen::Vector3d&) const override { return ""; }
  std::string off_words(const Eigen::Vector3d&) const override { return ""; }

 private:
  [[nodiscard]] double wanted_s(const signal::RestState& now) const;

  std::optional<double> fixed_s_;
  std::vector<signal::DyadicAllan> ladders_;  ///< of means of blocks at rest
  std::size_t blocks_ = 0;
  double block_s_ = 0.0, last_s_ = 0.0, wanted_s_ = least_s;
  bool done_ = false;
};

RestVerdict StillPlan::judge(const signal::RunningRests& rests) {
  const signal::RestState& now = rests.state();
  if (now.newest_there) {
    for (std::size_t axis = 0; axis < ladders_.size(); ++axis)
      ladders_[axis].add(now.newest_mean[axis]);
    block_s_ = blocks_ > 0 ? std::min(block_s_, now.newest_s - last_s_) : most_s;
    last_s_ = now.newest_s;
    ++blocks_;
  }
  // So seldom that chance is not mistaken for a floor.
  if (std::has_single_bit(blocks_)) wanted_s_ = wanted_s(now);
  const double left_s = wanted_s_ - (now.until_s - now.since_s);
  return {.enough = left_s <= 0.0, .seconds_left = std::max(0.0, left_s)};
}

// Ten times the averaging time at which white noise, N²/τ, has fallen to the flicker's floor.
double StillPlan::wanted_s(const signal::RestState& now) const {
  if (fixed_s_) return *fixed_s_;
  if (now.until_s - now.since_s < 0.5 * least_s) return least_s;
  double blocks = 0.0;
  for (const signal::DyadicAllan& ladder : ladders_) {
    const DwellNoise noise = fit_dwell_noise(ladder.levels(1.0), static_cast<double>(blocks_), 0.0);
    if (!(noise.flicker > 0.0)) return most_s;
    blocks = std::max(blocks, 10.0 * noise.white / noise.flicker);
  }
  return std::clamp(blocks * block_s_, least_s, most_s);
}

}  // namespace

std::unique_ptr<GuidePlan> still_plan(const GuideOptions& options) {
  return std::make_unique<StillPlan>(options);
}

}  // namespace proofmass::calibrate
