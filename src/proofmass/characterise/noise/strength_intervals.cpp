#include "proofmass/characterise/noise/strength_intervals.hpp"

#include <algorithm>
#include <cmath>

#include "proofmass/core/linalg.hpp"
#include "proofmass/core/statistics.hpp"

namespace proofmass::characterise {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

constexpr double quantile_95_two_sided = 3.841458820694124;  // of χ² with one degree of freedom
constexpr double quantile_95_one_sided = 2.705543454095404;  // the square of 1.645
constexpr double normal_95 = 1.6448536269514722, normal_975 = 1.9599639845400545;
// A slope depends on so few frequencies that asymptotic theory understates its chance ratio: the
// squares of Student's t with 8 degrees of freedom instead of those of the normal quantiles.
constexpr double ramp_two_sided = 5.318, ramp_one_sided = 3.458;

// Bounds the search for the end of an interval, for any data.
constexpr int most_doublings = 200;

struct Bracket {
  double inside, outside;
};

// Solves for a quantile of a loss that grows quadratically: regula falsi (Illinois) on its root.
template <class Loss>
double crossing(const Loss& loss, Bracket bracket, double quantile) {
  const auto height = [&](double at) { return std::sqrt(loss(at)) - std::sqrt(quantile); };
  double a = bracket.inside, fa = height(a), b = bracket.outside, fb = height(b);
  const double near = 1e-4 * std::abs(b - a);
  for (int k = 0; k < 30 && std::abs(b - a) > near; ++k) {
    const double c = (a * fb - b * fa) / (fb - fa), fc = height(c);
    if (std::abs(fc) < 1e-4) return c;
    if (fc * fb < 0.0) {
      a = b;
      fa = fb;
    } else {
      fa *= 0.5;
    }
    b = c;
    fb = fc;
  }
  return b;
}

// Change of the density for a small relative change of each fitted time constant.
std::vector<VectorXd> changes_of_shape(const Search& search) {
  constexpr double step = 0.01;
  std::vector<VectorXd> changes;
  const auto add = [&](std::optional<double> time_constant_s, int column, int power) {
    const double strength = search.fit.strength(column);
    if (!time_constant_s || strength == 0.0) return;
    const auto shape = [&](double T) { return search.relaxation(T, std::pow(T, power)); };
    changes.push_back(
        strength / (2.0 * step) *
        (shape(*time_constant_s * std::exp(step)) - shape(*time_constant_s * std::exp(-step))));
  };
  add(search.pole_s, column_of_white, 0);
  add(search.markov_s, column_of_markov, 2);
  return changes;
}

// Covariance of some strengths, including the uncertainty of the time constants.
Eigen::MatrixXd covariance_of(const Search& search, const std::vector<int>& columns_in) {
  const std::vector<VectorXd> changes = changes_of_shape(search);
  const auto n = static_cast<Index>(columns_in.size());
  const auto more = static_cast<Index>(changes.size());
  Eigen::MatrixXd X(static_cast<Index>(search.evidence.groups.size()), n + more);
  for (Index k = 0; k < n; ++k)
    X.col(k) = search.likelihood.column(columns_in[static_cast<std::size_t>(k)]);
  for (Index k = 0; k < more; ++k) X.col(n + k) = changes[static_cast<std::size_t>(k)];
  return positive_inverse(search.likelihood.information_on(search.fit, X)).topLeftCorner(n, n);
}

// The column last among those kept.
std::vector<int> kept_with(const Search& search, int column) {
  std::vector<int> kept = without(search.active, column);
  kept.push_back(column);
  return kept;
}

double variance_of(const Search& search, int column) {
  const Eigen::MatrixXd covariance = covariance_of(search, kept_with(search, column));
  return covariance(covariance.rows() - 1, covariance.cols() - 1);
}

// Growth of the variance of a strength due to the fitted time constants.
double widening(const Search& search, int column) {
  if (!search.pole_s && !search.markov_s) return 1.0;
  const Eigen::MatrixXd known =
      positive_inverse(search.likelihood.information(search.fit, kept_with(search, column)));
  return std::max(1.0, variance_of(search, column) / known(known.rows() - 1, known.cols() - 1));
}

// Loss in twice the log-likelihood with one strength held at a value and all others free, including
// dropped ones: what they could explain instead belongs to its uncertainty. The loss is relative to
// the likelihood of the terms kept, which the free ones may exceed by chance.
class Profile {
 public:
  Profile(const Search& search, int column)
      : likelihood_(search.likelihood), rest_(without(search.all, column)), column_(column) {
    const std::vector<int> kept = kept_with(search, column);
    top_ = likelihood_.maximise(kept, {}, search.fit.strength);
    const Eigen::MatrixXd information = likelihood_.information(top_, kept);
    scale_ = std::sqrt(positive_inverse(information).diagonal()(information.rows() - 1));
  }

  [[nodiscard]] double top() const { return top_.strength(column_); }

  [[nodiscard]] double loss(double strength) const {
    const WhittleLikelihood::Held held{column_, strength};
    const double at = likelihood_.maximise(rest_, held, top_.strength).log_likelihood;
    return 2.0 * std::max(0.0, top_.log_likelihood - at);
  }

