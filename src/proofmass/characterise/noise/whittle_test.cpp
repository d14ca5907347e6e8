#include "proofmass/characterise/noise/whittle.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <random>

#include "proofmass/core/linalg.hpp"

namespace proofmass::characterise::whittle_test {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using Groups = std::vector<SpectralGroup>;

constexpr std::size_t count = 120;

/// n-th frequency, from 0.01 Hz to 10 Hz.
double frequency(std::size_t n) {
  return 0.01 * std::pow(1000.0, static_cast<double>(n) / (count - 1));
}

MatrixXd white_and_walk() {
  MatrixXd X(static_cast<Index>(count), 2);
  for (std::size_t n = 0; n < count; ++n) {
    X(static_cast<Index>(n), 0) = 1.0;
    X(static_cast<Index>(n), 1) = 0.01 / (frequency(n) * frequency(n));
  }
  return X;
}

/// Densities drawn about S = X θ: the first forty are single amplitudes, which a ramp affects, the
/// rest means with 3 … 20 degrees of freedom.
Groups draw(const VectorXd& theta, double slope, unsigned seed) {
  std::mt19937_64 engine(seed);
  std::normal_distribution<double> normal;
  const VectorXd S = white_and_walk() * theta;
  Groups groups(count);
  for (std::size_t n = 0; n < count; ++n) {
    SpectralGroup& group = groups[n];
    group.frequency_hz = frequency(n);
    const double scale = std::sqrt(S(static_cast<Index>(n)));
    if (n < 40) {
      group.dof = 1.0;
      group.of_ramp = n % 2 == 0 ? 0.3 / (frequency(n) * frequency(n)) : 0.0;
      group.amplitude = scale * normal(engine) + slope * group.of_ramp;
      group.density = group.amplitude * group.amplitude;
      continue;
    }
    group.dof = 3.0 + static_cast<double>(n % 18);
    for (int k = 0; k < static_cast<int>(group.dof); ++k) {
      const double z = scale * normal(engine);
      group.density += z * z / group.dof;
    }
  }
  return groups;
}

Groups without_ramp(Groups groups) {
  for (SpectralGroup& group : groups) group.amplitude = group.of_ramp = 0.0;
  return groups;
}

struct Slope {
  double value = 0.0, information = 0.0;
};

/// Weighted least-squares fit of the amplitudes to the ramp's.
Slope slope_at(const Groups& groups, const VectorXd& S) {
  double cross = 0.0, own = 0.0;
  for (std::size_t n = 0; n < groups.size(); ++n) {
    cross += groups[n].amplitude * groups[n].of_ramp / S(static_cast<Index>(n));
    own += groups[n].of_ramp * groups[n].of_ramp / S(static_cast<Index>(n));
  }
  return {own > 0.0 ? cross / own : 0.0, own};
}

/// The likelihood by its definition.
double log_likelihood(const Groups& groups, const VectorXd& S) {
  const Slope slope = slope_at(groups, S);
  double sum = slope.information > 0.0 ? -0.5 * std::log(slope.information) : 0.0;
  for (std::size_t n = 0; n < groups.size(); ++n) {
    const SpectralGroup& group = groups[n];
    const double rest = group.amplitude - slope.value * group.of_ramp;
    const double p = group.of_ramp != 0.0 ? rest * rest : group.density;
    const double s = S(static_cast<Index>(n));
    sum -= 0.5 * group.dof * (std::log(s) + p / s);
  }
  return sum;
}

/// dℓ/d ln θ of one strength.
double gradient(const Groups& groups, const VectorXd& theta, Index which) {
  constexpr double step = 1e-4;
  VectorXd up = theta, down = theta;
  up(which) *= 1.0 + step;
  down(which) *= 1.0 - step;
  const MatrixXd X = white_and_walk();
  return (log_likelihood(groups, X * up) - log_likelihood(groups, X * down)) / (2.0 * step);
}

const VectorXd truth = (VectorXd(2) << 2.0, 5.0).finished();

TEST(WhittleLikelihood, OfOneShapeIsGreatestAtTheWeightedMeanOfDensityOverShape) {
  const Groups groups = without_ramp(draw(truth, 0.0, 1));
  const MatrixXd X = white_and_walk();
  for (int column = 0; column < 2; ++column) {
    double sum = 0.0, dof = 0.0;
    for (std::size_t n = 0; n < count; ++n) {
      sum += groups[n].dof * groups[n].density / X(static_cast<Index>(n), column);
      dof += groups[n].dof;
    }
    const WhittleFit fit = WhittleLikelihood(groups, X).maximise({column});
    EXPECT_NEAR(fit.strength(column) * dof / sum, 1.0, 1e-9);
    EXPECT_EQ(fit.strength(1 - column), 0.0);
    EXPECT_NEAR(fit.density(7) / (fit.strength(column) * X(7, column)), 1.0, 1e-12);
  }
}

TEST(WhittleLikelihood, IsWhatItsFormulaSays) {
  for (const bool with_ramp : {false, true}) {
    const Groups groups = with_ramp ? draw(truth, 3.0, 2) : without_ramp(draw(truth, 0.0, 2));
    const WhittleFit fit = WhittleLikelihood(groups, white_and_walk()).maximise({0, 1});
    EXPECT_NEAR(fit.log_likelihood, log_likelihood(groups, fit.density), 1e-9);
  }
}

TEST(WhittleLikelihood, HasNoSlopeLeftAtItsMaximum) {
  for (unsigned seed = 1; seed <= 10; ++seed) {
    for (const bool with_ramp : {false, true}) {
      const Groups groups =
          with_ramp ? draw(truth, 3.0, seed) : without_ramp(draw(truth, 0.0, seed));
      const WhittleFit fit = WhittleLikelihood(groups, white_and_walk()).maximise({0, 1});
      for (const Index column : {0, 1})
        EXPECT_NEAR(gradient(groups, fit.strength, column), 0.0, 2e-3) << seed << " " << column;
    }
  }
}

TEST(WhittleLikelihood, LeavesAStrengthAtZeroOnlyWhereTheLikelihoodFallsFromThere) {
  const MatrixXd X = white_and_walk();
  std::size_t at_zero = 0;
  for (unsigned seed = 1; seed <= 20; ++seed) {
    const Groups groups = without_ramp(draw((VectorXd(2) << 2.0, 0.0).finished(), 0.0, seed));
    const WhittleFit fit = WhittleLikelihood(groups, X).maximise({0, 1});
    ASSERT_GE(fit.strength(1), 0.0);
    if (fit.strength(1) > 0.0) continue;
    ++at_zero;
    VectorXd inside = fit.strength;
    inside(1) = 1e-6;
    EXPECT_LT(log_likelihood(groups, X * inside), fit.log_likelihood + 1e-9) << seed;
  }
  EXPECT_GE(at_zero, 4U);
  EXPECT_LE(at_zero, 18U);
}

TEST(WhittleLikelihood, ReachesTheSameMaximumFromAnywhere) {
  const Groups groups = draw(truth, 3.0, 4);
  const WhittleLikelihood likelihood(groups, white_and_walk());
  const WhittleFit fit = likelihood.maximise({0, 1});
  for (const double white : {1e-3, 2.0, 1e3}) {
    for (const double walk : {1e-3, 5.0, 1e4}) {
      const WhittleFit other =
          likelihood.maximise({0, 1}, {}, (VectorXd(2) << white, walk).finished());
      EXPECT_NEAR(other.log_likelihood, fit.log_likelihood, 1e-6) << white << " " << walk;
      EXPECT_NEAR(other.strength(0) / fit.strength(0), 1.0, 1e-4);
      EXPECT_NEAR(other.strength(1) / fit.strength(1), 1.0, 1e-3);
    }
  }
}

TEST(WhittleLikelihood, DoesNotDependOnTheUnit) {
  const Groups groups = draw(truth, 3.0, 5);
  const WhittleFit fit = WhittleLikelihood(groups, white_and_walk()).maximise({0, 1});
  for (const double unit : {1e-9, 1e6}) {
    Groups other = groups;
    for (SpectralGroup& group : other) {
      group.density *= unit * unit;
      group.amplitude *= unit;
    }
    const WhittleFit scaled = WhittleLikelihood(other, white_and_walk()).maximise({0, 1});
    EXPECT_NEAR(scaled.strength(0) / (unit * unit * fit.strength(0)), 1.0, 1e-6);
    EXPECT_NEAR(scaled.strength(1) / (unit * unit * fit.strength(1)), 1.0, 1e-6);
    EXPECT_NEAR(scaled.slope / (unit * fit.slope), 1.0, 1e-6);
  }
}

TEST(WhittleLikelihood, KeepsAHeldStrengthWhereItIs) {
  const Groups groups = draw(truth, 0.0, 6);
  const WhittleLikelihood likelihood(groups, white_and_walk());
  const WhittleFit fit = likelihood.maximise({0, 1});
  for (const double factor : {0.0, 0.5, 1.0, 2.0}) {
    const double held = factor * fit.strength(1);
    const WhittleFit at = likelihood.maximise({0}, WhittleLikelihood::Held{1, held});
    EXPECT_EQ(at.strength(1), held);
    EXPECT_NEAR(gradient(groups, at.strength, 0), 0.0, 2e-3);
    if (factor == 1.0) {
      EXPECT_NEAR(at.log_likelihood, fit.log_likelihood, 1e-7);
    } else {
      EXPECT_LT(at.log_likelihood, fit.log_likelihood);
    }
  }
}

TEST(WhittleLikelihood, OfAllStrengthsHeldNeedsNoSearch) {
  const Groups groups = draw(truth, 0.0, 6);
  const WhittleFit fit = WhittleLikelihood(groups, white_and_walk())
                             .maximise({}, WhittleLikelihood::Held{0, truth(0)});
  EXPECT_NEAR(fit.log_likelihood, log_likelihood(groups, VectorXd::Constant(count, truth(0))),
              1e-9);
}

TEST(WhittleLikelihood, TheRampsSlopeIsThatOfWeightedLeastSquares) {
  const Groups groups = draw(truth, 3.0, 7);
  const WhittleFit fit = WhittleLikelihood(groups, white_and_walk()).maximise({0, 1});
  const Slope slope = slope_at(groups, fit.density);
  EXPECT_NEAR(fit.slope / slope.value, 1.0, 1e-9);
  EXPECT_NEAR(fit.slope_variance * slope.information, 1.0, 1e-9);
  EXPECT_NEAR(fit.slope, 3.0, 3.5 * std::sqrt(fit.slope_variance));
}

TEST(WhittleLikelihood, TheStrengthsDoNotDependOnTheRampsSlope) {
  const MatrixXd X = white_and_walk();
  const WhittleFit level = WhittleLikelihood(draw(truth, 0.0, 8), X).maximise({0, 1});
  const WhittleFit steep = WhittleLikelihood(draw(truth, 10.0, 8), X).maximise({0, 1});
  EXPECT_NEAR(steep.strength(0) / level.strength(0), 1.0, 1e-4);
  EXPECT_NEAR(steep.strength(1) / level.strength(1), 1.0, 1e-4);
  EXPECT_NEAR(steep.slope - 10.0, level.slope, 1e-6);
}

TEST(WhittleLikelihood, WithoutARampThereIsNoSlope) {
  const Groups groups = without_ramp(draw(truth, 0.0, 9));
  const WhittleFit fit = WhittleLikelihood(groups, white_and_walk()).maximise({0, 1});
  EXPECT_EQ(fit.slope, 0.0);
  EXPECT_EQ(fit.slope_variance, 0.0);
}

TEST(WhittleLikelihood, DensitiesAreThoseWithTheRampTakenOut) {
  const Groups groups = draw(truth, 50.0, 10);
  const WhittleLikelihood likelihood(groups, white_and_walk());
  const WhittleFit fit = likelihood.maximise({0, 1});
  const Eigen::ArrayXd p = likelihood.densities(fit);
  for (std::size_t n = 0; n < count; ++n) {
    const double rest = groups[n].amplitude - fit.slope * groups[n].of_ramp;
    const double expected = groups[n].of_ramp != 0.0 ? rest * rest : groups[n].density;
    EXPECT_NEAR(p(static_cast<Index>(n)), expected, 1e-9 * (1.0 + expected));
  }
}

TEST(WhittleLikelihood, InformationIsHalfTheDegreesOfFreedomOverTheSquareOfOneStrength) {
  const Groups groups = without_ramp(draw(truth, 0.0, 11));
  const WhittleLikelihood likelihood(groups, white_and_walk());
  const WhittleFit fit = likelihood.maximise({1});
  const double expected = 0.5 * likelihood.dof().sum() / (fit.strength(1) * fit.strength(1));
  EXPECT_NEAR(likelihood.information(fit, {1})(0, 0) / expected, 1.0, 1e-9);
}

TEST(WhittleLikelihood, SpreadsAsTheInverseOfItsInformationSays) {
  constexpr unsigned runs = 300;
  const MatrixXd X = white_and_walk();
  VectorXd squares = VectorXd::Zero(2), sums = VectorXd::Zero(2);
  for (unsigned seed = 1; seed <= runs; ++seed) {
    const WhittleLikelihood likelihood(draw(truth, 3.0, seed), X);
    const WhittleFit fit = likelihood.maximise({0, 1});
    const MatrixXd covariance = positive_inverse(likelihood.information(fit, {0, 1}));
    for (const Index column : {0, 1}) {
      const double z =
          (fit.strength(column) - truth(column)) / std::sqrt(covariance(column, column));
      sums(column) += z / runs;
      squares(column) += z * z / runs;
    }
  }
  for (const Index column : {0, 1}) {
    EXPECT_NEAR(sums(column), 0.0, 0.35) << column;
    EXPECT_NEAR(squares(column), 1.0, 0.35) << column;
  }
}

TEST(WhittleLikelihood, AMisfitLowersDegreesOfFreedomAndInformation) {
  const Groups groups = draw(truth, 0.0, 12);
  WhittleLikelihood likelihood(groups, white_and_walk());
  const WhittleFit fit = likelihood.maximise({0, 1});
  const MatrixXd before = likelihood.information(fit, {0, 1});
  likelihood.allow_misfit(0.04);
  for (std::size_t n = 0; n < count; ++n)
    EXPECT_NEAR(2.0 / likelihood.dof()(static_cast<Index>(n)), 2.0 / groups[n].dof + 0.04, 1e-12);
  const MatrixXd after = likelihood.information(fit, {0, 1});
  for (const Index column : {0, 1}) EXPECT_LT(after(column, column), before(column, column));
  // A second call replaces the first.
  likelihood.allow_misfit(0.0);
  EXPECT_NEAR(likelihood.information(fit, {0, 1})(0, 0) / before(0, 0), 1.0, 1e-12);
}

TEST(WhittleLikelihood, TakesAShapeInTheOthersPlace) {
  const Groups groups = without_ramp(draw(truth, 0.0, 13));
  WhittleLikelihood likelihood(groups, white_and_walk());
  const VectorXd walk = likelihood.column(1);
  likelihood.set_column(0, walk);
  EXPECT_NEAR(likelihood.maximise({0}).strength(0), likelihood.maximise({1}).strength(1), 1e-9);
}

}  // namespace
}  // namespace proofmass::characterise::whittle_test
