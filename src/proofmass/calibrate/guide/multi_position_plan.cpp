#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <limits>

#include "proofmass/calibrate/direction_words.hpp"
#include "proofmass/calibrate/guide/fit.hpp"
#include "proofmass/calibrate/guide/plan.hpp"
#include "proofmass/core/units.hpp"

namespace proofmass::calibrate {
namespace {

constexpr double again_rad = 10.0 * rad_per_deg;  // closer to another counts as that position again
constexpr double unmoved_rad = 1.5 * rad_per_deg;  // closer to the previous counts as not moved

/// Faces, edges and corners of a cube, in this order.
std::vector<Eigen::Vector3i> sides() {
  std::vector<Eigen::Vector3i> out{{0, 0, 1},  {0, 0, -1}, {1, 0, 0},
                                   {-1, 0, 0}, {0, 1, 0},  {0, -1, 0}};
  for (const int axes : {2, 3})
    for (int code = 0; code < 27; ++code) {
      const Eigen::Vector3i side(1 - code / 9, 1 - code / 3 % 3, 1 - code % 3);
      if (side.cwiseAbs().sum() == axes) out.push_back(side);
    }
  return out;
}

class MultiPositionPlan final : public GuidePlan {
 public:
  explicit MultiPositionPlan(const GuideOptions& options)
      : options_(options),
        fewest_(options.positions.value_or(12)),
        length_(3, options.shortest_rest_s, options.longest_rest_s) {
    if (options.one_g)
      reader_ = ForceReader{.correction = Eigen::Matrix3d::Identity() / *options.one_g};
    choose_next();
  }

  std::string prompt() const override;
  std::optional<std::string> refusal(const Eigen::Vector3d& mean) const override;
  RestVerdict judge(const signal::RunningRests& rests) override;
  std::vector<GuideStep> take(std::vector<Pose>& poses) override;
  std::string lost_words(double seconds) override {
    return fmt::format("It moved after {:.1f} s: place it there again, and let go of it.", seconds);
  }
  void skip() override {
    skipped_.push_back(next_up_);
    choose_next();
    done_ = next_words_.empty();
  }
  bool repeat() override;
  bool can_repeat() const override { return latest_suspect().has_value(); }
  bool done() const override { return done_; }
  std::string place_words(const Eigen::Vector3d& mean) const override {
    return reader_ ? direction_words(reader_->force(mean)) : "";
  }
  std::string off_words(const Eigen::Vector3d& mean) const override;
  void draw(GuidePicture& picture) const override;

 private:
  struct Nearest {
    std::size_t pose;
    double apart_rad;
  };
  /// Expects at least one pose.
  [[nodiscard]] Nearest nearest_to(const Eigen::Vector3d& mean) const;
  void choose_next();
  [[nodiscard]] std::optional<Eigen::Vector3d> up_of(const Eigen::Vector3d& mean) const;
  [[nodiscard]] PlacedPose placed(std::size_t k) const;
  [[nodiscard]] std::optional<double> std_of_rest() const;
  [[nodiscard]] std::vector<Eigen::Vector3d> taken() const;
  [[nodiscard]] std::vector<GuideStep> suspects();
  [[nodiscard]] std::optional<std::size_t> latest_suspect() const;

