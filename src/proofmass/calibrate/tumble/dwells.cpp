#include "proofmass/calibrate/tumble/dwells.hpp"

#include <algorithm>
#include <cmath>

#include "proofmass/core/statistics.hpp"
#include "proofmass/core/units.hpp"

namespace proofmass::calibrate {
namespace {

constexpr double within_rad = 0.25 * rad_per_deg, creep_rad = 0.03 * rad_per_deg;

bool creeps(View<double> angle_rad) {
  const std::size_t third = angle_rad.size() / 3;
  const double first = moments(angle_rad.first(third)).mean;
  return std::abs(moments(angle_rad.last(third)).mean - first) > creep_rad;
}

}  // namespace

bool stops_in_places(View<double> angle_rad, double rate_hz) {
  constexpr std::size_t fewest = 100, samples_a_place = 10;
  if (angle_rad.size() < fewest) return false;
  std::size_t moves = 0;
  for (std::size_t k = 1; k < angle_rad.size(); ++k)
    if (std::abs(angle_rad[k] - angle_rad[k - 1]) > 0.25 * rad_per_deg) ++moves;
  return (moves + 1) * samples_a_place < angle_rad.size() ||
         !steady_angles(angle_rad, {.rate_hz = rate_hz}).empty();
}

std::vector<Dwell> steady_angles(View<double> angle_rad, const SteadyAngleOptions& options) {
  constexpr double usual_s = 0.5;
  constexpr std::size_t usual = 20, least = 6;
  std::size_t shortest = usual;
  if (options.rate_hz > 0.0) {
    const double samples = options.shortest_s.value_or(usual_s) * options.rate_hz;
    shortest = std::max(least, static_cast<std::size_t>(std::ceil(samples)));
  }
  std::vector<Dwell> dwells;
  std::size_t first = 0;
  const auto close = [&](std::size_t end) {  // [first, end)
    const std::size_t length = end - first, trim = std::max<std::size_t>(1, length / 20);
    if (length >= shortest && !creeps(angle_rad.subspan(first, length)))
      dwells.push_back({.first = first + trim, .last = end - 1 - trim});
    first = end;
  };
  for (std::size_t k = 1; k <= angle_rad.size(); ++k) {
    const bool stays =
        k < angle_rad.size() && std::isfinite(angle_rad[k]) &&
        std::abs(std::remainder(angle_rad[k] - angle_rad[first], rad_per_turn)) <= within_rad;
    if (!stays) close(k);
  }
  return dwells;
}

std::vector<Dwell> at_rest(View<Dwell> steady, View<signal::Rest> rests) {
  constexpr std::size_t least = 6;
  std::vector<Dwell> dwells;
  for (const Dwell& stretch : steady) {
    Dwell longest{.first = 0, .last = 0};
    for (const signal::Rest& rest : rests) {
      const std::size_t first = std::max(stretch.first, rest.first);
      const std::size_t last = std::min(stretch.last, rest.last);
      if (last > first && last - first > longest.last - longest.first)
        longest = {.first = first, .last = last};
    }
    if (longest.last - longest.first + 1 >= least) dwells.push_back(longest);
  }
  return dwells;
}

Result<DwellOutputs> dwell_outputs(View<double> output, View<Dwell> dwells, double lsb) {
  // pose_means expects three axes: the same one three times.
  const auto found = pose_means({output, output, output}, dwells, {lsb, lsb, lsb});
  if (!found) return found.error();
  DwellOutputs out;
  out.noise_dof = found->noise_dof;
  for (const Pose& pose : found->poses) {
    out.mean.push_back(pose.mean.x());
    out.std.push_back(std::sqrt(std::max(pose.mean_covariance(0, 0), 0.0)));
  }
  return out;
}

std::vector<double> dwell_angles(View<double> angle_rad, View<Dwell> dwells) {
  std::vector<double> means;
  for (const Dwell& dwell : dwells) {
    const double at = angle_rad[dwell.first];
    double sum = 0.0;  // sum of wrapped differences, since an angle may jump by a turn
    for (std::size_t k = dwell.first; k <= dwell.last; ++k)
      sum += std::remainder(angle_rad[k] - at, rad_per_turn);
    means.push_back(at + sum / static_cast<double>(dwell.last - dwell.first + 1));
  }
  return means;
}

}  // namespace proofmass::calibrate
