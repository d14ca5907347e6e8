#include "proofmass/estimate/wheel/findings.hpp"

#include <algorithm>
#include <cmath>

#include "proofmass/core/linalg.hpp"

namespace proofmass::estimate {
namespace {

/// Ratio of posterior to prior standard deviation above which the recording does not determine a
/// value.
constexpr double undetermined = 0.5;

std::optional<Uncertain> determined(const WheelFit& fit, int at, double offset = 0.0) {
  const double std = std::sqrt(fit.constants_cov(at, at));
  if (!(std < undetermined * std::sqrt(fit.constants_prior_cov(at, at)))) return std::nullopt;
  return Uncertain{fit.constants(at) + offset, std};
}

void describe_place(const WheelFit& fit, int at, WheelSensorFit& sensor) {
  sensor.radius_m = fit.given_radius_m;
  const Eigen::Vector2d r = fit.constants.segment<2>(at);
  const Eigen::Matrix2d cov = fit.constants_cov.block<2, 2>(at, at);
  const double radius = r.norm();
  if (!(radius > 0.0)) return;
  const Eigen::Vector2d outward = r / radius, forward(-outward(1), outward(0));
  const double std = std::sqrt(outward.dot(cov * outward));
  const double across = std::sqrt(forward.dot(cov * forward)) / radius;
  // Five standard deviations: a sensor at the axle is hardly ever estimated that far out by chance.
  if (across < 0.2) sensor.mounting_rad = Uncertain{-std::atan2(r(1), r(0)), across};
  // Without a given radius, stricter than for the rest: the norm of a vector is never below zero,
  // so an uncertain one looks large.
  const double most = fit.given_radius_m
                          ? fit.given_radius_m->std
                          : 0.5 * undetermined * std::sqrt(fit.constants_prior_cov(at, at));
  if (std < most) sensor.radius_m = Uncertain{radius, std};
}

enum class Kind { bias, scale, skew, phase, place };

/// One of the constants of a fit: its sensor, type and axis.
struct Constant {
  std::size_t sensor = 0;
  Kind kind = Kind::bias;
  int axis = 0;
};

/// In the state's order.
std::vector<Constant> constants_of(std::size_t sensors) {
  std::vector<Constant> all;
  for (std::size_t s = 0; s < sensors; ++s) {
    for (const Kind kind : {Kind::bias, Kind::scale})
      for (const int axis : {0, 1}) all.push_back({s, kind, axis});
    all.push_back({s, Kind::skew, 0});
  }
  if (sensors == 2) all.push_back({1, Kind::phase, 0});
  for (std::size_t s = 0; s < sensors; ++s)
    for (const int axis : {0, 1}) all.push_back({s, Kind::place, axis});
  return all;
}

std::string name_of(const Constant& constant) {
  const std::string along = constant.axis == 0 ? " along u" : " along v";
  switch (constant.kind) {
    case Kind::bias:
      return "bias" + along;
    case Kind::scale:
      return "scale" + along;
    case Kind::skew:
      return "skew of the axes";
    case Kind::phase:
      return "phase against the first sensor";
    case Kind::place:
      return "distance from the axle" + along;
  }
  return "";
}

std::string joined(const std::vector<std::string>& names) {
  std::string text;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (i > 0) text += i + 1 == names.size() ? " and " : ", ";
    text += names[i];
  }
  return text;
}

std::string sentence(const Eigen::VectorXd& direction,
                     const std::vector<Constant>& constants,
                     const std::vector<WheelSensorFit>& sensors,
                     const WheelFit& fit) {
  std::vector<std::string> names;
  bool place = false, bias = false;
  std::size_t sensor = sensors.size();
  bool one_sensor = true;
  const auto share = [&](std::size_t i) {
    return std::abs(direction(static_cast<Eigen::Index>(i)));
  };
  bool any_bias = false;
  for (std::size_t i = 0; i < constants.size(); ++i)
    any_bias = any_bias || (constants[i].kind == Kind::bias && share(i) >= 0.3);
  for (std::size_t i = 0; i < constants.size(); ++i) {
    // On a fast wheel a small offset from the axle has the effect of the whole prior bias.
    const bool trades = any_bias && constants[i].kind == Kind::place;
    if (share(i) < (trades ? 0.05 : 0.3)) continue;
    names.push_back(name_of(constants[i]));
    place = place || constants[i].kind == Kind::place;
    bias = bias || constants[i].kind == Kind::bias;
    one_sensor = one_sensor && (sensor == sensors.size() || sensor == constants[i].sensor);
    sensor = constants[i].sensor;
  }
  const std::string whose = one_sensor ? sensors[sensor].name : "the two sensors";
  if (place && fit.given_radius_m)
    return "the mounting azimuth and the biases of " + whose +
           " are not separable at one speed (ω²R): record a second speed";
  const std::string what = joined(names) + " of " + whose;
  if (place && bias) return what + " are not separable at one speed: record a second speed";
  if (place)
    return what + " does not show at this speed: the centripetal force is too small; turn faster";
  return what + (names.size() > 1 ? " are not separable" : " is not identifiable") +
         " from this recording: let the wheel turn at least one whole turn";
}

}  // namespace