  GuideOptions options_;
  std::size_t fewest_;
  RestLength length_;
  std::vector<Pose> poses_;
  double noise_dof_ = 0.0;
  std::optional<ForceReader> reader_;
  std::optional<GuideFit> fit_;
  std::optional<GuideMaps> maps_;
  std::vector<Eigen::Vector3d> skipped_;
  std::vector<std::size_t> named_suspects_;
  Eigen::Vector3d next_up_ = Eigen::Vector3d::Zero();
  std::string next_words_;
  double next_gain_ = 0.0;
  std::optional<std::size_t> repeated_;  ///< the pose that is requested again
  bool done_ = false;
};

std::optional<std::size_t> MultiPositionPlan::latest_suspect() const {
  if (!fit_ || !fit_->has_nine()) return std::nullopt;
  for (std::size_t k = poses_.size(); k-- > 0;)
    if (fit_->poses()[k].suspect) return k;
  return std::nullopt;
}

bool MultiPositionPlan::repeat() {
  const std::optional<std::size_t> suspect = latest_suspect();
  if (!suspect) return false;
  repeated_ = suspect;
  next_up_ = reader_->force(poses_[*suspect].mean).normalized();
  next_words_ =
      fmt::format("place it as for pose {} again, {}", *suspect + 1, direction_words(next_up_));
  return true;
}

std::string MultiPositionPlan::prompt() const {
  std::string text =
      fmt::format("Position {}: {}, and let go of it.", poses_.size() + 1, next_words_);
  if (fit_ && fit_->has_nine() && poses_.size() >= fewest_)
    text += fmt::format(" So far the accuracy at 1 g is {:.2g} mg; the target is {:.2g} mg.",
                        1e3 * fit_->error_g(), 1e3 * options_.target_std_g);
  return text;
}

MultiPositionPlan::Nearest MultiPositionPlan::nearest_to(const Eigen::Vector3d& mean) const {
  Nearest found{0, std::numeric_limits<double>::infinity()};
  for (std::size_t k = 0; k < poses_.size(); ++k) {
    double apart = (mean - poses_[k].mean).norm();
    if (reader_) {
      const Eigen::Vector3d a = reader_->force(mean), b = reader_->force(poses_[k].mean);
      apart = std::atan2(a.cross(b).norm(), a.dot(b));
    }
    if (apart <= found.apart_rad) found = {k, apart};
  }
  if (reader_) return found;
  // A radian is half the largest possible distance; from the first two no more is known.
  double widest = 0.0;
  for (const Pose& one : poses_)
    for (const Pose& other : poses_) widest = std::max(widest, (one.mean - other.mean).norm());
  const double noise = std::sqrt(poses_.back().mean_covariance.trace());
  found.apart_rad /= std::max(0.5 * widest, 100.0 * noise);
  return found;
}

std::optional<std::string> MultiPositionPlan::refusal(const Eigen::Vector3d& mean) const {
  if (poses_.empty()) return std::nullopt;
  const Nearest nearest = nearest_to(mean);
  if (nearest.apart_rad > again_rad || nearest.pose == repeated_) return std::nullopt;
  if (nearest.pose + 1 == poses_.size() && nearest.apart_rad < unmoved_rad) return "";
  return fmt::format("That is pose {} again: turn it further.", nearest.pose + 1);
}

RestVerdict MultiPositionPlan::judge(const signal::RunningRests& rests) {
  const RestVerdict verdict = length_.judge(rests, std_of_rest());
  if (!verdict.enough) return verdict;
  length_.keep(rests);
  noise_dof_ = verdict.dof;
  return verdict;
}

std::optional<double> MultiPositionPlan::std_of_rest() const {
  if (options_.one_g) return 0.5 * options_.target_std_g * *options_.one_g;
  if (!fit_) return std::nullopt;
  return 0.5 * options_.target_std_g * fit_->one_g();
}

std::vector<GuideStep> MultiPositionPlan::take(std::vector<Pose>& poses) {
  poses_ = poses;
  fit_ = GuideFit::of(poses_, noise_dof_);
  if (fit_) reader_ = fit_->reader();
  maps_.reset();
  if (fit_ && fit_->has_nine()) maps_ = fit_->maps();
  choose_next();
  std::vector<GuideStep> steps = suspects();
  const bool nine = fit_ && fit_->has_nine();
  const bool good = nine && poses_.size() >= fewest_ && fit_->error_g() <= options_.target_std_g;
  const bool most = poses_.size() >= 3 * fewest_ || next_words_.empty();
  if (!good && !most) return steps;
  done_ = true;
  steps.push_back(
      {GuideKind::enough,
       fmt::format(
           "{} positions{}.", poses_.size(),
           nine ? fmt::format(": the accuracy at 1 g is {:.2g} mg, from bias, scale and angles",
                              1e3 * fit_->error_g())
                : std::string(" do not determine bias, scale and angles"))});
  return steps;
}

std::vector<Eigen::Vector3d> MultiPositionPlan::taken() const {
  std::vector<Eigen::Vector3d> out = skipped_;
  if (reader_)
    for (const Pose& pose : poses_) out.push_back(reader_->force(pose.mean).normalized());
  return out;
}

void MultiPositionPlan::choose_next() {
  const std::vector<Eigen::Vector3d> before = taken();
  repeated_.reset();
  next_words_.clear();
  if (fit_ && fit_->has_nine()) {
    const NextPose next = fit_->next(before);
    next_up_ = next.up;
    next_words_ = next.words;
    next_gain_ = next.gain;
    return;
  }
  // While the poses' orientations are unknown, the requested ones are assumed.
  std::size_t unseen = reader_ ? 0 : poses_.size();
  constexpr double apart_rad = 25.0 * rad_per_deg;
  for (const Eigen::Vector3i& side : sides()) {
    const Eigen::Vector3d up = side.cast<double>().normalized();
    if (unseen > 0) {
      --unseen;
      continue;
    }
    const bool near = std::ranges::any_of(
        before, [&](const Eigen::Vector3d& other) { return up.dot(other) > std::cos(apart_rad); });
    if (near) continue;
    next_up_ = up;
    next_words_ = laying_words(side);
    return;
  }
}

std::string MultiPositionPlan::off_words(const Eigen::Vector3d& mean) const {
  if (!reader_) return "";
  const Eigen::Vector3d up = reader_->force(mean).normalized();
  const double off = std::atan2(up.cross(next_up_).norm(), up.dot(next_up_));
  return fmt::format("{}; {:.0f}° from the next position", direction_words(up), off / rad_per_deg);
}

std::optional<Eigen::Vector3d> MultiPositionPlan::up_of(const Eigen::Vector3d& mean) const {
  if (!reader_) return std::nullopt;
  return reader_->force(mean).normalized();
}

PlacedPose MultiPositionPlan::placed(std::size_t k) const {
  PlacedPose pose{.words = place_words(poses_[k].mean), .up = up_of(poses_[k].mean)};
  if (!fit_ || !fit_->has_nine()) return pose;
  // The fit's unit of force is g.
  const PoseResidual& residual = fit_->poses()[k];
  pose.suspect = residual.suspect;
  pose.residual_g = residual.leave_one_out_mps2;
  if (residual.leave_one_out_mps2 && residual.studentised && *residual.studentised != 0.0)
    pose.residual_std_g = std::abs(*residual.leave_one_out_mps2 / *residual.studentised);
  return pose;
}

void MultiPositionPlan::draw(GuidePicture& picture) const {
  if (picture.now) picture.now = up_of(*picture.now);
  if (!done_ && !next_words_.empty()) picture.next = next_up_;
  if (fit_ && fit_->has_nine()) {
    picture.error_g = fit_->error_g();
    picture.figures = fit_->figures();
    picture.maps = maps_;
    if (picture.next && !repeated_) picture.next_gain = next_gain_;
  }
  for (std::size_t k = 0; k < poses_.size(); ++k) picture.poses.push_back(placed(k));
}

std::vector<GuideStep> MultiPositionPlan::suspects() {
  std::vector<GuideStep> steps;
  if (!fit_ || !fit_->has_nine()) return steps;
  for (std::size_t k = 0; k < fit_->poses().size(); ++k) {
    const bool named = std::ranges::find(named_suspects_, k) != named_suspects_.end();
    if (!fit_->poses()[k].suspect || named) continue;
    named_suspects_.push_back(k);
    steps.push_back(
        {GuideKind::redo, fmt::format("Pose {} contradicts the others and is left out; it was {}.",
                                      k + 1, place_words(poses_[k].mean))});
  }
  return steps;
}

}  // namespace

std::unique_ptr<GuidePlan> multi_position_plan(const GuideOptions& options) {
  return std::make_unique<MultiPositionPlan>(options);
}

}  // namespace proofmass::calibrate
