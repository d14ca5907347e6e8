#include "proofmass/report/calibrate/certificate.hpp"

#include <gtest/gtest.h>

namespace proofmass::report::certificate_test {
namespace {

using calibrate::BudgetLine;
using calibrate::combine;
using D = calibrate::Distribution;

constexpr const char* axes[] = {"x", "y", "z"};
constexpr const char* angles[] = {"yz", "zy", "zx"};

calibrate::UncertaintyBudget bias(std::size_t axis, double value) {
  return combine({std::string("bias ") + axes[axis], "V", value},
                 {{"noise of the means", true, D::student_t, 21e-6, "V", 1.0, 15.0},
                  {"drift", false, D::normal, 0.3e-3 * 9.80665, "m/s^2", 0.0306, 0.0},
                  {"temperature", false, D::uniform, 60e-6, "V", 1.0, 0.0}})
      .value();
}

calibrate::UncertaintyBudget scale(std::size_t axis, double value) {
  return combine({std::string("scale ") + axes[axis], "V/(m/s^2)", value},
                 {{"noise of the means", true, D::student_t, 3.1e-6, "V/(m/s^2)", 1.0, 15.0},
                  {"gravity", false, D::normal, 1e-4, "m/s^2", -value / 9.81, 0.0},
                  {"ADC reference", false, D::uniform, 2.9e-4, "1", value, 0.0}})
      .value();
}

CertificateData fake_certificate() {
  CertificateData data{.name = "ADXL335",
                       .serial = "A-17 <left>",
                       .date = "2024-05-17",
                       .files = {"bench/run-1.csv", "bench/run-2.csv"},
                       .method = "rests in 24 positions, nine parameters against gravity",
                       .equations = {"f = T diag(1/scale) (mean − bias), |f| = g",
                                     "T = [1 −α_yz α_zy; 0 1 −α_zx; 0 0 1]"},
                       .gravity_mps2 = Uncertain{9.81012, 1e-4},
                       .temperature_k = Uncertain{296.15, 0.5},
                       .supply_v = Uncertain{3.0002, 3e-4},
                       .positions = 24,
                       .budgets = {},
                       .not_determined = {},
                       .monte_carlo = "200 calibrations of simulated data confirm the budget.",
                       .limits = {"The cross-axis sensitivity of the case."}};
  for (std::size_t axis = 0; axis < 3; ++axis)
    data.budgets.push_back(bias(axis, 1.5 + 0.01 * static_cast<double>(axis)));
  for (std::size_t axis = 0; axis < 3; ++axis)
    data.budgets.push_back(scale(axis, 0.0306 - 0.0002 * static_cast<double>(axis)));
  for (const char* angle : angles)
    data.budgets.push_back(
        combine({std::string("misalignment ") + angle, "rad", 4.0123e-3},
                {{"noise of the means", true, D::student_t, 131e-6, "rad", 1.0, 15.0}})
            .value());
  return data;
}

std::string page_of(const CertificateData& data) {
  return html({.verb = "certificate",
               .title = data.serial,
               .inputs = data.files,
               .conclusion = {},
               .sections = certificate_sections(data)});
}

const Table& results_of(const std::vector<Section>& sections) {
  return sections.at(1).tables.at(0);
}

TEST(Certificate, RoundsTheValueToTheExpandedUncertainty) {
  const auto sections = certificate_sections(fake_certificate());
  using Row = std::vector<std::string>;
  EXPECT_EQ(results_of(sections).rows[0], (Row{"bias x", "1500.00", "0.22", "mV", "1.96", "∞"}));
}

TEST(Certificate, NamesEverySourceWithItsShare) {
  const auto sections = certificate_sections(fake_certificate());
  const Table& budget = sections.at(3).tables.at(3);
  EXPECT_EQ(budget.caption,
            "scale x: u_c = 0.0094 mV/(m/s²), ν eff = 1270, k = 1.96, U = 0.018 mV/(m/s²)");
  ASSERT_EQ(budget.rows.size(), 3U);
  EXPECT_EQ(budget.rows[0][1], "A");
  EXPECT_EQ(budget.rows[1][3], "0.00010 m/s²");
  EXPECT_EQ(budget.rows[1][5], "−3.12 mV/(m/s²) per m/s²");
  EXPECT_EQ(budget.rows[2][3], "0.029 %");
  EXPECT_EQ(budget.rows[2][5], "0.306 mV/(m/s²) per %");
  EXPECT_EQ(budget.rows[2][2], "uniform");
  double shares = 0.0;
  for (int k = 0; k < 3; ++k) shares += std::stod(budget.rows[static_cast<std::size_t>(k)][7]);
  EXPECT_NEAR(shares, 100.0, 0.2);
}

TEST(Certificate, SaysWhatIsNotStatedAndWhatItDoesNotCover) {
  CertificateData bare;
  bare.not_determined = {"misalignment: null: six parameters were requested"};
  const std::string page = page_of(bare);
  EXPECT_NE(page.find("not stated"), std::string::npos);
  EXPECT_NE(page.find("six parameters were requested"), std::string::npos);
  EXPECT_EQ(page.find("Uncertainty budgets"), std::string::npos);
  EXPECT_EQ(page.find("Monte Carlo"), std::string::npos);
  EXPECT_NE(page.find("The angle between the sensor"), std::string::npos);
  EXPECT_NE(page.find("Approved by"), std::string::npos);
  EXPECT_NE(page.find("Certificate number"), std::string::npos);
  EXPECT_NE(page.find("counter(pages)"), std::string::npos) << "page n of m, printed";
}

TEST(Certificate, ShowsMisalignmentsInMilliradians) {
  const auto sections = certificate_sections(fake_certificate());
  using Row = std::vector<std::string>;
  EXPECT_EQ(results_of(sections).rows[6],
            (Row{"misalignment yz", "4.01", "0.28", "mrad", "2.13", "15"}));
}

TEST(Certificate, OfCertainFiguresHasNoUncertainty) {
  CertificateData data = fake_certificate();
  data.budgets = {combine({"scale x", "1", 1.0}, {}).value()};
  const auto sections = certificate_sections(data);
  using Row = std::vector<std::string>;
  EXPECT_EQ(results_of(sections).rows[0], (Row{"scale x", "1.000000", "0", "", "1.96", "∞"}));
}

TEST(Certificate, IsOnePageThatPrintsOnPaper) {
  const std::string page = page_of(fake_certificate());
  EXPECT_NE(page.find("level of confidence of 95 percent"), std::string::npos);
  EXPECT_NE(page.find("@page{size:A4"), std::string::npos);
  EXPECT_NE(page.find("<section class=\"signed\">"), std::string::npos);
  EXPECT_TRUE(certificate_sections(fake_certificate()).front().new_sheet);
  EXPECT_NE(page.find("A-17 &lt;left&gt;"), std::string::npos);
  EXPECT_NE(page.find("23.0\u00a0±\u00a00.5 °C"), std::string::npos);
  EXPECT_EQ(page.find("nan"), std::string::npos);
  EXPECT_EQ(page.find("<script"), std::string::npos);
  EXPECT_EQ(page.find("http"), std::string::npos);
}

}  // namespace
}  // namespace proofmass::report::certificate_test
