#include "proofmass/estimate/drive/steering.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>

namespace proofmass::estimate::drive {
namespace {

constexpr Uncertain usual_track_m{1.2, 0.6}, usual_base_m{2.6, 0.5};

// Which of the wheels are on the steered axle.
using Steered = std::array<bool, most_drive_wheels>;

// Whether an assignment agrees with what is given and has at most one wheel of a side on either
// axle; several on an axle if none is steered.
bool is_possible(const Steered& steered, const std::vector<DriveWheel>& wheels) {
  std::array<std::array<int, 2>, 2> count{};
  for (std::size_t i = 0; i < wheels.size(); ++i) {
    if (wheels[i].steered.value_or(steered[i]) != steered[i]) return false;
    ++count[wheels[i].side == VehicleSide::left ? 1 : 0][steered[i] ? 1 : 0];
  }
  const bool any = std::ranges::find(steered, true) != steered.end();
  return std::ranges::all_of(
      count, [any](const auto& side) { return side[1] <= 1 && (!any || side[0] <= 1); });
}

std::vector<Steered> assignments(const std::vector<DriveWheel>& wheels) {
  std::vector<Steered> all;
  for (unsigned bits = 0; bits < 1u << wheels.size(); ++bits) {
    Steered steered{};
    for (std::size_t i = 0; i < wheels.size(); ++i) steered[i] = ((bits >> i) & 1u) != 0;
    if (is_possible(steered, wheels)) all.push_back(steered);
  }
  return all;
}

std::string names_of(const std::vector<DriveWheel>& wheels, const Steered& steered) {
  std::string names;
  for (std::size_t i = 0; i < wheels.size(); ++i)
    if (steered[i]) names += (names.empty() ? "" : " and ") + wheels[i].sensor.name;
  return names;
}

void set_geometry(const std::vector<DriveWheel>& wheels,
                  const DriveOptions& options,
                  const Steered& steered,
                  Setting& setting) {
  const bool both = std::ranges::any_of(
      wheels, [&](const DriveWheel& wheel) { return wheel.side != wheels.front().side; });
  const bool offset = both || options.track_m;
  setting.vehicle.steered = steered;
  for (std::size_t i = 0; i < wheels.size(); ++i)
    setting.vehicle.side[i] = !offset ? 0.0 : wheels[i].side == VehicleSide::left ? 1.0 : -1.0;
  setting.track_m = !offset ? Uncertain{} : options.track_m.value_or(usual_track_m);
  const bool any = std::ranges::find(steered, true) != steered.end();
  setting.base_m = any ? options.wheelbase_m.value_or(usual_base_m) : Uncertain{};
}

// Whether the gyroscopes of two wheels turned by different angles: one of them steers.
bool turned_differently(const Trace& a, const Trace& b) {
  if (a.yaw_rad.empty() || b.yaw_rad.empty()) return false;
  const double first = a.yaw_rad.back() - a.yaw_rad.front();
  const double second = b.yaw_rad.back() - b.yaw_rad.front();
  const double span_s = a.time_s.back() - a.time_s.front();
  double walk_rad2 = (a.yaw_walk_rad2ps + b.yaw_walk_rad2ps) * span_s;
  for (const Trace* trace : {&a, &b})
    if (!trace->yaw_gap_rad2.empty()) walk_rad2 += trace->yaw_gap_rad2.back();
  return std::abs(first - second) >= 0.05 + 0.04 * std::abs(first) + 3.0 * std::sqrt(walk_rad2);
}

void warn_of_steering(const std::vector<DriveWheel>& wheels,
                      const std::vector<Trace>& traces,
                      DriveSolution& solution) {
  for (std::size_t i = 0; i < traces.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (!turned_differently(traces[i], traces[j])) continue;
      solution.notes.push_back(
          {Severity::warning,
           wheels[i].sensor.name + " and " + wheels[j].sensor.name +
               ": their gyroscopes turned by different angles, as wheels of a steered and of an "
               "unsteered axle do: state those of the steered axle",
           {Advice{"front"}}});
      return;
    }
  }
}

// The wheels of one axle show by a gyroscope of theirs alone whether they steer.
bool show_steering(const std::vector<DriveWheel>& wheels, const Recorded& recorded) {
  const auto lefts = std::ranges::count(wheels, VehicleSide::left, &DriveWheel::side);
  const auto rights = std::ssize(wheels) - lefts;
  return std::max(lefts, rights) > 1 || recorded.wheels_have_yaw();
}

// ln of the likelihood ratio at which one assignment is preferred.
constexpr double clear = 5.0;

// An assignment, and the logarithms of the likelihoods of all that were compared.
struct Choice {
  Steered steered{};
  double log_likelihood = -std::numeric_limits<double>::infinity();
  std::vector<double> compared{};

