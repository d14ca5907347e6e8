#include "proofmass/core/state_bytes.hpp"

#include <cmath>
#include <gtest/gtest.h>

namespace proofmass::state_bytes_test {
namespace {

struct Thing {
  double number = 0.0;
  std::size_t count = 0;
  bool flag = false;
  std::string text;
  std::vector<std::uint16_t> list;
  std::optional<double> there, absent;

  void exchange(StateBytes& bytes) {
    bytes(number);
    bytes(count);
    bytes(flag);
    bytes(text);
    bytes(list);
    bytes(there);
    bytes(absent);
  }
};

std::string bytes_of_a_thing() {
  Thing thing{1.0 / 3.0, 77, true, "acc_z", {1, 65535}, std::nan(""), {}};
  StateBytes bytes;
  thing.exchange(bytes);
  return std::move(bytes).bytes();
}

TEST(StateBytes, ReadsWhatItWrote) {
  const std::string written = bytes_of_a_thing();
  StateBytes bytes(written);
  Thing thing;
  thing.absent = 2.0;
  thing.exchange(bytes);
  EXPECT_TRUE(bytes.complete());
  EXPECT_EQ(thing.number, 1.0 / 3.0);
  EXPECT_EQ(thing.count, 77U);
  EXPECT_TRUE(thing.flag);
  EXPECT_EQ(thing.text, "acc_z");
  EXPECT_EQ(thing.list, (std::vector<std::uint16_t>{1, 65535}));
  ASSERT_TRUE(thing.there);
  EXPECT_TRUE(std::isnan(*thing.there));
  EXPECT_FALSE(thing.absent);
}

TEST(StateBytes, FailsWhereverTheBytesEnd) {
  const std::string written = bytes_of_a_thing();
  for (std::size_t length = 0; length < written.size(); ++length) {
    StateBytes bytes(std::string_view(written).substr(0, length));
    Thing thing;
    thing.exchange(bytes);
    EXPECT_TRUE(bytes.failed()) << length;
  }
  const std::string longer = written + "x";
  StateBytes more(longer);
  Thing().exchange(more);
  EXPECT_FALSE(more.complete());
}

TEST(StateBytes, AllocatesNoMoreThanIsThere) {
  const std::string huge(8, '\x7f');
  StateBytes bytes(huge);
  std::vector<double> list;
  bytes(list);
  EXPECT_TRUE(bytes.failed());
  EXPECT_TRUE(list.empty());
}

}  // namespace
}  // namespace proofmass::state_bytes_test
