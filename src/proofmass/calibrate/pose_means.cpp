#include "proofmass/calibrate/pose_means.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>

#include "proofmass/calibrate/multi_position/dwell_noise.hpp"
#include "proofmass/core/contract.hpp"
#include "proofmass/core/statistics.hpp"

namespace proofmass::calibrate {
namespace {

constexpr double spike = 8.0;  // robust standard deviations

// The numbers of one rest on one axis, without spikes.
std::vector<double> sound_values(View<double> samples, double lsb) {
  std::vector<double> out;
  const std::optional<double> middle = median(samples);
  if (!middle) return out;
  // If most samples are equal, quantisation steps are not spikes.
  const double width = spike * std::max(*robust_std(samples), lsb);
  out.reserve(samples.size());
  for (const double value : samples) {
    const double departure = std::abs(value - *middle);
    if (departure <= width || (width == 0.0 && departure == 0.0)) out.push_back(value);
  }
  return out;
}

// One axis: mean and variance of the mean for every rest.
struct AxisMeans {
  std::vector<double> mean, variance;
  std::vector<std::size_t> samples;
  std::vector<signal::AllanLevel> levels;
  double rounding = 0.0;
  double dof = 0.0, sample_std = 0.0;
  std::size_t rejected = 0;
};

Result<AxisMeans> axis_means(View<double> axis, View<Dwell> rests, double lsb) {
  std::vector<std::vector<double>> sound;
  std::vector<std::span<const double>> views;
  sound.reserve(rests.size());
  AxisMeans out;
  for (std::size_t k = 0; k < rests.size(); ++k) {
    PM_EXPECTS(rests[k].first <= rests[k].last && rests[k].last < axis.size());
    const View<double> samples = axis.subspan(rests[k].first, rests[k].last - rests[k].first + 1);
    sound.push_back(sound_values(samples, lsb));
    if (sound.back().size() < 2) {
      return Error{Errc::too_few_samples,
                   fmt::format("rest {}: {} of its {} samples are numbers: expected two or more",
                               k + 1, sound.back().size(), samples.size())};
    }
    out.rejected += samples.size() - sound.back().size();
  }
  views.reserve(sound.size());
  for (const std::vector<double>& rest : sound) views.emplace_back(rest);
  const DwellNoise noise = fit_dwell_noise(views, lsb);
  out.dof = noise.dof;
  out.levels = allan_levels(views);
  out.rounding = noise.rounding;
  double squares = 0.0, count = 0.0;
  for (const std::vector<double>& rest : sound) {
    const Moments m = moments(rest);
    out.mean.push_back(m.mean);
    out.samples.push_back(rest.size());
    out.variance.push_back(noise.variance_of_mean(rest.size()));
    squares += m.squares;
    count += static_cast<double>(m.count - 1);
  }
  out.sample_std = std::sqrt(squares / count);
  return out;
}

}  // namespace

Result<PoseMeans> pose_means(const std::array<View<double>, 3>& axes,
                             View<Dwell> rests,
                             const std::array<double, 3>& lsb) {
  if (axes[1].size() != axes[0].size() || axes[2].size() != axes[0].size())
    return Error{Errc::invalid_argument, "the three axes differ in length"};
  PoseMeans out;
  out.poses.resize(rests.size());
  double dof = std::numeric_limits<double>::infinity();
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const Result<AxisMeans> one = axis_means(axes[axis], rests, lsb[axis]);
    if (!one) return one.error();
    const auto row = static_cast<Eigen::Index>(axis);
    for (std::size_t k = 0; k < rests.size(); ++k) {
      Pose& pose = out.poses[k];
      pose.mean(row) = one->mean[k];
      pose.mean_covariance(row, row) = one->variance[k];
      pose.rounding_variance(row) = one->rounding;
      pose.samples = axis == 0 ? one->samples[k] : std::min(pose.samples, one->samples[k]);
      pose.label = rests[k].label;
      pose.up = rests[k].up;
    }
    out.session.levels[axis] = one->levels;
    out.session.rounding[axis] = one->rounding;
    dof = std::min(dof, one->dof);
    out.sample_std[axis] = one->sample_std;
    out.rejected += one->rejected;
  }
  if (!rests.empty() && std::isfinite(dof)) out.noise_dof = dof;
  out.session.rests = rests.size();
  for (const Dwell& rest : rests)
    out.session.spans.push_back(
        {static_cast<double>(rest.first), static_cast<double>(rest.last) + 1.0});
  return out;
}

}  // namespace proofmass::calibrate
