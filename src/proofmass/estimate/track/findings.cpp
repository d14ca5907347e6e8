#include "proofmass/estimate/track/findings.hpp"

#include <algorithm>
#include <cmath>
#include <cstdarg>
#include <cstdio>

#include "proofmass/estimate/unmeasured.hpp"

namespace proofmass::estimate {
namespace {

[[gnu::format(printf, 1, 2)]] std::string text(const char* format, ...) {
  char buffer[512];
  std::va_list arguments;
  va_start(arguments, format);
  std::vsnprintf(buffer, sizeof buffer, format, arguments);
  va_end(arguments);
  return buffer;
}

constexpr double degree = 0.017453292519943295;

void note_fixes(const FixReview& fixes, std::vector<Note>& notes) {
  if (fixes.false_rests > 0)
    notes.push_back(
        {Severity::info,
         text("%zu quiet intervals are not rests: the fixes contradict them", fixes.false_rests)});
  if (fixes.delay_s)
    notes.push_back(
        {Severity::warning,
         text("the fixes are %s by %.3g ± %.2g s relative to the accelerations, and their times "
              "are corrected by that: check that both have one clock",
              fixes.delay_s->value > 0.0 ? "late" : "early", std::abs(fixes.delay_s->value),
              fixes.delay_s->std)});
  for (const PositionFix& fix : fixes.wrong)
    notes.push_back({Severity::warning,
                     text("the fix of %.4g m at %.4g s contradicts the accelerations and the other "
                          "fixes, and is not used",
                          fix.position_m, fix.time_s)});
}

void note_rests(const TrackOptions& options, TrackSolution& solution) {
  auto& notes = solution.notes;
  if (solution.rests_by_quietness)
    notes.push_back(
        {Severity::info,
         "the sensor's noise at rest is unknown (measurements of several sensors fused, or "
         "smoothed): rests are the intervals that are quiet compared with the motion"});
  const bool decided = solution.alternatives.empty() && !solution.too_many_in_doubt;
  if (solution.cruises > 0 && decided)
    notes.push_back(
        {Severity::warning,
         text("%zu quiet intervals are taken as constant speed instead of rest: the "
              "velocities integrated up to them cancel, which a tilt or bias would not cause",
              solution.cruises)});
  if (solution.plateaus > 0 && decided)
    notes.push_back({Severity::warning,
                     text("%zu quiet intervals are taken as constant acceleration instead of rest: "
                          "the magnitude of the measurements differs from that at rest, or their "
                          "level and the velocities do; if the sensor was only tilted there, a "
                          "gyroscope would show it",
                          solution.plateaus)});
  if (solution.false_rests > 0)
    notes.push_back({Severity::info,
                     text("%zu short quiet intervals are not rests: their velocity and level are "
                          "inconsistent with the motion between the long rests",
                          solution.false_rests)});
  note_fixes(solution.fix_review, notes);
  if (solution.no_motion_shown)
    notes.push_back({Severity::info,
                     "no motion exceeds the noise: the interval includes a slow motion between "
                     "the two ends that noise could hide"});
  else if (solution.rests.size() == 1 && options.fixes.empty())
    notes.push_back({Severity::warning,
                     "only one rest: no second rest checks the velocity, so the band relies on "
                     "typical errors; keep the sensor still for 2 s at the end as well"});
}

void note_scale(const TrackSignal& signal, const TrackOptions& options, TrackSolution& solution) {
  if (options.scale_std) return;
  if (signal.resting_norm_mps2 && signal.gravity == GravityContent::present)
    solution.notes.push_back(
        {Severity::info,
         text("not calibrated: the norm at rest is %.4g m/s², gravity %.4g; lengths are assumed "
              "accurate to %.2g %%",
              *signal.resting_norm_mps2, options.gravity_mps2, 100.0 * solution.scale_std)});
  else
    solution.notes.push_back({Severity::info,
                              text("not calibrated: the scale is assumed accurate "
                                   "to %.2g %%; a sensor file gives a better value",
                                   100.0 * solution.scale_std),
                              {Advice{"sensor"}}});
}

void note_turning(TrackSolution& solution) {
  constexpr double noticed_rad = 1.0 * degree;
  if (solution.turned_rad && *solution.turned_rad > noticed_rad && !solution.axis_in_world)
    solution.notes.push_back(
        {Severity::warning, text("between two rests the sensor rotated by %.2g deg, which changes "
                                 "gravity along the axis: "
                                 "the band includes this as far as the rests show it; gyroscope "
                                 "channels would determine it",
                                 *solution.turned_rad / degree)});
}

void note_alternatives(TrackSolution& solution) {
  if (solution.too_many_in_doubt)
    solution.notes.push_back(
        {Severity::bad,
         "the integrated velocity is far from 0 at more than sixteen quiet intervals: rests cannot "
         "be distinguished from motion at constant speed, and no displacement is given. State when "
         "the sensor was at rest",
         {Advice{"still"}}});
  if (solution.alternatives.empty()) return;
  std::string all;
  for (const TrackAlternative& one : solution.alternatives) {
    std::string where;
    for (const TimeSpan& span : one.no_rests)
      where += text("%s%.1f to %.1f s", where.empty() ? "" : ", ", span.start_s, span.end_s);
    all += text("%s%.3g m with probability %.2g (%s)", all.empty() ? "" : "; ",
                one.displacement_m.value, one.probability,
                where.empty() ? "all of them rest" : ("in motion " + where).c_str());
  }
  solution.notes.push_back(
      {Severity::bad,
       "rests cannot be distinguished from motion at constant speed or acceleration: " + all +
           "; no displacement is given. State when the sensor was at rest",
       {Advice{"still"}, Advice{"rests", "ends"}}});
}

// Errors in motion that are absent at rest are mostly gravity, as the sensor tilts.
void note_leaning(const TrackOptions& options, TrackSolution& solution) {
  constexpr double noticed_rad = 1.0 * degree;
  const MotionErrorFigures& error = solution.motion_error;
  const double t = std::max(solution.budget.longest_motion_s, 1e-3);
  const double accel = std::hypot(error.jump_mps2, error.lean_mps2_rthz / std::sqrt(t),
                                  error.walk_mps2_rts * std::sqrt(t));
  const double lean_rad = accel / options.gravity_mps2;
  if (solution.axis_in_world || lean_rad < noticed_rad) return;
  solution.notes.push_back(
      {Severity::warning,
       text("in motion the errors are about %.2g m/s², as if the sensor tilted by %.2g deg: "
            "the figures are approximate; a gyroscope would resolve it",
            accel, lean_rad / degree)});
}

void note_jerk(TrackSolution& solution) {
  if (!solution.suspected_jerk) return;
  solution.notes.push_back(
      {Severity::bad,
       "the data behave like the derivative of an acceleration (jerk), not like an "
       "acceleration: integrated twice they differ from 0 while the sensor vibrates as in "
       "motion, and return to 0 at rest, as a velocity does; no displacement is given. If "
       "they are accelerations, state it",
       {Advice{"take-as-acceleration"}}});
}

}  // namespace

Error no_stop(const TrackSignal& signal) {
  return {Errc::not_observable,
          (signal.stops.why_none.empty() ? std::string("the sensor was never at rest")
                                         : signal.stops.why_none) +
              "; without a rest the bias cannot be distinguished from motion: keep the sensor "
              "still for 2 s before and after, state when it was at rest, or give positions",
          {Advice{"still"}, Advice{"fixes"}}};
}

Error hidden_motion() {
  return {
      Errc::not_observable,
      "nearly all of the recording looks like rest, yet it integrates to a velocity far "
      "beyond that of its noise: slow motion cannot be distinguished from drift; state when the "
      "sensor was at rest",
      {Advice{"still"}}};
}

std::optional<Error> unbridgeable_gap(const TrackSignal& signal) {
  constexpr double longest_s = 60.0;
  const auto gap = unmeasured_interval(signal.time_s, signal.accel_mps2.front(), longest_s);
  if (!gap) return std::nullopt;
  return Error{Errc::not_observable,
               text("no measurements from %.1f to %.1f s: the displacement in this gap may be "
                    "any, or the clock was set; analyse the parts before and after it",
                    gap->from_s, gap->to_s),
               {Advice{"from"}, Advice{"to"}}};
}

double scale_std(const TrackSignal& signal,
                 const TrackOptions& options,
                 const TrackSolution& solution) {
  constexpr double unknown = 0.01;
  if (options.scale_std) return *options.scale_std;
  if (!signal.resting_norm_mps2 || signal.gravity != GravityContent::present) return unknown;
  const double upwards =
      std::max(0.003, std::abs(*signal.resting_norm_mps2 / options.gravity_mps2 - 1.0));
  double cosine = solution.axis[2];
  if (!solution.axis_in_world) {
    cosine = 0.0;
    for (std::size_t a = 0; a < 3; ++a)
      cosine += solution.axis[a] * signal.reference_mps2[a] / *signal.resting_norm_mps2;
  }
  const double up = std::min(cosine * cosine, 1.0);
  return std::sqrt(up * upwards * upwards +
                   (1.0 - up) * std::max(unknown, upwards) * std::max(unknown, upwards));
}

void add_findings(const TrackSignal& signal, const TrackOptions& options, TrackSolution& solution) {
  note_jerk(solution);
  note_alternatives(solution);
  note_rests(options, solution);
  note_turning(solution);
  if (!solution.suspected_jerk) note_leaning(options, solution);
  note_scale(signal, options, solution);
  if (solution.missing > 0)
    solution.notes.push_back(
        {Severity::warning, text("%zu samples are missing: interpolated, with the uncertainty "
                                 "of the motion around them",
                                 solution.missing)});
  if (solution.travel_share < 0.8 && !solution.axis_given)
    solution.notes.push_back(
        {Severity::warning, text("only %.0f %% of the motion is along one axis: the displacement "
                                 "is that along its longest direction",
                                 100.0 * solution.travel_share)});
}

}  // namespace proofmass::estimate
