#include "proofmass/estimate/models/fusion_model.hpp"

#include <gtest/gtest.h>
#include <limits>

#include "proofmass/core/random.hpp"

namespace proofmass::estimate::fusion_model_test {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

FusionModelOptions fourteen(double dt_s) {
  FusionModelOptions out;
  for (PvaOptions& axis : out.axes) axis = {dt_s, 0.3, 0.04};
  out.bias_x = {dt_s, 5.0, 0.02};
  out.bias_y = {dt_s, 9.0, 0.03};
  return out;
}

TEST(FusionModel, EachRowReadsItsOwnAccelerationAndItsBias) {
  const LinearModel<14, 4, 2> model = fusion_model(fourteen(0.1));
  Mat<14> x = Mat<14>::Zero();
  for (int i = 0; i < 4; ++i) {
    x(3 * i) = 100.0;
    x(3 * i + 1) = 10.0;
    x(3 * i + 2) = i + 1.0;
  }
  x(fusion::bias_x_mps2) = 0.5;
  x(fusion::bias_y_mps2) = 0.25;
  EXPECT_EQ(Mat<4>(model.H * x), Mat<4>(1.5, 2.25, 3.5, 4.25));
}

TEST(FusionModel, OneAxisOfItIsTheModelOfOneAxis) {
  std::vector<Epoch<4, 2>> epochs;
  std::vector<Epoch<1, 1>> alone;
  Random noise(3, "noise");
  for (int k = 0; k < 60; ++k) {
    const double z = noise.normal();
    epochs.push_back({0.1, Mat<4>(z, nan, nan, nan), Mat<2>(0.1, 0.2)});
    alone.push_back({0.1, Mat<1>(z), Mat<1>(0.1)});
  }
  Gaussian<14> prior;
  prior.cov.setIdentity();
  Gaussian<4> prior_alone;
  prior_alone.cov.setIdentity();
  const auto all = smooth_linear(
      LinearSeries<14, 4, 2>::make(epochs, [](double dt) { return fusion_model(fourteen(dt)); })
          .value(),
      prior);
  const auto one = smooth_linear(
      LinearSeries<4, 1, 1>::make(
          alone, [](double dt) { return pva_bias_model({{dt, 0.3, 0.04}, 5.0, 0.02}); })
          .value(),
      prior_alone);
  EXPECT_NEAR(all.log_likelihood, one.log_likelihood, 1e-10);
  for (std::size_t k = 0; k < 60; ++k) {
    const auto& a = all.steps[k].smoothed;
    const auto& b = one.steps[k].smoothed;
    EXPECT_NEAR(a.mean(0), b.mean(0), 1e-11);
    EXPECT_NEAR(a.mean(fusion::bias_x_mps2), b.mean(3), 1e-12);
    EXPECT_NEAR(a.cov(0, 0), b.cov(0, 0), 1e-10);
  }
}

}  // namespace
}  // namespace proofmass::estimate::fusion_model_test
