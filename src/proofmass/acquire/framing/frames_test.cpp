#include <bit>
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "proofmass/acquire/framing/checks.hpp"
#include "proofmass/acquire/framing/fields.hpp"
#include "proofmass/acquire/framing/framing_test_support.hpp"

namespace proofmass::acquire::framing_frames_test {
namespace {

using Names = std::vector<std::string>;
using Column = std::vector<double>;
using Losses = std::vector<std::uint64_t>;

const std::string fields = "fields=u32 t_us, i16 x y, u8 seq, crc16";

void append_le(std::string& out, std::uint64_t value, int bytes) {
  for (int i = 0; i < bytes; ++i) out += static_cast<char>(value >> (8 * i));
}

/// A frame of `fields`.
std::string frame(std::uint32_t t_us, int x, int y, unsigned seq) {
  std::string out;
  append_le(out, t_us, 4);
  append_le(out, static_cast<std::uint16_t>(x), 2);
  append_le(out, static_cast<std::uint16_t>(y), 2);
  append_le(out, seq, 1);
  append_le(out, checksum(Check::crc16, out), 2);
  return out;
}

std::string cobs(const std::string& frame) {
  std::string out(1, '\0');
  std::size_t code_at = 0;
  for (const char c : frame) {
    if (c != '\0') out += c;
    const std::size_t code = out.size() - code_at;
    if (c != '\0' && code < 0xFF) continue;
    out[code_at] = static_cast<char>(code);
    code_at = out.size();
    out += '\0';
  }
  out[code_at] = static_cast<char>(out.size() - code_at);
  return out + '\0';
}

std::string slip(const std::string& frame) {
  std::string out;
  for (const char c : frame) {
    if (c == '\xC0')
      out += "\xDB\xDC";
    else if (c == '\xDB')
      out += "\xDB\xDD";
    else
      out += c;
  }
  return out + '\xC0';
}

std::string sync(const std::string& frame) {
  return "\xAA\x55" + frame;
}

struct Kind {
  const char* setting;
  std::string (*wrap)(const std::string&);
};
class FramingKinds : public testing::TestWithParam<Kind> {
 protected:
  [[nodiscard]] static std::string settings() {
    return fmt::format("framing={}&{}", GetParam().setting, fields);
  }
  /// Rows from..to, with values that require every kind of stuffing.
  [[nodiscard]] static std::vector<std::string> frames(unsigned from, unsigned to) {
    std::vector<std::string> out;
    for (unsigned k = from; k < to; ++k)
      out.push_back(GetParam().wrap(
          frame(0xFFFFF000u + 1000 * k, static_cast<int>(k) * 0x55AA, -21846, k % 256)));
    return out;
  }
  [[nodiscard]] static std::string joined(const std::vector<std::string>& frames) {
    std::string out;
    for (const std::string& one : frames) out += one;
    return out;
  }
};
INSTANTIATE_TEST_SUITE_P(
    All,
    FramingKinds,
    testing::Values(Kind{"cobs", cobs}, Kind{"slip", slip}, Kind{"sync:AA55", sync}),
    [](const auto& test) { return std::string(test.param.setting).substr(0, 4); });

TEST_P(FramingKinds, GiveEveryRowAndUnwrapTheClock) {
  const Decoded out = decode(joined(frames(0, 600)), settings());
  EXPECT_EQ(out.names(), (Names{"x", "y", "seq"}));
  ASSERT_EQ(out.rows(), 600u);
  EXPECT_EQ(out.channels[1], Column(600, -21846.0));
  EXPECT_EQ(out.counts.lost, 0u) << "seq ran over twice";
  for (std::size_t k = 1; k < 600; ++k)
    ASSERT_EQ(out.device_ns[k] - out.device_ns[k - 1], 1'000'000) << k;
}

TEST_P(FramingKinds, AreTheSameHoweverTheyAreCut) {
  std::vector<std::string> some = frames(0, 40);
  some[7][5] = static_cast<char>(some[7][5] ^ 0x10);
  some[20].erase(3, 1);
  some.insert(some.begin() + 30, "garbage in between \xAA\x55");
  const std::string bytes = joined(some);
  const Decoded whole = decode(bytes, settings());
  EXPECT_GE(whole.rows(), 36u);
  for (const std::size_t piece : {1u, 2u, 5u, 13u, 100u}) {
    const Decoded cut = decode(bytes, options_of(settings()), piece);
    EXPECT_EQ(cut.channels, whole.channels) << piece;
    EXPECT_EQ(cut.device_ns, whole.device_ns) << piece;
    EXPECT_EQ(cut.lost_before, whole.lost_before) << piece;
    EXPECT_EQ(cut.counts.bytes, whole.counts.bytes) << piece;
  }
}

TEST_P(FramingKinds, FindTheirWayBackAndCountWhatIsMissing) {
  std::vector<std::string> some = frames(0, 12);
  some[4][some[4].size() - 3] = static_cast<char>(some[4][some[4].size() - 3] ^ 0x06);
  some[8].erase(4, 1);
  const Decoded out = decode(joined(some), settings());
  ASSERT_EQ(out.rows(), 10u);
  EXPECT_EQ(out.channels[2], (Column{0, 1, 2, 3, 5, 6, 7, 9, 10, 11}));
  EXPECT_EQ(out.lost_before, (Losses{0, 0, 0, 0, 1, 0, 0, 1, 0, 0}));
  EXPECT_EQ(out.counts.bytes, some[4].size() + some[8].size());
  EXPECT_GE(out.counts.bad_checksums, 1u);
}

TEST_P(FramingKinds, CountLostFramesWithoutACounterToo) {
  std::vector<std::string> some = frames(0, 12);
  some[4][5] = static_cast<char>(some[4][5] ^ 0x10);
  const Decoded out = decode(joined(some), settings() + "&counter=none");
  ASSERT_EQ(out.rows(), 11u);
  EXPECT_EQ(out.lost_before, (Losses{0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0}));
}

TEST_P(FramingKinds, BeginInTheMiddleOfAFrameWithoutALoss) {
  const std::vector<std::string> some = frames(0, 6);
  for (std::size_t cut = 1; cut < some[0].size(); ++cut) {
    const Decoded out =
        decode(joined(some).substr(cut), settings() + "&counter=none", Carrier::stream);
    EXPECT_EQ(out.rows(), 5u) << cut;
    EXPECT_EQ(out.counts.lost, 0u) << cut;
  }
}

TEST(FramingFrames, WithoutAChecksumNeedTheNextWord) {
  std::string bytes;
  for (int k = 0; k < 5; ++k) bytes += std::string("\xAA\x55", 2) + static_cast<char>(k) + '\x01';
  bytes.erase(9, 1);
  const Decoded out = decode(bytes, "framing=sync:AA55&fields=u8 n, u8 one");
  EXPECT_EQ(out.channels[0], (Column{0, 3, 4})) << "the third lost a byte of its word";
  EXPECT_EQ(out.lost_before, (Losses{0, 2, 0})) << "so that nothing confirms the second";
}

TEST(FramingFields, AreReadInEitherOrderOfBytes) {
  const FrameLayout layout =
      FrameLayout::parse("u8 a, i24 b, be u24 c, pad 2, be i16 d, le f32 e, f64 f", false).value();
  EXPECT_EQ(layout.bytes, 1u + 3 + 3 + 2 + 2 + 4 + 8);
  std::string bytes("\xFF\xFE\xFF\xFF\x01\x02\x03??\xFF\x00", 11);
  append_le(bytes, std::bit_cast<std::uint32_t>(1.5f), 4);
  append_le(bytes, std::bit_cast<std::uint64_t>(-0.1), 8);
  Column values(layout.fields.size());
  layout.read(bytes, values);
  EXPECT_EQ(values, (Column{255, -2, 0x010203, -256, 1.5, -0.1}));
  const FrameLayout big = FrameLayout::parse("u16 a, le u16 b", true).value();
  values.resize(2);
  big.read(std::string("\x01\x02\x01\x02", 4), values);
  EXPECT_EQ(values, (Column{258, 513}));
}

TEST(FramingFields, HaveAChecksumInEitherOrderOfBytes) {
  const FrameLayout layout = FrameLayout::parse("u32 a, u32 b, u8 c, be crc16", false).value();
  EXPECT_TRUE(layout.is_sound("123456789\x29\xB1"));
  EXPECT_FALSE(layout.is_sound("123456789\xB1\x29"));
}

TEST(FramingFrames, OfCobsMayBeLongerThanItsLongestRun) {
  const std::string long_frame = '\x07' + std::string(298, 'x') + '\x09';
  const Decoded out =
      decode(cobs(long_frame) + cobs(long_frame), "framing=cobs&fields=u8 a, pad 298, u8 b");
  EXPECT_EQ(out.channels[0], (Column{7, 7}));
  EXPECT_EQ(out.channels[1], (Column{9, 9}));
}

TEST(FramingFields, DoNotTakeADurationForTheClock) {
  const Decoded out = decode(cobs("\x01\x02") + cobs("\x03\x04"), "framing=cobs&fields=u8 dt_us x");
  EXPECT_FALSE(out.head.has_device_clock);
  EXPECT_EQ(out.names(), (Names{"dt", "x"}));
}

TEST(FramingFields, SayWhatIsWrong) {
  const auto refusal = [](std::string_view text) {
    const auto layout = FrameLayout::parse(text, false);
    return layout ? std::string() : layout.error().message;
  };
  for (const char* text : {"", "u32", "int x", "u8 x, crc16, crc8", "pad", "pad x", "pad 0", "be",
                           "crc16", "crc16 sum", "pad 99999999999", "pad 4096, u8 x"})
    EXPECT_NE(refusal(text), "") << text;
  EXPECT_EQ(refusal("u8 x,"), "");
}

TEST(FramingFields, NeedAUnitForTheClock) {
  const auto decoder = Decoder::make(options_of("framing=cobs&fields=u32 t, i16 x"));
  ASSERT_FALSE(decoder);
  EXPECT_NE(decoder.error().message.find("time-unit="), std::string::npos);
  EXPECT_TRUE(Decoder::make(options_of("framing=cobs&fields=u32 t, i16 x&time-unit=ms")));
  EXPECT_TRUE(Decoder::make(options_of("framing=cobs&fields=u32 t, i16 x&time=none")));
}

TEST(FramingFields, TakeScaleAndUnit) {
  std::string bytes;
  for (int k = 0; k < 3; ++k) bytes += cobs(std::string{static_cast<char>(10 * k), '\x02'});
  const Decoded out = decode(bytes, "framing=cobs&fields=u8 x y&scale=x:0.5&unit=g&rate=100");
  EXPECT_EQ(out.channels[0], (Column{0, 5, 10}));
  EXPECT_EQ(out.channels[1], (Column{2, 2, 2}));
  EXPECT_EQ(out.head.recording.channels[1].unit.symbol, "g");
  EXPECT_EQ(out.head.recording.time.rate_hz, 100.0);
}

// The catalogue's check values are those of "123456789".
TEST(FramingChecks, AgreeWithTheCatalogue) {
  EXPECT_EQ(checksum(Check::crc8, "123456789"), 0xF4u);
  EXPECT_EQ(checksum(Check::crc16, "123456789"), 0x29B1u);
  EXPECT_EQ(checksum(Check::crc16_modbus, "123456789"), 0x4B37u);
  EXPECT_EQ(checksum(Check::crc32, "123456789"), 0xCBF43926u);
}

TEST(FramingPackets, HoldWholeFrames) {
  const auto decoder = Decoder::make(options_of(fields, Carrier::datagrams)).value();
  decoder->take_packet(frame(1, 2, 3, 1) + frame(2, 3, 4, 2), 10);
  decoder->take_packet(frame(4, 5, 6, 4).substr(1), 20);
  decoder->take_packet(frame(3, 2, 3, 5), 30);
  Decoded out;
  drain(*decoder, out);
  EXPECT_EQ(out.channels[2], (Column{1, 2, 5}));
  EXPECT_EQ(out.lost_before, (Losses{0, 0, 2}));
  EXPECT_EQ(decoder->counts().bytes, 10u);
}

}  // namespace
}  // namespace proofmass::acquire::framing_frames_test
