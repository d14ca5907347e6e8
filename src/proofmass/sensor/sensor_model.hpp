#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "proofmass/sensor/figure.hpp"

// Model of one accelerometer: the value types shared by the analyses. Every figure carries its
// unit, its standard deviation and its origin; Figure::si() gives it in the SI unit stated with
// each member.
namespace proofmass::sensor {

/// Nominal relation between specific force and recorded value:
///
///     V = zero_g_fraction · V_s + sensitivity · (V_s / V_ref) · f,   counts = V / lsb,
///
/// with the supply V_s and the reference V_ref. A sensor without reference_supply is not
/// ratiometric: V_s / V_ref is then 1, and its zero is at zero_g_fraction · supply.
/// Source: ADXL335 datasheet rev. B, "Use with operating voltages other than 3 V".
struct Electrical {
  std::optional<Figure> supply;            ///< V_s in V, if no channel records it
  std::optional<Figure> reference_supply;  ///< V_ref in V, at which sensitivity holds
  std::string supply_channel;              ///< the recording's channel with V_s, if any
  AxisFigures sensitivity;                 ///< V/(m/s^2)
  AxisFigures zero_g_fraction;             ///< 1
  AxisFigures bandwidth;                   ///< Hz, −3 dB of the one-pole filter
  std::optional<Figure> lsb;               ///< V, or m/s^2 for a sensor with digital output
  friend bool operator==(const Electrical&, const Electrical&) = default;
};

/// The nine parameters of a calibration against gravity,
///
///     f = T diag(1/scale) (reading − bias),     T = [1  −α_yz  α_zy]
///                                                   [0   1    −α_zx]
///                                                   [0   0     1   ],
///
/// equivalently reading = diag(scale) T⁻¹ f + bias. The reading is the recorded acceleration in
/// m/s^2 if scale has no unit, in volts (for a ratiometric sensor: scaled to V_ref) if it is per
/// volt, in counts if it is per count; bias is in the unit of the reading.
/// Source: D. Tedaldi, A. Pretto, E. Menegatti, A robust and easy to implement method for IMU
/// calibration without external equipments, ICRA 2014 (their K is diag(1/scale), their bias is
/// minus ours).
struct Calibration {
  AxisFigures bias;          ///< m/s^2, V or counts
  AxisFigures scale;         ///< 1, V/(m/s^2) or counts/(m/s^2)
  AxisFigures misalignment;  ///< α_yz, α_zy, α_zx in rad
  /// Covariance of bias x y z, scale x y z, misalignment, row by row, in SI.
  std::optional<std::array<std::array<double, 9>, 9>> covariance;
  /// Standard deviation of the bias from one session to another, in the unit of bias. It is not
  /// included in bias.std and covariance, which describe the repeatability within one recording.
  AxisFigures stability;
  std::optional<Figure> dof;          ///< 1, effective degrees of freedom of the std; absent: many
  std::optional<Figure> gravity;      ///< m/s^2, assumed in the calibration
  std::optional<Figure> temperature;  ///< K, during the calibration
  /// Standard deviation in rad of the angle between the sensor's axes and its case, which is not
  /// observable in a calibration against gravity alone.
  std::optional<Figure> alignment_std;
  friend bool operator==(const Calibration&, const Calibration&) = default;
};

/// Coefficients of the Allan variance, σ²(τ) = 3 Q²/τ² + N²/τ + (2 ln2/π) B² + K² τ/3 + R² τ²/2. N
/// is the two-sided density; a datasheet's one-sided density is √2 larger.
/// Source: IEEE Std 952-1997, annex C.
struct NoiseModel {
  AxisFigures white;         ///< N in m/s^2/sqrt(Hz)
  AxisFigures quantisation;  ///< Q in m/s
  AxisFigures flicker;       ///< B in m/s^2
  AxisFigures random_walk;   ///< K in m/s^2/sqrt(s)
  AxisFigures ramp;          ///< R in m/s^3
  friend bool operator==(const NoiseModel&, const NoiseModel&) = default;
};

/// Number of figures of a gyroscope's calibration.
inline constexpr std::size_t gyroscope_figures = 21;

/// The gyroscope beside the accelerometer,
///
///     ω = R(ρ) T diag(1/scale) (reading − bias − G f),
///
/// with the calibrated specific force f in m/s^2; ω and f are in the accelerometer's frame. T has
/// the form of Calibration, R is the rotation by the vector ρ from the gyroscope's frame to the
/// accelerometer's. The reading is in rad/s if scale has no unit, else in volts or counts.
struct Gyroscope {
  AxisFigures bias;                          ///< rad/s, V or counts
  AxisFigures scale;                         ///< 1, V/(rad/s) or counts/(rad/s)
  AxisFigures misalignment;                  ///< α_yz, α_zy, α_zx in rad
  AxisFigures alignment;                     ///< ρ in rad
  std::array<AxisFigures, 3> g_sensitivity;  ///< G, row by row: (rad/s)/(m/s^2), V or counts per it
  /// Covariance of the figures in this order, in SI.
  std::optional<std::array<std::array<double, gyroscope_figures>, gyroscope_figures>> covariance;
  AxisFigures white;        ///< N in rad/s/sqrt(Hz), the angle random walk
  AxisFigures flicker;      ///< B in rad/s, the bias instability
  AxisFigures random_walk;  ///< K in rad/s/sqrt(s), the rate random walk
  friend bool operator==(const Gyroscope&, const Gyroscope&) = default;
};

/// Warm-up of the bias after power-on: a1 (1 − e^(−t/T)) + a2.
struct DriftModel {
  AxisFigures a1, a2;         ///< m/s^2
  AxisFigures time_constant;  ///< T in s
  friend bool operator==(const DriftModel&, const DriftModel&) = default;
};

/// An incremental encoder on the axle: ψ = θ + Σ cos_n cos nθ + sin_n sin nθ, n = 1 (eccentricity)
/// and 2, with the count ψ and the angle θ from where the count is 0.
struct Encoder {
  std::optional<Figure> counts_per_turn;                           ///< 1
  std::optional<Figure> once_cos, once_sin, twice_cos, twice_sin;  ///< rad
  friend bool operator==(const Encoder&, const Encoder&) = default;
};

/// A line of a sensor file that is unknown to this version, kept so that it is written back.
struct UnknownEntry {
  std::string section;  ///< empty: outside any section
  std::string key;
  std::string toml;  ///< the value, as TOML
  friend bool operator==(const UnknownEntry&, const UnknownEntry&) = default;
};

struct SensorModel {
  std::string name, serial;
  std::string date;  ///< ISO 8601
  Electrical electrical;
  Calibration calibration;
  NoiseModel noise;
  DriftModel drift;
  Gyroscope gyroscope;
  Encoder encoder;
  std::vector<UnknownEntry> unknown;
  friend bool operator==(const SensorModel&, const SensorModel&) = default;
};

}  // namespace proofmass::sensor
