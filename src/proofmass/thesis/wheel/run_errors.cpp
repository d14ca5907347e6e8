#include "proofmass/thesis/wheel/run_errors.hpp"

#include <algorithm>
#include <cmath>

#include "proofmass/core/statistics.hpp"

namespace proofmass::thesis {
namespace {

Result<std::optional<ThesisErrors>> thesis_errors(const FirstTurn& turn,
                                                  WheelAxis axis,
                                                  Fusion how) {
  const std::optional<FusedReading> reading = fuse(turn, axis, how);
  if (!reading) return std::optional<ThesisErrors>{};
  const Result<ThesisPaths> paths = thesis_paths(*reading);
  if (!paths) return Error(paths.error()).at(turn.source);
  const std::vector<double> reference = turn.path_m(turn.angle_rad);
  return std::optional<ThesisErrors>(
      {path_error(turn, paths->integrated_m, reference, 0.0),
       path_error(turn, paths->filtered_m, reference, paths->filtered_std_m.back()),
       path_error(turn, paths->smoothed_m, reference, paths->smoothed_std_m.back())});
}

std::vector<double> scaled(const std::vector<double>& values, double factor) {
  std::vector<double> out(values);
  for (double& value : out) value *= factor;
  return out;
}

void judge_wheel(const FirstTurn& turn, double radius_m, RunErrors& errors) {
  const std::vector<double> reference = scaled(turn.angle_rad, radius_m);
  errors.wheel_filtered = path_error(turn, scaled(turn.filtered.angle_rad, radius_m), reference,
                                     radius_m * turn.filtered.std_rad.back());
  if (!turn.simulated) return;
  errors.wheel_smoothed = path_error(turn, scaled(turn.smoothed.angle_rad, radius_m), reference,
                                     radius_m * turn.smoothed.std_rad.back());
  errors.wheel_moved =
      path_error(turn, turn.path_m(turn.smoothed.angle_rad), turn.path_m(turn.angle_rad),
                 turn.moved_std_rad.empty() ? 0.0 : radius_m * turn.moved_std_rad.back());
}

}  // namespace

PathError path_error(const FirstTurn& turn,
                     const std::vector<double>& path,
                     const std::vector<double>& reference,
                     double end_std) {
  const std::size_t last = turn.size() - 1;
  const auto at = [&](std::size_t k) { return path[k] - reference[k]; };
  PathError error{.at_2s = at(turn.sample_at(2.0).value_or(last)),
                  .half = at(turn.sample_at(turn.time_s.back() / 2.0).value_or(last)),
                  .end = at(last),
                  .end_std = end_std};
  for (std::size_t k = 0; k <= last; ++k) {
    error.rms += at(k) * at(k);
    error.mean_abs += std::abs(at(k));
  }
  error.rms = std::sqrt(error.rms / static_cast<double>(turn.size()));
  error.mean_abs /= static_cast<double>(turn.size());
  return error;
}

Result<RunErrors> run_errors(const FirstTurn& turn, Detail detail) {
  RunErrors errors;
  if (!turn.radius_m) return errors;
  struct Part {
    std::optional<ThesisErrors>& errors;
    WheelAxis axis;
    Fusion how;
  };
  const std::array parts{
      Part{errors.roll, WheelAxis::forward, Fusion::gravity_cancelled},
      Part{errors.roll_gravity, WheelAxis::forward, Fusion::gravity_left_in},
      Part{errors.pitch, WheelAxis::outward, Fusion::gravity_cancelled},
      Part{errors.pitch_gravity, WheelAxis::outward, Fusion::gravity_left_in},
  };
  for (const Part& part : parts) {
    if (detail == Detail::tangential && part.axis == WheelAxis::outward) continue;
    auto found = thesis_errors(turn, part.axis, part.how);
    if (!found) return found.error();
    part.errors = std::move(found).value();
  }
  judge_wheel(turn, *turn.radius_m, errors);
  return errors;
}

Pick picked(std::optional<PathError> RunErrors::* which, double PathError::* what) {
  return [=](const RunErrors& run) -> std::optional<double> {
    const auto& error = run.*which;
    return error ? std::optional((*error).*what) : std::nullopt;
  };
}

Pick picked(std::optional<ThesisErrors> RunErrors::* which,
            PathError ThesisErrors::* method,
            double PathError::* what) {
  return [=](const RunErrors& run) -> std::optional<double> {
    const auto& errors = run.*which;
    return errors ? std::optional((*errors).*method.*what) : std::nullopt;
  };
}

std::vector<double> sizes_over(const std::vector<RunErrors>& runs, const Pick& pick) {
  std::vector<double> sizes;
  for (const RunErrors& run : runs)
    if (const auto value = pick(run)) sizes.push_back(std::abs(*value));
  return sizes;
}

std::optional<Uncertain> rms_over(const std::vector<RunErrors>& runs, const Pick& pick) {
  std::vector<double> squares = sizes_over(runs, pick);
  if (squares.empty() || squares.size() < runs.size()) return std::nullopt;
  for (double& size : squares) size *= size;
  const Moments over = moments(squares);
  const double rms = std::sqrt(over.mean);
  // d√m = dm / 2√m
  const double std =
      rms > 0.0 ? over.std() / std::sqrt(static_cast<double>(over.count)) / (2.0 * rms) : 0.0;
  return Uncertain{rms, std};
}

}  // namespace proofmass::thesis
