#include "proofmass/acquire/recorder/overrun_queue.hpp"

#include <gtest/gtest.h>
#include <thread>

namespace proofmass::acquire::overrun_queue_test {
namespace {

using namespace std::chrono_literals;

Arrival rows(OverrunQueue& queue, std::size_t count, double first) {
  Arrival arrival = queue.spare();
  for (std::size_t k = 0; k < count; ++k)
    arrival.channels[0].push_back(first + static_cast<double>(k));
  return arrival;
}

TEST(OverrunQueue, GivesWhatWasPutInItsOrder) {
  OverrunQueue queue(1, 100);
  queue.put(rows(queue, 2, 10.0));
  queue.put(rows(queue, 1, 20.0));
  Arrival arrival;
  EXPECT_EQ(queue.take(arrival, 0ms).value(), Arrived::rows);
  EXPECT_EQ(arrival.channels[0], (std::vector<double>{10.0, 11.0}));
  EXPECT_EQ(queue.take(arrival, 0ms).value(), Arrived::rows);
  EXPECT_EQ(arrival.channels[0], (std::vector<double>{20.0}));
  EXPECT_EQ(queue.take(arrival, 0ms).value(), Arrived::nothing);
}

TEST(OverrunQueue, CountsTheRowsThatFoundNoRoomInFrontOfTheNextThatDo) {
  OverrunQueue queue(1, 4);
  queue.put(rows(queue, 3, 0.0));
  queue.put(rows(queue, 2, 3.0));  // no room for both, so neither is kept
  Arrival known = rows(queue, 2, 5.0);
  known.lost_before = 7;
  queue.put(std::move(known));
  Arrival arrival;
  EXPECT_EQ(queue.take(arrival, 0ms).value(), Arrived::rows);
  EXPECT_EQ(arrival.lost_before, 0U);
  queue.put(rows(queue, 4, 7.0));
  EXPECT_EQ(queue.take(arrival, 0ms).value(), Arrived::rows);
  EXPECT_EQ(arrival.lost_before, 2U + 2U + 7U);
  EXPECT_EQ(arrival.channels[0].front(), 7.0);
}

TEST(OverrunQueue, TellsOfRowsLostWithNoneBehindThem) {
  OverrunQueue queue(1, 1);
  queue.put(rows(queue, 1, 0.0));
  queue.put(rows(queue, 1, 1.0));
  queue.end();
  Arrival arrival;
  EXPECT_EQ(queue.take(arrival, 0ms).value(), Arrived::rows);
  EXPECT_EQ(queue.take(arrival, 0ms).value(), Arrived::nothing);
  ASSERT_EQ(arrival.notes.size(), 1U);
  EXPECT_EQ(arrival.notes[0].text, "the last 1 rows were lost: they were not read in time");
  EXPECT_EQ(queue.take(arrival, 0ms).value(), Arrived::ended);
}

TEST(OverrunQueue, GivesWhatIsThereBeforeItSaysWhyItEnded) {
  OverrunQueue queue(1, 10);
  queue.put(rows(queue, 1, 0.0));
  queue.end(Error{Errc::device, "gone"});
  Arrival arrival;
  EXPECT_EQ(queue.take(arrival, 0ms).value(), Arrived::rows);
  const auto ended = queue.take(arrival, 0ms);
  ASSERT_FALSE(ended);
  EXPECT_EQ(ended.error().message, "gone");
}

TEST(OverrunQueue, WakesWhoWaits) {
  OverrunQueue queue(1, 10);
  std::thread late([&] { queue.put(rows(queue, 1, 5.0)); });
  Arrival arrival;
  EXPECT_EQ(queue.take(arrival, 600s).value(), Arrived::rows);
  late.join();
}

TEST(OverrunQueue, HandsItsMemoryBack) {
  OverrunQueue queue(1, 10);
  queue.put(rows(queue, 10, 0.0));
  Arrival arrival;
  ASSERT_EQ(queue.take(arrival, 0ms).value(), Arrived::rows);
  const double* const memory = arrival.channels[0].data();
  queue.put(rows(queue, 10, 0.0));
  ASSERT_EQ(queue.take(arrival, 0ms).value(), Arrived::rows);
  const Arrival spare = queue.spare();
  EXPECT_EQ(spare.rows(), 0U);
  EXPECT_EQ(spare.channels[0].data(), memory);
}

}  // namespace
}  // namespace proofmass::acquire::overrun_queue_test
