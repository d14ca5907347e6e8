#include "proofmass/estimate/filter/linear_gaussian.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <gtest/gtest.h>

#include "proofmass/core/chi_square.hpp"
#include "proofmass/estimate/filter/lag_test_support.hpp"
#include "proofmass/estimate/filter/square_root.hpp"
#include "proofmass/estimate/wheel_test_support.hpp"

namespace proofmass::estimate::linear_gaussian_test {
namespace {

using Model = LinearModel<3, 2, 1>;
using Series = LinearSeries<3, 2, 1>;
constexpr double none = std::numeric_limits<double>::quiet_NaN();

constexpr auto model_at = test::driven_oscillator;
constexpr auto prior = test::oscillator_prior;

// Irregular steps, with one channel missing, the other, or both, and an input throughout.
std::vector<Epoch<2, 1>> epochs() {
  const auto at = [](double dt_s, double z0, double z1, double u) {
    return Epoch<2, 1>{dt_s, Mat<2>(z0, z1), Mat<1>(u)};
  };
  return {at(0.1, 0.2, -0.1, 9.0),   at(0.1, 0.4, none, 0.3),  at(0.37, none, 0.9, -0.5),
          at(0.05, 0.1, 0.2, 1.0),   at(1.9, none, none, 0.7), at(0.1, -0.6, 0.3, 0.0),
          at(0.1, none, -1.4, -2.0), at(0.8, 0.7, 0.05, 0.4)};
}

// All states of the first `count` epochs at once: the information matrix of the joint posterior,
// written down term by term from the model, without recursion.
struct Batch {
  Eigen::VectorXd mean;
  Eigen::MatrixXd cov;
};
Batch least_squares(const std::vector<Epoch<2, 1>>& all, std::size_t count) {
  const auto size = static_cast<Eigen::Index>(3 * count);
  Eigen::MatrixXd information = Eigen::MatrixXd::Zero(size, size);
  Eigen::VectorXd vector = Eigen::VectorXd::Zero(size);
  information.topLeftCorner<3, 3>() += prior().cov.inverse();
  vector.head<3>() += prior().cov.inverse() * prior().mean;
  for (Eigen::Index at = 0; at < size; at += 3) {
    const Epoch<2, 1>& e = all[static_cast<std::size_t>(at / 3)];
    const Model m = model_at(e.dt_s);
    for (int i = 0; i < 2; ++i) {
      if (std::isnan(e.z(i))) continue;
      information.block<3, 3>(at, at) += m.H.row(i).transpose() * m.H.row(i) / m.R(i);
      vector.segment<3>(at) += m.H.row(i).transpose() * e.z(i) / m.R(i);
    }
    if (at == 0) continue;
    Mat<3, 6> residual;  // x[k] − F x[k−1] = B u + w
    residual << -m.F, Mat<3, 3>::Identity();
    const Mat<6, 3> weighted = residual.transpose() * m.Q.inverse();
    information.block<6, 6>(at - 3, at - 3) += weighted * residual;
    vector.segment<6>(at - 3) += weighted * (m.B * e.u);
  }
  const Eigen::MatrixXd cov = information.inverse();
  return {cov * vector, cov};
}

TEST(LinearGaussian, FilterEqualsBatchLeastSquaresOfWhatWasReadSoFar) {
  const auto run = filter_linear(Series::make(epochs(), model_at).value(), prior());
  for (std::size_t k = 0; k < epochs().size(); ++k) {
    const Batch batch = least_squares(epochs(), k + 1);
    EXPECT_TRUE(run.steps[k].filtered.mean.isApprox(batch.mean.tail<3>(), 1e-10)) << "k = " << k;
    EXPECT_TRUE(
        (run.steps[k].filtered.cov.dense().isApprox(batch.cov.bottomRightCorner<3, 3>(), 1e-10)))
        << "k = " << k;
  }
}

TEST(LinearGaussian, SmootherEqualsBatchLeastSquaresOfEverything) {
  const auto run = smooth_linear(Series::make(epochs(), model_at).value(), prior());
  const Batch batch = least_squares(epochs(), epochs().size());
  for (std::size_t k = 0; k < epochs().size(); ++k) {
    const auto at = static_cast<Eigen::Index>(3 * k);
    EXPECT_TRUE(run.steps[k].smoothed.mean.isApprox(batch.mean.segment<3>(at), 1e-10))
        << "k = " << k;
    EXPECT_TRUE((run.steps[k].smoothed.cov.dense().isApprox(batch.cov.block<3, 3>(at, at), 1e-10)))
        << "k = " << k;
  }
}

// Rauch–Tung–Striebel smoother with an inverse, all channels of an epoch at once.
struct Textbook {
  std::vector<Gaussian<3>> predicted, filtered, smoothed;
  double log_likelihood = 0.0, nis = 0.0;
};
Textbook textbook(const std::vector<Epoch<2, 1>>& all) {
  Textbook t;
  for (const Epoch<2, 1>& e : all) {
    const Model m = model_at(e.dt_s);
    Gaussian<3> x = prior();
    if (!t.filtered.empty())
      x = {m.F * t.filtered.back().mean + m.B * e.u,
           m.F * t.filtered.back().cov * m.F.transpose() + m.Q};
    t.predicted.push_back(x);
    std::vector<Eigen::Index> there;
    for (Eigen::Index i = 0; i < 2; ++i)
      if (!std::isnan(e.z(i))) there.push_back(i);
    if (!there.empty()) {
      const Eigen::MatrixXd H = m.H(there, Eigen::all);
      const Eigen::MatrixXd S =
          H * x.cov * H.transpose() + Eigen::MatrixXd(m.R(there).asDiagonal());
      const Eigen::VectorXd y = e.z(there) - H * x.mean;
      const Eigen::MatrixXd K = x.cov * H.transpose() * S.inverse();
      x = {x.mean + K * y, x.cov - K * S * K.transpose()};
      const double nis = y.dot(S.inverse() * y);
      t.nis += nis;
      t.log_likelihood -= 0.5 * (static_cast<double>(there.size()) * std::log(2.0 * test::pi) +
                                 std::log(S.determinant()) + nis);
    }
    t.filtered.push_back(x);
  }
  t.smoothed = t.filtered;
  for (std::size_t k = all.size() - 1; k-- > 0;) {
    const Mat<3, 3> F = model_at(all[k + 1].dt_s).F;
    const Mat<3, 3> G = t.filtered[k].cov * F.transpose() * t.predicted[k + 1].cov.inverse();
    t.smoothed[k].mean += G * (t.smoothed[k + 1].mean - t.predicted[k + 1].mean);
    t.smoothed[k].cov += G * (t.smoothed[k + 1].cov - t.predicted[k + 1].cov) * G.transpose();
  }
  return t;
}

TEST(LinearGaussian, SmootherEqualsRauchTungStriebelWithTheInverse) {
  const auto run = smooth_linear(Series::make(epochs(), model_at).value(), prior());
  const Textbook expected = textbook(epochs());
  for (std::size_t k = 0; k < epochs().size(); ++k) {
    EXPECT_TRUE(run.steps[k].smoothed.mean.isApprox(expected.smoothed[k].mean, 1e-11)) << k;
    EXPECT_TRUE(run.steps[k].smoothed.cov.dense().isApprox(expected.smoothed[k].cov, 1e-11)) << k;
  }
}

TEST(LinearGaussian, BothSmoothersAndTheSquareRootAreOne) {
  const auto series = Series::make(epochs(), model_at).value();
  const auto plain = smooth_linear(series, prior(), {.lag_one = true});
  const auto by_gains =
      smooth_linear(series, prior(), {.smoother = Smoother::rauch_tung_striebel, .lag_one = true});
  const auto root = smooth_square_root(series, prior()).run;
  for (const auto* other : {&by_gains, &root}) {
    EXPECT_NEAR(other->log_likelihood, plain.log_likelihood, 1e-12);
    EXPECT_NEAR(other->nis, plain.nis, 1e-12);
    EXPECT_EQ(other->readings, plain.readings);
    for (std::size_t k = 0; k < epochs().size(); ++k) {
      const auto &a = plain.steps[k].smoothed, &b = other->steps[k].smoothed;
      EXPECT_TRUE(b.mean.isApprox(a.mean, 1e-12)) << "k = " << k;
      EXPECT_TRUE(b.cov.dense().isApprox(a.cov.dense(), 1e-12)) << "k = " << k;
    }
    for (std::size_t k = 0; k < plain.lag_one.size(); ++k)
      EXPECT_TRUE(other->lag_one[k].isApprox(plain.lag_one[k], 1e-11)) << "k = " << k;
  }
}

TEST(LinearGaussian, LagOneCovariancesAreThoseOfBatchLeastSquares) {
  const auto run =
      smooth_linear(Series::make(epochs(), model_at).value(), prior(), {.lag_one = true});
  const Batch batch = least_squares(epochs(), epochs().size());
  ASSERT_EQ(run.lag_one.size() + 1, epochs().size());
  for (std::size_t k = 0; k < run.lag_one.size(); ++k) {
    const auto at = static_cast<Eigen::Index>(3 * k);
    EXPECT_TRUE((run.lag_one[k].isApprox(batch.cov.block<3, 3>(at + 3, at), 1e-10))) << k;
  }
}

TEST(LinearGaussian, LagOneCovariancesAreKeptOnlyOnRequest) {
  EXPECT_TRUE(smooth_linear(Series::make(epochs(), model_at).value(), prior()).lag_one.empty());
}

TEST(LinearGaussian, LikelihoodAndNisOfOneChannelAtATimeAreThoseOfAllAtOnce) {
  const auto run = filter_linear(Series::make(epochs(), model_at).value(), prior());
  const Textbook expected = textbook(epochs());
  EXPECT_NEAR(run.log_likelihood, expected.log_likelihood, 1e-11);
  EXPECT_NEAR(run.nis, expected.nis, 1e-11);
  EXPECT_EQ(run.readings, 11U);
}

TEST(LinearGaussian, AChannelWithoutAReadingHasNoInnovation) {
  const auto run = filter_linear(Series::make(epochs(), model_at).value(), prior());
  const auto& second_missing = run.steps[1];
  EXPECT_EQ(second_missing.readings, 1);
  EXPECT_FALSE(std::isnan(second_missing.innovation(0)));
  EXPECT_TRUE(std::isnan(second_missing.innovation(1)));
  const auto& first_missing = run.steps[2];
  EXPECT_TRUE(std::isnan(first_missing.innovation(0)));
  const Mat<3> predicted = textbook(epochs()).predicted[2].mean;
  EXPECT_NEAR(first_missing.innovation(1), 0.9 - model_at(0.37).H.row(1).dot(predicted), 1e-12);
  EXPECT_EQ(run.steps[4].readings, 0);
  EXPECT_EQ(run.steps[4].nis, 0.0);
}

TEST(LinearGaussian, AsksForAModelOnlyWhereTheStepChanges) {
  std::vector<double> asked;
  (void)Series::make(epochs(), [&](double dt_s) {
    asked.push_back(dt_s);
    return model_at(dt_s);
  });
  EXPECT_EQ(asked, (std::vector{0.1, 0.37, 0.05, 1.9, 0.1, 0.8}));
}

TEST(LinearGaussian, ModelsGivenOneByOneAreTheSameAsFromTheSteps) {
  std::vector<Model> models;
  for (const auto& e : epochs()) models.push_back(model_at(e.dt_s));
  const auto one_by_one = smooth_linear(Series::make(epochs(), models).value(), prior());
  const auto from_steps = smooth_linear(Series::make(epochs(), model_at).value(), prior());
  for (std::size_t k = 0; k < models.size(); ++k)
    EXPECT_EQ(one_by_one.steps[k].smoothed.cov, from_steps.steps[k].smoothed.cov);
  models.pop_back();
  const auto short_by_one = Series::make(epochs(), models);
  ASSERT_FALSE(short_by_one.has_value());
  EXPECT_EQ(short_by_one.error().message, "7 models for 8 epochs");
}

TEST(LinearGaussian, SaysWhichEpochItCannotUse) {
  auto bad = epochs();
  bad[3].z(1) = std::numeric_limits<double>::infinity();
  const auto infinite = Series::make(bad, model_at);
  ASSERT_FALSE(infinite.has_value());
  EXPECT_EQ(infinite.error().code, Errc::not_finite);
  EXPECT_TRUE(infinite.error().message.starts_with("epoch 3: "));

  bad = epochs();
  bad[2].dt_s = -0.1;
  const auto backwards = Series::make(bad, model_at);
  ASSERT_FALSE(backwards.has_value());
  EXPECT_EQ(backwards.error().code, Errc::invalid_argument);
  EXPECT_TRUE(backwards.error().message.starts_with("epoch 2: "));

  const auto worthless = Series::make(epochs(), [](double dt_s) {
    Model m = model_at(dt_s);
    if (dt_s > 1.0) m.R(0) = 0.0;
    return m;
  });
  ASSERT_FALSE(worthless.has_value());
  EXPECT_EQ(worthless.error().code, Errc::not_positive_definite);
  EXPECT_TRUE(worthless.error().message.starts_with("epoch 4: "));
}

TEST(LinearGaussian, NoEpochsGiveNoStepsAndLikelihoodOne) {
  const auto run = smooth_linear(Series::make({}, model_at).value(), prior());
  EXPECT_TRUE(run.steps.empty());
  EXPECT_EQ(run.log_likelihood, 0.0);
}

// One run drawn from the model itself: true states, and measurements of which a third are missing.
struct Drawn {
  std::vector<Mat<3>> truth;
  std::vector<Epoch<2, 1>> epochs;
};
Drawn draw(std::uint64_t seed, std::size_t count) {
  test::Normal normal(seed);
  const auto normals = [&] { return Mat<3>(normal(), normal(), normal()); };
  Drawn drawn;
  Mat<3> x = prior().mean + Mat<3, 3>(prior().cov.llt().matrixL()) * normals();
  for (std::size_t k = 0; k < count; ++k) {
    Epoch<2, 1> e{k % 3 == 0 ? 0.3 : 0.1, Mat<2>(none, none), Mat<1>(normal())};
    const Model m = model_at(e.dt_s);
    if (k > 0) x = (m.F * x + m.B * e.u + Mat<3, 3>(m.Q.llt().matrixL()) * normals()).eval();
    for (int i = 0; i < 2; ++i)
      if (normal.uniform() > 1.0 / 3.0) e.z(i) = m.H.row(i).dot(x) + std::sqrt(m.R(i)) * normal();
    drawn.truth.push_back(x);
    drawn.epochs.push_back(e);
  }
  return drawn;
}

double nees(const Gaussian<3>& x, const Mat<3>& truth) {
  const Mat<3> error = x.mean - truth;
  return error.dot(x.cov.llt().solve(error));
}

// Bar-Shalom, Li, Kirubarajan (2001), section 5.4.2: NEES over independent runs at one epoch, NIS
// over all epochs, since innovations are white.
TEST(LinearGaussian, ErrorsAndInnovationsAreAsLargeAsTheCovariancesSay) {
  constexpr std::size_t runs = 200, count = 40;
  double filtered = 0.0, smoothed = 0.0, nis = 0.0;
  std::size_t readings = 0;
  for (std::uint64_t seed = 1; seed <= runs; ++seed) {
    const Drawn drawn = draw(seed, count);
    const auto run = smooth_linear(Series::make(drawn.epochs, model_at).value(), prior());
    filtered += nees(run.steps.back().filtered, drawn.truth.back());
    smoothed += nees(run.steps[count / 2].smoothed, drawn.truth[count / 2]);
    nis += run.nis;
    readings += run.readings;
  }
  const Bounds state = mean_chi_square_95(3 * runs), innovation = mean_chi_square_95(readings);
  EXPECT_GT(filtered / (3 * runs), state.lower);
  EXPECT_LT(filtered / (3 * runs), state.upper);
  EXPECT_GT(smoothed / (3 * runs), state.lower);
  EXPECT_LT(smoothed / (3 * runs), state.upper);
  EXPECT_GT(nis / static_cast<double>(readings), innovation.lower);
  EXPECT_LT(nis / static_cast<double>(readings), innovation.upper);
}

}  // namespace
}  // namespace proofmass::estimate::linear_gaussian_test