void describe_sensors(const WheelFit& fit, double phase_rad, std::vector<WheelSensorFit>& sensors) {
  for (std::size_t s = 0; s < sensors.size(); ++s) {
    const int first = wheel::first_of(static_cast<int>(s)) - wheel::first_of(0);
    WheelSensorFit& sensor = sensors[s];
    for (int axis = 0; axis < 2; ++axis) {
      const auto at = static_cast<std::size_t>(axis);
      sensor.bias_mps2[at] = determined(fit, first + wheel::bias + axis);
      sensor.scale[at] = determined(fit, first + wheel::scale + axis, 1.0);
    }
    sensor.skew_rad = determined(fit, first + wheel::skew);
    if (s > 0) sensor.phase_rad = determined(fit, wheel::phase - wheel::first_of(0), phase_rad);
    const auto count = static_cast<int>(sensors.size());
    if (sensor.has_gyro) {
      const int gyro =
          wheel::gyro(count) - wheel::first_of(0) + wheel::gyro_states * static_cast<int>(s);
      sensor.gyro_bias_radps = determined(fit, gyro + wheel::gyro_bias);
      sensor.gyro_scale = determined(fit, gyro + wheel::gyro_scale, 1.0);
    }
    describe_place(fit, wheel::places(count) - wheel::first_of(0) + 2 * static_cast<int>(s),
                   sensor);
  }
}

void describe_encoder(const WheelFit& fit,
                      const EncoderReadings& readings,
                      std::size_t sensors,
                      WheelEncoderFit& encoder) {
  const int first = wheel::encoder(static_cast<int>(sensors)) - wheel::first_of(0);
  encoder.direction = readings.direction;
  double variance = 0.0, count = 0.0;
  for (const double one : readings.variance_rad2)
    if (std::isfinite(one)) variance += one, count += 1.0;
  double speed2 = 0.0;
  for (const Mat<wheel::moving>& at : fit.track.path.moving) speed2 += square(at(wheel::speed));
  const double rms_radps = std::sqrt(speed2 / static_cast<double>(fit.track.path.moving.size()));
  encoder.noise_rad =
      std::sqrt(variance / std::max(count, 1.0) + readings.more.variance_rad2(rms_radps));
  encoder.offset_rad = determined(fit, first, readings.zero_rad);
  if (encoder.offset_rad)
    encoder.offset_rad->value = std::remainder(encoder.offset_rad->value, rad_per_turn);
  for (std::size_t i = 0; i < encoder.errors_rad.size(); ++i)
    encoder.errors_rad[i] = determined(fit, first + 1 + static_cast<int>(i));
}

std::vector<std::string> say_not_observable(const WheelFit& fit,
                                            const std::vector<WheelSensorFit>& sensors) {
  // Ripple, gyroscope and encoder are nuisance parameters here.
  const int count = static_cast<int>(sensors.size());
  const Eigen::Index own = wheel::ripple(count) - wheel::first_of(0),
                     places_at = wheel::places(count) - wheel::first_of(0);
  std::vector<Eigen::Index> shown;
  for (Eigen::Index i = 0; i < fit.constants.size(); ++i)
    if (i < own || i >= places_at) shown.push_back(i);
  const Eigen::MatrixXd cov = fit.constants_cov(shown, shown);
  Eigen::VectorXd scale = fit.constants_prior_cov.diagonal()(shown).cwiseSqrt().cwiseInverse();
  // A given radius is known, however little the recording adds to it.
  const auto places = static_cast<Eigen::Index>(2 * sensors.size());
  scale.tail(places) = scale.tail(places).cwiseMin(1.0 / short_way_prior.place_m);
  const SymmetricEigen axes = symmetric_eigen(scale.asDiagonal() * cov * scale.asDiagonal());
  const std::vector<Constant> constants = constants_of(sensors.size());
  std::vector<std::string> sentences;
  for (Eigen::Index i = axes.values.size();
       i-- > 0 && axes.values(i) > undetermined * undetermined;) {
    const std::string text = sentence(axes.vectors.col(i), constants, sensors, fit);
    if (std::ranges::find(sentences, text) == sentences.end()) sentences.push_back(text);
  }
  return sentences;
}

}  // namespace proofmass::estimate
