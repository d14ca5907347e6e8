#include "proofmass/estimate/tilt/still.hpp"

#include <algorithm>
#include <cmath>

#include "proofmass/core/statistics.hpp"
#include "proofmass/core/units.hpp"
#include "proofmass/estimate/tilt/bias_change.hpp"
#include "proofmass/estimate/tilt/record.hpp"

namespace proofmass::estimate {
namespace {

void put(const std::optional<Uncertain>& angle, double& value, double& std) {
  value = angle ? angle->value : no_value;
  std = angle ? angle->std : no_value;
}

// Variance of white measurements with the same uncertainty of the mean over the rest.
Mat<3> noise_of_one(const TiltRecord& record, const TiltRest& rest) {
  Mat<3> out = Mat<3>::Zero();
  for (std::size_t i = 0; i < 3; ++i) {
    if (record.accel_mps2[i].empty()) continue;
    const StretchMean mean = stretch_mean(
        View<double>(record.accel_mps2[i]).subspan(rest.first, rest.last - rest.first + 1), 0.0);
    out(static_cast<Eigen::Index>(i)) = mean.variance * static_cast<double>(mean.count);
  }
  return out;
}

Note change_note(const BiasChange& change, double off_mps2) {
  const std::string widened = decimal(change.std_mps2, 4) + " m/s²";
  if (change.probability > 0.95)
    return {Severity::warning,
            "at rest the force differs from gravity by " + decimal(off_mps2) +
                " m/s², more than the calibration allows: the sensor has changed since, or it was "
                "not at rest; each axis is taken to be off by " +
                widened,
            {Advice{"bias-std"}}};
  return {
      Severity::info,
      "the bias may have changed since the calibration: each axis is taken to be off by " + widened,
      {Advice{"bias-std"}}};
}

}  // namespace

Note uncalibrated_note(const std::optional<double>& off_mps2,
                       double bias_std_mps2,
                       double gravity_mps2) {
  const std::string differs =
      off_mps2 ? "at rest the force differs from gravity by " + decimal(*off_mps2) + " m/s², and "
               : "";
  return {Severity::warning,
          differs +
              "the accuracy of the calibration is unknown: each axis is assumed to be off by " +
              decimal(bias_std_mps2) + " m/s², which tilts by " +
              decimal(bias_std_mps2 / gravity_mps2 * deg_per_rad) + "°",
          {Advice{"sensor"}, Advice{"bias-std"}}};
}

void find_rests(const TiltRecord& record,
                const TiltOptions& options,
                const std::vector<signal::Rest>& found,
                TiltSolution& solution) {
  const auto steps = converter_steps(record);
  solution.rests.clear();
  for (const signal::Rest& rest : found)
    solution.rests.push_back(rest_of(record, options, rest, steps));
}

bool judge_norm(TiltOptions& options, TiltSolution& solution) {
  if (options.bias_std_mps2) {
    solution.bias_std_mps2 = *options.bias_std_mps2;
    if (*options.bias_std_mps2 > 0.0) solution.norm_std_mps2 = *options.bias_std_mps2;
    return false;
  }
  const ForceSpread spread(options);
  double squares = 0.0, variance = 0.0, count = 0.0;
  for (const TiltRest& rest : solution.rests) {
    if (!rest.norm_mps2) continue;
    squares += square(rest.norm_mps2->value - options.gravity_mps2.value);
    variance += square(rest.norm_mps2->std);
    count += 1.0;
  }
  const double off = count > 0.0 ? std::sqrt(squares / count) : 0.0;
  if (spread.knows_calibration()) {
    const BiasChange change = bias_change(solution.rests, spread, options.gravity_mps2,
                                          stability_mps2(*options.calibration));
    options.bias_std_mps2 = solution.norm_std_mps2 = change.std_mps2;
    solution.notes.push_back(change_note(change, off));
  } else {
    options.bias_std_mps2 =
        uncalibrated_bias_std_mps2(solution.rests, spread, options.gravity_mps2);
    std::optional<double> differs;
    if (square(off) > 4.0 * (square(options.gravity_mps2.std) + variance / std::max(count, 1.0)))
      differs = solution.norm_std_mps2 = off;
    solution.notes.push_back(
        uncalibrated_note(differs, *options.bias_std_mps2, options.gravity_mps2.value));
  }
  solution.bias_std_mps2 = *options.bias_std_mps2;
  return true;
}

void set_up(TiltSeries& series, std::size_t k, const Mat<3>& force) {
  const Mat<3> up = force.normalized();
  for (std::size_t i = 0; i < 3; ++i) series.up[i][k] = up(static_cast<Eigen::Index>(i));
}

void make_series(const TiltRecord& record, TiltSolution& solution) {
  TiltSeries& s = solution.series;
  s.time_s = record.time_s;
  for (auto* values :
       {&s.roll_rad, &s.pitch_rad, &s.roll_std_rad, &s.pitch_std_rad, &s.filtered_roll_rad,
        &s.filtered_pitch_rad, &s.filtered_roll_std_rad, &s.filtered_pitch_std_rad})
    values->assign(solution.samples, no_value);
  for (auto& component : s.up) component.assign(solution.samples, no_value);
  s.weight.assign(solution.samples, 0.0F);
  s.resting.assign(solution.samples, 0);
  for (const TiltRest& rest : solution.rests)
    std::fill(s.resting.begin() + static_cast<std::ptrdiff_t>(rest.first),
              s.resting.begin() + static_cast<std::ptrdiff_t>(rest.last) + 1, 1);
}

void fill_still(const TiltRecord& record, const TiltOptions& options, TiltSolution& solution) {
  const ForceSpread spread(options);
  TiltSeries& s = solution.series;
  for (const TiltRest& rest : solution.rests) {
    const Mat<3, 3> noise = noise_of_one(record, rest).asDiagonal();
    Mat<3> sum = Mat<3>::Zero();
    double count = 0.0;
    for (std::size_t k = rest.first; k <= rest.last; ++k) {
      put(rest.angles.roll_rad, s.roll_rad[k], s.roll_std_rad[k]);
      put(rest.angles.pitch_rad, s.pitch_rad[k], s.pitch_std_rad[k]);
      set_up(s, k, rest.force_mps2);
      const Mat<3> f = vector_at(record.accel_mps2, k);
      if (static_cast<std::size_t>(f.array().isFinite().count()) == solution.axes) {
        sum += f;
        count += 1.0;
        s.weight[k] = 1.0F;
      }
      const Mat<3> known = sum.array().isFinite().select(sum / std::max(count, 1.0), 0.0);
      if (!(known.norm() > 0.0)) continue;
      const TiltAngles angles = angles_of_some(
          sum / count, noise / count + spread.calibration(known) + spread.alignment(known),
          options.gravity_mps2);
      put(angles.roll_rad, s.filtered_roll_rad[k], s.filtered_roll_std_rad[k]);
      put(angles.pitch_rad, s.filtered_pitch_rad[k], s.filtered_pitch_std_rad[k]);
    }
  }
}

}  // namespace proofmass::estimate
