#include "proofmass/characterise/allan/total_variance.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <numbers>
#include <numeric>

#include "proofmass/characterise/allan/phase_record.hpp"
#include "proofmass/characterise/test_support.hpp"

namespace proofmass::characterise::total_variance_test {
namespace {

using test::nbs14_phase;
using test::phase_of_white_rates;
using test::ten_point_phase;

using Variance = PhaseVariance (*)(View<double>, double, std::size_t);

double deviation(Variance variance, View<double> phase, std::size_t m) {
  return std::sqrt(variance(phase, 1.0, m).variance);
}

// In tables that give the Hadamard total deviation divided by the root of its bias for white
// frequency noise.
const double htot_bias = std::sqrt(0.995);

TEST(TotalVariance, AgreesWithNistOnTenPoints) {
  EXPECT_NEAR(deviation(total_variance, ten_point_phase, 1), 91.22945, 5e-6);
  EXPECT_NEAR(deviation(total_variance, ten_point_phase, 2), 93.90379, 5e-6);
}

TEST(TotalVariance, AgreesWithNistOnAThousandPoints) {
  const auto x = nbs14_phase();
  EXPECT_NEAR(deviation(total_variance, x, 1), 2.922319e-1, 5e-8);
  EXPECT_NEAR(deviation(total_variance, x, 10), 9.134743e-2, 5e-9);
  EXPECT_NEAR(deviation(total_variance, x, 100), 3.406530e-2, 5e-9);
  EXPECT_NEAR(deviation(total_variance, x, 256), 1.3369439e-2, 5e-10);
}

TEST(ModifiedTotalVariance, AgreesWithNistOnTenPoints) {
  EXPECT_NEAR(deviation(modified_total_variance, ten_point_phase, 1), 64.509, 5e-4);
  EXPECT_NEAR(deviation(modified_total_variance, ten_point_phase, 2), 64.794, 5e-4);
  EXPECT_NEAR(deviation(modified_total_variance, ten_point_phase, 1) / std::numbers::sqrt3, 37.244,
              5e-4);
  EXPECT_NEAR(deviation(modified_total_variance, ten_point_phase, 2) * 2.0 / std::numbers::sqrt3,
              74.818, 5e-4);
}

TEST(ModifiedTotalVariance, AgreesWithNistOnAThousandPoints) {
  const auto x = nbs14_phase();
  EXPECT_NEAR(deviation(modified_total_variance, x, 1), 2.0664e-1, 5e-6);
  EXPECT_NEAR(deviation(modified_total_variance, x, 10), 5.5529e-2, 5e-7);
  EXPECT_NEAR(deviation(modified_total_variance, x, 100), 1.9547e-2, 5e-7);
  // Published divided by the root of the bias for white frequency noise.
  EXPECT_NEAR(deviation(modified_total_variance, x, 10) / std::sqrt(0.73), 6.499161e-2, 5e-9);
  EXPECT_NEAR(deviation(modified_total_variance, x, 100) / std::sqrt(0.73), 2.287774e-2, 5e-9);
}

TEST(HadamardTotalVariance, AgreesWithNistOnTenPoints) {
  EXPECT_NEAR(deviation(hadamard_total_variance, ten_point_phase, 1), 70.80607, 5e-6);
  EXPECT_NEAR(deviation(hadamard_total_variance, ten_point_phase, 2) / htot_bias, 91.16396, 5e-6);
}

TEST(HadamardTotalVariance, AgreesWithNistOnAThousandPoints) {
  const auto x = nbs14_phase();
  EXPECT_NEAR(deviation(hadamard_total_variance, x, 1), 2.943883e-1, 5e-8);
  // The seventh digit falls on a tie: 9.61478750.
  EXPECT_NEAR(deviation(hadamard_total_variance, x, 10) / htot_bias, 9.614787e-2, 5.1e-9);
  EXPECT_NEAR(deviation(hadamard_total_variance, x, 100) / htot_bias, 3.058103e-2, 5e-9);
}

// Literal implementations of the definitions.

double total_by_definition(const std::vector<double>& x, double tau0_s, std::size_t m) {
  const std::size_t N = x.size();
  std::vector<double> extended;  // x*[2 − N] … x*[2N − 3]
  for (std::size_t j = N - 2; j >= 1; --j) extended.push_back(2.0 * x[0] - x[j]);
  extended.insert(extended.end(), x.begin(), x.end());
  for (std::size_t j = 1; j <= N - 2; ++j) extended.push_back(2.0 * x[N - 1] - x[N - 1 - j]);
  double sum = 0.0;
  for (std::size_t i = N - 1; i <= 2 * N - 4; ++i)
    sum += std::pow(extended[i - m] - 2.0 * extended[i] + extended[i + m], 2);
  return sum / (2.0 * std::pow(static_cast<double>(m) * tau0_s, 2) * static_cast<double>(N - 2));
}

double mean_of(const std::vector<double>& v, std::size_t first, std::size_t count) {
  double sum = 0.0;
  for (std::size_t i = first; i < first + count; ++i) sum += v[i];
  return sum / static_cast<double>(count);
}

std::vector<double> mirrored(std::vector<double> stretch) {
  const std::size_t n = stretch.size();
  const double slope =
      (mean_of(stretch, n - n / 2, n / 2) - mean_of(stretch, 0, n / 2)) /
      static_cast<double>(n - n / 2);  // NOLINT(bugprone-integer-division): the longer half
  for (std::size_t i = 0; i < n; ++i) stretch[i] -= slope * static_cast<double>(i);
  std::vector<double> extended(stretch.rbegin(), stretch.rend());
  extended.insert(extended.end(), stretch.begin(), stretch.end());
  extended.insert(extended.end(), stretch.rbegin(), stretch.rend());
  return extended;
}

double mean_square_by_definition(const std::vector<double>& v, std::size_t m) {
  const std::size_t stretches = v.size() - 3 * m + 1;
  double sum = 0.0;
  for (std::size_t n = 0; n < stretches; ++n) {
    const auto at = v.begin() + static_cast<std::ptrdiff_t>(n);
    const auto w = mirrored({at, at + static_cast<std::ptrdiff_t>(3 * m)});
    for (std::size_t i = 0; i < 6 * m; ++i)
      sum += std::pow(mean_of(w, i, m) - 2.0 * mean_of(w, i + m, m) + mean_of(w, i + 2 * m, m), 2);
  }
  return sum / static_cast<double>(6 * m * stretches);
}

constexpr double tau0_s = 0.02;

class TotalVariances : public testing::TestWithParam<double> {};  // by mean rate

TEST_P(TotalVariances, AgreeWithTheirDefinitions) {
  const double slope = GetParam();
  const auto level = phase_of_white_rates(150, 0.0, 11);
  const auto x = phase_of_white_rates(150, slope, 11);
  std::vector<double> rates(level.size() - 1);
  for (std::size_t i = 0; i < rates.size(); ++i) rates[i] = (level[i + 1] - level[i]) / tau0_s;
  const double tolerance = 1e-12 + 1e-13 * std::abs(slope);
  for (const std::size_t m : {1u, 2u, 3u, 4u, 7u, 10u, 49u, 50u, 90u, 149u}) {
    const double total = total_by_definition(level, tau0_s, m);
    EXPECT_NEAR(total_variance(x, tau0_s, m).variance, total, tolerance * total) << m;
    if (m > 50) continue;
    const double tau_s = static_cast<double>(m) * tau0_s;
    const double modified = mean_square_by_definition(level, m) / (2.0 * tau_s * tau_s);
    EXPECT_NEAR(modified_total_variance(x, tau0_s, m).variance, modified, tolerance * modified)
        << m;
    if (m == 1 || m > 49) continue;
    const double hadamard = mean_square_by_definition(rates, m) / 6.0;
    EXPECT_NEAR(hadamard_total_variance(x, tau0_s, m).variance, hadamard, tolerance * hadamard)
        << m;
  }
}

INSTANTIATE_TEST_SUITE_P(WithAMeanRateOf, TotalVariances, testing::Values(0.0, -3.0, 1e6));

TEST(TotalVariances, OfASteadyRateAreZero) {
  std::vector<double> x(100);
  for (std::size_t i = 0; i < x.size(); ++i) x[i] = 1e3 - 0.25 * static_cast<double>(i);
  for (const std::size_t m : {1u, 8u, 33u}) {
    EXPECT_EQ(total_variance(x, tau0_s, m).variance, 0.0);
    EXPECT_EQ(modified_total_variance(x, tau0_s, m).variance, 0.0);
    EXPECT_EQ(hadamard_total_variance(x, tau0_s, m).variance, 0.0);
  }
}

TEST(HadamardTotalVariance, IsBlindToADrift) {
  auto x = phase_of_white_rates(400, 0.0, 5);
  const auto without = x;
  for (std::size_t i = 0; i < x.size(); ++i) x[i] += 0.01 * std::pow(static_cast<double>(i), 2);
  for (const std::size_t m : {1u, 2u, 5u, 40u, 133u}) {
    const double expected = hadamard_total_variance(without, tau0_s, m).variance;
    EXPECT_NEAR(hadamard_total_variance(x, tau0_s, m).variance, expected, 1e-9 * expected) << m;
  }
}

TEST(TotalVariances, CountTheirTermsAsStable32Does) {
  const auto x = phase_of_white_rates(1001, 0.0, 1);
  EXPECT_EQ(total_variance(x, 1.0, 256).terms, 999u);
  EXPECT_EQ(modified_total_variance(x, 1.0, 256).terms, 234u);
  EXPECT_EQ(hadamard_total_variance(x, 1.0, 256).terms, 233u);
  EXPECT_EQ(hadamard_total_variance(x, 1.0, 1).terms, 998u);
}

TEST(TotalVariances, TakeTheShortestRecordsThereAre) {
  const std::vector<double> x{0.0, 1.0, 0.0, 2.0};
  const View<double> three(x.data(), 3);
  EXPECT_DOUBLE_EQ(total_variance(three, 1.0, 2).variance, 2.0);  // (−1 − 2 − 1)² / (2 · 4)
  EXPECT_EQ(modified_total_variance(three, 1.0, 1).terms, 1u);
  EXPECT_EQ(hadamard_total_variance(x, 1.0, 1).terms, 1u);
}

/// With as many shifts as there are samples in a stride, every interval occurs once.
double at_full_overlap(Variance variance, View<double> x, std::size_t m, std::size_t stride) {
  double sum = 0.0;
  std::size_t terms = 0;
  for (std::size_t shift = 0; shift < stride; ++shift) {
    const auto part = variance(x.subspan(shift), 1.0, m);
    sum += part.variance * static_cast<double>(part.terms);
    terms += part.terms;
  }
  return sum / static_cast<double>(terms);
}

TEST(TotalVariances, LoseLittleByAStride) {
  const auto x = phase_of_white_rates(30'001, 0.0, 3);
  constexpr std::size_t m = 5000, stride = 4;
  ASSERT_EQ(affordable_stride(x.size() - stride, m), stride);
  for (const Variance variance : {modified_total_variance, hadamard_total_variance}) {
    const auto strided = variance(x, 1.0, m);
    EXPECT_NEAR(static_cast<double>(strided.terms), (30'001.0 - 3.0 * m) / stride, 1.0);
    const double full = at_full_overlap(variance, x, m, stride);
    EXPECT_NEAR(strided.variance, full, 1e-3 * full);
  }
}

TEST(TotalVariances, AtAStrideAreTheMeanOfTheStretchesThatBeginThere) {
  const auto x = phase_of_white_rates(30'001, 0.0, 3);
  constexpr std::size_t m = 5000, stride = 4;
  for (const Variance variance : {modified_total_variance, hadamard_total_variance}) {
    const std::size_t length = variance == modified_total_variance ? 3 * m : 3 * m + 1;
    double sum = 0.0;
    std::size_t terms = 0;
    for (std::size_t begin = 0; begin + length <= x.size(); begin += stride, ++terms)
      sum += variance(View<double>(x).subspan(begin, length), 1.0, m).variance;
    const auto found = variance(x, 1.0, m);
    EXPECT_EQ(found.terms, terms);
    EXPECT_NEAR(found.variance, sum / static_cast<double>(terms), 1e-12 * found.variance);
  }
}

TEST(AffordableStride, HoldsTheCostAndTheOverlap) {
  EXPECT_EQ(affordable_stride(1'000'000, 40), 1u);
  EXPECT_EQ(affordable_stride(1'000'000, 41), 2u);
  for (const std::size_t N : {1000u, 1'000'000u, 100'000'000u}) {
    for (std::size_t m = 1; m < N; m = 3 * m + 1) {
      const std::size_t stride = affordable_stride(N, m);
      EXPECT_GE(static_cast<double>(m) / static_cast<double>(stride),
                std::min<double>(16.0, static_cast<double>(m)));
      EXPECT_LE(static_cast<double>(N) * static_cast<double>(m) / static_cast<double>(stride),
                std::max(4e7, 32.0 * static_cast<double>(N)));
    }
  }
}

// Stable32's tables for the phase record distributed with it.

struct Table {
  const char* file;
  Variance variance;
  bool of_rates_in_nist_1000;
  bool time;                         ///< multiplied by τ / √3
  double (*bias)(int, std::size_t);  ///< factor applied to sigma², by alpha and m
};

double none(int /*alpha*/, std::size_t /*m*/) {
  return 1.0;
}
double of_modified(int alpha, std::size_t /*m*/) {
  return alpha == 0 ? 0.73 : 0.83;
}
double of_hadamard(int alpha, std::size_t m) {
  return alpha == 0 && m > 1 ? 0.995 : 1.0;
}

class TotalVarianceTable : public testing::TestWithParam<Table> {};

TEST_P(TotalVarianceTable, IsMetInEveryRow) {
  if (test::stable32_folder().empty())
    GTEST_SKIP() << "NO TABLES OF STABLE32: set PROOFMASS_DATA to the folder of public data";
  const Table& table = GetParam();
  const auto x = table.of_rates_in_nist_1000 ? nbs14_phase() : test::stable32_phase();
  const auto rows = test::read_stable32_table(test::stable32_folder() / table.file);
  EXPECT_GE(rows.size(), 8u);
  for (const auto& row : rows) {
    const auto found = table.variance(x, 1.0, row.m);
    const double scale = table.time ? static_cast<double>(row.m) / std::numbers::sqrt3 : 1.0;
    const double sigma = scale * std::sqrt(found.variance / table.bias(row.alpha, row.m));
    EXPECT_NEAR(sigma, row.deviation, test::printed(row.deviation)) << row.m;
    EXPECT_EQ(static_cast<double>(found.terms), row.terms) << row.m;
  }
}

INSTANTIATE_TEST_SUITE_P(
    All,
    TotalVarianceTable,
    testing::Values(
        Table{"phase_dat_totdev.txt", total_variance, false, false, none},
        Table{"phase_dat_totdev_octave.txt", total_variance, false, false, none},
        Table{"phase_dat_mtotdev.txt", modified_total_variance, false, false, of_modified},
        Table{"phase_dat_mtotdev_decade.txt", modified_total_variance, false, false, none},
        Table{"phase_dat_mtotdev_octave.txt", modified_total_variance, false, false, none},
        Table{"phase_dat_mtotdev_octave_alpha0.txt", modified_total_variance, false, false, none},
        Table{"phase_dat_ttotdev_all.txt", modified_total_variance, false, true, of_modified},
        Table{"phase_dat_ttotdev_decade.txt", modified_total_variance, false, true, none},
        Table{"phase_dat_ttotdev_octave.txt", modified_total_variance, false, true, none},
        Table{"phase_dat_htotdev_octave.txt", hadamard_total_variance, false, false, of_hadamard},
        Table{"phase_dat_htotdev_octave_nobias.txt", hadamard_total_variance, true, false, none}),
    [](const auto& tested) {
      const std::string file = tested.param.file;
      return file.substr(0, file.find('.'));
    });

}  // namespace
}  // namespace proofmass::characterise::total_variance_test
