#include "proofmass/io/table_file.hpp"

#include <gtest/gtest.h>

namespace proofmass::io::table_file_test {
namespace {

using Indices = std::vector<std::size_t>;

TableSummary table(const std::string& name,
                   std::vector<std::string> headings,
                   std::optional<std::uint64_t> rows = std::nullopt) {
  return {name, std::move(headings), rows, std::nullopt};
}

struct Choice {
  Result<Indices> tables;
  std::vector<Note> notes;
};

Choice choose(const std::vector<TableSummary>& tables,
              const std::vector<std::string>& variables = {}) {
  ReadOptions options;
  options.variables = variables;
  std::vector<Note> notes;
  auto chosen = choose_table(tables, options, notes);
  return {std::move(chosen), std::move(notes)};
}

TEST(ChooseTable, PrefersAccelerations) {
  const auto choice = choose({table("Gyroscope", {"Time (s)", "Gyroscope x (rad/s)"}, 9000),
                              table("Accelerometer", {"Time (s)", "Acceleration x (m/s^2)"}, 100)});
  EXPECT_EQ(*choice.tables, Indices{1});
  ASSERT_EQ(choice.notes.size(), 1u);
  EXPECT_EQ(choice.notes[0].text,
            "Accelerometer is read, having accelerations; also holds Gyroscope (2 columns, 9000 "
            "rows)");
  ASSERT_EQ(choice.notes[0].advice.size(), 1u);
  EXPECT_EQ(choice.notes[0].advice[0].option, "variable");
  EXPECT_EQ(choice.notes[0].advice[0].value, "Gyroscope");
}

TEST(ChooseTable, TakesTheOneWithMostRowsOfSeveral) {
  const auto choice =
      choose({table("a", {"acc_x"}, 10), table("b", {"acc_x"}, 30), table("c", {"acc_x"}, 20)});
  EXPECT_EQ(*choice.tables, Indices{1});
}

TEST(ChooseTable, TakesGravityAlongWhereItCan) {
  const auto choice = choose({table("Linear", {"Linear Acceleration x (m/s^2)"}, 500),
                              table("Gravity", {"Gravity x (m/s^2)"}, 500),
                              table("Accelerometer", {"Acceleration x (m/s^2)"}, 400)});
  EXPECT_EQ(*choice.tables, Indices{2});
}

TEST(ChooseTable, TakesUnitsForMoreThanNames) {
  const auto choice = choose(
      {table("gyro", {"x (rad/s)", "y (rad/s)"}, 500), table("thing", {"u (g)", "v (g)"}, 400)});
  EXPECT_EQ(*choice.tables, Indices{1});
}

TEST(ChooseTable, FindsNamesExactlyThenByCaseThenByTheirEnd) {
  const std::vector<TableSummary> tables{table("a/IMU", {"x"}), table("IMU", {"x"}),
                                         table("imu", {"x"}), table("b/GNSS", {"x"})};
  EXPECT_EQ(choose(tables, {"IMU"}).tables.value(), Indices{1});
  EXPECT_EQ(choose(tables, {"Imu"}).tables.value(), (Indices{1, 2}));
  EXPECT_EQ(choose(tables, {"gnss"}).tables.value(), Indices{3});
  EXPECT_EQ(choose(tables, {"b/GNSS", "a/IMU"}).tables.value(), (Indices{3, 0}));
}

TEST(ChooseTable, SaysWhatThereIsInsteadOfANameThatIsNot) {
  const auto choice = choose({table("a", {"x"}), table("b", {"x"})}, {"c"});
  ASSERT_FALSE(choice.tables.has_value());
  EXPECT_EQ(choice.tables.error().code, Errc::invalid_argument);
  EXPECT_EQ(choice.tables.error().message, "has no table c; it has a, b");
}

TEST(ChooseTable, RefusesAFileWithoutATable) {
  const auto choice = choose({});
  ASSERT_FALSE(choice.tables.has_value());
  EXPECT_EQ(choice.tables.error().code, Errc::too_few_samples);
}

}  // namespace
}  // namespace proofmass::io::table_file_test
