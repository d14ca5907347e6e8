#include "proofmass/thesis/bias/bias_scale_limits.hpp"

#include <cmath>
#include <fmt/format.h>
#include <string>

#include "proofmass/report/wording.hpp"
#include "proofmass/sensor/datasheet.hpp"
#include "proofmass/sensor/gravity.hpp"
#include "proofmass/thesis/bias/tumble_parts.hpp"

namespace proofmass::thesis {
namespace {

using report::significant;
using sensor::adxl335;

constexpr double g = standard_gravity_mps2, supply_v = 3.3;
/// Dalhousie University, Halifax.
constexpr sensor::Place halifax{.latitude_rad = 44.64 * rad_per_deg, .height_m = 30.0};

// Standard deviation of a mean over a dwell, in white noise.
double mean_std_mps2(double dwell_s) {
  return adxl335.noise_density_mps2_rthz[0] / std::sqrt(2.0 * dwell_s);
}

std::vector<std::string> row(const std::string& what, double bias_mps2, double scale) {
  const auto words = [](double value) {
    return value == 0.0 ? std::string("none") : significant(value, 2);
  };
  return {what, words(bias_mps2 / mg_mps2), words(100.0 * scale)};
}

}  // namespace

double white_dwell_s(double scale_error) {
  const double density = adxl335.noise_density_mps2_rthz[0] * 1.96 / (2.0 * g * scale_error);
  return density * density;
}

double standard_gravity_scale_error() {
  return sensor::gravity_mps2(halifax) / g - 1.0;
}

std::vector<Finding> limit_findings() {
  const double scale = printed_x().scale_error;
  const ShownUnit percent{"%", 0.01};
  return {{.key = "gravity_scale_error",
           .label = "Scale-factor error that standard gravity makes in Halifax",
           .si_unit = "",
           .shown = percent,
           .ours = Uncertain{standard_gravity_scale_error(), sensor::gravity_anomaly_std_mps2 / g}},
          {.key = "dwell_for_scale_x",
           .label = "Time at each position until 0.0041 % stands out of white noise",
           .si_unit = "s",
           .shown = {"s"},
           .ours = Uncertain{white_dwell_s(scale)}},
          {.key = "supply_for_scale_x",
           .label = "Change of the supply that looks like 0.0041 %",
           .si_unit = "V",
           .shown = {"mV", 1e-3},
           .ours = Uncertain{scale * supply_v}},
          {.key = "warmth_for_scale_x",
           .label = "Change of temperature that may look like 0.0041 %",
           .si_unit = "K",
           .shown = {"K"},
           .ours = Uncertain{scale / adxl335.sensitivity_tempco_per_k}},
          {.key = "angle_for_bias",
           .label = "Error of each set angle that moves a bias by 0.01 mg",
           .si_unit = "rad",
           .shown = {"°", rad_per_deg},
           .ours = Uncertain{std::sqrt(2.0) * 1e-5}}};
}

report::Table limits_table(double gravity_mps2) {
  constexpr double dwell_s = 60.0, angle_rad = 0.1 * rad_per_deg, tilt_rad = 0.5 * rad_per_deg;
  constexpr double supply_step_v = 1e-3;
  const double noise_mps2 = mean_std_mps2(dwell_s) / std::sqrt(2.0);
  const double half_step_v = 0.5 * sensor::lsb_v(5.0, sensor::usb6009.bits_differential);
  const double sense_v =
      supply_v / adxl335.reference_supply_v * *adxl335.sensitivity_v_per_mps2.typ;
  return {
      .caption = "What moves the figures of a four-point tumble",
      .head = {"Effect", "Bias (mg)", "Scale factor (%)"},
      .rows = {
          row("white noise of 150 µg/√Hz, 60 s a position", noise_mps2, noise_mps2 / gravity_mps2),
          row("each angle set to 0.1°", gravity_mps2 * angle_rad / std::sqrt(2.0),
              0.5 * angle_rad * angle_rad),
          row("axle 0.5° out of level", 0.0, -0.5 * tilt_rad * tilt_rad),
          row("standard gravity for that of Halifax", 0.0, standard_gravity_scale_error()),
          row("gravity's anomaly, one standard deviation", 0.0,
              sensor::gravity_anomaly_std_mps2 / gravity_mps2),
          row("supply 1 mV higher", 0.5 * supply_step_v / sense_v, supply_step_v / supply_v),
          row("1 K warmer, typically", adxl335.bias_tempco_mps2_per_k,
              adxl335.sensitivity_tempco_per_k),
          row("half a step of 14 bits over ±5 V, where no noise blurs it", half_step_v / sense_v,
              half_step_v / sense_v / gravity_mps2)}};
}

}  // namespace proofmass::thesis
