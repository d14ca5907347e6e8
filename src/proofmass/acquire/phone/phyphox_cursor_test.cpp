#include "proofmass/acquire/phone/phyphox_cursor.hpp"

#include <gtest/gtest.h>
#include <vector>

namespace proofmass::acquire::phyphox_cursor_test {
namespace {

using Columns = std::vector<std::vector<double>>;
using Range = PhyphoxCursor::Range;

/// Times with a constant column.
Columns times(std::vector<double> times_s) {
  const std::size_t rows = times_s.size();
  return {std::move(times_s), std::vector<double>(rows, 9.81)};
}

TEST(PhyphoxCursor, AsksForEverythingFirst) {
  PhyphoxCursor cursor;
  EXPECT_EQ(cursor.threshold(), "full");
  EXPECT_EQ(cursor.take(times({})), (Range{0, 0}));
  EXPECT_EQ(cursor.take(times({0.0, 0.1})), (Range{0, 2}));
}

TEST(PhyphoxCursor, AsksForALittleAgainAndPassesItOver) {
  PhyphoxCursor cursor;
  (void)cursor.take(times({99.96, 99.98, 100.0}));
  EXPECT_EQ(cursor.threshold(), "99.949998");  // 50 ms less, and two units of the eighth place
  EXPECT_EQ(cursor.take(times({99.96, 99.98, 100.0, 100.02})), (Range{3, 4}));
  EXPECT_EQ(cursor.take(times({99.98, 100.0, 100.02})), (Range{3, 3}));
}

TEST(PhyphoxCursor, TellsRowsApartThatAreWrittenWithOneTime) {
  PhyphoxCursor cursor;
  (void)cursor.take(times({20000.001, 20000.002, 20000.002}));
  EXPECT_EQ(cursor.take(times({20000.001, 20000.002, 20000.002, 20000.002, 20000.003})),
            (Range{3, 5}));
}

TEST(PhyphoxCursor, AsksFurtherBackWhereTheClockSteppedBack) {
  PhyphoxCursor cursor;
  (void)cursor.take(times({1.00, 1.01, 1.02, 1.03}));
  EXPECT_EQ(cursor.take(times({0.99, 1.00, 1.01, 1.02, 1.03, 1.04, 0.99, 1.00})), (Range{5, 6}))
      << "rows from before 0.98 may be missing";
  EXPECT_EQ(cursor.threshold(), "-9.0100002");
  EXPECT_EQ(cursor.take(times({0.99, 1.00, 1.01, 1.02, 1.03, 1.04, 0.97, 0.98, 0.99, 1.00})),
            (Range{6, 10}));
  EXPECT_EQ(cursor.threshold(), "0.94999998");
}

TEST(PhyphoxCursor, KnowsWhichTimeAClockRanOverTheSameStretch) {
  PhyphoxCursor cursor;
  (void)cursor.take(Columns{{1.0, 1.01, 1.02, 1.0, 1.01}, {1, 2, 3, 4, 5}});
  EXPECT_EQ(cursor.take(Columns{{1.0, 1.01, 1.02, 1.0, 1.01, 1.02}, {1, 2, 3, 4, 5, 6}}),
            (Range{5, 6}));
}

TEST(PhyphoxCursor, FindsTheRowsBehindAClockThatWasSetBack) {
  PhyphoxCursor cursor;
  (void)cursor.take(times({10.0, 10.1, 10.2}));
  cursor.see_end(5.1);
  EXPECT_EQ(cursor.threshold(), "-4.9000002");
  EXPECT_EQ(cursor.take(times({9.9, 10.0, 10.1, 10.2})), (Range{4, 4}))
      << "its new rows are not whole yet";
  EXPECT_EQ(cursor.take(times({9.9, 10.0, 10.1, 10.2, 5.0, 5.1})), (Range{4, 6}));
  EXPECT_EQ(cursor.take(times({5.1, 5.2})), (Range{1, 2}));
}

TEST(PhyphoxCursor, TakesAllOfABufferThatWasEmptied) {
  PhyphoxCursor cursor;
  (void)cursor.take(times({10.0, 10.1, 10.2}));
  cursor.see_end(0.1);
  EXPECT_EQ(cursor.take(times({0.0, 0.1})), (Range{0, 2}));
}

TEST(PhyphoxCursor, GoesOnWhereASmallBufferHasLostRows) {
  PhyphoxCursor cursor;
  (void)cursor.take(times({10.0, 10.1, 10.2}));
  EXPECT_EQ(cursor.take(times({15.0, 15.1})), (Range{0, 2}));
}

TEST(PhyphoxCursor, LeavesWhatWasMeasuredBeforeAlone) {
  PhyphoxCursor cursor;
  cursor.start_behind(7.0);
  EXPECT_EQ(cursor.take(times({6.96, 6.98, 7.0, 7.02})), (Range{3, 4}));
}

}  // namespace
}  // namespace proofmass::acquire::phyphox_cursor_test
