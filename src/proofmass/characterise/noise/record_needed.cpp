#include "proofmass/characterise/noise/record_needed.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <vector>

#include "proofmass/characterise/noise/search.hpp"
#include "proofmass/characterise/noise/whittle.hpp"
#include "proofmass/core/linalg.hpp"
#include "proofmass/core/statistics.hpp"

namespace proofmass::characterise {
namespace {

// c²/std(c²) at which a term is identified with 95 % probability: the root of the gain required by
// the fit (noise/search.hpp) plus the quantile. The gain of a slow term is skewed, since it depends
// on few coefficients, and by simulation less is enough.
const double needed_ratio_of_fast = std::sqrt(needed_gain) + 1.644854;
constexpr double needed_ratio_of_slow = 1.959964 + 1.644854;
// Required margin of the expected root of a ramp's gain over its threshold: by simulation.
constexpr double ramp_margin = 0.6;
constexpr double longest = 1e4;  // times the recording
constexpr double step = 1.06;    // between the lengths that are tried
constexpr std::size_t single_ordinates = 48;
constexpr double width_of_group = 0.06;

struct Shapes {
  std::vector<double> frequency_hz;  ///< descending by `step`
  Eigen::MatrixXd densities;         ///< of each strength, one row a frequency
  Eigen::VectorXd total;             ///< of the model
};

std::vector<Coefficient*> strengths(NoiseModelFit& model) {
  std::vector<Coefficient*> all{&model.quantisation, &model.white, &model.flicker,
                                &model.random_walk};
  if (model.markov) all.push_back(&model.markov->strength);
  return all;
}

Shapes shapes_of(const NoiseModelFit& model, std::size_t count) {
  Shapes shapes;
  const double lowest_hz = 0.5 / (longest * model.duration_s);
  for (double f = 0.5 * model.rate_hz; f > lowest_hz; f /= step) shapes.frequency_hz.push_back(f);
  const auto rows = static_cast<Eigen::Index>(shapes.frequency_hz.size());
  shapes.densities.resize(rows, static_cast<Eigen::Index>(count));
  shapes.total.resize(rows);
  for (Eigen::Index row = 0; row < rows; ++row) {
    const double f = shapes.frequency_hz[static_cast<std::size_t>(row)];
    for (std::size_t k = 0; k < count; ++k)
      shapes.densities(row, static_cast<Eigen::Index>(k)) = model.shape(static_cast<Term>(k), f);
    shapes.total(row) = model.density(f);
  }
  return shapes;
}

// The shortest length at which `strength` of column `which` is distinguishable from zero; the
// columns `in` are the model's.
std::optional<double> length_for(const Shapes& shapes,
                                 std::vector<Eigen::Index> in,
                                 Eigen::Index which,
                                 double strength) {
  const bool known = std::find(in.begin(), in.end(), which) != in.end();
  if (!known) in.push_back(which);
  const auto n = static_cast<Eigen::Index>(in.size());
  Eigen::Index place = 0;
  while (in[static_cast<std::size_t>(place)] != which) ++place;
  // Information a second of recording, from each frequency up.
  std::vector<Eigen::MatrixXd> rate(static_cast<std::size_t>(shapes.total.size()));
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(n, n);
  Eigen::VectorXd X(n);
  for (Eigen::Index row = 0; row < shapes.total.size(); ++row) {
    const double S = shapes.total(row) + (known ? 0.0 : strength * shapes.densities(row, which));
    for (Eigen::Index k = 0; k < n; ++k)
      X(k) = shapes.densities(row, in[static_cast<std::size_t>(k)]) / S;
    const double width_hz = (1.0 - 1.0 / step) * shapes.frequency_hz[static_cast<std::size_t>(row)];
    sum += width_hz * X * X.transpose();
    rate[static_cast<std::size_t>(row)] = sum;
  }
  const auto length_s = [&](std::size_t row) { return 0.5 / shapes.frequency_hz[row]; };
  const double needed_ratio =
      is_slow(static_cast<int>(which)) ? needed_ratio_of_slow : needed_ratio_of_fast;
  const auto tells = [&](std::size_t row) {
    const double variance = positive_inverse(length_s(row) * rate[row])(place, place);
    return strength >= needed_ratio * std::sqrt(variance);
  };
  // The first rows have too few values to separate so many terms.
  std::size_t too_short = 2 * in.size(), enough = rate.size() - 1;
  if (!tells(enough)) return std::nullopt;
  while (enough - too_short > 1) {
    const std::size_t middle = (too_short + enough) / 2;
    (tells(middle) ? enough : too_short) = middle;
  }
  return length_s(enough);
}

// The groups of a recording of some length, without densities: the first coefficients one by one,
// the others in groups.
std::vector<SpectralGroup> groups_of(double length_s, double rate_hz) {
  std::vector<SpectralGroup> groups;
  const double spacing_hz = 0.5 / length_s, last_hz = 0.5 * rate_hz;
  for (std::size_t k = 1; k <= single_ordinates; ++k) {
    const double f = static_cast<double>(k) * spacing_hz;
    if (f < last_hz) groups.push_back({.frequency_hz = f, .density = 0.0, .dof = 1.0});
  }
  for (double f = (static_cast<double>(single_ordinates) + 0.5) * spacing_hz; f < last_hz;
       f *= 1.0 + width_of_group) {
    const double width_hz = std::min(width_of_group * f, last_hz - f);
    groups.push_back(
        {.frequency_hz = f + 0.5 * width_hz, .density = 0.0, .dof = width_hz / spacing_hz});
  }
  return groups;
}

// Expected loss in twice the log-likelihood without a ramp in a recording of length T: with
// expected densities, R² 8 T³/(π k)⁴ the ramp's at every odd ordinate, and the strengths of all
// terms free to explain them.
double loss_without_ramp(const NoiseModelFit& model,
                         std::size_t count,
                         double slope,
                         double length_s) {
  std::vector<SpectralGroup> groups = groups_of(length_s, model.rate_hz);
  Eigen::MatrixXd columns(static_cast<Eigen::Index>(groups.size()),
                          static_cast<Eigen::Index>(count));
  double top = 0.0;
  for (std::size_t g = 0; g < groups.size(); ++g) {
    const double f = groups[g].frequency_hz, S = model.density(f);
    for (std::size_t k = 0; k < count; ++k)
      columns(static_cast<Eigen::Index>(g), static_cast<Eigen::Index>(k)) =
          model.shape(static_cast<Term>(k), f);
    groups[g].density = S;
    if (g % 2 == 0 && g < single_ordinates)
      groups[g].density += 8.0 * square(slope) * std::pow(length_s, 3) /
                           std::pow(std::numbers::pi * static_cast<double>(g + 1), 4);
    top -= 0.5 * groups[g].dof * (std::log(S) + 1.0);
  }
  std::vector<int> all(count);
  std::iota(all.begin(), all.end(), 0);
  const WhittleLikelihood likelihood(std::move(groups), columns);
  return 2.0 * (top - likelihood.maximise(all).log_likelihood);
}

// The shortest sufficient length, by bisection.
std::optional<double> length_for_ramp(const NoiseModelFit& model, std::size_t count, double slope) {
  const double enough = square(std::sqrt(needed_gain_of_ramp) + ramp_margin);
  const auto shows = [&](double length_s) {
    return loss_without_ramp(model, count, slope, length_s) >= enough;
  };
  constexpr double fewest_samples = 100.0;
  double low = fewest_samples / model.rate_hz, high = longest * model.duration_s;
  if (!(high > low) || !shows(high)) return std::nullopt;
  if (shows(low)) return low;
  while (high > 1.02 * low) {
    const double middle = std::sqrt(low * high);
    (shows(middle) ? high : low) = middle;
  }
  return high;
}

double size_of(const Coefficient& coefficient) {
  return coefficient.verdict == Verdict::identified ? coefficient.value : coefficient.upper_95;
}

// What this recording did not show cannot be expected from a shorter one.
void note_length(Coefficient& coefficient, std::optional<double> length_s, double duration_s) {
  if (length_s && coefficient.verdict == Verdict::not_observable)
    length_s = std::max(*length_s, duration_s);
  coefficient.record_needed_s = length_s;
}

}  // namespace

void set_records_needed(NoiseModelFit& model) {
  const std::vector<Coefficient*> all = strengths(model);
  const Shapes shapes = shapes_of(model, all.size());
  std::vector<Eigen::Index> in;
  for (std::size_t k = 0; k < all.size(); ++k) {
    if (all[k]->verdict == Verdict::identified) in.push_back(static_cast<Eigen::Index>(k));
  }
  for (std::size_t k = 0; k < all.size(); ++k) {
    const double size = size_of(*all[k]);
    note_length(*all[k], length_for(shapes, in, static_cast<Eigen::Index>(k), size * size),
                model.duration_s);
  }
  note_length(model.ramp, length_for_ramp(model, all.size(), size_of(model.ramp)),
              model.duration_s);
}

}  // namespace proofmass::characterise
