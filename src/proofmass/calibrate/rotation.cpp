#include "proofmass/calibrate/rotation.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <numbers>
#include <utility>

#include "proofmass/calibrate/rotating/delay.hpp"
#include "proofmass/calibrate/rotating/encoder_zero.hpp"
#include "proofmass/calibrate/rotating/pass.hpp"
#include "proofmass/calibrate/rotating/results.hpp"
#include "proofmass/calibrate/rotating/ripple.hpp"
#include "proofmass/calibrate/rotating/turns.hpp"
#include "proofmass/calibrate/rotating/words.hpp"
#include "proofmass/core/units.hpp"

namespace proofmass::calibrate {
namespace {

constexpr double quarter = std::numbers::pi / 2.0;
constexpr std::size_t least_steady_turns = 12;

Status check_one(const RotationRecording& one, const RotationRecording& first) {
  if (one.axes.empty() || one.axes.size() > 2) {
    return Error{Errc::invalid_argument, "expected one axis in the plane of the wheel, or two"};
  }
  if (one.axes.size() != first.axes.size()) {
    return Error{Errc::invalid_argument, "the recordings differ in their number of axes"};
  }
  if (one.angle_rad.empty() != first.angle_rad.empty()) {
    return Error{Errc::invalid_argument, "an angle is there in some recordings and not in others"};
  }
  const std::size_t n = one.time_s.size();
  const bool angle_fits = one.angle_rad.empty() || one.angle_rad.size() == n;
  const bool axes_fit = std::ranges::all_of(one.axes, [n](const auto& a) { return a.size() == n; });
  if (!angle_fits || !axes_fit) {
    return Error{Errc::invalid_argument, "columns of different lengths"};
  }
  if (n < 2) return Error{Errc::too_few_samples, "fewer than two samples"};
  for (std::size_t k = 0; k < n; ++k) {
    if (!std::isfinite(one.time_s[k]) || (k > 0 && !(one.time_s[k] > one.time_s[k - 1]))) {
      return Error{Errc::not_finite, fmt::format("sample {}: time does not go on", k + 1)};
    }
  }
  return Done{};
}

Status check(View<RotationRecording> recordings, const RotationOptions& options) {
  if (recordings.empty()) return Error{Errc::invalid_argument, "no recording"};
  if (!(options.gravity_mps2 > 0.0) || !(options.turns_per_knot >= 3.0)) {
    return Error{Errc::invalid_argument, "gravity above 0 and 3 turns a knot or more are expected"};
  }
  for (const RotationRecording& one : recordings) {
    if (const Status status = check_one(one, recordings.front()); !status) {
      return status.error().at(one.name);
    }
  }
  return Done{};
}

// Whether the encoder's angle increases over a section.
double sense_of(const SteadyTurns& section, const std::vector<double>& angle_rad) {
  double first = std::numeric_limits<double>::quiet_NaN(), last = first;
  for (std::size_t k = section.first; k <= section.last; ++k) {
    if (!std::isfinite(angle_rad[k])) continue;
    if (!std::isfinite(first)) first = angle_rad[k];
    last = angle_rad[k];
  }
  return last < first ? -1.0 : 1.0;
}

// Initial phase from the turns.
void start_phase(RotationState& state, const RotationOptions& options) {
  constexpr double most_intervals = 300.0;
  for (const SteadyTurns& section : state.sections) {
    const auto turns = static_cast<double>(section.turn_s.size() - 1);
    const double intervals =
        std::clamp(std::floor(turns / options.turns_per_knot), 1.0, most_intervals);
    std::vector<double> theta;
    theta.reserve(section.turn_s.size());
    for (std::size_t k = 0; k < section.turn_s.size(); ++k) {
      theta.push_back(rad_per_turn * static_cast<double>(k));
    }
    state.splines.push_back(fit_spline(section.turn_s, theta, static_cast<std::size_t>(intervals)));
    state.ripples.emplace_back(Ripple::Zero());
    if (state.angle_given)
      state.sense.push_back(sense_of(section, state.recordings[section.recording].angle_rad));
  }
}

// ω̄², whether ω² varies enough to determine a radius, and each section's speed.
void judge_speed(RotationState& state, RotationFit& fit) {
  constexpr double least_spread = 0.1;  // of ω², relative; less may be drift
  double sum = 0.0, squares = 0.0, count = 0.0;
  std::vector<double> by_section(state.sections.size()), samples(state.sections.size());
  std::vector<double> speed(state.sections.size());
  for_each_sample(state, [&](const RotationRecording&, const RotationSample& sample) {
    sum += sample.speed_squared;
    squares += sample.speed_squared * sample.speed_squared;
    count += 1.0;
    by_section[sample.section] += sample.speed_squared;
    speed[sample.section] += std::sqrt(sample.speed_squared);
    samples[sample.section] += 1.0;
  });
  state.mean_square_speed = sum / count;
  const double variance = squares / count - state.mean_square_speed * state.mean_square_speed;
  state.speed_determined =
      std::sqrt(std::max(variance, 0.0)) > least_spread * state.mean_square_speed;
  fit.sections.clear();
  fit.turns = 0.0;
  for (std::size_t s = 0; s < state.sections.size(); ++s) {
    const SteadyTurns& one = state.sections[s];
    const double n = std::max(samples[s], 1.0), mean = speed[s] / n;
    const double spread = std::sqrt(std::max(by_section[s] / n - mean * mean, 0.0));
    const auto turns = static_cast<double>(one.turn_s.size() - 1);
    fit.sections.push_back(
        {one.recording, one.turn_s.front(), one.turn_s.back(), turns, mean, spread});
    fit.turns += turns;
  }
}

double phase_of(const Harmonics& h) {
  return std::atan2(h(2), h(1));
}

// Shifts each axis's phase so that its output is K1 sin φ; errors if two axes are not orthogonal.
Status settle_phase(RotationState& state) {
  const auto whole_quarters = [](double phase) { return quarter * std::round(phase / quarter); };
  const double first = phase_of(state.harmonics[0]);
  state.offset[0] = state.angle_given ? whole_quarters(first) : first;
  if (state.axes == 2) {
    const double apart = std::remainder(phase_of(state.harmonics[1]) - first, rad_per_turn);
    if (std::abs(std::abs(apart) - quarter) > quarter / 2.0) {
      return Error{Errc::invalid_argument,
                   fmt::format("the two axes are {:.0f}° apart: expected two that are square to "
                               "each other in the plane of the wheel",
                               apart / rad_per_deg)};
    }
    // A second axis that lags is one that leads on a wheel that rotates in the other direction.
    if (apart < 0.0) {
      state.direction = -1.0;
      state.offset[0] = std::numbers::pi - state.offset[0];
    }
    state.offset[1] = state.offset[0] + quarter;
  }
  return Done{};
}

Status follows_gravity(const RotationState& state) {
  constexpr double most = 0.5;
  for (std::size_t axis = 0; axis < state.axes; ++axis) {
    const double left = relative_residual(state, axis);
    if (left < most) continue;
    return Error{
        Errc::not_observable,
        fmt::format(
            "{} % of the output's variation does not follow the rotation of gravity: the axle "
            "moves (as on a vehicle), the rotation is not uniform, or "
            "the axis is not in the plane of the wheel",
            std::round(100.0 * std::min(left, 9.99)))};
  }
  return Done{};
}

// Gauss–Newton iterations; their number, and whether they converged.
void iterate(RotationState& state, RotationFit& fit) {
  constexpr int most = 40;
  constexpr double still = 1e-10;
  for (fit.iterations = 1; fit.iterations <= most; ++fit.iterations) {
    const double change = step(state, !state.angle_given);
    if (!std::isfinite(change)) return;
    if (change < still) {
      fit.converged = true;
      return;
    }
  }
}

// The initial ω̄² was that of the turns' beginnings; the fitted one is better.
void refer_to_fitted_speed(RotationState& state, RotationFit& fit) {
  if (state.angle_given) return;
  const int before = fit.iterations;
  judge_speed(state, fit);
  if (!state.speed_determined) {
    for (Harmonics& h : state.harmonics) h(square_speed_column) = 0.0;
  }
  fit.converged = false;
  iterate(state, fit);
  fit.iterations += before;
}

// The encoder gives the speed variation within the turn, and thereby r ω² and r ω̇.
void fit_with_measured_ripples(RotationState& state, RotationFit& fit) {
  measure_ripples(state);
  const int before = fit.iterations;
  iterate(state, fit);
  fit.iterations += before;
}

// The steady turns of all recordings.
Result<FoundTurns> steady_turns(std::vector<RotationRecording>& recordings) {
  FoundTurns found;
  for (std::size_t k = 0; k < recordings.size(); ++k) {
    recordings[k].angle_rad = counted_on(recordings[k].angle_rad);
    find_turns(recordings[k], k, found);
  }
  std::size_t steady = 0;
  for (const SteadyTurns& one : found.sections) steady += one.turn_s.size() - 1;
  if (steady >= least_steady_turns) return found;
  return Error{Errc::too_few_samples,
               fmt::format("{} steady turns among the {} found: at least {} are needed, in "
                           "runs of 8 or more whose durations agree with their neighbours to "
                           "8 %, with 16 samples each (the axle must not move)",
                           steady, found.turns, least_steady_turns)};
}

// Harmonics and phase.
Status fit_harmonics(RotationState& state, RotationFit& fit) {
  // Harmonics for the current phase, the phase shifted, and harmonics again.
  step(state, false);
  if (const Status status = settle_phase(state); !status) return status.error();
  state.phase_defined = !state.angle_given;
  for (Harmonics& h : state.harmonics) h.setZero();
  step(state, false);
  step(state, false);
  if (const Status status = follows_gravity(state); !status) return status.error();
  iterate(state, fit);
  refer_to_fitted_speed(state, fit);
  if (!state.angle_given)
    fit.converged = fit_ripples(state) && fit.converged;
  else
    fit_with_measured_ripples(state, fit);
  return Done{};
}

// The harmonics with the scatter of their blocks and all bounds.
RotationEstimate estimate_of(const RotationState& state,
                             const RotationOptions& options,
                             RotationFit& fit) {
  const RotationNormal normal = normal_equations(state);
  RotationEstimate estimate;
  estimate.harmonics.resize(state.size());
  for (std::size_t axis = 0; axis < state.axes; ++axis) {
    estimate.harmonics.segment<harmonic_count>(harmonic_count * static_cast<Eigen::Index>(axis)) =
        state.harmonics[axis];
  }
  const RotationSolver solver = make_solver(state, normal);
  estimate.blocks = block_scores(state, solver);
  fit.blocks = static_cast<std::size_t>(estimate.blocks.scores.cols());
  fit.dof = estimate.dof();
  if (fit.angle_given) {
    allow_for_delay(state, options, estimate, fit);
    allow_for_radius(state, options, estimate);
  } else {
    separate_ripples(state, solver, options, estimate, fit);
  }
  return estimate;
}

}  // namespace

Result<RotationFit> fit_rotation(View<RotationRecording> recordings,
                                 const RotationOptions& options) {
  if (const Status status = check(recordings, options); !status) return status.error();
  std::vector<RotationRecording> counted(recordings.begin(), recordings.end());
  const auto found = steady_turns(counted);
  if (!found) return found.error();
  RotationFit fit;
  fit.steady_fraction = found->steady_s / found->recorded_s;
  fit.angle_given = !counted.front().angle_rad.empty();
  RotationState state;
  if (fit.angle_given) state.zero = relate_zero(counted, found->sections);
  state.recordings = counted;
  state.sections = found->sections;
  state.angle_given = fit.angle_given;
  state.axes = counted.front().axes.size();
  start_phase(state, options);
  judge_speed(state, fit);
  judge_delay(state);
  if (const Status status = fit_harmonics(state, fit); !status) return status.error();
  if (state.axes == 2) fit.direction = state.direction > 0.0 ? 1 : -1;
  const RotationEstimate estimate = estimate_of(state, options, fit);
  fill_rotation(state, estimate, options, fit);
  fold_turns(state, fit);
  note_doubts(state, options, fit);
  note_zero(state, fit);
  note_ripples(options, fit);
  return fit;
}

}  // namespace proofmass::calibrate
