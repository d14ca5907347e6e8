#include "proofmass/simulate/procedure/sensor_error_model.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <string>

#include "proofmass/core/random.hpp"
#include "proofmass/simulate/procedure/pose_plan.hpp"
#include "proofmass/simulate/rig/sensor_twin.hpp"

namespace proofmass::simulate {
namespace {

constexpr const char* origin = "simulated";

std::size_t pendulous(std::size_t axis) {
  return (axis + 1) % 3;
}
std::size_t output_axis(std::size_t axis) {
  return (axis + 2) % 3;
}

ProcedureSensor drawn(const ProcedureOptions& options) {
  ProcedureSensor s = options.sensor;
  Random random(options.seed, "bench sensor");
  for (std::size_t axis = 0; axis < 3; ++axis) {
    s.bias_mps2[axis] += s.bias_spread_mps2 * random.uniform();
    s.scale[axis] *= 1.0 + s.scale_spread * random.uniform();
    s.misalignment_rad[axis] += s.misalignment_spread_rad * random.uniform();
  }
  return s;
}

/// The equation in ProcedureSensor's comment.
std::array<sensor::ModelEquation, 3> equations_of(const ProcedureSensor& s) {
  const auto& [a_yz, a_zy, a_zx] = s.misalignment_rad;
  Eigen::Matrix3d T;
  T << 1.0, -a_yz, a_zy, 0.0, 1.0, -a_zx, 0.0, 0.0, 1.0;
  const Eigen::Matrix3d T_inverse = T.inverse();
  std::array<sensor::ModelEquation, 3> equations = s.equation;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto at = [&](std::size_t column) {
      return T_inverse(static_cast<Eigen::Index>(axis), static_cast<Eigen::Index>(column));
    };
    sensor::ModelEquation& e = equations[axis];
    e.K1 *= s.scale[axis];
    e.K0 += s.bias_mps2[axis] / s.scale[axis];
    e.delta_o += at(pendulous(axis));
    e.delta_p -= at(output_axis(axis));
  }
  return equations;
}

Axes constant_part(const std::array<sensor::ModelEquation, 3>& equations) {
  return {equations[0].K1 * equations[0].K0, equations[1].K1 * equations[1].K0,
          equations[2].K1 * equations[2].K0};
}

sensor::AxisFigures same_on_all(double value, const char* unit) {
  return sensor::make_axis_figures({value, value, value}, unit, origin);
}

/// An equation of u as one of gain · u + offset.
sensor::ModelEquation through(sensor::ModelEquation e, double gain, double offset) {
  e.K1 *= gain;
  e.K0 += offset / e.K1;
  return e;
}

}  // namespace

Eigen::Matrix3d linear_part(const std::array<sensor::ModelEquation, 3>& equations) {
  Eigen::Matrix3d M;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const sensor::ModelEquation& e = equations[axis];
    const auto row = static_cast<Eigen::Index>(axis);
    M(row, row) = e.K1;
    M(row, static_cast<Eigen::Index>(pendulous(axis))) = e.K1 * e.delta_o;
    M(row, static_cast<Eigen::Index>(output_axis(axis))) = -e.K1 * e.delta_p;
  }
  return M;
}

SensorErrorModel::SensorErrorModel(const ProcedureOptions& options)
    : options_(options),
      output_{options.output, options.daq,
              options.sensor.zero_g_fraction * options.supply.reference_v,
              options.sensor.sensitivity_v_per_mps2} {
  options_.sensor = drawn(options);
  reading_ = equations_of(options_.sensor);
}

double SensorErrorModel::reading_mps2(std::size_t axis, const SensorMotion& motion) const {
  const auto i = static_cast<Eigen::Index>(axis);
  const auto p = static_cast<Eigen::Index>(pendulous(axis));
  const auto o = static_cast<Eigen::Index>(output_axis(axis));
  return sensor::output(reading_[axis], {.ai_mps2 = motion.force_mps2(i),
                                         .ap_mps2 = motion.force_mps2(p),
                                         .ao_mps2 = motion.force_mps2(o),
                                         .omega_i_radps = motion.omega_radps(i),
                                         .omega_p_radps = motion.omega_radps(p),
                                         .omega_dot_o_radps2 = motion.omega_dot_radps2(o)});
}

// Zero and sensitivity scale with the supply, the noise does not.
double SensorErrorModel::volts(std::size_t axis, double reading_mps2, double noise_mps2) const {
  const ProcedureSensor& s = options_.sensor;
  const ProcedureSupply& supply = options_.supply;
  const double excess_v = supply.actual_v - supply.reference_v;
  const double clipped = std::clamp(reading_mps2, -s.full_scale_mps2, s.full_scale_mps2);
  const double on_supply =
      clipped * (1.0 + s.scale_per_v[axis] * excess_v) + s.bias_per_v_mps2pv[axis] * excess_v;
  return s.zero_g_fraction * supply.actual_v +
         s.sensitivity_v_per_mps2 * (supply.actual_v / supply.reference_v * on_supply + noise_mps2);
}

