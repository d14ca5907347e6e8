#include "proofmass/estimate/tilt.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "proofmass/core/statistics.hpp"
#include "proofmass/estimate/tilt_motion.hpp"
#include "proofmass/estimate/tilt_rest.hpp"

namespace proofmass::estimate {
namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN();
constexpr double still_share = 0.9;
constexpr std::size_t fewest_moving = 50;

using Axes = std::array<std::vector<double>, 3>;

std::string number(double value) {
  const double hundredths = std::round(std::abs(value) * 100.0);
  std::string fraction = std::to_string(static_cast<long long>(hundredths) % 100);
  if (fraction.size() == 1) fraction.insert(0, "0");
  return (value < 0.0 ? "-" : "") + std::to_string(static_cast<long long>(hundredths) / 100) + "." +
         fraction;
}

bool has_rates(const TiltRecord& record) {
  return std::ranges::all_of(record.rate_radps, [](const auto& axis) { return !axis.empty(); });
}

Mat<3> at(const Axes& axes, std::size_t k) {
  Mat<3> out = Mat<3>::Constant(none);
  for (std::size_t i = 0; i < 3; ++i)
    if (!axes[i].empty() && std::isfinite(axes[i][k]))
      out(static_cast<Eigen::Index>(i)) = axes[i][k];
  return out;
}

Status check(const TiltRecord& record, std::size_t& samples) {
  const auto& axes = record.accel_mps2;
  const auto first = std::ranges::find_if(axes, [](const auto& axis) { return !axis.empty(); });
  if (first == axes.end()) return Error{Errc::invalid_argument, "no accelerometer axis"};
  samples = first->size();
  const auto fits = [&](const auto& values) { return values.empty() || values.size() == samples; };
  if (!std::ranges::all_of(axes, fits) || !std::ranges::all_of(record.rate_radps, fits) ||
      !fits(record.time_s))
    return Error{Errc::invalid_argument, "channels of different length"};
  for (std::size_t k = 0; k < record.time_s.size(); ++k)
    if (!std::isfinite(record.time_s[k]) || (k > 0 && record.time_s[k] < record.time_s[k - 1]))
      return Error{Errc::invalid_argument,
                   "time must ascend, but does not at sample " + std::to_string(k)};
  return Done{};
}

// Refuses what cannot be the force on a body under gravity, by its median norm.
Status check_force(const TiltRecord& record, const TiltOptions& options, TiltSolution& solution) {
  std::vector<double> norms;
  for (std::size_t k = 0; k < solution.samples; ++k) {
    const Mat<3> f = at(record.accel_mps2, k);
    const auto present = static_cast<std::size_t>(f.array().isFinite().count());
    if (present < solution.axes)
      ++solution.unusable;
    else
      norms.push_back(f.norm());
  }
  if (norms.empty()) return Error{Errc::too_few_samples, "no sample has a reading on every axis"};
  if (solution.axes < 3) return Done{};
  const double usual = *median(norms), g = options.gravity_mps2.value;
  if (usual < 0.5 * g || usual > 2.0 * g)
    return Error{Errc::not_observable,
                 "the force has a median of " + number(usual) + " m/s^2 where gravity is " +
                     number(g) +
                     (usual < g ? ": gravity was removed from it, or its unit is another"
                                : ": its unit is another, or it needs a calibration")};
  return Done{};
}

signal::RestSearch rests_of(const TiltRecord& record, const TiltOptions& options) {
  std::vector<View<double>> axes;
  for (const auto& axis : record.accel_mps2)
    if (!axis.empty()) axes.emplace_back(axis);
  double rate_hz = 0.0;
  if (record.time_s.size() > 1) {
    std::vector<double> steps;
    for (std::size_t k = 1; k < record.time_s.size(); ++k)
      steps.push_back(record.time_s[k] - record.time_s[k - 1]);
    const double step = median(steps).value_or(0.0);
    if (step > 0.0) rate_hz = 1.0 / step;
  }
  return signal::find_rests(axes, {.rate_hz = rate_hz, .shortest_s = options.shortest_rest_s});
}

// Whether the base moves; or why nothing can be said.
Result<bool> is_moving(const TiltRecord& record,
                       const TiltOptions& options,
                       const signal::RestSearch& found,
                       const TiltSolution& solution) {
  std::size_t resting = 0;
  for (const signal::Rest& rest : found.rests) resting += rest.last - rest.first + 1;
  const bool mostly =
      static_cast<double>(resting) >= still_share * static_cast<double>(solution.samples);
  const bool timed = record.time_s.size() > 1;
  if (options.base == TiltBase::still || (options.base == TiltBase::automatic && mostly))
    return false;
  const bool can_follow = timed && solution.axes == 3;
  if (options.base == TiltBase::automatic && !can_follow && !found.rests.empty()) return false;
  if (!timed)
    return Error{Errc::not_observable, "a moving base takes time: give a time column or the rate"};
  if (solution.axes < 3)
    return Error{Errc::not_observable, "a moving base takes three axes, not " +
                                           std::to_string(solution.axes) +
                                           "; if it is still, say so"};
  if (solution.samples < solution.unusable + fewest_moving)
    return Error{Errc::too_few_samples, "a moving base takes at least 50 readings"};
  return true;
}

void make_series(const TiltRecord& record, TiltSolution& solution) {
  TiltSeries& s = solution.series;
  s.time_s = record.time_s;
  for (auto* values :
       {&s.roll_rad, &s.pitch_rad, &s.roll_std_rad, &s.pitch_std_rad, &s.filtered_roll_rad,
        &s.filtered_pitch_rad, &s.filtered_roll_std_rad, &s.filtered_pitch_std_rad})
    values->assign(solution.samples, none);
  s.weight.assign(solution.samples, 0.0F);
  s.resting.assign(solution.samples, 0);
  for (const TiltRest& rest : solution.rests)
    std::fill(s.resting.begin() + static_cast<std::ptrdiff_t>(rest.first),
              s.resting.begin() + static_cast<std::ptrdiff_t>(rest.last) + 1, 1);
}

void put(const std::optional<Uncertain>& angle, double& value, double& std) {
  value = angle ? angle->value : none;
  std = angle ? angle->std : none;
}

// Of a still base: the mean of the rest so far, and that of the rest.
void fill_still(const TiltRecord& record, const TiltOptions& options, TiltSolution& solution) {
  const ForceSpread spread(options);
  TiltSeries& s = solution.series;
  for (const TiltRest& rest : solution.rests) {
    Mat<3> sum = Mat<3>::Zero(), whole = Mat<3>::Zero();
    double count = 0.0;
    for (std::size_t i = 0; i < 3; ++i) {
      if (record.accel_mps2[i].empty()) continue;
      const auto row = static_cast<Eigen::Index>(i);
      const StretchMean mean = stretch_mean(
          View<double>(record.accel_mps2[i]).subspan(rest.first, rest.last - rest.first + 1), 0.0);
      whole(row) = mean.variance * static_cast<double>(mean.count) +
                   1e-12;  // of one reading, as strong as all of them together say
    }
    for (std::size_t k = rest.first; k <= rest.last; ++k) {
      put(rest.angles.roll_rad, s.roll_rad[k], s.roll_std_rad[k]);
      put(rest.angles.pitch_rad, s.pitch_rad[k], s.pitch_std_rad[k]);
      const Mat<3> f = at(record.accel_mps2, k);
      const auto present = static_cast<std::size_t>(f.array().isFinite().count());
      if (present == solution.axes) {
        sum += f;
        count += 1.0;
        s.weight[k] = 1.0F;
      }
      if (count == 0.0) continue;
      const Mat<3> mean = sum / count;
      const Mat<3> known = mean.array().isFinite().select(mean, 0.0);
      if (!(known.norm() > 0.0)) continue;
      const Mat<3, 3> noise = (whole / count).asDiagonal();
      const TiltAngles angles = angles_of_some(
          mean, noise + spread.calibration(known) + spread.alignment(known), options.gravity_mps2);
      put(angles.roll_rad, s.filtered_roll_rad[k], s.filtered_roll_std_rad[k]);
      put(angles.pitch_rad, s.filtered_pitch_rad[k], s.filtered_pitch_std_rad[k]);
    }
  }
}

TiltInstants instants_of(const TiltRecord& record, const TiltSolution& solution) {
  TiltInstants out;
  const bool rates = has_rates(record);
  std::vector<double> steps(1, 0.0);
  for (std::size_t k = 1; k < solution.samples; ++k)
    steps.push_back(record.time_s[k] - record.time_s[k - 1]);
  const double longest = 5.0 * median(View<double>(steps).subspan(1)).value_or(0.0);
  out.resting = solution.series.resting;
  for (std::size_t k = 0; k < solution.samples; ++k) {
    out.force_mps2.push_back(at(record.accel_mps2, k));
    if (!rates) continue;
    const Mat<3> now = at(record.rate_radps, k);
    const Mat<3> before = k == 0 ? now : out.rate_at_radps.back();
    Mat<3> mean = 0.5 * (now + before);
    if (!now.allFinite()) mean = before;
    if (!before.allFinite()) mean = now;
    if (steps[k] > longest) mean.setConstant(none);
    out.rate_at_radps.push_back(now);
    out.rate_radps.push_back(mean);
  }
  out.step_s = std::move(steps);
  return out;
}

// Takes readings that a logger wrote again and again until the next came for one. They are told by
// whole rows that repeat, in motion, where noise alone would keep them apart.
std::size_t drop_held(TiltInstants& instants) {
  const std::size_t size = instants.force_mps2.size();
  std::vector<std::size_t> repeats;
  std::size_t moving = 0;
  for (std::size_t k = 1; k < size; ++k) {
    if (instants.resting[k] != 0 || !instants.force_mps2[k].allFinite()) continue;
    ++moving;
    const bool same_rate = instants.rate_at_radps.empty() ||
                           instants.rate_at_radps[k] == instants.rate_at_radps[k - 1];
    if (same_rate && instants.force_mps2[k] == instants.force_mps2[k - 1]) repeats.push_back(k);
  }
  if (2 * repeats.size() < moving) return 0;
  for (const std::size_t k : repeats) instants.force_mps2[k].setConstant(none);
  return repeats.size();
}

// Standard deviation of white noise as strong at low frequency as the longest rest shows.
Mat<3> rest_std(const Axes& axes, const TiltSolution& solution, double least) {
  Mat<3> out = Mat<3>::Constant(least);
  const auto longest = std::ranges::max_element(
      solution.rests, {}, [](const TiltRest& rest) { return rest.last - rest.first; });
  if (longest == solution.rests.end()) return out;
  for (std::size_t i = 0; i < 3; ++i) {
    const StretchMean mean = stretch_mean(
        View<double>(axes[i]).subspan(longest->first, longest->last - longest->first + 1), 0.0);
    const double variance = std::max(mean.scatter, mean.variance * static_cast<double>(mean.count));
    out(static_cast<Eigen::Index>(i)) = std::max(least, std::sqrt(variance));
  }
  return out;
}

TiltKnown known_of(const TiltRecord& record,
                   const TiltOptions& options,
                   const TiltSolution& solution,
                   const TiltInstants& instants) {
  TiltKnown known{.gravity_mps2 = options.gravity_mps2.value,
                  .gravity_std_mps2 = options.gravity_mps2.std,
                  .rest_std_mps2 = rest_std(record.accel_mps2, solution, 1e-4),
                  .rate_bias_std_radps = options.rate_bias_std_radps,
                  .rate_bias_walk_radps_rts = options.rate_bias_walk_radps_rts};
  std::vector<double> norms;
  for (const TiltRest& rest : solution.rests)
    if (rest.norm_mps2) norms.push_back(rest.norm_mps2->value);
  if (const auto norm = median(norms)) {
    known.gravity_mps2 = *norm;
    known.gravity_std_mps2 = 0.0;
  }
  if (!has_rates(record)) return known;
  known.rest_rate_std_radps = rest_std(record.rate_radps, solution, 1e-5);
  const double step_s = median(View<double>(instants.step_s).subspan(1)).value_or(0.0);
  if (!solution.rests.empty())
    known.rate_noise_radps_rthz = known.rest_rate_std_radps.maxCoeff() * std::sqrt(step_s);
  known.rate_scale_std = options.rate_scale_std;
  std::vector<double> rates;
  for (const Mat<3>& rate : instants.rate_at_radps)
    if (rate.allFinite()) rates.push_back(rate.norm());
  known.usual_rate_radps = std::max(0.05, quantile(rates, 0.9).value_or(1.0));
  return known;
}

// Where nothing is known of the sensor's errors, a norm that is not gravity's shows their size.
void judge_norm(TiltOptions& options, TiltSolution& solution) {
  const ForceSpread spread(options);
  double squares = 0.0, count = 0.0;
  for (const TiltRest& rest : solution.rests) {
    if (!rest.norm_mps2) continue;
    const double off = rest.norm_mps2->value - options.gravity_mps2.value;
    squares += off * off;
    count += 1.0;
  }
  const double off = count > 0.0 ? std::sqrt(squares / count) : 0.0;
  const bool unknown = !spread.knows_calibration() && options.bias_std_mps2 == 0.0;
  if (unknown && off > 2.0 * options.gravity_mps2.std) {
    options.bias_std_mps2 = off;
    solution.notes.push_back(
        {Severity::warning,
         "at rest the force departs from gravity by " + number(off) +
             " m/s^2, and nothing says how well the sensor is calibrated: each axis is taken to be "
             "off by as much; a sensor file tells better"});
  } else if (unknown) {
    solution.notes.push_back(
        {Severity::warning,
         "nothing says how well the sensor is calibrated: standard deviations count its noise "
         "alone, and a bias of 0.1 m/s^2 tilts by 0.6 degrees; give --sensor or --bias-std"});
  } else if (count > 0.0 && solution.rests.front().norm_mps2 &&
             off > 3.0 * std::hypot(solution.rests.front().norm_mps2->std,
                                    options.gravity_mps2.std)) {
    solution.notes.push_back(
        {Severity::warning,
         "at rest the force departs from gravity by " + number(off) +
             " m/s^2, more than three standard deviations of the calibration: the sensor has "
             "changed, or it was not at rest"});
  }
}

void find_rests(const TiltRecord& record,
                const TiltOptions& options,
                const std::vector<signal::Rest>& found,
                TiltSolution& solution) {
  std::array<double, 3> steps{};
  for (std::size_t i = 0; i < 3; ++i) steps[i] = least_step(record.accel_mps2[i]);
  solution.rests.clear();
  for (const signal::Rest& rest : found)
    solution.rests.push_back(rest_of(record, options, rest, steps));
}

void note_unusable(TiltSolution& solution) {
  if (solution.unusable == 0) return;
  solution.notes.push_back({Severity::warning, std::to_string(solution.unusable) + " of " +
                                                   std::to_string(solution.samples) +
                                                   " samples lack a reading on some axis"});
}

}  // namespace

