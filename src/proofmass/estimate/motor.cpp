#include "proofmass/estimate/motor.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "proofmass/core/number_words.hpp"
#include "proofmass/estimate/motor/conclude.hpp"
#include "proofmass/estimate/motor/screening.hpp"

namespace proofmass::estimate {
namespace {

using motor::Motion;
using motor::Series;

MotorSeries series_of(const Series& series,
                      const Motion& motion,
                      const std::optional<motor::ElectricalFit>& electrical,
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

void note_offset(const Series& series, std::vector<Note>& notes) {
  constexpr double least_share = 0.02;  // of the largest current
  const double top_a = motor::largest_magnitude(series.current_a);
  if (!(std::abs(series.current_offset_a) > least_share * top_a)) return;
  notes.push_back({Severity::warning, "current: " + significant(series.current_offset_a, 2) +
                                          " A at rest without a voltage are subtracted"});
}

}  // namespace

const MotorParameter* MotorSolution::find(std::string_view name) const {
  const auto found = std::ranges::find(parameters, name, &MotorParameter::name);
  return found == parameters.end() ? nullptr : &*found;
}

Result<MotorSolution> estimate_motor(const MotorRecord& record, const MotorOptions& options) {
  if (options.progress) options.progress("identification", 0.0);
  std::vector<Note> notes;
  const MotorRecord used = motor::screened(record, notes);
  const Result<motor::Identified> found = motor::identify(used, options);
  if (!found) return found.error();
  const Series& series = found->series;
  const Motion& motion = found->motion;
  note_offset(series, notes);
  const motor::Findings findings(*found, motor::current_errors(used, options, *found));
  MotorSolution out{.notes = std::move(notes)};
  out.parameters = findings.parameters();
  if (std::ranges::none_of(out.parameters, [](const auto& one) { return one.value.has_value(); }))
    return Error{Errc::not_observable,
                 "no figure of the drive is determined: " + out.parameters.front().reason};
  out.friction = findings.friction_curve();
  out.has_current = series.has_current();
  out.rate_hz = 1.0 / series.step_s;
  out.angle_noise_rad = found->electrical ? found->electrical->angle_noise_rad
                                          : found->mechanical.angle_noise_rad.value_or(0.0);
  out.moving_share =
      static_cast<double>(motor::moving_samples(motion)) / static_cast<double>(series.size());
  out.reversals = motion.reversals();
  if (found->electrical) out.angle_correlation = found->electrical->correlation;
  out.motion_correlation = found->mechanical.correlation;
  out.series = series_of(series, motion, found->electrical, findings);
  return out;
}

}  // namespace proofmass::estimate
