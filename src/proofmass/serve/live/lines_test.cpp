#include "proofmass/serve/live/lines.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <nlohmann/json.hpp>

namespace proofmass::serve::live_lines_test {
namespace {

using nlohmann::json;
using namespace std::chrono_literals;

struct Written {
  std::vector<json> lines;
  LiveLines to{[this](std::string_view line) { lines.push_back(json::parse(line)); }};

  [[nodiscard]] std::vector<json> of(const char* kind) const {
    std::vector<json> out;
    for (const json& line : lines)
      if (line.contains(kind)) out.push_back(line[kind]);
    return out;
  }
};

Recording head_at(double rate_hz) {
  Recording head;
  head.source = "sim:wheel";
  head.time.rate_hz = rate_hz;
  head.channels = {{"x", *parse_unit("g"), {}}, {"y", *parse_unit("g"), {}}};
  return head;
}

TEST(LiveLines, ARowIsABucketUpToAThousandASecond) {
  Written written;
  written.to.opened(head_at(1000.0), "run.mcap");
  const std::vector<double> t{0.0, 0.001, 0.002}, x{1, 2, 3}, y{-1, -2, -3};
  written.to.samples({0, {x, y}, t}, LiveLines::Clock::time_point(1s));
  const auto rows = written.of("rows");
  ASSERT_EQ(rows.size(), 1U);
  EXPECT_EQ(rows[0]["every"], 1);
  EXPECT_EQ(rows[0]["t"], json(t));
  EXPECT_EQ(rows[0]["min"], json({x, y}));
  EXPECT_FALSE(rows[0].contains("max"));
  EXPECT_EQ(written.of("head")[0]["file"], "run.mcap");
}

TEST(LiveLines, FasterRowsAreExtremesSoThatASpikeIsSeen) {
  Written written;
  written.to.opened(head_at(4000.0), "");
  const std::vector<double> t{0, 0.25e-3, 0.5e-3, 0.75e-3, 1e-3, 1.25e-3, 1.5e-3, 1.75e-3};
  const std::vector<double> x{1, 9, 2, 3, 4, 4, -7, 4}, y(8, 0.5);
  written.to.samples({0, {x, y}, t}, LiveLines::Clock::time_point(1s));
  const json rows = written.of("rows").at(0);
  EXPECT_EQ(rows["every"], 4);
  EXPECT_EQ(rows["t"], json({0.0, 1e-3}));
  EXPECT_EQ(rows["min"][0], json({1.0, -7.0}));
  EXPECT_EQ(rows["max"][0], json({9.0, 4.0}));
  EXPECT_TRUE(written.of("head")[0]["file"].is_null());
}

TEST(LiveLines, AMissingValueIsNullAndDoesNotHideOthers) {
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  Written written;
  written.to.opened(head_at(2000.0), "");
  const std::vector<double> t{0, 0.5e-3, 1e-3, 1.5e-3}, x{none, 3, none, none}, y{1, 1, 1, 1};
  written.to.samples({0, {x, y}, t}, LiveLines::Clock::time_point(1s));
  const json rows = written.of("rows").at(0);
  EXPECT_EQ(rows["min"][0][0], 3.0);
  EXPECT_TRUE(rows["max"][0][1].is_null());
}

TEST(LiveLines, AFrameLastsTwentyFiveMilliseconds) {
  Written written;
  written.to.opened(head_at(100.0), "");
  for (int k = 0; k < 100; ++k) {
    const std::vector<double> t{0.01 * k}, x{1.0};
    written.to.samples({static_cast<std::size_t>(k), {x, x}, t},
                       LiveLines::Clock::time_point(1s + k * 10ms));
  }
  EXPECT_EQ(written.of("rows").size(), 34U);  // every third sample of 10 ms
  EXPECT_EQ(written.of("state").size(), 5U);
}

TEST(LiveLines, CountsWhatEventsReportAsMissingAndHowLongNothingCame) {
  Written written;
  written.to.opened(head_at(100.0), "");
  const std::vector<double> t{0.5}, x{1.0};
  written.to.samples({0, {x, x}, t}, LiveLines::Clock::time_point(1s));
  written.to.event({EventKind::lost, Severity::warning, 0.5, 0.1, 10, "10 rows"});
  written.to.event({EventKind::stalled, Severity::warning, 0.5, 0.0, 0, "nothing"});
  written.to.refresh(LiveLines::Clock::time_point(4s));
  const json state = written.of("state").back();
  EXPECT_EQ(state["lost"], 10);
  EXPECT_EQ(state["gaps"], 1);
  EXPECT_EQ(state["samples"], 1);
  EXPECT_DOUBLE_EQ(state["silence_s"], 3.0);
  EXPECT_EQ(written.of("event").at(0)["severity"], "warning");
}

TEST(LiveLines, IndentedJsonBecomesOneLine) {
  EXPECT_EQ(live_line("noise", "{\n  \"a\": [\n    1,\n    \"b\\n  c\"\n  ]\n}\n"),
            R"({"noise":{"a": [1,"b\n  c"]}})");
}

}  // namespace
}  // namespace proofmass::serve::live_lines_test
