#include "proofmass/calibrate/guide/rest_length.hpp"

#include <algorithm>
#include <cmath>

namespace proofmass::calibrate {
namespace {

using signal::AllanLevel;

// Levels begin with the shortest averaging time and leave none out.
void pool(const std::vector<AllanLevel>& more, std::vector<AllanLevel>& all) {
  if (all.size() < more.size()) all.resize(more.size());
  for (std::size_t k = 0; k < more.size(); ++k) {
    const double pairs = all[k].pairs + more[k].pairs;
    const double sum = all[k].variance * all[k].pairs + more[k].variance * more[k].pairs;
    all[k] = {more[k].samples, sum / pairs, pairs};
  }
}

}  // namespace

RestVerdict RestLength::judge(const signal::RunningRests& rests,
                              std::optional<double> target_std) const {
  const signal::RestState& now = rests.state();
  const double length_s = now.until_s - now.since_s;
  RestVerdict out;
  out.seconds_left = shortest_s_ - length_s;
  if (out.seconds_left > 0.0) return out;
  bool falls = false;
  double more_s = 0.0;
  for (std::size_t axis = 0; axis < axes_; ++axis) {
    std::vector<AllanLevel> levels = pooled_[axis];
    pool(rests.levels(axis), levels);
    const DwellNoise noise =
        fit_dwell_noise(levels, static_cast<double>(now.samples), now.step[axis]);
    const double variance = noise.variance_of_mean(now.samples);
    out.variance(static_cast<Eigen::Index>(axis)) = variance;
    out.dof = axis == 0 ? noise.dof : std::min(out.dof, noise.dof);
    constexpr double hardly = 0.9;  // of a variance: a twentieth of the standard deviation
    const double excess = target_std ? variance / (*target_std * *target_std) - 1.0 : 0.0;
    if (!(excess > 0.0)) continue;
    constexpr double known = 10.0;  // degrees of freedom
    falls |= noise.dof < known || noise.variance_of_mean(2 * now.samples) < hardly * variance;
    more_s = std::max(more_s, length_s * excess);
  }
  out.enough = !falls || length_s >= longest_s_;
  out.seconds_left = out.enough ? 0.0 : std::min(more_s, longest_s_ - length_s);
  return out;
}

void RestLength::keep(const signal::RunningRests& rests) {
  for (std::size_t axis = 0; axis < axes_; ++axis) pool(rests.levels(axis), pooled_[axis]);
}

}  // namespace proofmass::calibrate
