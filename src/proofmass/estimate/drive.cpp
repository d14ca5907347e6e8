#include "proofmass/estimate/drive.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <string>
#include <utility>

#include "proofmass/core/in_parallel.hpp"
#include "proofmass/core/statistics.hpp"
#include "proofmass/estimate/drive/findings.hpp"
#include "proofmass/estimate/drive/fit.hpp"
#include "proofmass/estimate/drive/steering.hpp"
#include "proofmass/estimate/drive/yaw.hpp"

namespace proofmass::estimate {
namespace {

using namespace drive;

constexpr double least_correlation = 0.3;
constexpr double least_common_s = 3.0;
constexpr double unknown_radius_m = 0.3;  // with no scale, lengths are in units of this
// Least standard deviations of offsets found by correlation, before the filter refines them.
constexpr double wheel_offset_std_s = 0.1, fix_offset_std_s = 0.4;

Status check(const std::vector<DriveWheel>& wheels) {
  if (wheels.empty()) return Error{Errc::invalid_argument, "no wheel"};
  if (wheels.size() > most_drive_wheels)
    return Error{Errc::invalid_argument, "more than four wheels"};
  for (const DriveWheel& wheel : wheels) {
    if (!wheel.encoder_rad.empty() && wheel.encoder_rad.size() != wheel.sensor.time_s.size())
      return Error{Errc::invalid_argument, wheel.sensor.name + ": channels of different lengths"};
    if (wheel.circumference_m && !(wheel.circumference_m->value > 0.0))
      return Error{Errc::invalid_argument,
                   wheel.sensor.name + ": a circumference must be positive"};
  }
  return Done{};
}

Signal speed_signal(const Trace& trace) {
  Signal signal{trace.time_s, trace.speed_radps};
  for (double& value : signal.values) value = std::abs(value);
  return signal;
}

std::string seconds(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.2f s", value);
  return text;
}

// Σ of both speeds' product on the first's clock: negative if one counts backwards.
double same_way(const Trace& a, const Trace& b, double offset_s) {
  double sum = 0.0;
  for (std::size_t k = 0; k < a.time_s.size(); ++k) {
    const double t = a.time_s[k] + offset_s;
    if (t < b.time_s.front() || t > b.time_s.back()) continue;
    sum += a.speed_radps[k] * at_time(b.time_s, b.speed_radps, t);
  }
  return sum;
}

// The clocks of the recordings, numbered from the first wheel's, which is 0.
class Clocks {
 public:
  int number(int given) {
    const auto [found, is_new] = numbers_.try_emplace(given, next_);
    if (is_new) ++next_;
    return found->second;
  }
  int another() { return next_++; }