  [[nodiscard]] bool any_steered() const {
    return std::ranges::find(steered, true) != steered.end();
  }
  // Whether another assignment explains the motion nearly as well.
  [[nodiscard]] bool is_open() const {
    return std::ranges::count_if(compared,
                                 [&](double one) { return one > log_likelihood - clear; }) > 1;
  }
};

// Compares the likelihoods at the most probable paths: the likelihood is an integral over speed and
// yaw rate, which are almost free. Its value depends on the point of the vehicle whose speed is the
// state, and favours the assignment in which that point is slower.
Choice choose(const std::vector<DriveWheel>& wheels,
              const DriveOptions& options,
              const Recorded& recorded,
              Setting setting) {
  const std::vector<Steered> all = assignments(wheels);
  Choice choice{all.front(), -std::numeric_limits<double>::infinity(), {}};
  if (all.size() == 1 || !show_steering(wheels, recorded)) return choice;
  // A single wheel shows only by the fixes' noise that it steers: that noise must be estimated.
  const Effort effort = all.size() <= 2 ? Effort::comparison : Effort::quick_comparison;
  for (const Steered& steered : all) {
    set_geometry(wheels, options, steered, setting);
    const Pass pass = fit_path(recorded, setting, effort, {}).pass;
    const double now = effort == Effort::comparison ? pass.log_likelihood : -0.5 * pass.chi2;
    choice.compared.push_back(now);
    if (!(now > choice.log_likelihood + clear)) continue;
    choice.log_likelihood = now;
    choice.steered = steered;
  }
  return choice;
}

void note_choice(const std::vector<DriveWheel>& wheels,
                 const Choice& choice,
                 DriveSolution& solution) {
  const std::string names = names_of(wheels, choice.steered);
  // A single wheel shows by the fixes alone that it steers, which wander.
  if (choice.is_open() || (wheels.size() == 1 && !choice.compared.empty()))
    solution.notes.push_back(
        {Severity::warning,
         "the motion does not show which wheels are on the steered axle: " +
             (choice.any_steered() ? names + " are taken to be"
                                   : std::string("all are taken as unsteered")) +
             ", and the heading is off by the change of the steering angle if they are not; state "
             "them",
         {Advice{"front"}}});
  if (!choice.compared.empty() && choice.log_likelihood > choice.compared.front())
    solution.notes.push_back({Severity::info,
                              "the motion shows that " + names + " are on the steered axle",
                              {Advice{"front"}}});
}

}  // namespace

Fitted fit_best(const std::vector<DriveWheel>& wheels,
                const DriveOptions& options,
                const Recorded& recorded,
                Setting& setting,
                DriveSolution& solution) {
  const Choice choice = choose(wheels, options, recorded, setting);
  set_geometry(wheels, options, choice.steered, setting);
  if (!choice.any_steered() && assignments(wheels).size() > 1)
    warn_of_steering(wheels, recorded.wheels, solution);
  note_choice(wheels, choice, solution);
  return fit_path(recorded, setting, Effort::full, options.progress);
}

}  // namespace proofmass::estimate::drive
