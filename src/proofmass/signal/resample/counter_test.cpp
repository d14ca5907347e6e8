#include "proofmass/signal/resample/counter.hpp"

#include <gtest/gtest.h>

namespace proofmass::signal::counter_test {
namespace {

Recording counting(std::vector<double> values) {
  Recording recording;
  recording.channels.push_back({"Packet Counter", {}, std::move(values)});
  return recording;
}

TEST(Counter, IsKnownByItsName) {
  for (const char* name : {"PacketCounter", "Packet number", "n_samples", "index", "Sample#"})
    EXPECT_TRUE(is_counter_name(name)) << name;
  for (const char* name : {"Acc_X", "time", "temperature", "packet loss rate"})
    EXPECT_FALSE(is_counter_name(name)) << name;
}

TEST(Counter, GoesUpInOnesNearlyAlways) {
  EXPECT_TRUE(find_counter(counting({0, 1, 2, 3, 4, 6, 7, 8, 9, 10, 11})).has_value());
  EXPECT_FALSE(find_counter(counting({3, 5, 6, 8, 9, 11, 12, 14})).has_value());
  EXPECT_FALSE(find_counter(counting({0, 1, 2, 3, 4, 5, 1, 2, 3, 4, 5, 6})).has_value());
}

TEST(Counter, MayRunOver) {
  std::vector<double> values;
  for (int k = 65'500; k < 65'700; ++k) values.push_back(k % 65'536);
  EXPECT_TRUE(find_counter(counting(values)).has_value());
  EXPECT_EQ(count_lost_rows(values), 0u);
}

TEST(Counter, MissesTheRowsItSkips) {
  EXPECT_EQ(count_lost_rows(std::vector<double>{5, 6, 9, 10, 11, 13}), 3u);
  EXPECT_EQ(count_lost_rows(std::vector<double>{}), 0u);
}

}  // namespace
}  // namespace proofmass::signal::counter_test
