#include <gtest/gtest.h>

#include "proofmass/io/messages/cdr_plan.hpp"
#include "proofmass/io/messages/cdr_schema.hpp"
#include "proofmass/io/messages/cdr_specimens.hpp"

namespace proofmass::io::cdr_test {
namespace {

using specimen::CdrWriter;

CdrPlan plan_of(std::string_view text) {
  const auto schema = read_cdr_schema("test_msgs/msg/Thing", text);
  EXPECT_TRUE(schema.has_value()) << schema.error().message;
  const auto plan = plan_cdr(schema.value());
  EXPECT_TRUE(plan.has_value()) << plan.error().message;
  return plan.value();
}

std::vector<std::string> paths_of(const CdrPlan& plan) {
  std::vector<std::string> paths;
  for (const CdrColumn& column : plan.columns) paths.push_back(column.path);
  return paths;
}

std::vector<double> decoded(std::string_view message,
                            const CdrPlan& plan,
                            CdrLayout layout = CdrLayout::xcdr) {
  std::vector<double> columns(plan.columns.size());
  const Status status = decode_cdr(message, layout, plan, columns);
  EXPECT_TRUE(status.has_value()) << status.error().message;
  return columns;
}

std::string problem_of(std::string_view text) {
  const auto schema = read_cdr_schema("test_msgs/msg/Thing", text);
  if (!schema) return schema.error().message;
  const auto plan = plan_cdr(*schema);
  return plan ? "" : plan.error().message;
}

using Paths = std::vector<std::string>;
using Values = std::vector<double>;

TEST(Cdr, ReadsEveryTypeOfFigureInEitherByteOrder) {
  const CdrPlan plan = plan_of(
      "bool a\nint8 b\nuint16 c\nint32 d\nfloat32 e\nuint8 f\nfloat64 g\nint64 h\nbyte i\n"
      "uint64 j\nchar k\nuint32 l\nint16 m");
  for (const bool big_endian : {false, true}) {
    CdrWriter out(big_endian);
    out.put(std::uint8_t{1}).put(std::int8_t{-5}).put(std::uint16_t{65'000});
    out.put(std::int32_t{-70'000}).put(1.5F).put(std::uint8_t{200}).put(-2.25);
    out.put(std::int64_t{-9}).put(std::uint8_t{7}).put(std::uint64_t{1} << 40);
    out.put(std::uint8_t{'A'}).put(std::uint32_t{4'000'000'000}).put(std::int16_t{-3});
    EXPECT_EQ(decoded(out.message(), plan), (Values{1, -5, 65'000, -70'000, 1.5, 200, -2.25, -9, 7,
                                                    1099511627776.0, 65, 4e9, -3}));
  }
}

TEST(Cdr, AlignsToFourBytesInTheSecondEncoding) {
  const CdrPlan plan = plan_of("uint8 a\nfloat64 b");
  const CdrWriter first = CdrWriter().put(std::uint8_t{3}).put(2.5);
  const CdrWriter second = CdrWriter(false, 4, true).put(std::uint8_t{3}).put(2.5);
  EXPECT_EQ(first.body().size(), 16u);
  EXPECT_EQ(second.body().size(), 12u);
  EXPECT_EQ(decoded(first.message(), plan), (Values{3, 2.5}));
  EXPECT_EQ(decoded(second.message(), plan), (Values{3, 2.5}));
}

TEST(Cdr, PassesOverTextsAndLists) {
  const CdrPlan plan = plan_of(
      "string<=10 name\nfloat64[] list\nstring[2] words\nPoint[<=4] points\nPoint one\n"
      "uint8 LIMIT=5\nfloat32[3] three\n"
      "===\nMSG: test_msgs/Point\nfloat32 x\nint64[] odd\n");
  EXPECT_EQ(paths_of(plan), (Paths{"one_x", "three_0", "three_1", "three_2"}));
  EXPECT_EQ(plan.skipped, (Paths{"list", "points", "one_odd"}));
  CdrWriter out;
  out.text("abcd").put(std::uint32_t{2}).put(1.0).put(2.0).text("x").text("yy");
  out.put(std::uint32_t{2});
  for (int i = 0; i < 2; ++i) out.put(3.0F).put(std::uint32_t{1}).put(std::int64_t{4});
  out.put(7.5F).put(std::uint32_t{0}).put(1.0F).put(2.0F).put(3.0F);
  EXPECT_EQ(decoded(out.message(), plan), (Values{7.5, 1, 2, 3}));
}

TEST(Cdr, FindsTheStampOfTheHeader) {
  const auto schema = read_cdr_schema("sensor_msgs/msg/Imu", specimen::imu_definition);
  const CdrPlan plan = plan_cdr(schema.value()).value();
  EXPECT_EQ(plan.stamp, 0u);
  EXPECT_EQ(plan.columns.size(), 12u);
  EXPECT_EQ(plan.columns[9].path, "linear_acceleration_x");
  EXPECT_EQ(plan.columns[9].parent, "sensor_msgs/Imu.linear_acceleration");
  const Values row = decoded(specimen::imu_message(4, 5'000'000'007), plan);
  EXPECT_EQ(row, (Values{5, 7, 0, 0, 0, 1, 0.01, 0.02, 0.03, 0.004, -0.5, 9.81}));
}

TEST(Cdr, ReadsTheFirstVersionOfRosWithoutAlignment) {
  const CdrPlan plan = plan_of(
      "Header header\nuint8 a\nfloat64 b\n===\nMSG: std_msgs/Header\nuint32 seq\ntime stamp\n"
      "string frame_id");
  EXPECT_EQ(plan.stamp, 1u);
  CdrWriter out(false, 1);
  out.put(std::uint32_t{8}).put(std::uint32_t{100}).put(std::uint32_t{5}).text("frame");
  out.put(std::uint8_t{2}).put(0.125);
  EXPECT_EQ(decoded(out.body(), plan, CdrLayout::ros1), (Values{8, 100, 5, 2, 0.125}));
}

TEST(Cdr, RefusesAMessageThatBreaksOff) {
  const auto schema = read_cdr_schema("sensor_msgs/msg/Imu", specimen::imu_definition);
  const CdrPlan plan = plan_cdr(schema.value()).value();
  Values columns(plan.columns.size());
  const std::string message = specimen::imu_message(4, 5);
  const std::size_t needed = message.size() - 9 * 8;  // the last covariances are not read
  for (std::size_t size = 0; size < needed; ++size)
    EXPECT_FALSE(decode_cdr(message.substr(0, size), CdrLayout::xcdr, plan, columns)) << size;
  EXPECT_TRUE(decode_cdr(message.substr(0, needed), CdrLayout::xcdr, plan, columns));
  std::string other = message;
  other[1] = '\x02';
  EXPECT_EQ(decode_cdr(other, CdrLayout::xcdr, plan, columns).error().code, Errc::unsupported);
}

TEST(Cdr, BelievesNoLengthOfAList) {
  const CdrPlan plan = plan_of(
      "P[] ps\nstring[] s\nfloat64 a\n===\nMSG: test_msgs/P\nQ[] qs\n===\nMSG: "
      "test_msgs/Q\nuint8[] b\n");
  Values columns(1);
  CdrWriter out;
  out.put(std::uint32_t{0xFFFFFFFF}).put(std::uint32_t{0xFFFFFFFF}).put(std::uint32_t{0});
  EXPECT_FALSE(decode_cdr(out.message(), CdrLayout::xcdr, plan, columns));
}

TEST(Cdr, RefusesSchemasThatCannotBe) {
  EXPECT_NE(problem_of("Other o\n").find("does not define test_msgs/Other"), std::string::npos);
  EXPECT_NE(problem_of("Thing t\nfloat64 a\n").find("deeper"), std::string::npos);
  EXPECT_NE(problem_of("float64\n").find("line 1"), std::string::npos);
  EXPECT_NE(problem_of("float64[x] a\n").find("line 1"), std::string::npos);
  EXPECT_NE(problem_of("float64[0] a\n").find("line 1"), std::string::npos);
  EXPECT_NE(problem_of("string a\n").find("no single figure"), std::string::npos);
  EXPECT_NE(problem_of("wstring a\nfloat64 b\n").find("wide"), std::string::npos);
  EXPECT_EQ(problem_of("float64 b\nwstring a\n"), "");
  EXPECT_NE(problem_of("").find("no single figure"), std::string::npos);
  // Sixteen levels of messages that contain two of the next are not expanded.
  std::string wide = "M1 a\nM1 b\n";
  for (int i = 1; i < 14; ++i)
    wide += "===\nMSG: test_msgs/M" + std::to_string(i) + "\nM" + std::to_string(i + 1) + " a\nM" +
            std::to_string(i + 1) + " b\n";
  EXPECT_NE(problem_of(wide + "===\nMSG: test_msgs/M14\nfloat64 x\n").find("4096"),
            std::string::npos);
}

}  // namespace
}  // namespace proofmass::io::cdr_test
