#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "proofmass/core/progress.hpp"
#include "proofmass/core/recording.hpp"
#include "proofmass/core/result.hpp"
#include "proofmass/core/units.hpp"
#include "proofmass/sensor/datasheet.hpp"
#include "proofmass/sensor/sensor_model.hpp"
#include "proofmass/simulate/wheel_motion.hpp"

// Digital twin of the thesis's rig: a wheel, accelerometers on it, an acquisition card.
namespace proofmass::simulate {

using Axes = std::array<double, 3>;

/// One three-axis accelerometer on the wheel. Its reading of the force f along its own axes is
///
///     u = (I + C) diag(scale) T⁻¹ f,   reading = u + nonlinearity · u²/full_scale + bias
///                                                + warm_up (1 − e^(−t/warm_up_time)) + walk,
///
/// with T of sensor::Calibration and the cross-axis sensitivities C off the diagonal; it is clipped
/// at ± full_scale. White noise is added.
struct RigSensor {
  double radius_m = 0.1;      ///< distance from the axle
  double position_rad = 0.0;  ///< about the axle, from the mark on the wheel
  /// Rotation of the x axis from the mark's spoke, about the axle; then about its own y, then x
  /// axis.
  double mounting_rad = 0.0, tilt_y_rad = 0.0, tilt_x_rad = 0.0;
  Axes bias_mps2{};
  Axes scale{1.0, 1.0, 1.0};
  Axes misalignment_rad{};             ///< α_yz, α_zy, α_zx
  std::array<double, 6> cross_axis{};  ///< xy, xz, yx, yz, zx, zy: of the first axis to the second
  double nonlinearity = 0.0;           ///< fraction of full scale, at full scale
  double full_scale_mps2 = *sensor::adxl335.full_scale_mps2.typ;
  Axes warm_up_mps2{0.1, 0.1, 0.1};
  double warm_up_time_s = 20.0;                 ///< 95 % of it is reached after 60 s
  Axes noise_rms_mps2{0.0184, 0.0184, 0.0184};  ///< independent from sample to sample
  Axes noise_density_mps2_rthz{};  ///< one-sided, white before the filter; adds to the above
  double bandwidth_hz = 100.0;     ///< −3 dB of the one-pole RC filter
  bool filter_signal = true;       ///< the filter delays the signal too, not only the noise
  Axes bias_walk_mps2_rts{};       ///< random walk of the bias, growth in 1 s
  double sensitivity_v_per_mps2 = 0.330 / standard_gravity_mps2;  ///< at the nominal supply
  double zero_g_fraction = 0.5;                                   ///< relative to the supply
};

/// The wheel and its support.
struct RigWheel {
  double start_angle_rad = 0.0;  ///< angle of the mark on the wheel; 0 = horizontal
  std::vector<SpeedSegment> profile{{.duration_s = 60.0, .speed_radps = 11.0 * radps_per_rpm}};
  SpeedRipple ripple{.fraction = 0.02};
  double axle_tilt_rad = 2.0 * rad_per_deg;  ///< tilt of the spin axis above the horizontal
  /// The wheel rolls on the ground below it without slip, and its hub accelerates with it: by
  /// −rolling_radius · α along the horizontal from which the angle is measured. 0 = hub at rest.
  double rolling_radius_m = 0.0;
  double shake_horizontal_rms_mps2 = 0.0, shake_vertical_rms_mps2 = 0.0;  ///< hub vibration
  double shake_bandwidth_hz = 20.0;
};

/// Supply of the ratiometric sensors: nominal + √2 ripple_rms sin(2π ripple_hz t + phase).
struct RigSupply {
  double nominal_v = 3.3;
  double ripple_rms_v = 0.0;
  double ripple_hz = 100.0;
  bool recorded = false;  ///< as a channel "supply"
};

/// The converter: steps of (max_v − min_v) / 2^bits, channels skew_s apart.
struct RigDaq {
  int bits = 0;  ///< 0: neither quantisation nor limits
  double min_v = -5.0, max_v = 5.0;
  double skew_s = 0.0;
};

enum class RigOutput {
  acceleration,  ///< m/s^2, from the nominal supply, zero and sensitivity
  voltage,
  counts,  ///< requires RigDaq::bits
};
/// Parses "acceleration", "voltage", "counts".
[[nodiscard]] std::optional<RigOutput> output_named(std::string_view name);
/// The same card, with 16 bits over the supply if it has none: counts need a quantisation step.
[[nodiscard]] RigDaq with_steps(const RigDaq& daq, double supply_v);

/// The defaults are the thesis's wheel at 11 rpm, 200 Hz, 60 s, its axle 2° off level, with sensors
/// that have noise, bias, warm-up and filter delay, and a speed with ripple.
struct RigOptions {
  std::uint64_t seed = 1;
  double rate_hz = 200.0;
  double gravity_mps2 = standard_gravity_mps2;
  int axes = 3;  ///< recorded axes per sensor: 2 or 3
  RigOutput output = RigOutput::acceleration;
  double bias_spread_mps2 = 0.3;  ///< adds a uniform draw of ± this to each bias
  /// Draws misalignment, cross-axis sensitivity, scale and nonlinearity for each sensor, uniformly
  /// within ± the ADXL335's figures, in addition to those given.
  bool datasheet_errors = false;
  RigWheel wheel;
  RigSupply supply;
  RigDaq daq;
  /// Two opposite sensors with parallel axes.
  std::vector<RigSensor> sensors{RigSensor{}, RigSensor{.position_rad = rad_per_turn / 2}};
};

struct RigResult {
  /// Channels acc1_x, acc1_y, acc1_z, acc2_x, … and, if enabled, supply.
  Recording recording;
  /// angle (rad, unwrapped: of the first sensor's x axis above the horizontal, positive from x to
  /// y), speed (rad/s), acceleration (rad/s^2), and bias1_x, … (m/s^2: with warm-up and walk), at
  /// the times of the recording's scans.
  Recording truth;
  /// The sensors as drawn from the seed. A rotation of the axes relative to the case, which a
  /// 9-parameter calibration cannot represent, is in alignment_std.
  std::vector<sensor::SensorModel> sensors;
};

/// Simulates the rig. With the wheel's angle θ, e_r outward along the mark's spoke, e_t forward and
/// e_z along the spin axis, the force on a sensor at p on the wheel is
///
///     f = (g + A_v) (sinθ cosβ, cosθ cosβ, sinβ) + A_h (cosθ, −sinθ, 0) − ω² p + α e_z × p,
///
/// β the tilt of the axle, A_h and A_v the hub's acceleration along the horizontal and upward.
/// Source: docs/methods/wheel.md.
///
/// The same options give the same numbers. Errors: invalid_argument (the message names the option).
[[nodiscard]] Result<RigResult> simulate_rig(const RigOptions& options,
                                             const Progress& progress = {});

/// The error of an invalid option, without simulating.
[[nodiscard]] Status check(const RigOptions& options);

}  // namespace proofmass::simulate
