#include <Eigen/LU>
#include <cmath>
#include <gtest/gtest.h>
#include <limits>

#include "proofmass/estimate/gain_study.hpp"
#include "proofmass/estimate/motion_models.hpp"

// docs/errata.md, sections 4.1.1 to 4.1.4: the filter, its gain and its tuning.
namespace proofmass::thesis::errata_filter_test {
namespace {

using estimate::Mat;

/// A prior and one measurement of the acceleration one step later, by the library's filter.
struct OneReading {
  double variance_m2ps4 = 0.5, reading_mps2 = 2.5;
  estimate::Gaussian<3> prior;
  estimate::LinearModel<3, 1> model;
  estimate::Gaussian<3> predicted, filtered;

  explicit OneReading(double variance)
      : variance_m2ps4(variance),
        model(estimate::pva_model(
            {.dt_s = 0.5, .jerk_psd_m2ps5 = 1.0, .accel_variance_m2ps4 = variance})) {
    prior.mean << 1.0, 2.0, 3.0;
    prior.cov << 1.0, 0.3, 0.2, 0.3, 2.0, 0.4, 0.2, 0.4, 3.0;
    constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    const std::vector<estimate::Epoch<1>> epochs{{.dt_s = 0.0, .z = Mat<1>(nan)},
                                                 {.dt_s = 0.5, .z = Mat<1>(reading_mps2)}};
    const std::vector models(2, model);
    const auto series = estimate::LinearSeries<3, 1>::make(epochs, models).value();
    filtered = estimate::filter_linear(series, prior).steps.back().filtered;
    predicted.mean = model.F * prior.mean;
    predicted.cov = model.F * prior.cov * model.F.transpose() + model.Q;
  }

