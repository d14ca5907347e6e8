#include "proofmass/characterise/record_needed.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "proofmass/core/linalg.hpp"

namespace proofmass::characterise {
namespace {

constexpr double needed_ratio = 1.959964 + 1.644854;
constexpr double longest = 1e4;  // times the recording
constexpr double step = 1.06;    // between the lengths that are tried

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

// The shortest length that tells `strength` of column `which` from zero; the columns `in` are the
// model's.
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
  const auto tells = [&](std::size_t row) {
    const double variance = positive_inverse(length_s(row) * rate[row])(place, place);
    return strength >= needed_ratio * std::sqrt(variance);
  };
  // The first rows have too few values to tell so many terms apart.
  std::size_t too_short = 2 * in.size(), enough = rate.size() - 1;
  if (!tells(enough)) return std::nullopt;
  while (enough - too_short > 1) {
    const std::size_t middle = (too_short + enough) / 2;
    (tells(middle) ? enough : too_short) = middle;
  }
  return length_s(enough);
}

std::optional<double> length_for_ramp(const NoiseModelFit& model, double slope) {
  constexpr int terms = 200;
  for (double T = 32.0 / model.rate_hz; T < longest * model.duration_s; T *= step) {
    double sum = 0.0;
    for (int k = 1; k < terms; k += 2) {
      const double f = k / (2.0 * T);
      if (f > 0.5 * model.rate_hz) break;
      sum += 1.0 / (std::pow(k, 4) * model.density(f));
    }
    const double information = 8.0 * T * T * T / std::pow(std::numbers::pi, 4) * sum;
    if (slope * std::sqrt(information) >= needed_ratio) return T;
  }
  return std::nullopt;
}

double size_of(const Coefficient& coefficient) {
  return coefficient.verdict == Verdict::identified ? coefficient.value : coefficient.upper_95;
}

// What the recording at hand did not show cannot be promised from a shorter one.
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
  note_length(model.ramp, length_for_ramp(model, size_of(model.ramp)), model.duration_s);
}

}  // namespace proofmass::characterise
