#include "proofmass/characterise/noise/cosine_ordinates.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <numeric>

#include "proofmass/characterise/noise/noise_test_support.hpp"
#include "proofmass/characterise/noise/term_spectra.hpp"

namespace proofmass::characterise::low_band_test {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using test::Series;

constexpr double rate_hz = 100.0;
constexpr double nan_value = std::numeric_limits<double>::quiet_NaN();

BlockMeans gathered(View<double> series) {
  BlockMeans means(rate_hz);
  means.add(series);
  return means;
}

std::vector<CosineOrdinate> ordinates_of(View<double> series) {
  return gathered(series).ordinates();
}

/// The amplitudes are a linear map of the samples: its matrix, one column per sample.
MatrixXd map_to_amplitudes(std::size_t samples) {
  MatrixXd map(static_cast<Index>(samples - 1), static_cast<Index>(samples));
  for (std::size_t n = 0; n < samples; ++n) {
    Series impulse(samples, 0.0);
    impulse[n] = 1.0;
    const auto found = ordinates_of(impulse);
    for (std::size_t k = 0; k < found.size(); ++k)
      map(static_cast<Index>(k), static_cast<Index>(n)) = found[k].amplitude;
  }
  return map;
}

/// Checks that a covariance is diagonal with the term's density on the diagonal.
void expect_independent(const MatrixXd& covariance, Term term, std::size_t samples) {
  for (Index k = 0; k < covariance.rows(); ++k) {
    const double f = static_cast<double>(k + 1) * rate_hz / (2.0 * static_cast<double>(samples));
    const double density = term_density(term, f, {rate_hz, 1});
    EXPECT_NEAR(covariance(k, k) / density, 1.0, 1e-9) << "ordinate " << k + 1;
    for (Index j = 0; j < k; ++j)
      ASSERT_LT(std::abs(covariance(k, j)), 1e-9 * std::sqrt(covariance(k, k) * covariance(j, j)))
          << k + 1 << " " << j + 1;
  }
}

TEST(BlockMeans, OfWhiteNoiseGivesIndependentOrdinatesOfItsDensity) {
  for (const std::size_t samples : {16U, 37U, 60U}) {
    const MatrixXd map = map_to_amplitudes(samples);
    expect_independent(map * map.transpose() * rate_hz, Term::white, samples);
  }
}

TEST(BlockMeans, OfARandomWalkGivesIndependentOrdinatesOfItsDensity) {
  for (const std::size_t samples : {16U, 37U, 60U}) {
    const auto n = static_cast<Index>(samples);
    const MatrixXd sums = MatrixXd::Ones(n, n).triangularView<Eigen::Lower>();
    const MatrixXd map = map_to_amplitudes(samples) * sums;
    expect_independent(map * map.transpose() / rate_hz, Term::random_walk, samples);
  }
}

TEST(BlockMeans, ARampHasTheAmplitudesThatTheyGiveIt) {
  const std::size_t samples = 101;
  const auto found = ordinates_of(test::ramp(3.0, rate_hz, samples));
  ASSERT_EQ(found.size(), samples - 1);
  for (std::size_t k = 0; k < found.size(); ++k) {
    EXPECT_NEAR(found[k].amplitude, 3.0 * found[k].of_ramp, 1e-9 * std::abs(found[0].of_ramp));
    if (k % 2 == 1) {
      EXPECT_NEAR(found[k].of_ramp, 0.0, 1e-9 * std::abs(found[0].of_ramp)) << k + 1;
    }
  }
  // For many samples −T^{3/2} √8 / (π k)² for odd k.
  const double duration_s = samples / rate_hz;
  EXPECT_NEAR(found[0].of_ramp / (-std::pow(duration_s, 1.5) * std::sqrt(8.0) /
                                  (std::numbers::pi * std::numbers::pi)),
              1.0, 1e-3);
}

TEST(BlockMeans, TheLevelDoesNotMatter) {
  const Series noise = test::normals(200, 3);
  const auto plain = ordinates_of(noise);
  const auto raised = ordinates_of(test::sum_of({noise, Series(200, 1e4)}));
  for (std::size_t k = 0; k < plain.size(); ++k)
    EXPECT_NEAR(raised[k].amplitude, plain[k].amplitude, 1e-9);
}

TEST(BlockMeans, FrequenciesRunFromOneOverTwiceTheRecordToHalfTheRate) {
  const auto found = ordinates_of(test::normals(250, 1));
  ASSERT_EQ(found.size(), 249U);
  EXPECT_DOUBLE_EQ(found.front().frequency_hz, 0.2);
  EXPECT_DOUBLE_EQ(found.back().frequency_hz, 49.8);
}

TEST(BlockMeans, GrowByHalvingAndRemainTheMeansOfTheirSamples) {
  const Series series = test::normals(200'003, 2);
  for (const auto& [samples, block] :
       {std::pair{65'535U, 1U}, {65'536U, 2U}, {131'071U, 2U}, {131'072U, 4U}, {200'003U, 4U}}) {
    const BlockMeans means = gathered(View<double>(series).first(samples));
    ASSERT_EQ(means.block(), block);
    const Series found = means.means();
    ASSERT_EQ(found.size(), samples / block);
    for (std::size_t k = 0; k < found.size(); ++k) {
      const auto first = series.begin() + static_cast<std::ptrdiff_t>(k * block);
      const double mean = std::accumulate(first, first + block, 0.0) / block;
      ASSERT_NEAR(found[k], mean, 1e-12);
    }
  }
}

TEST(BlockMeans, GrowNoFurtherThanTheLongest) {
  BlockMeans means(rate_hz);
  const Series piece(1 << 16, 1.0);
  for (int k = 0; k < 200; ++k) means.add(piece);
  EXPECT_EQ(means.block(), BlockMeans::longest_block);
  EXPECT_EQ(means.means().size(), 200 * piece.size() / BlockMeans::longest_block);
}

TEST(BlockMeans, OrdinatesOfBlocksReachAQuarterOfTheirRate) {
  const auto found = ordinates_of(test::normals(131'072, 1));
  EXPECT_NEAR(found.back().frequency_hz, rate_hz / 4.0 / 4.0, 1e-9);
  EXPECT_EQ(found.size(), 32'768U / 2U);
}

/// Mean ratio of amplitude² to its expectation, with its standard deviation in `scatter`.
double mean_ratio(const std::vector<CosineOrdinate>& found,
                  Term term,
                  std::size_t block,
                  double& scatter) {
  double sum = 0.0;
  for (const CosineOrdinate& ordinate : found)
    sum += ordinate.amplitude * ordinate.amplitude /
           term_density(term, ordinate.frequency_hz, {rate_hz, block});
  scatter = std::sqrt(2.0 / static_cast<double>(found.size()));
  return sum / static_cast<double>(found.size());
}

TEST(BlockMeans, OrdinatesOfBlocksHaveTheDensityOfTheMeans) {
  constexpr std::size_t samples = 150'000;
  double scatter = 0.0;
  const double white =
      mean_ratio(ordinates_of(test::white(1.0, rate_hz, samples, 4)), Term::white, 4, scatter);
  EXPECT_NEAR(white, 1.0, 4.0 * scatter);
  const double walk = mean_ratio(ordinates_of(test::random_walk(1.0, rate_hz, samples, 5)),
                                 Term::random_walk, 4, scatter);
  EXPECT_NEAR(walk, 1.0, 4.0 * scatter);
  const double quantised = mean_ratio(ordinates_of(test::quantisation(1.0, rate_hz, samples, 6)),
                                      Term::quantisation, 4, scatter);
  EXPECT_NEAR(quantised, 1.0, 6.0 * scatter);
}

TEST(BlockMeans, OrdinatesOfFlickerHaveItsDensity) {
  double scatter = 0.0;
  const auto found = ordinates_of(test::flicker(1.0, 30'000, 7));
  const double ratio = mean_ratio(found, Term::flicker, 1, scatter);
  EXPECT_NEAR(ratio, 1.0, 4.0 * scatter);
  // Also at the lowest ordinates, where a window would cause leakage.
  const std::vector<CosineOrdinate> lowest(found.begin(), found.begin() + 300);
  const double ratio_of_lowest = mean_ratio(lowest, Term::flicker, 1, scatter);
  EXPECT_NEAR(ratio_of_lowest, 1.0, 4.0 * scatter);
}

TEST(BlockMeans, InOddPiecesAreWhatTheyAreInOne) {
  Series series = test::normals(300'000, 8);
  for (std::size_t k = 100; k < series.size(); k += 997) series[k] = nan_value;
  BlockMeans pieces(rate_hz);
  std::size_t at = 0;
  for (std::size_t length = 1; at < series.size(); length = length * 7 % 4099 + 1) {
    const std::size_t taken = std::min(length, series.size() - at);
    pieces.add(View<double>(series).subspan(at, taken));
    at += taken;
  }
  const auto expected = ordinates_of(series), found = pieces.ordinates();
  EXPECT_EQ(pieces.block(), 8U);
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t k = 0; k < found.size(); ++k)
    ASSERT_NEAR(found[k].amplitude, expected[k].amplitude, 1e-12);
}

TEST(BlockMeans, AreMissingWhereMoreThanHalfOfTheirSamplesAre) {
  Series series(131'072, 2.0);
  series[0] = series[1] = series[2] = nan_value;  // three of the first four samples
  series[4] = series[5] = nan_value;              // two of the next four
  series[6] = 3.0;
  const Series means = gathered(series).means();
  EXPECT_TRUE(std::isnan(means[0]));
  EXPECT_DOUBLE_EQ(means[1], 2.5);
  EXPECT_DOUBLE_EQ(means[2], 2.0);
}

/// Positions at which the frequency decreases: where the next interval begins.
std::vector<std::size_t> stretches_in(const std::vector<CosineOrdinate>& found) {
  std::vector<std::size_t> sizes{0};
  for (std::size_t k = 0; k < found.size(); ++k) {
    if (k > 0 && found[k].frequency_hz <= found[k - 1].frequency_hz) sizes.push_back(0);
    ++sizes.back();
  }
  return sizes;
}

Series with_gap(std::size_t samples, std::size_t first, std::size_t length) {
  Series series = test::normals(samples, 9);
  for (std::size_t k = first; k < first + length; ++k) series[k] = nan_value;
  return series;
}

TEST(BlockMeans, AGapOfEightIsFilledAndALongerOneSplits) {
  EXPECT_EQ(stretches_in(ordinates_of(with_gap(1000, 400, 8))), (std::vector<std::size_t>{999}));
  EXPECT_EQ(stretches_in(ordinates_of(with_gap(1000, 400, 9))),
            (std::vector<std::size_t>{399, 590}));
}

TEST(BlockMeans, InALongRecordAGapOfHalfAPercentIsFilled) {
  EXPECT_EQ(stretches_in(ordinates_of(with_gap(10'000, 4000, 50))).size(), 1U);
  EXPECT_EQ(stretches_in(ordinates_of(with_gap(10'000, 4000, 51))).size(), 2U);
}

TEST(BlockMeans, EachStretchIsThatOfARecordOfItsOwn) {
  const Series series = with_gap(300, 100, 20);
  const auto found = ordinates_of(series);
  const auto first = ordinates_of(View<double>(series).first(100));
  const auto second = ordinates_of(View<double>(series).subspan(120));
  ASSERT_EQ(found.size(), first.size() + second.size());
  for (std::size_t k = 0; k < found.size(); ++k) {
    const CosineOrdinate& alone = k < first.size() ? first[k] : second[k - first.size()];
    EXPECT_DOUBLE_EQ(found[k].frequency_hz, alone.frequency_hz);
    EXPECT_NEAR(found[k].amplitude, alone.amplitude, 1e-12);
    EXPECT_NEAR(found[k].of_ramp, alone.of_ramp, 1e-12);
  }
}

TEST(BlockMeans, MissingEndsAreCutOff) {
  const Series inner = test::normals(100, 10);
  Series series(3, nan_value);
  series.insert(series.end(), inner.begin(), inner.end());
  series.insert(series.end(), 5, nan_value);
  const auto found = ordinates_of(series), expected = ordinates_of(inner);
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t k = 0; k < found.size(); ++k)
    EXPECT_NEAR(found[k].amplitude, expected[k].amplitude, 1e-12);
}

TEST(BlockMeans, StretchesOfFewerThanSixteenAreNotUsed) {
  EXPECT_TRUE(ordinates_of(test::normals(15, 1)).empty());
  EXPECT_EQ(ordinates_of(test::normals(16, 1)).size(), 15U);
  EXPECT_EQ(stretches_in(ordinates_of(with_gap(100, 15, 20))), (std::vector<std::size_t>{64}));
  EXPECT_TRUE(ordinates_of(Series(1000, nan_value)).empty());
  EXPECT_TRUE(BlockMeans(rate_hz).ordinates().empty());
}

TEST(BlockMeans, TheDensityOfWhiteNoiseIsKeptWhereOneInTenIsMissing) {
  Series series = test::white(1.0, rate_hz, 20'000, 11);
  const Series dice = test::normals(series.size(), 12);
  for (std::size_t k = 0; k < series.size(); ++k)
    if (dice[k] > 1.2816) series[k] = nan_value;
  double scatter = 0.0;
  const double ratio = mean_ratio(ordinates_of(series), Term::white, 1, scatter);
  EXPECT_NEAR(ratio, 1.0, 4.0 * scatter + 0.02);
}

TEST(BlockMeans, LongGapsInWhiteNoiseAddNoSlowNoise) {
  constexpr std::size_t samples = 50'000, length = 200;
  Series series = test::white(1.0, rate_hz, samples, 21);
  for (std::size_t first = 1000; first + length < samples; first += 2500)
    std::fill_n(series.begin() + static_cast<std::ptrdiff_t>(first), length, nan_value);
  std::vector<CosineOrdinate> slow = ordinates_of(series);
  // Below one over the length of a gap.
  std::erase_if(slow, [](const CosineOrdinate& one) { return one.frequency_hz > 0.5; });
  double scatter = 0.0;
  const double ratio = mean_ratio(slow, Term::white, 1, scatter);
  EXPECT_NEAR(ratio, 1.0, 3.0 * scatter + 0.1);
}

}  // namespace
}  // namespace proofmass::characterise::low_band_test