Result<TiltSolution> estimate_tilt(const TiltRecord& record, const TiltOptions& given) {
  TiltSolution solution;
  TiltOptions options = given;
  if (Status fits = check(record, solution.samples); !fits) return fits.error();
  for (const auto& axis : record.accel_mps2) solution.axes += axis.empty() ? 0 : 1;
  if (Status force = check_force(record, options, solution); !force) return force.error();
  note_unusable(solution);
  signal::RestSearch found = rests_of(record, options);
  const Result<bool> moving = is_moving(record, options, found, solution);
  if (!moving) return moving.error();
  solution.moving = *moving;
  if (!solution.moving && found.rests.empty()) {
    found.rests.push_back({0, solution.samples - 1});
    solution.notes.push_back(
        {Severity::warning, "no rest was found (" + found.why_none +
                                "): the mean of the whole recording is taken, as if it were"});
  }
  find_rests(record, options, found.rests, solution);
  const double bias_std = options.bias_std_mps2;
  judge_norm(options, solution);
  if (options.bias_std_mps2 != bias_std) find_rests(record, options, found.rests, solution);
  make_series(record, solution);
  if (!solution.moving) {
    fill_still(record, options, solution);
    solution.final = solution.rests.back().angles;
    solution.shares = solution.rests.back().shares;
    return solution;
  }
  TiltInstants instants = instants_of(record, solution);
  if (const std::size_t held = drop_held(instants); held > 0)
    solution.notes.push_back(
        {Severity::warning, std::to_string(held) + " of " + std::to_string(solution.samples) +
                                " rows repeat the one before: the sensor is slower than the "
                                "recording, and each reading counts once"});
  const TiltKnown known = known_of(record, options, solution, instants);
  if (options.progress) options.progress("fitting the noise", 0.0);
  const bool gyroscope = has_rates(record);
  Mat<3> rate_bias = Mat<3>::Zero();
  // A biased gyroscope's turning would pass for acceleration: once more without its bias.
  for (int round = 0; round < (gyroscope ? 2 : 1); ++round) {
    const BaseAccel accel = base_accel(instants, rate_bias, known.gravity_mps2);
    instants.accel_std_mps2 = accel.std_mps2;
    solution.motion = fit_tilt_motion(instants, known, accel, gyroscope);
    if (gyroscope) rate_bias = rate_bias_of(instants, known, *solution.motion);
  }
  run_tilt(instants, known, options, solution);
  return solution;
}

}  // namespace proofmass::estimate
