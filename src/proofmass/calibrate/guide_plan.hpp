#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "proofmass/calibrate/pose_guide.hpp"
#include "proofmass/calibrate/rest_length.hpp"
#include "proofmass/core/view.hpp"
#include "proofmass/signal/running_rests.hpp"

// What the procedures ask for, each in its own way; PoseGuide has what they share.
namespace proofmass::calibrate {

class GuidePlan {
 public:
  GuidePlan() = default;
  GuidePlan(const GuidePlan&) = delete;
  GuidePlan& operator=(const GuidePlan&) = delete;
  virtual ~GuidePlan() = default;

  /// What to do now.
  [[nodiscard]] virtual std::string prompt() const = 0;
  /// Why a new rest with this mean is not wanted; empty text: it is the one before, which nobody
  /// moved. nullopt: it is.
  [[nodiscard]] virtual std::optional<std::string> refusal(const Eigen::Vector3d& mean) const = 0;
  /// Is the rest that is under way long enough?
  [[nodiscard]] virtual RestVerdict judge(const signal::RunningRests& rests) = 0;
  /// The last of the poses is new. Says what is to be said of it beside its own figures.
  [[nodiscard]] virtual std::vector<GuideStep> take(std::vector<Pose>& poses) = 0;
  /// The rest that was under way ended after so long.
  [[nodiscard]] virtual std::string lost_words(double seconds) = 0;
  virtual void skip() = 0;
  [[nodiscard]] virtual bool done() const = 0;
  /// How a reading lies: "+z up, 12° to +x", "at 29.8°"; empty where that is not known.
  [[nodiscard]] virtual std::string place_words(const Eigen::Vector3d& mean) const = 0;
  /// How far a reading is from what is asked for: "34° to go"; empty where that is not known.
  [[nodiscard]] virtual std::string off_words(const Eigen::Vector3d& mean) const = 0;
  [[nodiscard]] virtual std::vector<double> angles_deg() const { return {}; }
};

[[nodiscard]] std::unique_ptr<GuidePlan> multi_position_plan(const GuideOptions& options);
[[nodiscard]] std::unique_ptr<GuidePlan> tumble_plan(const GuideOptions& options);
[[nodiscard]] std::unique_ptr<GuidePlan> still_plan(const GuideOptions& options);

}  // namespace proofmass::calibrate
