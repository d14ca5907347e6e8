#include "proofmass/characterise/noise/slow_wave.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "proofmass/core/linalg.hpp"
#include "proofmass/core/quantity.hpp"

namespace proofmass::characterise {
namespace {

using Eigen::Index;

constexpr double fewest_periods = 0.2, most_periods = 6.0, period_step = 0.2;
constexpr std::size_t fewest_single = 12;

struct RampAndWave {
  Uncertain slope_per_s;
  SlowWave wave;
};

// Ramp, cosine and sine by least squares over the single coefficients, weighted by a density.
RampAndWave fitted_wave(const Search& search, const Eigen::VectorXd& density, double frequency_hz) {
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  Eigen::Vector3d score = Eigen::Vector3d::Zero();
  for (std::size_t g = 0; g < search.evidence.groups.size(); ++g) {
    const SpectralGroup& group = search.evidence.groups[g];
    if (group.vector.k == 0) continue;
    const std::complex<double> wave = group.vector.of_wave(frequency_hz);
    const Eigen::Vector3d row(group.of_ramp, wave.real(), wave.imag());
    const double weight = 1.0 / density(static_cast<Index>(g));
    information += weight * row * row.transpose();
    score += weight * group.amplitude * row;
  }
  // The ramp's column and the others are of different units.
  const Eigen::Vector3d scale = information.diagonal().cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
  const Eigen::Matrix3d even = scale.asDiagonal() * information * scale.asDiagonal();
  const Eigen::Matrix3d covariance =
      scale.asDiagonal() * positive_inverse(even) * scale.asDiagonal();
  const Eigen::Vector3d found = covariance * score;
  return {{found(0), std::sqrt(covariance(0, 0))}, {frequency_hz, found(1), found(2)}};
}

struct Candidate {
  SlowWave wave;
  double log_likelihood = 0.0;
};

Candidate best_at(const Search& search,
                  const std::vector<Eigen::VectorXd>& densities,
                  double frequency_hz) {
  Candidate best;
  for (const Eigen::VectorXd& density : densities) {
    const SlowWave wave = fitted_wave(search, density, frequency_hz).wave;
    const double value = search.likelihood.without_wave(wave)
                             .maximise(search.active, {}, search.fit.strength)
                             .log_likelihood;
    if (best.wave.frequency_hz == 0.0 || value > best.log_likelihood) best = {wave, value};
  }
  return best;
}

}  // namespace

std::optional<SlowWave> best_slow_wave(const Search& search, double duration_s) {
  const auto single = std::ranges::count_if(search.evidence.groups,
                                            [](const auto& group) { return group.vector.k > 0; });
  if (static_cast<std::size_t>(single) < fewest_single) return std::nullopt;
  std::vector<int> fast = search.active;
  std::erase_if(fast, is_slow);
  std::vector<Eigen::VectorXd> densities{search.fit.density};
  if (!fast.empty()) {
    Eigen::VectorXd of_fast = Eigen::VectorXd::Zero(search.fit.density.size());
    for (const int column : fast)
      of_fast += search.fit.strength(column) * search.likelihood.column(column);
    if (of_fast.minCoeff() > 0.0) densities.push_back(of_fast);
  }
  Candidate best;
  const auto consider = [&](double periods) {
    const Candidate at = best_at(search, densities, periods / duration_s);
    if (best.wave.frequency_hz == 0.0 || at.log_likelihood > best.log_likelihood) best = at;
  };
  for (double periods = fewest_periods; periods < most_periods; periods += period_step)
    consider(periods);
  for (double width = 0.5 * period_step; width > 0.01; width *= 0.5) {
    const double centre = best.wave.frequency_hz * duration_s;
    consider(std::max(0.5 * fewest_periods, centre - width));
    consider(centre + width);
  }
  return best.wave;
}

Uncertain slope_beside_wave(const Search& search, double frequency_hz) {
  Uncertain slope = fitted_wave(search, search.fit.density, frequency_hz).slope_per_s;
  // The wave has been subtracted: the remaining slope is the fit's.
  slope.value = search.fit.slope;
  return slope;
}

bool wave_may_stand_for(const Search& search, const SlowWave& wave, int column) {
  const WhittleLikelihood rest = search.likelihood.without_wave(wave);
  const double with = rest.maximise(search.active, {}, search.fit.strength).log_likelihood;
  const double less =
      rest.maximise(without(search.active, column), {}, search.fit.strength).log_likelihood;
  return 2.0 * (with - less) < needed_gain;
}

}  // namespace proofmass::characterise
