#include "proofmass/sensor/noise_update.hpp"

#include <array>
#include <cmath>
#include <fmt/format.h>
#include <string_view>
#include <utility>

#include "proofmass/core/contract.hpp"
#include "proofmass/sensor/file/change.hpp"

namespace proofmass::sensor {
namespace {

/// 95 % of a normal distribution lies below this many standard deviations.
constexpr double one_sided_95 = 1.6448536269514722;

/// One coefficient: its name, its unit, its source and its destination.
struct Term {
  std::string_view name, unit;
  MeasuredCoefficient MeasuredNoise::* measured;
  AxisFigures NoiseModel::* figures;
};

constexpr std::array<Term, 5> terms{{
    {"white", "m/s^2/sqrt(Hz)", &MeasuredNoise::white, &NoiseModel::white},
    {"quantisation", "m/s", &MeasuredNoise::quantisation, &NoiseModel::quantisation},
    {"flicker", "m/s^2", &MeasuredNoise::flicker, &NoiseModel::flicker},
    {"random_walk", "m/s^2/sqrt(s)", &MeasuredNoise::random_walk, &NoiseModel::random_walk},
    {"ramp", "m/s^3", &MeasuredNoise::ramp, &NoiseModel::ramp},
}};

/// The same for a gyroscope.
struct GyroscopeTerm {
  std::string_view name, unit;
  MeasuredCoefficient MeasuredNoise::* measured;
  AxisFigures Gyroscope::* figures;
};

constexpr std::array<GyroscopeTerm, 3> gyroscope_terms{{
    {"white", "rad/s/sqrt(Hz)", &MeasuredNoise::white, &Gyroscope::white},
    {"flicker", "rad/s", &MeasuredNoise::flicker, &Gyroscope::flicker},
    {"random_walk", "rad/s/sqrt(s)", &MeasuredNoise::random_walk, &Gyroscope::random_walk},
}};

std::string joined(std::string_view origin, const std::string& text) {
  return origin.empty() ? text : fmt::format("{}: {}", origin, text);
}

Status check(const Uncertain& figure) {
  if (!std::isfinite(figure.value) || !std::isfinite(figure.std))
    return Error{Errc::not_finite, "must be a finite number with a finite standard deviation"};
  if (figure.value < 0.0 || figure.std < 0.0)
    return Error{Errc::invalid_argument, "must not be negative"};
  return Done{};
}

/// Value or bound of a coefficient; nullopt if neither is known.
std::optional<Uncertain> known(const MeasuredCoefficient& coefficient) {
  if (coefficient.identified) return coefficient.identified;
  if (coefficient.upper_95) return Uncertain{0.0, *coefficient.upper_95 / one_sided_95};
  return std::nullopt;
}

std::string origin_of(const MeasuredCoefficient& coefficient,
                      std::string_view unit,
                      std::string_view origin) {
  if (coefficient.identified) return std::string(origin);
  return joined(origin, fmt::format("below {:.3g} {} (95 %)", *coefficient.upper_95, unit));
}

/// Model is the struct whose member the term names.
template <class AnyTerm, class Model>
Status put(const MeasuredNoise& measured, const AnyTerm& term, Model& noise) {
  const MeasuredCoefficient& coefficient = measured.*term.measured;
  const auto figure = known(coefficient);
  if (!figure) return Done{};
  if (const Status fits = check(*figure); !fits)
    return fits.error().at(fmt::format("noise.{} of axis {}", term.name, "xyz"[measured.axis]));
  Figure entry =
      make_figure(figure->value, term.unit, origin_of(coefficient, term.unit, measured.origin));
  entry.std = figure->std;
  (noise.*term.figures)[measured.axis] = std::move(entry);
  return Done{};
}

Status put_bandwidth(const MeasuredNoise& measured, Electrical& electrical) {
  auto& bandwidth = electrical.bandwidth[measured.axis];
  if (!measured.bandwidth_hz || bandwidth) return Done{};
  if (const Status fits = check(*measured.bandwidth_hz); !fits)
    return fits.error().at("electrical.bandwidth");
  bandwidth = make_figure(measured.bandwidth_hz->value, "Hz", measured.origin);
  bandwidth->std = measured.bandwidth_hz->std;
  return Done{};
}

Status put_lsb(const MeasuredNoise& measured, Electrical& electrical) {
  if (!measured.lsb || electrical.lsb) return Done{};
  const Figure& lsb = *measured.lsb;
  if (lsb.unit.si_symbol != "V" && lsb.unit.si_symbol != "m/s^2")
    return Error{Errc::invalid_argument,
                 fmt::format("electrical.lsb: is in {}; expected V or m/s^2", lsb.unit.symbol)};
  if (const Status fits = check({lsb.value, lsb.std.value_or(0.0)}); !fits)
    return fits.error().at("electrical.lsb");
  electrical.lsb = lsb;
  return Done{};
}

Status put(const MeasuredNoise& measured, SensorModel& model) {
  if (measured.gyroscope) {
    for (const GyroscopeTerm& term : gyroscope_terms)
      if (const Status done = put(measured, term, model.gyroscope); !done) return done;
    return Done{};
  }
  for (const Term& term : terms)
    if (const Status done = put(measured, term, model.noise); !done) return done;
  if (const Status done = put_bandwidth(measured, model.electrical); !done) return done;
  return put_lsb(measured, model.electrical);
}

}  // namespace

Status update_noise(SensorModel& model, View<MeasuredNoise> measured) {
  SensorModel updated = model;
  std::array<bool, 6> seen{};  // of the accelerometer, then of the gyroscope
  for (const MeasuredNoise& axis : measured) {
    PM_EXPECTS(axis.axis < 3);
    if (std::exchange(seen[axis.axis + (axis.gyroscope ? 3 : 0)], true))
      return Error{Errc::invalid_argument,
                   fmt::format("axis {} is there twice, but a sensor file is of one sensor: choose "
                               "its channels",
                               "xyz"[axis.axis])};
    if (const Status done = put(axis, updated); !done) return done;
  }
  model = std::move(updated);
  return Done{};
}

Status update_sensor_file(const std::string& path, View<MeasuredNoise> measured) {
  return change_sensor_file(path,
                            [&](SensorModel& model) { return update_noise(model, measured); });
}

}  // namespace proofmass::sensor