  // Where the loss reaches a quantile: above the maximum, or below it (0 if it does not).
  [[nodiscard]] double upper(double quantile) const {
    double inside = top(), outside = inside + scale_ * std::sqrt(quantile);
    for (int k = 0; k < most_doublings && loss(outside) < quantile; ++k) {
      inside = outside;
      outside = top() + 2.0 * (outside - top());
    }
    return root(inside, outside, quantile);
  }
  [[nodiscard]] double lower(double quantile) const {
    if (top() <= 0.0 || loss(0.0) <= quantile) return 0.0;
    double inside = top(), outside = std::max(0.0, top() - scale_ * std::sqrt(quantile));
    while (outside > 0.0 && loss(outside) < quantile) {
      inside = outside;
      outside = std::max(0.0, top() - 2.0 * (top() - outside));
    }
    return root(inside, outside, quantile);
  }

 private:
  [[nodiscard]] double root(double inside, double outside, double quantile) const {
    return crossing([this](double at) { return loss(at); }, {inside, outside}, quantile);
  }

  const WhittleLikelihood& likelihood_;
  std::vector<int> rest_;
  int column_;
  WhittleFit top_;
  double scale_ = 0.0;
};

// Loss in twice the log-likelihood with a given slope and all terms free, including dropped ones: a
// random walk too weak to be identified resembles a slope.
class SlopeProfile {
 public:
  explicit SlopeProfile(const Search& search) : search_(search), top_(log_likelihood(slope())) {}

  [[nodiscard]] double slope() const { return search_.fit.slope; }

  [[nodiscard]] double loss(double at) const {
    return 2.0 * std::max(0.0, top_ - log_likelihood(at));
  }

  // Above the estimated slope (direction 1) or below it (−1).
  [[nodiscard]] double end(double direction, double quantile) const {
    double inside = slope();
    double step = direction * std::sqrt(quantile * search_.fit.slope_variance);
    for (int k = 0; k < most_doublings && loss(inside + step) < quantile; ++k) {
      inside += step;
      step *= 2.0;
    }
    return crossing([this](double at) { return loss(at); }, {inside, inside + step}, quantile);
  }

 private:
  [[nodiscard]] double log_likelihood(double at) const {
    return search_.likelihood.at_slope(at)
        .maximise(search_.all, {}, search_.fit.strength)
        .log_likelihood;
  }

  const Search& search_;
  double top_;
};

}  // namespace

void set_std_of_longer_side(Coefficient& found) {
  if (found.verdict != Verdict::identified) {
    found.std = found.upper_95 / normal_95;
    return;
  }
  found.std =
      std::max(found.upper_two_sided_95 - found.value, found.value - found.lower_95) / normal_975;
}

Coefficient strength_coefficient(const Search& search, int column) {
  const Profile profile(search, column);
  const bool in =
      std::find(search.active.begin(), search.active.end(), column) != search.active.end();
  Coefficient found;
  const double wider = widening(search, column);
  found.upper_95 = std::sqrt(profile.upper(wider * quantile_95_one_sided));
  found.upper_two_sided_95 = std::sqrt(profile.upper(wider * quantile_95_two_sided));
  found.lower_95 = in ? std::sqrt(profile.lower(wider * quantile_95_two_sided)) : 0.0;
  const double strength = search.fit.strength(column);
  if (in && strength > 0.0) {
    found.verdict = Verdict::identified;
    found.value = std::sqrt(strength);
    found.std = 0.5 * (found.upper_two_sided_95 - found.lower_95) / normal_975;
    if (is_slow(column)) set_std_of_longer_side(found);
  } else {
    found.std = found.upper_95 / normal_95;
  }
  return found;
}

Coefficient ramp_coefficient(const Search& search) {
  const SlopeProfile profile(search);
  const double slope = profile.slope();
  const double direction = slope < 0.0 ? -1.0 : 1.0;
  Coefficient found;
  found.upper_95 = std::abs(profile.end(direction, ramp_one_sided));
  found.upper_two_sided_95 = std::abs(profile.end(direction, ramp_two_sided));
  const double lower = direction * profile.end(-direction, ramp_two_sided);
  found.lower_95 = std::max(0.0, lower);
  if (profile.loss(0.0) > needed_gain_of_ramp) {
    found.verdict = Verdict::identified;
    found.value = std::abs(slope);
    found.std = std::max(found.upper_two_sided_95 - found.value, found.value - lower) / normal_975;
  } else {
    found.std = found.upper_95 / normal_95;
  }
  return found;
}

Coefficient ramp_coefficient(const Uncertain& slope_per_s) {
  const double size = std::abs(slope_per_s.value);
  const double reach = std::sqrt(ramp_two_sided) * slope_per_s.std;
  Coefficient found;
  found.upper_95 = size + std::sqrt(ramp_one_sided) * slope_per_s.std;
  found.upper_two_sided_95 = size + reach;
  found.lower_95 = std::max(0.0, size - reach);
  if (square(size) > needed_gain_of_ramp * square(slope_per_s.std)) {
    found.verdict = Verdict::identified;
    found.value = size;
    found.std = reach / normal_975;
  } else {
    found.lower_95 = 0.0;
    found.std = found.upper_95 / normal_95;
  }
  return found;
}

}  // namespace proofmass::characterise
