#include "proofmass/estimate/drive/trace.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "proofmass/core/units.hpp"
#include "proofmass/estimate/drive/yaw.hpp"

namespace proofmass::estimate::drive {
namespace {

Result<Trace> trace_encoder(const DriveWheel& wheel) {
  Trace trace;
  constexpr double quantum_std_rad = 2e-3;
  for (std::size_t k = 0; k < wheel.encoder_rad.size(); ++k) {
    if (!std::isfinite(wheel.encoder_rad[k])) continue;
    trace.time_s.push_back(wheel.sensor.time_s[k]);
    trace.angle_rad.push_back(wheel.encoder_rad[k]);
  }
  const std::size_t n = trace.time_s.size();
  if (n < 10) return Error{Errc::too_few_samples, wheel.sensor.name + ": no angle of the encoder"};
  // The least step between two readings is the encoder's resolution.
  double step = INFINITY;
  for (std::size_t k = 1; k < n; ++k)
    if (const double d = std::abs(trace.angle_rad[k] - trace.angle_rad[k - 1]); d > 1e-9)
      step = std::min(step, d);
  const double std_rad =
      std::max(quantum_std_rad, std::isfinite(step) ? step / std::sqrt(12.0) : 0.0);
  trace.angle_std_rad.assign(n, std_rad);
  for (std::size_t k = 0; k < n; ++k) {
    const std::size_t a = k < 5 ? 0 : k - 5, b = std::min(k + 5, n - 1);
    trace.speed_radps.push_back((trace.angle_rad[b] - trace.angle_rad[a]) /
                                (trace.time_s[b] - trace.time_s[a]));
  }
  trace.turns = Uncertain{(trace.angle_rad.back() - trace.angle_rad.front()) / rad_per_turn,
                          std::sqrt(2.0) * std_rad / rad_per_turn};
  return trace;
}

}  // namespace

double at_time(const std::vector<double>& time_s, const std::vector<double>& values, double t) {
  const auto after = std::ranges::upper_bound(time_s, t);
  if (after == time_s.begin()) return values.front();
  if (after == time_s.end()) return values.back();
  const auto k = static_cast<std::size_t>(after - time_s.begin());
  const double share = (t - time_s[k - 1]) / (time_s[k] - time_s[k - 1]);
  return values[k - 1] + share * (values[k] - values[k - 1]);
}

Result<Trace> trace_wheel(const DriveWheel& wheel, const WheelOptions& options) {
  if (!wheel.encoder_rad.empty()) return trace_encoder(wheel);
  WheelOptions own = options;
  if (wheel.circumference_m) own.rolling_radius_m = wheel.circumference_m->value / rad_per_turn;
  const auto solved = estimate_wheel({wheel.sensor}, own);
  if (!solved) return solved.error();
  if (!solved->turns)
    return Error{Errc::not_observable, wheel.sensor.name + ": the number of turns is ambiguous: " +
                                           solved->smoother.note};
  Trace trace;
  trace.time_s = solved->series.time_s;
  trace.angle_rad = solved->series.angle_rad;
  // The smoother's errors are correlated over some epochs; the filter takes them as white.
  constexpr double inflation = 2.0;
  for (const double std_rad : solved->series.angle_std_rad)
    trace.angle_std_rad.push_back(inflation * std_rad);
  trace.speed_radps = solved->series.speed_radps;
  trace.turns = solved->turns;
  trace.rolling_radius_m = solved->rolling_radius_m;
  for (const Note& note : solved->notes)
    if (note.severity != Severity::info)
      trace.notes.push_back({note.severity, wheel.sensor.name + ": " + note.text});
  const auto& rates = wheel.sensor.rate_radps;
  if (!rates[0].empty() && !wheel.sensor.accel_mps2[2].empty()) add_yaw(wheel.sensor, trace);
  return trace;
}

std::vector<Stretch> rests_of(const Trace& wheel, double least_s) {
  std::vector<Stretch> rests;
  bool open = false;
  for (std::size_t k = 0; k < wheel.time_s.size(); ++k) {
    const bool stands = std::abs(wheel.speed_radps[k]) < standing_radps;
    if (stands && !open) rests.push_back({wheel.time_s[k], wheel.time_s[k], 0, {}});
    if (stands) {
      rests.back().end_s = wheel.time_s[k];
      ++rests.back().rows;
    }
    open = stands;
  }
  std::erase_if(rests, [&](const Stretch& rest) { return rest.end_s - rest.start_s < least_s; });
  return rests;
}

void reverse(Trace& wheel) {
  for (double& angle : wheel.angle_rad) angle = -angle;
  for (double& speed : wheel.speed_radps) speed = -speed;
  if (wheel.turns) wheel.turns->value = -wheel.turns->value;
}

}  // namespace proofmass::estimate::drive
