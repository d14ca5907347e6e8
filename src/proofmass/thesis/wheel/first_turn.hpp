#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "proofmass/core/result.hpp"
#include "proofmass/thesis/thesis_paths.hpp"
#include "proofmass/thesis/wheel/rig.hpp"
#include "proofmass/thesis/wheel_runs.hpp"

// The first revolution of a record, on which every estimator of section 5.4 is evaluated.
namespace proofmass::thesis {

/// An angle through the revolution.
struct AngleEstimate {
  std::vector<double> angle_rad, std_rad;
};

/// The direction of rotation is positive here.
struct FirstTurn {
  std::string source;
  bool simulated = false;
  bool whole = false;      ///< the record contains a full revolution
  bool from_rest = false;  ///< which starts at rest
  double gravity_mps2 = 0.0;
  double set_speed_radps = 0.0;     ///< 0: unknown
  std::vector<double> time_s = {};  ///< from the start of the motion
  /// [sensor][0 outward, 1 forward], both in the axes of the first sensor.
  std::vector<std::array<std::vector<double>, 2>> force_mps2 = {};
  std::vector<std::array<KnownBias, 2>> bias = {};  ///< along these axes
  double noise_mps2 = 0.0;                          ///< of the first sensor, per sample and axis
  bool opposite = false;  ///< the second sensor sits opposite the first, as far from the axle
  std::optional<double> radius_m = {};
  /// The truth, or else the smoothed wheel model: of the first sensor's place above the horizontal.
  std::vector<double> angle_rad = {}, speed_radps = {}, accel_radps2 = {};
  double start_speed_std_radps = 0.0;
  AngleEstimate filtered = {}, smoothed = {};  ///< of the wheel model
  /// Standard deviation of the smoothed angle less that at the first sample; empty if not computed.
  std::vector<double> moved_std_rad = {};
  std::vector<double> smoothed_accel_radps2 = {};  ///< of the wheel model
  Uncertain mean_speed_radps = {};                 ///< by the wheel model, over the fastest turn
  std::vector<std::string> notes = {};             ///< assumptions

  [[nodiscard]] std::size_t size() const { return time_s.size(); }
  /// The sample at that time; absent if the revolution is shorter.
  [[nodiscard]] std::optional<std::size_t> sample_at(double t_s) const;
  /// Path of the sensors along their circle, for an angle; empty without a radius.
  [[nodiscard]] std::vector<double> path_m(const std::vector<double>& angle_rad) const;
};

/// Runs the wheel model over the record (at most its first 20 000 samples) and cuts out the first
/// revolution. Errors: those of estimate_wheel(), too_few_samples (it hardly moves); with the
/// record's name.
[[nodiscard]] Result<FirstTurn> first_turn(const WheelRecord& record, double gravity_mps2);

/// first_turn() of a simulated record, by a single pass of the wheel model. Expects record =
/// simulate_wheel(run).
[[nodiscard]] FirstTurn first_turn(const RigRun& run, const WheelRecord& record);

enum class WheelAxis : std::size_t { outward, forward };

enum class Fusion {
  gravity_cancelled,  ///< (4.59): the second sensor turned by 180°, half the sum of the signals
  gravity_left_in,    ///< axes parallel, half the sum; of one sensor its reading
};

/// x1 and x2, or y1 and y2, as one signal. nullopt if gravity must cancel and there is only one
/// sensor, or the second is not opposite.
[[nodiscard]] std::optional<FusedReading> fuse(const FirstTurn& turn, WheelAxis axis, Fusion how);

}  // namespace proofmass::thesis
