#include "proofmass/fleet/figures.hpp"

#include <gtest/gtest.h>

namespace proofmass::fleet::figures_test {
namespace {

TEST(RowsOfDocument, AreOneAChannelWithEveryFigureUnderItsOwnName) {
  const auto found = rows_of_document(R"({
    "proofmass": "0.1.0", "verb": "noise", "input": ["a.csv"],
    "warnings": ["x: ramp is null: too short", "y: ramp is null: too short", "of all"],
    "channels": [
      {"name": "x", "unit": "m/s^2", "deviation": {"statistic": "oadev", "points": [{"tau_s": 1}]},
       "parameters": {"white": {"value": 1e-3, "std": 1e-4, "unit": "u", "interval_95": [8e-4, 12e-4],
                                "verdict": "identified"}, "ramp": null}},
      {"name": "y", "ok": true}],
    "provenance": {"version": "0.1.0", "commit": "c", "inputs": [{"path": "a.csv", "sha256": "00"}]}})");
  ASSERT_TRUE(found) << found.error().message;
  const Row expected{{"channel", "x"},
                     {"unit", "m/s^2"},
                     {"deviation_statistic", "oadev"},
                     {"white", 1e-3},
                     {"white_std", 1e-4},
                     {"white_unit", "u"},
                     {"white_interval_95_lower", 8e-4},
                     {"white_interval_95_upper", 12e-4},
                     {"white_verdict", "identified"},
                     {"reason", "x: ramp is null: too short; of all"}};
  ASSERT_EQ(found->rows.size(), 2U);
  EXPECT_EQ(found->rows[0], expected);
  EXPECT_EQ(found->rows[1].back().second,
            io::parquet::TableCell("y: ramp is null: too short; of all"));
  EXPECT_EQ(found->version, "0.1.0");
  ASSERT_EQ(found->inputs.size(), 1U);
  EXPECT_EQ(found->inputs[0].sha256, "00");
}

TEST(RowsOfDocument, AreOneWhereThereAreNoChannels) {
  const auto found = rows_of_document(
      R"({"proofmass": "0.1.0", "verb": "wheel", "turns": {"value": 5.5, "std": 0.1}, "bias": [1, 2],
          "methods": {"ekf": {"turns": {"value": 5, "std": 1}}}})");
  ASSERT_TRUE(found);
  const Row expected{{"turns", 5.5},  {"turns_std", 0.1},         {"bias_1", 1.0},
                     {"bias_2", 2.0}, {"methods_ekf_turns", 5.0}, {"methods_ekf_turns_std", 1.0},
                     {"reason", ""}};
  ASSERT_EQ(found->rows.size(), 1U);
  EXPECT_EQ(found->rows[0], expected);
}

TEST(RowsOfDocument, AreRefusedOfAnythingElse) {
  EXPECT_FALSE(rows_of_document("{"));
  EXPECT_FALSE(rows_of_document("[1]"));
  EXPECT_FALSE(rows_of_document("{\"a\": 1}"));
}

}  // namespace
}  // namespace proofmass::fleet::figures_test