double SensorErrorModel::unrounded(double v) const {
  return options_.output == RigOutput::counts ? v / daq_lsb_v(options_.daq) : output_.written(v);
}

double SensorErrorModel::recorded(std::size_t axis, double reading_mps2, double noise_mps2) const {
  return output_.recorded(volts(axis, reading_mps2, noise_mps2));
}

double SensorErrorModel::mean_recorded(std::size_t axis,
                                       double reading_mps2,
                                       double noise_mps2) const {
  return unrounded(volts(axis, reading_mps2, noise_mps2));
}

double SensorErrorModel::noise_gain() const {
  return mean_recorded(0, 0.0, 1.0) - mean_recorded(0, 0.0, 0.0);
}

bool SensorErrorModel::feels_rates() const {
  return std::ranges::any_of(
      reading_, [](const sensor::ModelEquation& e) { return e.Kspin != 0.0 || e.Kang != 0.0; });
}

std::array<sensor::ModelEquation, 3> SensorErrorModel::recorded_equations() const {
  std::array<sensor::ModelEquation, 3> equations = reading_;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double offset = mean_recorded(axis, 0.0, 0.0);
    equations[axis] = through(reading_[axis], mean_recorded(axis, 1.0, 0.0) - offset, offset);
  }
  return equations;
}

sensor::SensorModel SensorErrorModel::model() const {
  const ProcedureSensor& s = options_.sensor;
  const ProcedureSupply& supply = options_.supply;
  sensor::SensorModel model;
  model.name = "simulated sensor";
  model.serial = "seed " + std::to_string(options_.seed);
  model.electrical.supply = sensor::make_figure(supply.actual_v, "V", origin);
  model.electrical.reference_supply = sensor::make_figure(supply.reference_v, "V", origin);
  if (supply.recorded) model.electrical.supply_channel = "supply";
  model.electrical.sensitivity = same_on_all(s.sensitivity_v_per_mps2, "V/(m/s^2)");
  model.electrical.zero_g_fraction = same_on_all(s.zero_g_fraction, "1");
  if (options_.daq.bits > 0)
    model.electrical.lsb = sensor::make_figure(daq_lsb_v(options_.daq), "V", origin);

  // An output in m/s² is calibrated directly; volts and counts are first converted by [electrical],
  // which removes the ratiometric part.
  std::array<sensor::ModelEquation, 3> equations = recorded_equations();
  const double excess_v = supply.actual_v - supply.reference_v;
  if (options_.output != RigOutput::acceleration)
    for (std::size_t axis = 0; axis < 3; ++axis)
      equations[axis] = through(reading_[axis], 1.0 + s.scale_per_v[axis] * excess_v,
                                s.bias_per_v_mps2pv[axis] * excess_v);
  const Eigen::Matrix3d M = linear_part(equations);
  model.calibration = calibration_of(M, constant_part(equations));
  model.calibration.gravity = sensor::make_figure(options_.gravity_mps2, "m/s^2", origin);
  model.calibration.alignment_std = sensor::make_figure(unseen_turn_rad(M), "rad", origin);

  Axes white = s.noise_rms_mps2;
  for (double& n : white) n /= std::sqrt(options_.rate_hz);
  model.noise.white = sensor::make_axis_figures(white, "m/s^2/sqrt(Hz)", origin);
  model.noise.flicker = sensor::make_axis_figures(s.flicker_mps2, "m/s^2", origin);
  model.noise.random_walk =
      sensor::make_axis_figures(s.bias_walk_mps2_rts, "m/s^2/sqrt(s)", origin);
  model.noise.ramp = sensor::make_axis_figures(s.ramp_mps2ps, "m/s^3", origin);
  return model;
}

BenchDrift::BenchDrift(const ProcedureOptions& options, std::size_t axis, std::size_t trial)
    : sensor_(options.sensor),
      axis_(axis),
      noise_({options.sensor.flicker_mps2[axis], options.sensor.bias_walk_mps2_rts[axis]},
             Random(session_seed(options), "bench drift", 3 * trial + axis)) {}

double BenchDrift::at(double t_s) {
  if (t_s > now_s_) noise_.pass(t_s - now_s_);
  now_s_ = t_s;
  return noise_.value_mps2() -
         sensor_.warm_up_mps2[axis_] * std::expm1(-t_s / sensor_.warm_up_time_s) +
         sensor_.ramp_mps2ps[axis_] * t_s;
}

double BenchDrift::mean_over(double start_s, double end_s) {
  if (start_s > now_s_) noise_.pass(start_s - now_s_);
  now_s_ = end_s;
  const double T = sensor_.warm_up_time_s, d = end_s - start_s;
  const double cold = std::exp(-start_s / T) * -std::expm1(-d / T) * T / d;
  return noise_.mean_over(d) + sensor_.warm_up_mps2[axis_] * (1.0 - cold) +
         sensor_.ramp_mps2ps[axis_] * 0.5 * (start_s + end_s);
}

}  // namespace proofmass::simulate
