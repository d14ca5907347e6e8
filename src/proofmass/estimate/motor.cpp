#include "proofmass/estimate/motor.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "proofmass/estimate/motor/conclude.hpp"
#include "proofmass/estimate/motor/prepare.hpp"

namespace proofmass::estimate {
namespace {

using motor::ElectricalFit;
using motor::MechanicalFit;
using motor::Motion;
using motor::Series;

constexpr int rounds = 3;
constexpr std::size_t least_rows = 100;

struct MotorSpeed {
  std::vector<double> radps;
  double std_radps = 0.0;
  std::size_t half_window = 0;
};

/// The motor's speed by its back-EMF, through the local cubic over 25 ms.
MotorSpeed speed_by_back_emf(const Series& series, const ElectricalFit& electrical) {
  constexpr double window_s = 0.025;
  const Eigen::VectorXd speed = electrical.speed_terms * electrical.value;
  const std::vector<double> raw{speed.data(), speed.data() + speed.size()};
  const std::size_t half = motor::half_window(window_s, series.step_s);
  return {motor::smoothed(raw, series.step_s, window_s),
          motor::slope_noise(half) * motor::sample_noise(raw), half};
}

MotorSeries series_of(const Series& series,
                      const Motion& motion,
                      const std::optional<ElectricalFit>& electrical,
                      const motor::Findings& findings) {
  MotorSeries out{.voltage_v = series.voltage_v,
                  .current_a = series.current_a,
                  .load_angle_rad = series.angle_rad,
                  .speed_radps = motion.speed_radps,
                  .contact = motion.contact};
  if (electrical) out.motor_angle_rad = electrical->motor_angle_rad;
  for (std::size_t k = 0; k < series.size(); ++k) {
    out.time_s.push_back(series.time_s(k));
    out.friction.push_back(motion.contact[k] == 0 ? std::numeric_limits<double>::quiet_NaN()
                                                  : findings.friction_at(motion.speed_radps[k]));
  }
  return out;
}

Error too_still() {
  return {Errc::not_observable, "the load hardly moves: nothing shows the drive"};
}

}  // namespace

const MotorParameter* MotorSolution::find(std::string_view name) const {
  const auto found = std::ranges::find(parameters, name, &MotorParameter::name);
  return found == parameters.end() ? nullptr : &*found;
}

Result<MotorSolution> estimate_motor(const MotorRecord& record, const MotorOptions& options) {
  Result<Series> prepared = motor::prepare(record, options);
  if (!prepared) return prepared.error();
  Series series = std::move(prepared).value();
  const Motion load = motor::motion_of_load(series);
  const auto rows = [](const Motion& motion) {
    return motion.contact.size() -
           static_cast<std::size_t>(std::ranges::count(motion.contact, std::int8_t{0}));
  };
  if (rows(load) < least_rows) return too_still();
  if (series.has_current()) motor::subtract_current_offset(load, series);
  Motion motion = load;
  std::optional<ElectricalFit> electrical;
  motor::ElectricalStart start;
  if (series.has_current())
    start.resistance_per_constant = motor::resistance_per_constant(series, motion);
  for (int round = 0; series.has_current() && round < rounds; ++round) {
    if (options.progress) options.progress("identification", static_cast<double>(round) / rounds);
    electrical = motor::fit_electrical(series, motion, start);
    start = electrical->next;
    MotorSpeed speed = speed_by_back_emf(series, *electrical);
    const double gap_rad =
        2.0 *
        std::max(electrical->half_backlash_rad + 2.0 * electrical->half_backlash_std_rad, 0.0);
    motion =
        motor::motion_of_motor(series, electrical->motor_angle_rad, electrical->load_angle_rad,
                               std::move(speed.radps), speed.std_radps, gap_rad, speed.half_window);
    if (rows(motion) < least_rows) return too_still();
  }
  const Result<MechanicalFit> found = electrical
                                          ? motor::fit_with_current(series, motion, *electrical)
                                          : motor::fit_without_current(series, motion);
  if (!found) return found.error();
  const MechanicalFit& mechanical = *found;
  const motor::Findings findings(series, motion, electrical, mechanical);
  MotorSolution out;
  out.parameters = findings.parameters();
  if (std::ranges::none_of(out.parameters, [](const auto& one) { return one.value.has_value(); }))
    return Error{Errc::not_observable,
                 "no figure of the drive is determined: " + out.parameters.front().reason};
  out.friction = findings.friction_curve();
  out.has_current = series.has_current();
  out.rate_hz = 1.0 / series.step_s;
  out.angle_noise_rad =
      electrical ? electrical->angle_noise_rad : mechanical.angle_noise_rad.value_or(0.0);
  out.moving_share = static_cast<double>(rows(motion)) / static_cast<double>(series.size());
  out.reversals = motion.reversals();
  if (electrical) out.angle_correlation = electrical->correlation;
  out.motion_correlation = mechanical.correlation;
  out.series = series_of(series, motion, electrical, findings);
  return out;
}

}  // namespace proofmass::estimate
