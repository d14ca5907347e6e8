#include "proofmass/thesis/budget_items.hpp"

#include <array>
#include <gtest/gtest.h>
#include <string>

namespace proofmass::thesis::budget_items_test {
namespace {

struct Cell {
  const char* key;
  double printed_m, exact_m;
};

// ½ b t² computed by hand, 1 mg = 9.80665e-3 m/s².
constexpr std::array<Cell, 16> cells{{
    {"navigation_1s", 0.13e-3, 0.1225831e-3},
    {"navigation_10s", 12e-3, 12.25831e-3},
    {"navigation_1min", 0.44, 0.4412993},
    {"navigation_1h", 1.6e3, 1588.677},
    {"tactical_1s", 1.5e-3, 1.470998e-3},
    {"tactical_10s", 150e-3, 147.0998e-3},
    {"tactical_1min", 5.3, 5.295591},
    {"tactical_1h", 19e3, 19064.13},
    {"industrial_1s", 15e-3, 14.70998e-3},
    {"industrial_10s", 1.5, 1.470998},
    {"industrial_1min", 53.0, 52.95591},
    {"industrial_1h", 190e3, 190641.3},
    {"automotive_1s", 620e-3, 612.9156e-3},
    {"automotive_10s", 60.0, 61.29156},
    {"automotive_1min", 2.2e3, 2206.496},
    {"automotive_1h", 7900e3, 7943387.0},
}};

TEST(BudgetItems, HaveAllSixteenCellsAsPrintedAndByHand) {
  const Item item = budget_items().front();
  EXPECT_EQ(item.id, "table 2.1");
  ASSERT_EQ(item.findings.size(), cells.size() + 1);
  for (std::size_t k = 0; k < cells.size(); ++k) {
    const Finding& finding = item.findings[k];
    EXPECT_EQ(finding.key, cells.at(k).key);
    EXPECT_DOUBLE_EQ(*finding.thesis, cells.at(k).printed_m) << finding.key;
    EXPECT_NEAR(finding.ours->value / cells.at(k).exact_m, 1.0, 1e-6) << finding.key;
    EXPECT_EQ(finding.ours->std, 0.0);
  }
}

TEST(BudgetItems, ShowEachCellInTheUnitThatTheThesisPrintsItIn) {
  const Item item = budget_items().front();
  EXPECT_EQ(item.findings[0].shown.symbol, "mm");
  EXPECT_EQ(item.findings[9].shown.symbol, "m");  // 1.5 m
  EXPECT_EQ(item.findings[14].shown.symbol, "km");
}

TEST(BudgetItems, SayHowFarThePrintedFiguresAreOff) {
  const report::Table table = budget_items().front().tables.front();
  EXPECT_EQ(table.rows[0][2], "0.123 mm (+6.1 %)");
  EXPECT_EQ(table.rows[3][5], "7940 km (−0.5 %)");
}

// (1 − cos ωt)/(½ ω²t²) with ω = √(9.80665/6.371e6) = 1.24067e-3 rad/s: ωt = 4.46642.
TEST(BudgetItems, LeaveAnEighthOfItAfterAnHourOnARoundEarth) {
  const Finding finding = budget_items().front().findings.back();
  EXPECT_EQ(finding.key, "schuler_1h");
  EXPECT_NEAR(finding.ours->value, 0.1247, 2e-4);
}

}  // namespace
}  // namespace proofmass::thesis::budget_items_test
