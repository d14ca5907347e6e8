#include "proofmass/estimate/motor/conclude.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "proofmass/core/statistics.hpp"

namespace proofmass::estimate::motor {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double normal_95 = 1.959964;
// A positive figure is determined if its relative standard deviation is below this,
constexpr double determined_relative = 0.3;
// and a part of the friction if its standard deviation is below this share of the largest torque.
constexpr double determined_share = 0.1;

// Relative standard deviation of the gains of the channels for voltage and current, and of what the
// regression takes as exact: no recording shows it.
constexpr double channel_gain_std = 5e-4;

// Standard deviation of ln ωs because friction near a rest is not a function of the speed alone.
constexpr double curve_std = 0.015;

const char* const no_current =
    "no current is used: only ratios to the torque constant and the resistance show";
const char* const no_motor_angle =
    "no current is used, without which the motor's angle in the gap of the gear is not known";
const char* const no_reversal =
    "the gear bore on one flank throughout: the recording needs a reversal of the load";
const char* const one_speed =
    "the recorded speeds do not separate it from the other friction terms: record several speeds";
const char* const no_slow_motion =
    "no slow motion near a rest shows the rise of friction: record slow reversals";
const char* const steady = "the speed changes too little";

// Place of a coefficient of the mechanical equation.
constexpr Index in_joint(Mechanical i) {
  return Index{electrical_count} + Index{i};
}
constexpr Index of_drive = in_joint(drive), of_viscous = in_joint(viscous),
                of_coulomb = in_joint(coulomb), of_stribeck = in_joint(stribeck),
                of_stribeck_speed = in_joint(stribeck_speed),
                of_unbalance_cos = in_joint(unbalance_cos),
                of_unbalance_sin = in_joint(unbalance_sin);

double torque_constant(const VectorXd& p) {
  return 1.0 / p(per_constant);
}
double inertia(const VectorXd& p) {
  return torque_constant(p) / p(of_drive);
}
double hypotenuse(const VectorXd& p) {
  return std::hypot(p(of_unbalance_cos), p(of_unbalance_sin));
}

struct Words {
  const char *name, *unit, *meaning;
};

MotorParameter absent(const Words& words, std::string why) {
  return {
      .name = words.name, .unit = words.unit, .meaning = words.meaning, .reason = std::move(why)};
}

MotorParameter plain(const Words& words, const Uncertain& found) {
  return {
      .name = words.name,
      .unit = words.unit,
      .meaning = words.meaning,
      .value = found,
      .interval_95 = {{found.value - normal_95 * found.std, found.value + normal_95 * found.std}}};
}

// A figure that can only be positive: the interval is symmetric in its logarithm.
MotorParameter positive(const Words& words, const Uncertain& found, const char* why) {
  const double relative = found.std / found.value;
  if (!(found.value > 0.0) || !(relative < determined_relative)) return absent(words, why);
  MotorParameter out = plain(words, found);
  out.interval_95 = {{found.value * std::exp(-normal_95 * relative),
                      found.value * std::exp(normal_95 * relative)}};
  return out;
}

// Friction: `scale` is the std that the largest torque corresponds to.
MotorParameter friction(const Words& words, const Uncertain& found, double scale, const char* why) {
  return found.std < determined_share * scale ? plain(words, found) : absent(words, why);
}

}  // namespace

