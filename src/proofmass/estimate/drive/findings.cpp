#include "proofmass/estimate/drive/findings.hpp"

#include <cmath>
#include <cstddef>

#include "proofmass/core/statistics.hpp"

namespace proofmass::estimate::drive {
namespace {

// Beyond this an interval is no longer that of a heading, which is an angle.
constexpr double lost_heading_rad = 0.7;
// Beyond this the uncertainty of the position is an arc, which an ellipse does not describe.
constexpr double bent_position_rad = 0.3;
// The errors of the angles are correlated over some samples, as quantisation is; the filter takes
// them as white, and the offsets of the clocks as more precise than a fraction of a sample.
constexpr double least_clock_std_s = 0.003;
// Between the two sides where nothing else measures turns: a turn may explain any offset but that
// of a start or stop, which is known to an epoch of 0.1 s.
constexpr double opposite_clock_std_s = 0.03;

Uncertain state(const Gaussian<at::states>& x, int index) {
  return {x.mean(index), std::sqrt(std::max(0.0, x.cov(index, index)))};
}

std::optional<Uncertain> clock_offset(const Gaussian<at::states>& end,
                                      int clock,
                                      double least_std_s = least_clock_std_s) {
  if (clock == 0) return Uncertain{};
  const Uncertain offset = state(end, at::clock + clock);
  return Uncertain{offset.value, std::hypot(offset.std, least_std_s)};
}

void add_series(const Fitted& fitted, const std::vector<Epoch>& epochs, DriveSeries& out) {
  for (std::size_t k = 0; k < fitted.pass.path.size(); ++k) {
    const Mat<seen_states> now = seen(fitted.pass.path[k]);
    const auto& cov = fitted.pass.seen_cov[k];
    const auto std_of = [&](int i) { return std::sqrt(std::max(0.0, cov(i, i))); };
    out.time_s.push_back(epochs[k].time_s - epochs.front().time_s);
    out.x_m.push_back(now(0));
    out.y_m.push_back(now(1));
    out.heading_rad.push_back(now(2));
    out.distance_m.push_back(now(3));
    out.speed_mps.push_back(now(4));
    out.x_std_m.push_back(std_of(0));
    out.y_std_m.push_back(std_of(1));
    out.xy_cov_m2.push_back(cov(0, 1));
    out.heading_std_rad.push_back(std_of(2));
    out.speed_std_mps.push_back(std_of(4));
    out.rate_radps.push_back(fitted.pass.path[k](at::rate));
  }
}

void add_wheels(const Recorded& recorded,
                const Fitted& fitted,
                const Known& known,
                DriveSolution& solution) {
  const Gaussian<at::states>& end = fitted.pass.end;
  const Vehicle& vehicle = fitted.setting.vehicle;
  for (std::size_t i = 0; i < recorded.wheels.size(); ++i) {
    DriveWheelFit& fit = solution.wheels[i];
    const Trace& trace = recorded.wheels[i];
    const int index = static_cast<int>(i);
    fit.steered = vehicle.steered[i];
    fit.turns = trace.turns;
    fit.has_yaw = !trace.yaw_rad.empty();
    fit.spin_tilt_rad = trace.spin_tilt_rad;
    const bool opposite = vehicle.side[i] != vehicle.side[0];
    fit.clock_offset_s = clock_offset(
        end, vehicle.clock[i], opposite && !known.yaw ? opposite_clock_std_s : least_clock_std_s);
    if (!known.scale) continue;
    const Uncertain rho = state(end, at::radius + index);
    const double circumference_m = rad_per_turn * vehicle.radius_m[i] * std::exp(rho.value);
    fit.circumference_m = Uncertain{circumference_m, circumference_m * rho.std};
  }
}

void add_position(const Fitted& fitted, DriveSolution& solution) {
  const Mat<seen_states> at_end = seen(fitted.pass.path.back());
  const auto& cov = fitted.pass.seen_cov.back();
  for (int i = 0; i < 2; ++i)
    solution.end_m[static_cast<std::size_t>(i)] =
        Uncertain{at_end(i), std::sqrt(std::max(0.0, cov(i, i)))};
  const double gap_m = std::hypot(at_end(0), at_end(1));
  // Along the line to the start; at the start itself the larger axis of the ellipse.
  const double c = gap_m > 0.0 ? at_end(0) / gap_m : 1.0, s = gap_m > 0.0 ? at_end(1) / gap_m : 0.0;
  const double along = c * c * cov(0, 0) + 2.0 * c * s * cov(0, 1) + s * s * cov(1, 1);
  solution.closure_m = Uncertain{gap_m, std::sqrt(std::max(0.0, along))};
}

void say_heading_lost(const Known& known, DriveSolution& solution) {
  std::string why = "heading: ";
  if (!known.both_sides && !known.yaw)
    why +=
        "the wheels of one side without a gyroscope do not show turns; a gyroscope on a wheel or "
        "the frame, a wheel of the other side, or position fixes determine it";
  else if (!known.yaw && !known.track)
    why +=
        "the difference of the two sides is the heading change times the track width, which is "
        "not known; the track width, a gyroscope or position fixes determine it";
  else
    why +=
        "the uncertainty of the heading exceeds 40 degrees; a gyroscope, more precise "
        "circumferences or position fixes determine it";
  solution.not_observable.push_back(why);
  solution.not_observable.emplace_back(
      "end position: without the heading only the distance travelled is determined");
}

void add_fixes(const Recorded& recorded, const Fitted& fitted, DriveSolution& solution) {
  const LocalFixes& fixes = *recorded.fixes;
  DriveFixesFit& fit = *solution.fixes;
  fit.used = fitted.pass.fixes_used;
  fit.fixes = fixes.time_s.size();
  fit.noise_m = fitted.noise.fix_std_m;
  fit.wander_m = fitted.noise.wander_std_m;
  fit.wander_s = fitted.noise.wander_s;
  for (std::size_t k = 1; k < fixes.time_s.size(); ++k)
    fit.path_m +=
        std::hypot(fixes.east_m[k] - fixes.east_m[k - 1], fixes.north_m[k] - fixes.north_m[k - 1]);
  fit.clock_offset_s = clock_offset(fitted.pass.end, fitted.setting.vehicle.fix_clock);
}

}  // namespace

void report_findings(const Recorded& recorded,
                     const Fitted& fitted,
                     const Known& known,
                     DriveSolution& solution) {
  const Gaussian<at::states>& end = fitted.pass.end;
  solution.reference_point = known.reference_point;
  add_wheels(recorded, fitted, known, solution);
  solution.slip_m_per_rtm = fitted.noise.slip_m_per_rtm;
  solution.nis = fitted.pass.nis;
  const Vehicle& vehicle = fitted.setting.vehicle;
  if (recorded.frame)
    solution.frame_clock_offset_s = clock_offset(end, vehicle.clock[most_drive_wheels]);
  const bool fixes = recorded.fixes.has_value();
  if (known.scale)
    solution.distance_m = state(end, at::path);
  else
    solution.not_observable.emplace_back(
        "distance: neither the circumference of a wheel nor position fixes are given, so the scale "
        "of the path is not determined");
  const Uncertain heading = state(end, at::heading);
  const bool heading_known =
      (fixes || known.yaw || (known.both_sides && known.track)) && heading.std < lost_heading_rad;
  if (heading_known)
    solution.heading_change_rad = heading;
  else
    say_heading_lost(known, solution);
  if (known.track && known.both_sides && known.scale) solution.track_m = state(end, at::track);
  for (int i = 0; i < vehicle.wheels; ++i)
    if (vehicle.steered[static_cast<std::size_t>(i)] && known.scale)
      solution.wheelbase_m = state(end, at::base);
  const Uncertain bearing = state(end, at::bearing);
  if (fixes && bearing.std < lost_heading_rad)
    solution.heading_start_rad =
        Uncertain{std::remainder(bearing.value, rad_per_turn), bearing.std};
  else if (!fixes)
    solution.not_observable.emplace_back(
        "absolute position and heading: without position fixes the path is relative to the start");
  if (fixes) add_fixes(recorded, fitted, solution);
  if (!heading_known || !known.scale) return;
  if (heading.std > bent_position_rad) {
    solution.not_observable.emplace_back(
        "end position: the uncertainty of the heading exceeds 17 degrees; a gyroscope, more "
        "precise "
        "circumferences or position fixes determine it");
    return;
  }
  add_position(fitted, solution);
  add_series(fitted, epochs_of(recorded, vehicle), solution.series);
}

}  // namespace proofmass::estimate::drive