 private:
  std::map<int, int> numbers_;
  int next_ = 0;
};

struct Gathered {
  Recorded recorded;
  Setting setting;
};

// Relates one more wheel's clock to the first's, and its direction. Errors: not_observable.
Status relate(const DriveWheel& wheel,
              std::size_t i,
              Clocks& clocks,
              Gathered& all,
              DriveSolution& solution) {
  Vehicle& vehicle = all.setting.vehicle;
  std::vector<Trace>& traces = all.recorded.wheels;
  int clock = clocks.number(wheel.clock);
  const auto at_clock = static_cast<std::size_t>(clock);
  const bool known = clock == 0 || all.recorded.offset_std_s[at_clock] > 0.0;
  const std::optional<double> expected =
      known ? std::optional(all.recorded.offset_s[at_clock]) : std::nullopt;
  const Alignment found =
      align(log_speed(speed_signal(traces.front())), log_speed(speed_signal(traces[i])), expected);
  if (!known && found.correlation < least_correlation)
    return Error{Errc::not_observable, wheel.sensor.name + ": its speed resembles that of " +
                                           solution.wheels.front().name +
                                           " at no offset of their clocks: not of one drive"};
  if (known && std::abs(found.offset_s - *expected) > 0.5) {
    solution.notes.push_back({Severity::warning, wheel.sensor.name +
                                                     ": its stamps are of another clock than they "
                                                     "seem: the motion differs by " +
                                                     seconds(found.offset_s - *expected)});
    clock = clocks.another();
  }
  vehicle.clock[i] = clock;
  double offset_s = expected.value_or(0.0);
  if (!known || clock != clocks.number(wheel.clock)) {
    offset_s = found.offset_s;
    all.recorded.offset_s[static_cast<std::size_t>(clock)] = offset_s;
    all.recorded.offset_std_s[static_cast<std::size_t>(clock)] =
        std::max(wheel_offset_std_s, found.std_s);
  }
  if (same_way(traces.front(), traces[i], offset_s) < 0.0) reverse(traces[i]);
  return Done{};
}

// Forward is the direction in which the vehicle gets further.
void face_forward(std::vector<Trace>& traces) {
  double net = 0.0;
  for (const Trace& trace : traces) net += trace.angle_rad.back() - trace.angle_rad.front();
  if (net >= 0.0) return;
  for (Trace& trace : traces) reverse(trace);
}

// Turns of the vehicle on the first wheel's clock: by the gyroscope of a wheel, whose steering is
// part of it only briefly, or by the difference of the two sides, in turns of the wheels.
std::optional<Signal> turns_of(const std::vector<DriveWheel>& wheels, const Gathered& all) {
  const std::vector<Trace>& traces = all.recorded.wheels;
  const auto offset_s = [&](std::size_t i) {
    return all.recorded.offset_s[static_cast<std::size_t>(all.setting.vehicle.clock[i])];
  };
  for (std::size_t i = 0; i < traces.size(); ++i) {
    if (traces[i].yaw_rad.empty()) continue;
    Signal turns{traces[i].time_s, traces[i].yaw_rad};
    for (double& t : turns.time_s) t -= offset_s(i);
    return turns;
  }
  const auto right = std::ranges::find(wheels, VehicleSide::right, &DriveWheel::side);
  const auto left = std::ranges::find(wheels, VehicleSide::left, &DriveWheel::side);
  if (right == wheels.end() || left == wheels.end()) return std::nullopt;
  const auto r = static_cast<std::size_t>(right - wheels.begin());
  const auto l = static_cast<std::size_t>(left - wheels.begin());
  Signal turns;
  for (std::size_t k = 0; k < traces[r].time_s.size(); ++k) {
    const double t = traces[r].time_s[k] - offset_s(r);
    if (t < all.recorded.start_s || t > all.recorded.end_s) continue;
    turns.time_s.push_back(t);
    turns.values.push_back(traces[r].angle_rad[k] -
                           at_time(traces[l].time_s, traces[l].angle_rad, t + offset_s(l)));
  }
  return turns;
}

// Offset of the frame's clock by the turns of the vehicle. Errors: not_observable, those of
// trace_frame.
Result<Alignment> relate_frame(const DriveFrame& frame,
                               const std::vector<DriveWheel>& wheels,
                               const Gathered& all) {
  const auto turns = turns_of(wheels, all);
  if (!turns || frame.sensor.rate_radps[0].empty())
    return Error{Errc::not_observable,
                 frame.sensor.name +
                     ": its clock is not that of a wheel, and the wheels show no "
                     "turns to relate them by"};
  const auto trace = trace_frame(
      frame.sensor, {{frame.sensor.time_s.front(), frame.sensor.time_s.front() + 1.0, 0, {}}});
  if (!trace) return trace.error();
  const Alignment found = align(*turns, {trace->time_s, trace->yaw_rad});
  if (found.correlation < least_correlation)
    return Error{Errc::not_observable,
                 frame.sensor.name +
                     ": its turns resemble those of the wheels at no offset of their clocks"};
  return found;
}

Status add_frame(const DriveFrame& frame,
                 const std::vector<DriveWheel>& wheels,
                 Clocks& clocks,
                 Gathered& all,
                 DriveSolution& solution) {
  const int clock = clocks.number(frame.clock);
  const auto at_clock = static_cast<std::size_t>(clock);
  if (clock != 0 && all.recorded.offset_std_s[at_clock] == 0.0) {
    const auto found = relate_frame(frame, wheels, all);
    if (!found && found.error().code != Errc::not_observable) return found.error();
    if (!found) {
      solution.notes.push_back({Severity::warning, found.error().message + ": it is not used"});
      return Done{};
    }
    all.recorded.offset_s[at_clock] = found->offset_s;
    all.recorded.offset_std_s[at_clock] = std::max(2.0 * wheel_offset_std_s, found->std_s);
  }
  const double offset_s = all.recorded.offset_s[at_clock];
  all.setting.vehicle.clock[most_drive_wheels] = clock;
  std::vector<Stretch> rests = rests_of(all.recorded.wheels.front(), 1.0);
  for (Stretch& rest : rests) {
    // Half a second inside, since the offset is not exact yet.
    rest.start_s += offset_s + 0.3;
    rest.end_s += offset_s - 0.3;
  }
  auto trace = trace_frame(frame.sensor, rests);
  if (!trace) {
    solution.notes.push_back({Severity::warning, trace.error().message + ": it is not used"});
    return Done{};
  }
  all.recorded.frame = std::move(trace).value();
  return Done{};
}

Status add_fixes(const GnssFixes& fixes, Clocks& clocks, Gathered& all, DriveSolution& solution) {
  LocalFixes local = local_fixes(fixes);
  const ScaledAlignment found = align_fixes(speed_signal(all.recorded.wheels.front()), local);
  if (found.alignment.correlation < least_correlation) {
    solution.notes.push_back(
        {Severity::warning,
         fixes.name + ": the speed of the fixes resembles that of the wheels at no offset "
                      "of their clocks: the fixes are not used"});
    return Done{};
  }
  for (double& t : local.time_s) t *= found.scale;
  if (found.scale != 1.0) {
    char text[32];
    std::snprintf(text, sizeof text, "%g", found.scale);
    solution.notes.push_back(
        {Severity::warning, fixes.name +
                                ": its stamps fit the motion of the wheels when multiplied by " +
                                text + ", which was done"});
  }
  const int clock = clocks.another();
  all.setting.vehicle.fix_clock = clock;
  all.recorded.offset_s[static_cast<std::size_t>(clock)] = found.alignment.offset_s;
  all.recorded.offset_std_s[static_cast<std::size_t>(clock)] = fix_offset_std_s;
  all.recorded.fixes = std::move(local);
  solution.fixes = DriveFixesFit{.name = fixes.name, .time_scale = found.scale};
  solution.has_fixes = true;
  solution.origin_deg = {all.recorded.fixes->latitude_rad * deg_per_rad,
                         all.recorded.fixes->longitude_rad * deg_per_rad};
  return Done{};
}

// Rolling radius from the fixes' speed at the wheels' faster half, by the median.
double radius_from_fixes(const Recorded& recorded, double offset_s) {
  const Signal speed = speed_of(*recorded.fixes);
  const Trace& wheel = recorded.wheels.front();
  double fastest = 0.0;
  for (const double rate : wheel.speed_radps) fastest = std::max(fastest, std::abs(rate));
  std::vector<double> ratios;
  for (std::size_t k = 0; k < speed.time_s.size(); ++k) {
    const double t = speed.time_s[k] - offset_s;
    if (t < wheel.time_s.front() || t > wheel.time_s.back()) continue;
    const double rate = std::abs(at_time(wheel.time_s, wheel.speed_radps, t));
    if (rate > 0.5 * fastest) ratios.push_back(speed.values[k] / rate);
  }
  return median(ratios).value_or(unknown_radius_m);
}

/// Rolling radius of a wheel as given or, without fixes, as its own gyroscope and accelerometer
/// show it.
std::optional<Uncertain> known_radius_m(const DriveWheel& wheel,
                                        const Recorded& recorded,
                                        std::size_t at) {
  if (const auto& given = wheel.circumference_m)
    return Uncertain{given->value / rad_per_turn, given->std / rad_per_turn};
  return recorded.fixes ? std::nullopt : recorded.wheels[at].rolling_radius_m;
}

void set_radii(const std::vector<DriveWheel>& wheels, Gathered& all) {
  Vehicle& vehicle = all.setting.vehicle;
  double usual_m = unknown_radius_m, spread = 0.02;
  const auto given = std::ranges::find_if(
      wheels, [](const DriveWheel& wheel) { return wheel.circumference_m.has_value(); });
  if (given != wheels.end()) {
    usual_m = given->circumference_m->value / rad_per_turn;
    spread = 0.1;
  } else if (all.recorded.fixes) {
    usual_m = radius_from_fixes(all.recorded,
                                all.recorded.offset_s[static_cast<std::size_t>(vehicle.fix_clock)]);
    spread = 0.2;
  }
  for (std::size_t i = 0; i < wheels.size(); ++i) {
    const auto own = known_radius_m(wheels[i], all.recorded, i);
    vehicle.radius_m[i] = own ? own->value : usual_m;
    all.setting.radius_std[i] = own ? own->std / own->value : spread;
  }
}

Result<Gathered> gather(const std::vector<DriveWheel>& wheels,
                        const std::optional<DriveFrame>& frame,
                        const std::optional<GnssFixes>& fixes,
                        const DriveOptions& options,
                        DriveSolution& solution) {
  Gathered all;
  Clocks clocks;
  all.setting.vehicle.wheels = static_cast<int>(wheels.size());
  std::vector<std::optional<Result<Trace>>> traces(wheels.size());
  in_parallel(wheels.size(), options.progress, [&](std::size_t i, const Progress& shown) {
    WheelOptions own = options.wheel;
    own.progress = shown;
    traces[i] = trace_wheel(wheels[i], own);
  });
  for (std::size_t i = 0; i < wheels.size(); ++i) {
    Result<Trace>& trace = *traces[i];
    if (!trace) return trace.error();
    for (const Note& note : trace->notes) solution.notes.push_back(note);
    all.recorded.wheels.push_back(std::move(trace).value());
    solution.wheels.push_back({.name = wheels[i].sensor.name, .side = wheels[i].side});
  }
  for (std::size_t i = 0; i < wheels.size(); ++i)
    if (Status status = relate(wheels[i], i, clocks, all, solution); !status) return status.error();
  face_forward(all.recorded.wheels);
  Recorded& recorded = all.recorded;
  recorded.start_s = -INFINITY;
  recorded.end_s = INFINITY;
  for (std::size_t i = 0; i < wheels.size(); ++i) {
    const double offset_s =
        recorded.offset_s[static_cast<std::size_t>(all.setting.vehicle.clock[i])];
    recorded.start_s = std::max(recorded.start_s, recorded.wheels[i].time_s.front() - offset_s);
    recorded.end_s = std::min(recorded.end_s, recorded.wheels[i].time_s.back() - offset_s);
  }
  if (recorded.end_s - recorded.start_s < least_common_s)
    return Error{Errc::not_observable, "the wheels' recordings have no three seconds in common"};
  if (frame)
    if (Status status = add_frame(*frame, wheels, clocks, all, solution); !status)
      return status.error();
  if (fixes)
    if (Status status = add_fixes(*fixes, clocks, all, solution); !status) return status.error();
  set_radii(wheels, all);
  return all;
}

Known known_of(const std::vector<DriveWheel>& wheels,
               const DriveOptions& options,
               const Gathered& all,
               const Fitted& fitted) {
  Known known;
  const bool fixes = all.recorded.fixes.has_value();
  known.scale = fixes;
  for (std::size_t i = 0; i < wheels.size(); ++i)
    known.scale |= known_radius_m(wheels[i], all.recorded, i).has_value();
  known.yaw = all.recorded.has_yaw();
  known.both_sides = std::ranges::any_of(
      wheels, [&](const DriveWheel& wheel) { return wheel.side != wheels.front().side; });
  known.track = options.track_m.has_value() || fixes || known.yaw;
  const auto& vehicle = fitted.setting.vehicle;
  if (known.both_sides || options.track_m)
    known.reference_point = std::ranges::find(vehicle.steered, true) == vehicle.steered.end()
                                ? "middle between the wheels"
                                : "middle of the unsteered axle";
  else
    known.reference_point =
        "contact point of the unsteered wheel on the side of " + wheels.front().sensor.name;
  return known;
}

}  // namespace

Result<DriveSolution> estimate_drive(const std::vector<DriveWheel>& wheels,
                                     const std::optional<DriveFrame>& frame,
                                     const std::optional<GnssFixes>& fixes,
                                     const DriveOptions& options) {
  if (Status status = check(wheels); !status) return status.error();
  DriveSolution solution;
  auto gathered = gather(wheels, frame, fixes, options, solution);
  if (!gathered) return gathered.error();
  Gathered all = std::move(gathered).value();
  const Fitted fitted = fit_best(wheels, options, all.recorded, all.setting, solution);
  if (!fitted.converged)
    return Error{
        Errc::not_observable,
        "the path does not converge: too little is known of the vehicle's dimensions, or the "
        "recordings contradict each other",
        {Advice{"circumference"}, Advice{"track"}}};
  report_findings(all.recorded, fitted, known_of(wheels, options, all, fitted), solution);
  return solution;
}

}  // namespace proofmass::estimate