Findings::Findings(const Identified& found, const CurrentErrors& errors)
    : value_(VectorXd::Zero(in_joint(mechanical_count))),
      covariance_(MatrixXd::Zero(value_.size(), value_.size())),
      has_current_(found.electrical.has_value()),
      has_both_flanks_(found.motion.has_both_flanks()),
      shows_stribeck_(found.mechanical.shows_stribeck),
      top_radps_(found.motion.top_radps()),
      rest_radps_(found.motion.rest_radps),
      top_effort_(0.0) {
  for (const double v : has_current_ ? found.series.current_a : found.series.voltage_v)
    top_effort_ = std::max(top_effort_, std::abs(v));
  const MechanicalFit& mechanical = found.mechanical;
  value_.tail(mechanical_count) = mechanical.value;
  covariance_.bottomRightCorner(mechanical_count, mechanical_count) = mechanical.covariance;
  covariance_(of_stribeck_speed, of_stribeck_speed) += curve_std * curve_std;
  if (!has_current_) {
    covariance_(of_drive, of_drive) += square(channel_gain_std * value_(of_drive));
    return;
  }
  const ElectricalFit& electrical = *found.electrical;
  value_.head(electrical_count) = electrical.value;
  MatrixXd of_electrical = electrical.covariance;
  of_electrical.diagonal() += (channel_gain_std * electrical.value).cwiseAbs2();
  const MatrixXd& by = mechanical.by_electrical;
  const MatrixXd cross = by * of_electrical;
  covariance_.topLeftCorner(electrical_count, electrical_count) = of_electrical;
  covariance_.bottomLeftCorner(mechanical_count, electrical_count) = cross;
  covariance_.topRightCorner(electrical_count, mechanical_count) = cross.transpose();
  covariance_.bottomRightCorner(mechanical_count, mechanical_count) += cross * by.transpose();
  value_ += errors.shift.head(value_.size());
  covariance_ += errors.covariance.topLeftCorner(value_.size(), value_.size());
  constexpr Index of_backlash = joint_count - 1;
  half_backlash_rad_ = electrical.half_backlash_rad + errors.shift(of_backlash);
  half_backlash_std_rad_ = std::hypot(electrical.half_backlash_std_rad,
                                      std::sqrt(errors.covariance(of_backlash, of_backlash)));
}

template <class Function>
Uncertain Findings::figure(const Function& of) const {
  VectorXd slope(value_.size());
  for (Index i = 0; i < value_.size(); ++i) {
    const double h = std::max(1e-6 * std::abs(value_(i)), 1e-3 * std::sqrt(covariance_(i, i)));
    VectorXd moved = value_;
    moved(i) += h;
    const double up = of(moved);
    moved(i) -= 2.0 * h;
    slope(i) = h > 0.0 ? (up - of(moved)) / (2.0 * h) : 0.0;
  }
  return {of(value_), std::sqrt(std::max(slope.dot(covariance_ * slope), 0.0))};
}

MotorParameter Findings::backlash() const {
  const Words words{"backlash", "rad", "free play of the load's shaft"};
  if (!has_current_) return absent(words, no_motor_angle);
  if (!has_both_flanks_) return absent(words, no_reversal);
  MotorParameter out = plain(words, {2.0 * half_backlash_rad_, 2.0 * half_backlash_std_rad_});
  for (double& end : *out.interval_95) end = std::max(end, 0.0);
  return out;
}

