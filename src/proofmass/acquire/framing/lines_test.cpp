#include <cmath>
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "proofmass/acquire/framing/framing_test_support.hpp"

namespace proofmass::acquire::framing_lines_test {
namespace {

using Names = std::vector<std::string>;
using Column = std::vector<double>;

std::string many_rows(std::size_t count) {
  std::string text = "t_us,ax (g),ay (g)\n";
  for (std::size_t k = 0; k < count; ++k)
    text += fmt::format("{},{:.3f},{:.3f}\r\n", 1000 * k + 7, 0.001 * static_cast<double>(k), -1.5);
  return text;
}

TEST(FramingLines, TakeNamesAndUnitsFromTheHeader) {
  const Decoded out = decode(many_rows(3));
  EXPECT_EQ(out.names(), (Names{"ax", "ay"}));
  EXPECT_EQ(out.head.recording.channels[0].unit.symbol, "g");
  EXPECT_TRUE(out.head.has_device_clock);
  EXPECT_EQ(out.device_ns, (std::vector<std::int64_t>{7'000, 1'007'000, 2'007'000}));
  EXPECT_EQ(out.channels[0], (Column{0.0, 0.001, 0.002}));
}

TEST(FramingLines, AreTheSameHoweverTheyAreCut) {
  const std::string text = many_rows(60) + "oops\n" + "1,2\n" + "60007,0.1,0.2\n";
  const Decoded whole = decode(text);
  ASSERT_EQ(whole.rows(), 61u);
  for (const std::size_t piece : {1u, 2u, 3u, 7u, 64u, 500u}) {
    const Decoded cut = decode(text, options_of(""), piece);
    EXPECT_EQ(cut.channels, whole.channels) << piece;
    EXPECT_EQ(cut.device_ns, whole.device_ns) << piece;
    EXPECT_EQ(cut.lost_before, whole.lost_before) << piece;
    EXPECT_EQ(cut.counts.lines, whole.counts.lines) << piece;
  }
}

TEST(FramingLines, OfAStreamDropAFirstLineThatMayLackItsBeginning) {
  const std::string text = "3,4,5\n10,1,2\n20,3,4\n30,5,6\n40,7,8\n";
  EXPECT_EQ(decode(text, "time=none", Carrier::stream).rows(), 4u);
  EXPECT_EQ(decode(text, "time=none").rows(), 5u);
  EXPECT_EQ(decode(many_rows(5), "", Carrier::stream).rows(), 5u) << "a header is whole";
}

TEST(FramingLines, BeginAtTheHeaderThatADeviceWritesOnceItHasBegunAnew) {
  const Decoded out = decode(
      "77,5,5\n88,6,6\n99,7,7\nms,x,y\n1,0.5,2\n2,0.25,3\n3,0.125,4\n4,1,5\n", "", Carrier::stream);
  EXPECT_EQ(out.names(), (Names{"x", "y"}));
  EXPECT_EQ(out.channels[0], (Column{0.5, 0.25, 0.125, 1.0}));
  EXPECT_EQ(out.device_ns.front(), 1'000'000);
}

TEST(FramingLines, TellThatTheHeaderCameOnceMore) {
  const Decoded out = decode(many_rows(5) + "t_us,ax (g),ay (g)\n7,1,2\n");
  EXPECT_EQ(out.rows(), 6u);
  EXPECT_EQ(out.counts.lines, 0u);
  EXPECT_TRUE(out.is_noted("device restarted"));
  EXPECT_LT(out.device_ns.back(), out.device_ns[4]) << "the device's clock went back, and is left";
}

TEST(FramingLines, AreNamedByTheirPlaceWithoutAHeader) {
  EXPECT_EQ(decode("1;2;3\n1;2;4\n").names(), (Names{"c1", "c2", "c3"}));
  const Decoded named = decode("1;2;3\n1;2;4\n", "columns=x%20(mg),y,z");
  EXPECT_EQ(named.names(), (Names{"x", "y", "z"}));
  EXPECT_EQ(named.head.recording.channels[0].unit.symbol, "mg");
  const auto wrong = Decoder::make(options_of("columns=x,y")).value();
  wrong->take("1;2;3\n1;2;4\n", 0);
  EXPECT_EQ(wrong->settle(true).error().message, "columns= names 2 columns, the lines have 3");
}

TEST(FramingLines, FindSeparatorAndDecimalMark) {
  for (const char* text : {"1.5,-2\n0.5,3\n", "1,5;-2\n0,5;3\n", "1.5\t-2\n0.5\t3\n",
                           "1.5 -2\n0.5 3\n", "1,5 -2\n0,5 3\n", "1.5, -2,\n0.5, 3,\n"}) {
    const Decoded out = decode(text);
    ASSERT_EQ(out.channels.size(), 2u) << text;
    EXPECT_EQ(out.channels[0], (Column{1.5, 0.5})) << text;
    EXPECT_EQ(out.channels[1], (Column{-2.0, 3.0})) << text;
  }
}

TEST(FramingLines, KeepNanForWhatIsNoNumber) {
  const Decoded out = decode("1,2,3\n4,,6\n7,nan,9\n");
  ASSERT_EQ(out.rows(), 3u);
  EXPECT_TRUE(std::isnan(out.channels[1][1]) && std::isnan(out.channels[1][2]));
}

TEST(FramingLines, ReadPairsInAnyOrder) {
  for (const char* text : {"x:1.02,y:0.3\ny:0.4,x:2\n", "x: 1.02, y: 0.3\ny: 0.4, x: 2\n",
                           "x=1.02\ty=0.3\ny=0.4\tx=2\n", "x: 1.02 y: 0.3\ny: 0.4 x: 2\n",
                           "x:1,02;y:0,3\ny:0,4;x:2\n"}) {
    const Decoded out = decode(text);
    ASSERT_EQ(out.names(), (Names{"x", "y"})) << text;
    EXPECT_EQ(out.channels[0], (Column{1.02, 2.0})) << text;
    EXPECT_EQ(out.channels[1], (Column{0.3, 0.4})) << text;
  }
}

TEST(FramingLines, DoNotTakeAMessageForAColumn) {
  std::string text;
  for (int k = 0; k < 10; ++k) text += fmt::format("x:{},y:2\n", k);
  const Decoded out = decode(text + "Free memory: 1234\nx:10,y:2\n");
  EXPECT_EQ(out.names(), (Names{"x", "y"}));
  EXPECT_EQ(out.rows(), 11u);
  EXPECT_TRUE(out.is_noted("Free memory"));
}

TEST(FramingLines, PassOverARowWithoutATime) {
  const Decoded out = decode("ms:1,x:1\nms:2,x:2\nms:nan,x:3\nms:4,x:4\n");
  EXPECT_EQ(out.channels[0], (Column{1.0, 2.0, 4.0}));
  EXPECT_EQ(out.lost_before, (std::vector<std::uint64_t>{0, 0, 1}));
  EXPECT_EQ(out.counts.untimed, 1u);
}

TEST(FramingLines, FlattenJson) {
  const Decoded out = decode(
      "{\"timestamp\":1.5,\"acc\":{\"x\":1,\"y\":2},\"who\":\"me\"}\n"
      "{\"acc\":{\"y\":4,\"x\":3},\"timestamp\":1.75,\"who\":\"me\"}\n",
      "time-unit=s");
  EXPECT_EQ(out.names(), (Names{"acc.x", "acc.y"}));
  EXPECT_EQ(out.channels[1], (Column{2.0, 4.0}));
  EXPECT_EQ(out.device_ns, (std::vector<std::int64_t>{1'500'000'000, 1'750'000'000}));
  EXPECT_TRUE(out.is_noted("who"));
}

TEST(FramingLines, KeepTheColumnsAskedForWhereLinesNameThem) {
  const std::string text = "{\"a\":1,\"b\":2}\n{\"gps\":7}\n{\"a\":3,\"b\":4}\n{\"a\":5,\"b\":6}\n";
  const Decoded out = decode(text, "columns=b");
  EXPECT_EQ(out.names(), Names{"b"});
  EXPECT_EQ(out.channels[0], (Column{2.0, 4.0, 6.0}));
  EXPECT_EQ(out.counts.lines, 0u) << "a line that was not asked for is none that does not fit";
}

TEST(FramingLines, PassOverWhatIsNoRowAndCountARowThatWasDamaged) {
  const Decoded out = decode("x,y\n1,2\n3,4\ncalibrating\n5,6\n7,8,9,10\n11,1z\n13,14\n");
  EXPECT_EQ(out.channels[0], (Column{1.0, 3.0, 5.0, 13.0}));
  EXPECT_EQ(out.counts.lines, 3u);
  EXPECT_EQ(out.lost_before, (std::vector<std::uint64_t>{0, 0, 0, 2})) << "words are no row";
  EXPECT_TRUE(out.is_noted("calibrating"));
}

TEST(FramingLines, TellARepeatedTroubleWithoutFlooding) {
  std::string text = many_rows(300);
  for (int k = 0; k < 1000; ++k) text += "some words\n";
  const Decoded out = decode(text, options_of(""), 20);
  EXPECT_EQ(out.counts.lines, 1000u);
  EXPECT_LT(out.notes.size(), 20u);
  EXPECT_TRUE(out.is_noted("1000 lines skipped by now"));
}

TEST(FramingLines, WithoutAnEndAreGarbageAndBounded) {
  std::string text = "x,y\n1,2\n3,4\n5,6\n7,8\n";
  const Decoded out = decode(text + std::string(1'000'000, '7') + "\n9,10\n");
  EXPECT_EQ(out.channels[0], (Column{1.0, 3.0, 5.0, 7.0, 9.0}));
  EXPECT_EQ(out.counts.bytes, 1'000'000u);
}

TEST(FramingLines, UnwrapTheClockOf32Bits) {
  const Decoded out = decode("micros,x\n4294965000,1\n4294966000,2\n4294967000,3\n704,4\n1704,5\n");
  ASSERT_EQ(out.device_ns.size(), 5u);
  for (std::size_t k = 1; k < 5; ++k)
    EXPECT_EQ(out.device_ns[k] - out.device_ns[k - 1], 1'000'000) << k;
}

TEST(FramingLines, KeepTheNanosecondsOfAnEpoch) {
  const Decoded out = decode("timestamp (ns),x\n1700000000000000001,1\n1700000000001000003,2\n");
  ASSERT_EQ(out.device_ns.size(), 2u);
  EXPECT_EQ(out.device_ns[1] - out.device_ns[0], 1'000'002);
  const Decoded seconds = decode("time (s),x\n1700000000.000000001,1\n1700000000.001,2\n");
  ASSERT_EQ(seconds.device_ns.size(), 2u);
  EXPECT_EQ(seconds.device_ns[1] - seconds.device_ns[0], 999'999);
  EXPECT_FALSE(seconds.head.recording.time.start_ns) << "what comes live was taken now";
  const Decoded before = decode("time (s),x\n-1.5,1\n-0.25,2\n0.5,3\n");
  EXPECT_EQ(before.device_ns,
            (std::vector<std::int64_t>{-1'500'000'000, -250'000'000, 500'000'000}));
}

TEST(FramingLines, CountWhatACounterLeavesOut) {
  const Decoded out = decode("seq,x\n253,1\n254,2\n255,3\n0,4\n1,5\n4,6\n5,7\n", "counter=seq");
  EXPECT_EQ(out.names(), (Names{"seq", "x"}));
  EXPECT_EQ(out.lost_before, (std::vector<std::uint64_t>{0, 0, 0, 0, 0, 2, 0}));
  EXPECT_EQ(out.head.recording.channels[0].unit.symbol, "counts");
}

TEST(FramingLines, KnowACounterByItsNameAndWhatItDoes) {
  std::string text = "x,seq\n";
  for (int k = 0; k < 20; ++k) text += fmt::format("1,{}\n", k < 15 ? k : k + 3);
  EXPECT_EQ(decode(text).counts.lost, 3u);
  EXPECT_EQ(decode(text, "counter=none").counts.lost, 0u);
}

TEST(FramingLines, TakeAClocksUnitFromThePaceOfTheHost) {
  const auto decoder = Decoder::make(options_of("", Carrier::stream)).value();
  Decoded out;
  for (int k = 0; k < 60; ++k)
    decoder->take(fmt::format("{},1,{}\n", 4 * k, k % 3), std::int64_t{k} * 4'000'000);
  ASSERT_TRUE(decoder->settle(false).value());
  decoder->describe(out.head);
  drain(*decoder, out);
  EXPECT_TRUE(out.head.has_device_clock);
  EXPECT_EQ(out.device_ns[1] - out.device_ns[0], 4'000'000);
}

TEST(FramingLines, DoNotTakeACountForAClock) {
  const auto decoder = Decoder::make(options_of("", Carrier::stream)).value();
  Decoded out;
  for (int k = 0; k < 60; ++k)
    decoder->take(fmt::format("{},1,{}\n", k, k % 3), std::int64_t{k} * 4'000'000);
  ASSERT_TRUE(decoder->settle(false).value());
  decoder->describe(out.head);
  drain(*decoder, out);
  EXPECT_FALSE(out.head.has_device_clock);
  EXPECT_TRUE(out.is_noted("increases by one"));
}

TEST(FramingLines, NameTheColumnsThatAreThere) {
  const auto refusal = [](const std::string& settings) {
    const auto decoder = Decoder::make(options_of(settings)).value();
    decoder->take("t,x\n1,2\n3,4\n", 0);
    return decoder->settle(true).error().message;
  };
  EXPECT_EQ(refusal("time=tt"), "time=tt: there is no such column of figures; there are t, x");
  EXPECT_EQ(refusal("counter=n"), "counter=n: there is no such column of figures; there are t, x");
  EXPECT_NE(refusal("unit=x:parsec").find("unit=parsec"), std::string::npos);
  EXPECT_NE(refusal("scale=x:0").find("scale=0"), std::string::npos);
}

TEST(FramingLines, TakeUnitsAndFactorsFromTheSettings) {
  const Decoded out = decode("ms,x (g),y\n1,2,3\n2,4,6\n", "unit=mV&scale=y:0.5");
  EXPECT_EQ(out.head.recording.channels[0].unit.symbol, "g") << "the header knows better";
  EXPECT_EQ(out.head.recording.channels[1].unit.symbol, "mV");
  EXPECT_EQ(out.channels[0], (Column{2.0, 4.0}));
  EXPECT_EQ(out.channels[1], (Column{1.5, 3.0}));
}

TEST(FramingLines, SayWhatCameInsteadOfRows) {
  const auto decoder = Decoder::make(options_of("", Carrier::stream)).value();
  EXPECT_EQ(decoder->what_came(), "");
  decoder->take("\xFF\x80\x01", 0);
  EXPECT_NE(decoder->what_came().find("3 bytes came, but no line"), std::string::npos);
  decoder->take("\nhello\n", 0);
  EXPECT_FALSE(decoder->settle(true).value());
  EXPECT_NE(decoder->what_came().find("hello"), std::string::npos);
}

}  // namespace
}  // namespace proofmass::acquire::framing_lines_test
