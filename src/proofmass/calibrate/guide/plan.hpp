#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "proofmass/calibrate/guide/rest_length.hpp"
#include "proofmass/calibrate/pose_guide.hpp"
#include "proofmass/core/view.hpp"
#include "proofmass/signal/running_rests.hpp"

// The specific part of each procedure; PoseGuide has the common part.
namespace proofmass::calibrate {

class GuidePlan {
 public:
  GuidePlan() = default;
  GuidePlan(const GuidePlan&) = delete;
  GuidePlan& operator=(const GuidePlan&) = delete;
  virtual ~GuidePlan() = default;

  /// Next instruction.
  [[nodiscard]] virtual std::string prompt() const = 0;
  /// Why a new rest with this mean is rejected; empty text: it is the previous one, not moved.
  /// nullopt: accepted.
  [[nodiscard]] virtual std::optional<std::string> refusal(const Eigen::Vector3d& mean) const = 0;
  /// Whether the current rest is long enough.
  [[nodiscard]] virtual RestVerdict judge(const signal::RunningRests& rests) = 0;
  /// The last of the poses is new. Returns what to report in addition to its own values.
  [[nodiscard]] virtual std::vector<GuideStep> take(std::vector<Pose>& poses) = 0;
  /// Message if the current rest ended after this time.
  [[nodiscard]] virtual std::string lost_words(double seconds) = 0;
  virtual void skip() = 0;
  /// Requests the latest outlying position once more; false if no position is an outlier.
  virtual bool repeat() { return false; }
  [[nodiscard]] virtual bool can_repeat() const { return false; }
  [[nodiscard]] virtual bool done() const = 0;
  /// Orientation of a measurement: "+z up, 12° to +x", "at 29.8°"; empty if unknown.
  [[nodiscard]] virtual std::string place_words(const Eigen::Vector3d& mean) const = 0;
  /// Distance of a measurement from the requested position: "34° to go"; empty if unknown.
  [[nodiscard]] virtual std::string off_words(const Eigen::Vector3d& mean) const = 0;
  [[nodiscard]] virtual std::vector<double> angles_deg() const { return {}; }
  /// Fills in what is specific to the plan; `now` comes as the mean of the sensor's output, and
  /// becomes a direction, or absent.
  virtual void draw(GuidePicture& picture) const { picture.now.reset(); }
};

[[nodiscard]] std::unique_ptr<GuidePlan> multi_position_plan(const GuideOptions& options);
[[nodiscard]] std::unique_ptr<GuidePlan> tumble_plan(const GuideOptions& options);
[[nodiscard]] std::unique_ptr<GuidePlan> still_plan(const GuideOptions& options);

}  // namespace proofmass::calibrate
