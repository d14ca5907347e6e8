#include "proofmass/acquire/phone/phyphox_messages.hpp"

#include <cmath>
#include <gtest/gtest.h>

#include "proofmass/acquire/network/peer_test_support.hpp"
#include "proofmass/acquire/phone/phyphox_plan.hpp"

namespace proofmass::acquire::phyphox_messages_test {
namespace {

PhyphoxConfig config(const std::string& inputs, const std::string& exports = "[]") {
  return parse_phyphox_config(
             R"({"title":"T","buffers":[{"name":"a"},{"name":"b"},{"name":"t","size":100}],"inputs":)" +
             inputs + R"(,"export":)" + exports + "}")
      .value();
}

TEST(PhyphoxConfig, NamesBuffersAndInputs) {
  const PhyphoxConfig read =
      config(R"([{"source":"linear_acceleration","outputs":[{"x":"a"},{"y":"b"},{"t":"t"}]}])");
  EXPECT_EQ(read.title, "T");
  EXPECT_EQ(read.buffers.at(2).rows, 100U);
  EXPECT_EQ(read.inputs.at(0).outputs.at("y"), "b");
}

TEST(PhyphoxConfig, RefusesWhatIsNone) {
  for (const char* text : {"", "{", "[]", "{\"title\":\"T\"}", "<html>"})
    EXPECT_FALSE(parse_phyphox_config(text)) << text;
}

TEST(PhyphoxPlan, TakesLinearAccelerationWhereThereIsNoOther) {
  const auto groups =
      plan_phyphox(
          config(R"([{"source":"linear_acceleration","outputs":[{"y":"b"},{"x":"a"},{"t":"t"}]}])"),
          {})
          .value();
  ASSERT_EQ(groups.size(), 1U);
  EXPECT_EQ(groups[0].buffers, (std::vector<std::string>{"a", "b"}));
  EXPECT_EQ(groups[0].time, "t");
  EXPECT_EQ(groups[0].units[0].symbol, "m/s^2");
}

TEST(PhyphoxPlan, ReadsLabelsWhereNoInputSaysAcceleration) {
  const auto groups =
      plan_phyphox(config(R"([{"source":"bluetooth"}])", R"json([{"set":"S","sources":[
      {"label":"Time (s)","buffer":"t"},{"label":"Up (g)","buffer":"b"},{"label":"Charge (V)","buffer":"a"}]}])json"),
                   {})
          .value();
  ASSERT_EQ(groups.size(), 1U);
  EXPECT_EQ(groups[0].buffers, (std::vector<std::string>{"b"}));
  EXPECT_EQ(groups[0].time, "t");
  EXPECT_EQ(groups[0].units[0].symbol, "g");
}

TEST(PhyphoxPlan, TakesNamedBuffers) {
  const auto one = plan_phyphox(config("[]"), {.buffers = {"b"}, .time = "t"});
  EXPECT_EQ(one.value()[0].buffers, (std::vector<std::string>{"b"}));
  EXPECT_TRUE(
      says(plan_phyphox(config("[]"), {.buffers = {"c"}, .time = "t"}).error().message, "a, b, t"));
  EXPECT_TRUE(says(plan_phyphox(config("[]"), {.buffers = {"b"}}).error().message, "time="));
}

TEST(PhyphoxPlan, SaysWhatIsThereInsteadOfAcceleration) {
  const auto none = plan_phyphox(config(R"([{"source":"audio","outputs":[{"out":"a"}]}])"), {});
  ASSERT_FALSE(none);
  EXPECT_EQ(none.error().code, Errc::device);
  EXPECT_TRUE(says(none.error().message, "its inputs are: audio"));
}

TEST(PhyphoxReply, GivesTheBuffersInTheOrderAskedFor) {
  PhyphoxReply reply;
  ASSERT_TRUE(parse_phyphox_reply(
      R"({"buffer":{"a":{"size":0,"updateMode":"partial","buffer":[1,null,3.5E1]},
      "t":{"size":0,"updateMode":"partial", "buffer":[]}},"status":{"session":"1f","measuring":true}})",
      {"t", "a", "gone"}, reply));
  EXPECT_EQ(reply.session, "1f");
  EXPECT_TRUE(reply.measuring);
  EXPECT_TRUE(reply.buffers[0].empty());
  ASSERT_EQ(reply.buffers[1].size(), 3U);
  EXPECT_TRUE(std::isnan(reply.buffers[1][1]));
  EXPECT_EQ(reply.buffers[1][2], 35.0);
  EXPECT_EQ(reply.is_there, (std::vector<bool>{true, true, false}));
}

TEST(PhyphoxReply, CutAnywhereIsRefused) {
  const std::string whole =
      R"({"buffer":{"a":{"buffer":[1,2]}},"status":{"session":"1f","measuring":true}})";
  PhyphoxReply reply;
  for (std::size_t size = 0; size < whole.size(); ++size)
    EXPECT_FALSE(parse_phyphox_reply(whole.substr(0, size), {"a"}, reply)) << size;
  EXPECT_TRUE(parse_phyphox_reply(whole, {"a"}, reply));
}

TEST(PhyphoxTime, IsThatOfTheLastStart) {
  EXPECT_EQ(parse_phyphox_time(R"([{"event":"START","experimentTime":0,"systemTime":1000.5},
      {"event":"PAUSE","experimentTime":3,"systemTime":1003.5},{"event":"START","experimentTime":3,"systemTime":1010}])")
                .value(),
            1007.0);
  EXPECT_EQ(parse_phyphox_time("[]").value(), std::nullopt);
}

}  // namespace
}  // namespace proofmass::acquire::phyphox_messages_test
