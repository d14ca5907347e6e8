#pragma once

#include <array>
#include <numbers>
#include <optional>

#include "proofmass/core/units.hpp"

// Figures of the manufacturers' datasheets, in SI, as data.
namespace proofmass::sensor {

/// One line of a datasheet's table.
struct Limits {
  std::optional<double> min, typ, max;
};

/// A three-axis analog accelerometer whose output is a fraction of its supply. Axes in the order x,
/// y, z where they differ.
struct AnalogAccelerometer {
  double reference_supply_v;  ///< supply of the figures below
  double reference_temp_c;
  Limits supply_v;
  Limits full_scale_mps2;  ///< in either direction
  Limits sensitivity_v_per_mps2;
  std::array<Limits, 3> zero_g_v;
  std::array<double, 3> noise_density_mps2_rthz;  ///< one-sided; does not scale with the supply
  double nonlinearity;                            ///< ± fraction of full scale
  double interaxis_alignment_rad;                 ///< ±
  double package_alignment_rad;                   ///< ±
  double cross_axis;                              ///< ± fraction
  double bias_tempco_mps2_per_k;                  ///< ±
  double sensitivity_tempco_per_k;                ///< ± fraction
  std::array<double, 3> bandwidth_hz;             ///< without a filter capacitor
  double filter_resistance_ohm;                   ///< in series with each output
};

/// Analog Devices ADXL335 at 3 V and 25 °C.
/// Source: Analog Devices, ADXL335 datasheet rev. B (2010), table 1.
inline constexpr AnalogAccelerometer adxl335{
    .reference_supply_v = 3.0,
    .reference_temp_c = 25.0,
    .supply_v = {.min = 1.8, .typ = {}, .max = 3.6},
    .full_scale_mps2 = {.min = 3.0 * standard_gravity_mps2,
                        .typ = 3.6 * standard_gravity_mps2,
                        .max = {}},
    .sensitivity_v_per_mps2 = {.min = 0.270 / standard_gravity_mps2,
                               .typ = 0.300 / standard_gravity_mps2,
                               .max = 0.330 / standard_gravity_mps2},
    .zero_g_v = {{{.min = 1.35, .typ = 1.5, .max = 1.65},
                  {.min = 1.35, .typ = 1.5, .max = 1.65},
                  {.min = 1.2, .typ = 1.5, .max = 1.8}}},
    .noise_density_mps2_rthz = {150e-6 * standard_gravity_mps2, 150e-6 * standard_gravity_mps2,
                                300e-6 * standard_gravity_mps2},
    .nonlinearity = 0.003,
    .interaxis_alignment_rad = 0.1 * rad_per_deg,
    .package_alignment_rad = 1.0 * rad_per_deg,
    .cross_axis = 0.01,
    .bias_tempco_mps2_per_k = 1e-3 * standard_gravity_mps2,
    .sensitivity_tempco_per_k = 1e-4,
    .bandwidth_hz = {1600.0, 1600.0, 550.0},
    .filter_resistance_ohm = 32e3,
};

/// A three-axis gyroscope with digital output.
struct DigitalGyroscope {
  double noise_density_radps_rthz;      ///< one-sided, typical
  double zero_rate_radps;               ///< ± initial offset
  double scale_tolerance;               ///< ± fraction
  double cross_axis;                    ///< ± fraction, typical
  double g_sensitivity_radps_per_mps2;  ///< static, typical
};

/// InvenSense MPU-6050 at 25 °C.
/// Source: InvenSense, MPU-6000/MPU-6050 Product Specification, PS-MPU-6000A-00 revision 3.4
/// (2013), section 6.1.
inline constexpr DigitalGyroscope mpu6050{
    .noise_density_radps_rthz = 0.005 * rad_per_deg,
    .zero_rate_radps = 20.0 * rad_per_deg,
    .scale_tolerance = 0.03,
    .cross_axis = 0.02,
    .g_sensitivity_radps_per_mps2 = 0.1 * rad_per_deg / standard_gravity_mps2,
};

/// Angle random walk N, which is two-sided, of a one-sided density of the rate: density / √2, in
/// rad/√s. Source: IEEE Std 952-1997, annex C.1.
[[nodiscard]] double angle_random_walk(double density_radps_rthz);

/// −3 dB frequency of the output with a capacitor to ground, f = 1 / (2π R C): 0.1 µF gives 50 Hz.
/// The resistance of an individual device is within ±15 %.
[[nodiscard]] constexpr double filter_bandwidth_hz(const AnalogAccelerometer& sensor,
                                                   double capacitance_f) {
  return 1.0 / (2.0 * std::numbers::pi * sensor.filter_resistance_ohm * capacitance_f);
}

/// rms of white noise of one-sided density ND after a one-pole filter: ND √(π/2 · bandwidth).
/// Source: ADXL335 datasheet, "Design trade-offs" (which rounds π/2 to 1.6).
[[nodiscard]] double filtered_noise_rms(double density_rthz, double bandwidth_hz);

/// A data acquisition card that multiplexes one converter over its channels.
struct AcquisitionCard {
  int bits_differential, bits_single_ended;
  std::array<double, 8> ranges_differential_v;  ///< ±
  double range_single_ended_v;                  ///< ±
  double rate_hz;                               ///< aggregate over all channels
  bool simultaneous;  ///< false: channels of one scan are sampled one after another
  bool antialias_filter;
};

/// National Instruments USB-6009.
/// Source: National Instruments, USB-6008/6009 User Guide and Specifications, 371303 (analog
/// input).
inline constexpr AcquisitionCard usb6009{
    .bits_differential = 14,
    .bits_single_ended = 13,
    .ranges_differential_v = {1.0, 1.25, 2.0, 2.5, 4.0, 5.0, 10.0, 20.0},
    .range_single_ended_v = 10.0,
    .rate_hz = 48e3,
    .simultaneous = false,
    .antialias_filter = false,
};

/// Quantisation step of a converter over ±range_v: 2 range / 2^bits.
[[nodiscard]] constexpr double lsb_v(double range_v, int bits) {
  return 2.0 * range_v / static_cast<double>(1ULL << bits);
}

}  // namespace proofmass::sensor
