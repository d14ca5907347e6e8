#pragma once

#include <optional>
#include <string>
#include <string_view>

// Definitions of the tumble test and its coefficients.
namespace proofmass::calibrate {

/// Output of one axis at one table setting.
struct TumblePosition {
  double angle_rad = 0.0;   ///< angle of the table
  double output = 0.0;      ///< m/s^2, V or counts
  double output_std = 0.0;  ///< of the output, due to noise alone; 0 if unknown
  int direction = 0;        ///< +1: approached forwards, −1: backwards, 0: not stated
  double mount_rad = 0.0;   ///< rotation of the sensor on the table
  /// 1: the pendulous axis lies in the plane of rotation with the input axis; 2: the output axis.
  int plane = 1;
  std::optional<double> time_s = {};
  std::optional<double> temperature = {};  ///< K, or °C: only differences are used
  std::string label = {};  ///< as named by the user: "row 7", "rest at 12 s"; may be empty
};

/// In the model equation
///
///     E = K1 [K0 + aᵢ + K2 aᵢ² + K3 aᵢ³ + δo aₚ − δp aₒ + Kip aᵢ aₚ + Kio aᵢ aₒ + Kpp aₚ² + Koo
///     aₒ²], aᵢ = g sin φ, aₚ = g cos φ (first plane), aₒ = g cos φ (second plane),
///
/// with the harmonics of E, B0 = U + Q and C2 = Q:
enum class TumbleQuantity {
  K1,              ///< (S1 + 3 S3)/g
  K0,              ///< K0 + Kpp g² = (B0 + C2)/K1: the bias at 0 g
  K0_up_down,      ///< K0 + K2 g² = (B0 − C2)/K1: half the sum of +1 g and −1 g
  misalignment,    ///< δo = C1/(K1 g)
  K2_minus_Kpp,    ///< −2 C2/(K1 g²)
  Kip,             ///< 2 S2/(K1 g²)
  K3,              ///< −4 S3/(K1 g³)
  third_cosine,    ///< C3/K1: 0 in the model
  K0_second,       ///< K0 + Koo g² = (B0 + C2)/K1 of the second plane
  misalignment_p,  ///< δp = −C1/(K1 g)
  K2_minus_Koo,    ///< −2 C2/(K1 g²)
  Kio,             ///< 2 S2/(K1 g²)
  drift,           ///< of the bias, per second or per position
  temperature,     ///< of the bias, per kelvin
  hysteresis,      ///< H/K1: output approached forwards minus backwards
  backlash,        ///< L/(K1 g): angle approached forwards minus backwards
  indexing_cos,    ///< a₁/(K1 g), the table's true minus indicated angle, times cos θ
  indexing_sin,    ///< b₁/(K1 g)
  indexing_cos2,   ///< a₂/(K1 g)
  indexing_sin2,   ///< b₂/(K1 g)
};

/// "K2_minus_Kpp": the name used in documents.
[[nodiscard]] std::string_view name_of(TumbleQuantity quantity);

/// Exponent of acceleration in its unit: 1 for a bias, 0 for an angle, −1 for K2, −2 for K3. K1's
/// unit is the output's per acceleration.
[[nodiscard]] int acceleration_power(TumbleQuantity quantity);

/// Four outputs a quarter turn apart, named by the input axis's angle from the horizontal in
/// degrees: 90 is upwards.
struct FourPoint {
  double E0 = 0.0, E90 = 0.0, E180 = 0.0, E270 = 0.0;
};

/// K1 = (E90 − E270)/(2g), which is K1 (1 + K3 g²) of the model; K0 + Kpp g² = (E0 + E180)/(2 K1);
/// K0 + K2 g² = (E90 + E270)/(2 K1); δo = (E0 − E180)/(2 K1 g).
struct FourPointResult {
  double K1 = 0.0;                 ///< output per m/s^2
  double bias_0g_mps2 = 0.0;       ///< K0 + Kpp g²
  double bias_up_down_mps2 = 0.0;  ///< K0 + K2 g²
  double misalignment_rad = 0.0;   ///< δo
  double K2_minus_Kpp_s2pm = 0.0;  ///< (bias_up_down − bias_0g)/g²
};

/// The closed forms of the four-point tumble. Expects E90 ≠ E270 and gravity above 0.
/// Source: IEEE Std 1293-2018, four-point tumble (by its published description).
[[nodiscard]] FourPointResult four_point(const FourPoint& readings, double gravity_mps2);

/// Scale factor and offset of the correction f = Ks (reading − offset).
struct CorrectionFactors {
  double offset = 0.0;              ///< (E0 + E180)/2, unit of the output
  double scale = 1.0;               ///< Ks = nominal/measured scale factor
  double scale_factor_error = 0.0;  ///< measured/nominal − 1
};

/// Correction from a four-point tumble and the nominal scale factor in output per m/s^2. Source: M.
/// A. Lele, thesis (2010), 5.1.2, equations 5.1 and 5.2, with corrected units.
[[nodiscard]] CorrectionFactors correction_factors(const FourPoint& readings,
                                                   double gravity_mps2,
                                                   double nominal_scale);

}  // namespace proofmass::calibrate