std::vector<MotorParameter> Findings::with_current() const {
  const double torque = torque_constant(value_) * top_effort_;
  std::vector<MotorParameter> out{
      positive({"resistance", "ohm", "of the armature, with its leads"},
               figure([](const VectorXd& p) { return p(resistance) / p(per_constant); }),
               "the current changes too little"),
      positive({"torque_constant", "N*m/A", "at the load's shaft; equal to the back-EMF constant"},
               figure(torque_constant), steady),
      positive({"inertia", "kg*m^2", "of motor, gear and load, at the load's shaft"},
               figure(inertia), steady),
      friction({"viscous_friction", "N*m*s/rad", "friction per speed"},
               figure([](const VectorXd& p) { return p(of_viscous) * inertia(p); }),
               torque / top_radps_, one_speed),
      friction({"coulomb_friction", "N*m", "dry friction well above speed zero"},
               figure([](const VectorXd& p) { return p(of_coulomb) * inertia(p); }), torque,
               one_speed)};
  const Words breakaway{"breakaway_friction", "N*m",
                        "friction at the onset of motion, by the curve's limit at speed zero"};
  const Words speed{"stribeck_speed", "rad/s", "speed over which friction falls from breakaway"};
  if (shows_stribeck_) {
    out.push_back(friction(breakaway, figure([](const VectorXd& p) {
                             return (p(of_coulomb) + p(of_stribeck)) * inertia(p);
                           }),
                           torque, no_slow_motion));
    out.push_back(positive(speed,
                           figure([](const VectorXd& p) { return std::exp(p(of_stribeck_speed)); }),
                           no_slow_motion));
  } else {
    out.push_back(absent(breakaway, no_slow_motion));
    out.push_back(absent(speed, no_slow_motion));
  }
  const Words unbalance{"unbalance", "N*m", "largest torque of an unbalanced load"};
  const Uncertain size = figure([](const VectorXd& p) { return hypotenuse(p) * inertia(p); });
  out.push_back(size.value > 4.0 * size.std
                    ? positive(unbalance, size, "not distinguishable from zero")
                    : absent(unbalance, "not distinguishable from zero"));
  out.push_back(backlash());
  return out;
}

std::vector<MotorParameter> Findings::without_current() const {
  std::vector<MotorParameter> out{
      positive({"gain", "rad/s/V", "speed per volt above friction"},
               figure([](const VectorXd& p) { return p(of_drive); }), one_speed),
      positive({"time_constant", "s", "of the speed after a step of the voltage"},
               figure([](const VectorXd& p) { return p(of_viscous); }),
               "smaller than the delay of the sensor's filter, or the speed changes too little"),
      friction({"friction_voltage", "V", "voltage that dry friction costs"},
               figure([](const VectorXd& p) { return p(of_coulomb) / p(of_drive); }), top_effort_,
               one_speed)};
  const Words breakaway{"breakaway_voltage", "V", "the same at the onset of motion"};
  if (shows_stribeck_)
    out.push_back(friction(breakaway, figure([](const VectorXd& p) {
                             return (p(of_coulomb) + p(of_stribeck)) / p(of_drive);
                           }),
                           top_effort_, no_slow_motion));
  else
    out.push_back(absent(breakaway, no_slow_motion));
  out.push_back(backlash());
  for (const Words& words :
       {Words{"resistance", "ohm", ""}, Words{"torque_constant", "N*m/A", ""},
        Words{"inertia", "kg*m^2", ""}, Words{"viscous_friction", "N*m*s/rad", ""},
        Words{"coulomb_friction", "N*m", ""}, Words{"breakaway_friction", "N*m", ""}})
    out.push_back(absent(words, no_current));
  return out;
}

std::vector<MotorParameter> Findings::parameters() const {
  return has_current_ ? with_current() : without_current();
}

namespace {

// Opposing a forward motion.
double forward_friction(const VectorXd& p, double speed_radps, bool has_current) {
  const double fall = std::exp(-std::pow(speed_radps / std::exp(p(of_stribeck_speed)), 2));
  const double dry = p(of_coulomb) + p(of_stribeck) * fall;
  return has_current ? (dry + p(of_viscous) * speed_radps) * inertia(p) : dry / p(of_drive);
}

}  // namespace

double Findings::friction_at(double speed_radps) const {
  return std::copysign(forward_friction(value_, std::abs(speed_radps), has_current_), speed_radps);
}

std::vector<FrictionPoint> Findings::friction_curve() const {
  constexpr int points = 60;
  std::vector<FrictionPoint> out;
  for (int k = 0; k <= points; ++k) {
    const double w = rest_radps_ + (top_radps_ - rest_radps_) * k / points;
    const Uncertain found =
        figure([&](const VectorXd& p) { return forward_friction(p, w, has_current_); });
    out.push_back({.speed_radps = w, .torque = found.value, .std = found.std});
  }
  return out;
}

}  // namespace proofmass::estimate::motor
