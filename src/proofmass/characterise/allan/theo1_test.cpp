#include "proofmass/characterise/allan/theo1.hpp"

#include <cmath>
#include <gtest/gtest.h>

#include "proofmass/characterise/allan/phase_record.hpp"
#include "proofmass/characterise/test_support.hpp"

namespace proofmass::characterise::theo1_test {
namespace {

using test::phase_of_white_rates;

TEST(Theo1, AgreesWithPublishedValuesOnAThousandPoints) {
  const auto x = test::nbs14_phase();
  EXPECT_NEAR(std::sqrt(theo1(x, 1.0, 10).variance), 1.0757e-1, 5e-6);
  EXPECT_NEAR(std::sqrt(theo1(x, 1.0, 100).variance), 3.1789e-2, 5e-7);
  EXPECT_NEAR(std::sqrt(theo1(x, 1.0, 1000).variance), 5.0524e-3, 5e-8);
}

/// As published: i starts at 0 here, δ runs from 0 to m/2 − 1.
double by_definition(const std::vector<double>& x, double tau0_s, std::size_t m) {
  double sum = 0.0;
  for (std::size_t i = 0; i < x.size() - m; ++i)
    for (std::size_t delta = 0; delta < m / 2; ++delta)
      sum += std::pow((x[i] - x[i - delta + m / 2]) + (x[i + m] - x[i + delta + m / 2]), 2) /
             static_cast<double>(m / 2 - delta);  // NOLINT(bugprone-integer-division): m is even
  const double span_s = static_cast<double>(m) * tau0_s;
  return sum / (0.75 * static_cast<double>(x.size() - m) * span_s * span_s);
}

class Theo1WithAMeanRateOf : public testing::TestWithParam<double> {};

TEST_P(Theo1WithAMeanRateOf, AgreesWithItsDefinition) {
  const auto level = phase_of_white_rates(200, 0.0, 7);
  const auto x = phase_of_white_rates(200, GetParam(), 7);
  for (const std::size_t m : {2u, 4u, 10u, 32u, 34u, 66u, 150u, 198u}) {
    const double expected = by_definition(level, 0.02, m);
    const auto found = theo1(x, 0.02, m);
    EXPECT_NEAR(found.variance, expected, (1e-12 + 1e-13 * GetParam()) * expected) << m;
    EXPECT_EQ(found.terms, (200 - m) * m / 2);
  }
}

INSTANTIATE_TEST_SUITE_P(Some, Theo1WithAMeanRateOf, testing::Values(0.0, 3.0, 1e6));

TEST(Theo1, OfTwoIntervalsIsTwoThirdsOfTheAllanVariance) {
  const auto x = phase_of_white_rates(100, 0.0, 2);
  double sum = 0.0;
  for (std::size_t i = 0; i + 2 < x.size(); ++i) sum += std::pow(x[i] - 2 * x[i + 1] + x[i + 2], 2);
  EXPECT_NEAR(theo1(x, 1.0, 2).variance, 2.0 / 3.0 * sum / (2.0 * 98.0), 1e-14 * sum);
}

TEST(Theo1, LosesLittleByAStride) {
  const auto x = phase_of_white_rates(30'001, 0.0, 3);
  constexpr std::size_t m = 5000, stride = 4;
  ASSERT_EQ(affordable_stride(x.size() - stride, m), stride);
  double full = 0.0;
  for (std::size_t shift = 0; shift < stride; ++shift)
    full += theo1(View<double>(x).subspan(shift), 1.0, m).variance / stride;
  const auto strided = theo1(x, 1.0, m);
  EXPECT_NEAR(strided.variance, full, 1e-3 * full);
  EXPECT_EQ(strided.terms, (25'001 + stride - 1) / stride * (m / 2));
}

struct Table {
  const char* file;
  double bias;  ///< factor applied to sigma²
};

class Theo1Table : public testing::TestWithParam<Table> {};

TEST_P(Theo1Table, IsMetInEveryRow) {
  if (test::stable32_folder().empty())
    GTEST_SKIP() << "NO TABLES OF STABLE32: set PROOFMASS_DATA to the folder of public data";
  const auto x = test::stable32_phase();
  const auto rows = test::read_stable32_table(test::stable32_folder() / GetParam().file);
  EXPECT_GE(rows.size(), 7u);
  for (const auto& row : rows) {
    const auto found = theo1(x, 1.0, row.m);
    const double sigma = std::sqrt(found.variance * GetParam().bias);
    EXPECT_NEAR(sigma, row.deviation, test::printed(row.deviation)) << row.m;
    EXPECT_NEAR(static_cast<double>(found.terms), row.terms, 0.501 * (row.terms > 1e5 ? 10 : 1));
  }
}

INSTANTIATE_TEST_SUITE_P(All,
                         Theo1Table,
                         testing::Values(Table{"phase_dat_theo1.txt", 0.6027867},
                                         Table{"phase_dat_theo1_alpha0.txt", 1.0},
                                         Table{"phase_dat_theo1_alpha0_decade.txt", 1.0}),
                         [](const auto& tested) {
                           const std::string file = tested.param.file;
                           return file.substr(0, file.find('.'));
                         });

}  // namespace
}  // namespace proofmass::characterise::theo1_test
