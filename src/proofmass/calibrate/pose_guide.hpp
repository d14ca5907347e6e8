#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "proofmass/calibrate/pose.hpp"
#include "proofmass/core/block.hpp"
#include "proofmass/signal/running_rests.hpp"

// Guides a person through a procedure, position by position, from the samples as they arrive.
namespace proofmass::calibrate {

enum class GuideProcedure {
  multi_position,  ///< by hand, all over the sphere, until bias and scale are known well enough
  tumble,  ///< a table about a horizontal axis, evenly spaced angles, the first one repeated
  still,   ///< one long rest, for noise
};

struct GuideOptions {
  GuideProcedure procedure = GuideProcedure::multi_position;
  /// Indices of the axes x, y, z of one sensor in the blocks; multi_position needs all three, the
  /// others one to three.
  std::vector<std::size_t> channels{};
  double rate_hz = 0.0;           ///< nominal; 0: from the time stamps
  std::optional<double> one_g{};  ///< output at 1 g; absent: volts, counts
  /// Target uncertainty of bias, scale and angles, as an error at 1 g.
  double target_std_g = 1e-3;
  /// multi_position: minimum number, 12 if absent; tumble: number per turn, 12 if absent.
  std::optional<std::size_t> positions{};
  double shortest_rest_s = 2.0, longest_rest_s = 20.0;
  /// still: duration. Absent: until the noise floor is reached, five minutes to an hour.
  std::optional<double> still_s{};
};

enum class GuideKind {
  prompt,      ///< what to do next
  hold_still,  ///< the sensor is at rest: do not touch it
  captured,
  redo,    ///< the position is not the one requested
  enough,  ///< the result so far
  done,    ///< finished
};

/// One sentence for a person.
struct GuideStep {
  GuideKind kind = GuideKind::prompt;
  std::string text;
  double time_s = 0.0;  ///< time of the samples it refers to
};

/// Current status, for a line that is overwritten.
struct GuideLive {
  signal::RestPhase phase = signal::RestPhase::listening;
  std::optional<double> seconds_left;  ///< of the current rest
  std::string words;                   ///< "hold still: 3 s more", "34° to go"
  bool can_repeat = false;             ///< a pose contradicts the others
};

/// An accepted position. Directions are unit vectors upwards, in the sensor's axes.
struct PlacedPose {
  std::string words;                    ///< "+z up, 12° to +x"; empty if unknown
  std::optional<Eigen::Vector3d> up{};  ///< absent until bias and scale are roughly known
  /// |f| − 1 g by a fit to the other poses, and its standard deviation due to noise, in g; absent
  /// until those determine bias, scale and angles.
  std::optional<double> residual_g{}, residual_std_g{};
  bool suspect = false;  ///< contradicts the others, and is left out
};

/// The figures of the poses so far, with their standard deviations.
struct GuideFigures {
  Eigen::Vector3d bias_g, bias_std_g;
  Eigen::Vector3d scale, scale_std;           ///< output at 1 g, less the bias
  Eigen::Vector3d angles_rad, angle_std_rad;  ///< misalignment yz, zy, zx
};

/// Standard deviation of |f| of a calibrated measurement at 1 g, by which way is up, on two Lambert
/// (equal-area) maps of the hemispheres about +z and −z. Row i and column k of a map are at v and
/// u = −1, …, 1; with r² = u² + v² the direction is 2 asin(r/√2) from its middle, towards +y as v
/// and towards +x (on the map of −z: −x) as u. Where r > 1 it lies in the other hemisphere.
struct GuideMaps {
  static constexpr Eigen::Index size = 17;
  Eigen::Matrix<double, size, size> plus_z_g, minus_z_g;
  double largest_g = 0.0;
};

/// What a picture of the procedure shows.
struct GuidePicture {
  std::string prompt;                        ///< the current instruction
  std::optional<double> held;                ///< part of the current rest that is over, 0 … 1
  std::optional<Eigen::Vector3d> now, next;  ///< orientation now, and the one wanted
  std::optional<double> error_g;             ///< largest error at 1 g of the figures so far, 1 std
  std::optional<double> next_gain;           ///< part by which the next pose reduces error_g
  std::optional<GuideFigures> figures;       ///< once nine parameters are determined
  std::optional<GuideMaps> maps;             ///< likewise
  std::vector<PlacedPose> poses;             ///< multi_position only
};

/// A rest is accepted once its mean is known to half of the target, or does not improve by waiting,
/// in two to twenty seconds. Choice of the next position:
///
/// - multi_position: the faces first, then edges and corners far from all previous ones; from nine
///   on the most informative one (next_pose). Any new position is accepted, not only the requested
///   one; one within ten degrees of another is not. The procedure ends when the requested number is
///   reached and no error at 1 g exceeds the target, or at three times that number.
/// - tumble: k · 360°/positions. The table's angle is measured by gravity as soon as the positions
///   so far determine how the axes rotate; a rest that is off by more than a third of a step or 5°
///   is rejected. Until then, and with one axis alone, each new rest counts.
/// - still: the timer restarts with each motion. Without still_s it runs until ten times the
///   averaging time at which white noise has fallen to the floor (flicker).
///
/// The steps do not depend on the block size. Memory: that of RunningRests.
class PoseGuide {
 public:
  explicit PoseGuide(const GuideOptions& options);
  PoseGuide(PoseGuide&&) noexcept;
  PoseGuide& operator=(PoseGuide&&) noexcept;
  ~PoseGuide();

  /// Processes the next samples; the first call returns the first prompt. Nothing follows `done`.
  [[nodiscard]] std::vector<GuideStep> add(const Block& block);
  /// Skips the requested position.
  [[nodiscard]] std::vector<GuideStep> skip();
  /// Requests the position that contradicts the others once more; both count, so that the fit can
  /// say which of them is wrong.
  [[nodiscard]] std::vector<GuideStep> repeat();
  [[nodiscard]] GuideLive live() const;
  [[nodiscard]] GuidePicture picture() const;
  [[nodiscard]] bool done() const;

  /// The accepted rests, in their order, with their times and means; labels as "pose 3".
  [[nodiscard]] const std::vector<Pose>& poses() const;
  /// Tumble: the table's angle at each of them.
  [[nodiscard]] std::vector<double> angles_deg() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace proofmass::calibrate