  /// Covariance of the error for any gain.
  [[nodiscard]] Mat<3, 3> covariance(const Mat<3>& gain) const {
    const Mat<3, 3> left = Mat<3, 3>::Identity() - gain * model.H;
    return left * predicted.cov * left.transpose() + model.R(0) * gain * gain.transpose();
  }
  [[nodiscard]] Mat<3> gain() const {
    const Mat<3> PHt = predicted.cov * model.H.transpose();
    return PHt / (model.H.row(0).dot(PHt) + model.R(0));
  }
};

// (4.9), (4.27): K = A P⁻ Cᵀ (C P⁻ Cᵀ + R)⁻¹. Compared with least squares in information form,
// which has no gain.
TEST(ErrataChapter4, AGainWithTheTransitionInItIsNotThatOfLeastSquares) {
  const OneReading one(0.5);
  const Mat<3, 3> before = one.predicted.cov.inverse();
  const Mat<3, 3> after = before + one.model.H.transpose() * one.model.H / one.variance_m2ps4;
  const Mat<3> stated =
      before * one.predicted.mean + one.model.H.transpose() * one.reading_mps2 / one.variance_m2ps4;
  const Mat<3> least_squares = after.inverse() * stated;
  EXPECT_LT((one.filtered.mean - least_squares).norm(), 1e-12);

  const double innovation = one.reading_mps2 - one.predicted.mean(2);
  const Mat<3> printed = one.model.F * one.gain();
  EXPECT_GT((one.predicted.mean + printed * innovation - least_squares).norm(), 0.1);
  EXPECT_GT(one.covariance(printed).trace(), 1.05 * one.filtered.cov.trace());
}

// (4.10), (4.30), (4.33): correct.
TEST(ErrataChapter4, TheOtherFormsOfCovarianceAndGainAreRight) {
  const OneReading one(0.5);
  const Mat<3, 3> short_form =
      (Mat<3, 3>::Identity() - one.gain() * one.model.H) * one.predicted.cov;
  EXPECT_LT((short_form - one.filtered.cov).norm(), 1e-12);
  EXPECT_LT((one.filtered.cov * one.model.H.transpose() / one.variance_m2ps4 - one.gain()).norm(),
            1e-12);
}

// (4.11): K = 0, x̂[k] = x̂[k−1]; P⁻ goes to zero if measurements are not trusted.
TEST(ErrataChapter4, WithInfiniteRThePredictionRemainsNotThePreviousEstimate) {
  const OneReading one(1e15);
  EXPECT_LT(one.gain().norm(), 1e-13);
  EXPECT_LT((one.filtered.mean - one.predicted.mean).norm(), 1e-12);
  EXPECT_GT((one.filtered.mean - one.prior.mean).norm(), 1.0);
  EXPECT_GT(one.predicted.cov(2, 2), 3.0);  // P⁻ is unchanged
}

// (4.12): K = H⁻¹, x̂ = H⁻¹ y as R goes to zero. H has one row and three columns.
TEST(ErrataChapter4, AnExactMeasurementDeterminesOnlyTheMeasuredQuantity) {
  const OneReading one(1e-12);
  EXPECT_NEAR(one.filtered.mean(2), one.reading_mps2, 1e-10);
  EXPECT_NEAR(one.model.H.row(0).dot(one.gain()), 1.0, 1e-11);  // all that remains of (4.12) is H
                                                                // K = 1
  EXPECT_GT(one.filtered.cov(0, 0), 0.5 * one.predicted.cov(0, 0));
  EXPECT_GT(one.filtered.cov(1, 1), 0.5 * one.predicted.cov(1, 1));
}

estimate::GainStudy study(double q, double R, double P0 = 100.0) {
  return estimate::gain_study({.jerk_psd_m2ps5 = q,
                               .accel_variance_m2ps4 = R,
                               .step_s = 0.2,
                               .duration_s = 100.0,
                               .prior_variance = P0});
}

// 4.1.2: "Kalman gain is inversely proportional to measurement noise covariance R"; 4.1.4:
// "changes in proportion to the process noise covariance Q".
TEST(ErrataChapter4, TheGainIsInProportionNeitherToQNorToOneOverR) {
  EXPECT_NEAR(study(4.0, 1.0).limit[2] / study(4.0, 4.0).limit[2], 1.62, 0.01);
  EXPECT_NEAR(study(4.0, 1.0).limit[2] / study(1.0, 1.0).limit[2], 1.62, 0.01);
  // At most with the square root, if the gain is small.
  EXPECT_NEAR(study(1e-6, 1.0).limit[2] / study(1e-6, 4.0).limit[2], 2.0, 0.01);
}

// 4.1.4: "The initial guess of P is large which reflect less confidence on the measurement".
TEST(ErrataChapter4, AWidePriorGivesTheFirstMeasurementFullWeight) {
  EXPECT_GT(study(1.0, 1.0, 100.0).epochs.front().gain[2], 0.98);
  EXPECT_LT(study(1.0, 1.0, 0.01).epochs.front().gain[2], 0.25);
}

// (4.26): off the diagonal σ_p σ_v, which is a correlation of one; then "taken as zero".
TEST(ErrataChapter4, TheStatesNoisesAreCorrelatedAndNotWholly) {
  const auto Q = [](double dt) -> Mat<3, 3> {
    return estimate::pva_model({.dt_s = dt, .jerk_psd_m2ps5 = 1.0, .accel_variance_m2ps4 = 1.0}).Q;
  };
  const auto correlation = [&](int i, int j) {
    return Q(0.2)(i, j) / std::sqrt(Q(0.2)(i, i) * Q(0.2)(j, j));
  };
  EXPECT_NEAR(correlation(0, 1), std::sqrt(15.0) / 4.0, 1e-12);
  EXPECT_NEAR(correlation(0, 2), std::sqrt(5.0) / 3.0, 1e-12);
  EXPECT_NEAR(correlation(1, 2), std::sqrt(3.0) / 2.0, 1e-12);
  // Two steps of 0.1 s must equal one of 0.2 s; the diagonal alone gives less than half.
  Mat<3, 3> F;
  F << 1.0, 0.1, 0.005, 0.0, 1.0, 0.1, 0.0, 0.0, 1.0;
  const Mat<3, 3> whole = F * Q(0.1) * F.transpose() + Q(0.1);
  EXPECT_LT((whole - Q(0.2)).norm(), 1e-14);
  const Mat<3, 3> diagonal = Q(0.1).diagonal().asDiagonal();
  const double twice = (F * diagonal * F.transpose() + diagonal)(0, 0);
  EXPECT_LT(twice, 0.5 * Q(0.2)(0, 0));
}

// 4.1.4: Q and R are tuned "such that error covariance P and Kalman gain K converges quickly".
TEST(ErrataChapter4, TheGainThatSettlesSoonestIsNotTheBest) {
  constexpr double q = 0.2, R = 4.0;  // process noise of the acceleration per step
  // Error variance of a filter of gain k on a random-walk level, by its own recursion.
  const auto error = [&](double k) {
    return ((1.0 - k) * (1.0 - k) * q + k * k * R) / (1.0 - (1.0 - k) * (1.0 - k));
  };
  const auto matched = study(1.0, R), quick = study(16.0, R);
  EXPECT_LT(*quick.settling_s[2], *matched.settling_s[2]);
  EXPECT_NEAR(error(matched.limit[2]), matched.limit_variance_m2ps4, 1e-12);
  EXPECT_GT(error(quick.limit[2]), 1.3 * error(matched.limit[2]));
}

// 4.1.1: "reduces and stabilises at a minimum value"; 4.1.4: "covariance decreases over the time".
TEST(ErrataChapter4, FromAccelerationsThePositionsVarianceGrowsWithTheCubeOfTime) {
  const auto run = study(1.0, 1.0, 1e-9);
  const auto at = [&](double t_s) {
    return run.epochs[static_cast<std::size_t>(std::lround(t_s / 0.2))].variance;
  };
  EXPECT_NEAR(at(80.0)[0] / at(40.0)[0], 8.0, 0.4);
  EXPECT_NEAR(at(80.0)[1] / at(40.0)[1], 2.0, 0.1);
  EXPECT_NEAR(at(80.0)[2] / at(40.0)[2], 1.0, 1e-9);
}

}  // namespace
}  // namespace proofmass::thesis::errata_filter_test
