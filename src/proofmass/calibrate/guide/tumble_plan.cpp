#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>

#include "proofmass/calibrate/guide/plan.hpp"
#include "proofmass/calibrate/guide/turned_axes.hpp"
#include "proofmass/core/number_words.hpp"
#include "proofmass/core/units.hpp"

namespace proofmass::calibrate {
namespace {

class TumblePlan final : public GuidePlan {
 public:
  explicit TumblePlan(const GuideOptions& options)
      : options_(options),
        positions_(options.positions.value_or(12)),
        length_(options.channels.size(), options.shortest_rest_s, options.longest_rest_s),
        axes_(options.channels.size(), options.one_g) {}

  std::string prompt() const override {
    const bool closing = next_ == positions_;
    return fmt::format("Position {} of {}: turn the table to {:g}°{}.", next_ + 1, positions_ + 1,
                       closing ? 0.0 : next_deg(), closing ? " once more, going on as before" : "");
  }
  std::optional<std::string> refusal(const Eigen::Vector3d& mean) const override;
  RestVerdict judge(const signal::RunningRests& rests) override {
    const auto one_g = axes_.one_g();
    RestVerdict verdict = length_.judge(
        rests, one_g ? std::optional(0.5 * options_.target_std_g * *one_g) : std::nullopt);
    if (verdict.enough) length_.keep(rests);
    noise_ = Eigen::Vector3d(rests.state().noise_std.data()).norm();
    return verdict;
  }
  std::vector<GuideStep> take(std::vector<Pose>& poses) override {
    angles_deg_.push_back(next_deg());
    last_ = poses.back().mean;
    axes_.add(next_deg() * rad_per_deg, *last_);
    ++next_;
    if (!done()) return {};
    return {{GuideKind::enough, fmt::format("{} positions, the turn is closed.", poses.size())}};
  }
  std::string lost_words(double seconds) override {
    return fmt::format("It moved after {:.1f} s: leave it at {:g}°.", seconds,
                       std::fmod(next_deg(), 360.0));
  }
  void skip() override { ++next_; }
  bool done() const override { return next_ > positions_; }
  std::string place_words(const Eigen::Vector3d& mean) const override {
    const std::optional<double> off = off_deg(mean);
    return off ? fmt::format("at {:.1f}° by gravity", shown(next_deg() - *off)) : "";
  }
  std::string off_words(const Eigen::Vector3d& mean) const override {
    const std::optional<double> off = off_deg(mean);
    return off ? fmt::format("{}° to go to {:g}°", fixed(*off, 1), std::fmod(next_deg(), 360.0))
               : "";
  }
  std::vector<double> angles_deg() const override { return angles_deg_; }

 private:
  [[nodiscard]] double step_deg() const { return 360.0 / static_cast<double>(positions_); }
  [[nodiscard]] double next_deg() const { return step_deg() * static_cast<double>(next_); }
  /// Remaining rotation to the next setting, within ±180°.
  [[nodiscard]] std::optional<double> off_deg(const Eigen::Vector3d& mean) const {
    const std::optional<double> angle_rad = axes_.angle_rad(mean);
    if (!angle_rad) return std::nullopt;
    return std::remainder(next_deg() - *angle_rad / rad_per_deg, 360.0);
  }
  static double shown(double angle_deg) {
    const double turn = std::fmod(angle_deg, 360.0);
    return turn < -0.05 ? turn + 360.0 : turn;
  }

  GuideOptions options_;
  std::size_t positions_, next_ = 0;
  RestLength length_;
  TurnedAxes axes_;
  std::vector<double> angles_deg_;
  std::optional<Eigen::Vector3d> last_;
  double noise_ = 0.0;  ///< of one sample
};

std::optional<std::string> TumblePlan::refusal(const Eigen::Vector3d& mean) const {
  if (!last_) return std::nullopt;
  const std::optional<double> off = off_deg(mean);
  if (!off) {
    // A change below half the noise of a sample is not a rotation of the table.
    if ((mean - *last_).norm() < 0.5 * noise_) return "";
    return std::nullopt;
  }
  const double tolerance = std::min(5.0, step_deg() / 3.0);
  if (std::abs(*off) <= tolerance) return std::nullopt;
  if (std::abs(*off - (next_deg() - angles_deg_.back())) <= tolerance) return "";
  return fmt::format("That is {:.1f}°: turn it {} by {:.1f}° to {:g}°.", shown(next_deg() - *off),
                     *off > 0.0 ? "on" : "back", std::abs(*off), std::fmod(next_deg(), 360.0));
}

}  // namespace

std::unique_ptr<GuidePlan> tumble_plan(const GuideOptions& options) {
  return std::make_unique<TumblePlan>(options);
}

}  // namespace proofmass::calibrate
