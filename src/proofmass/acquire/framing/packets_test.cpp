#include <fmt/format.h>
#include <gtest/gtest.h>

#include "proofmass/acquire/framing/framing_test_support.hpp"

namespace proofmass::acquire::framing_packets_test {
namespace {

using Names = std::vector<std::string>;
using Column = std::vector<double>;

TEST(FramingPackets, ThatCameApartAreHandedOutApart) {
  const auto decoder = Decoder::make(options_of("time=none", Carrier::datagrams)).value();
  decoder->take_packet("1,2", 10'000'000);
  decoder->take_packet("3,4", 20'000'000);
  decoder->take_packet("5,6", 500'000'000);
  ASSERT_TRUE(decoder->settle(true).value());
  Arrival arrival;
  ASSERT_TRUE(decoder->hand_out(arrival));
  EXPECT_EQ(arrival.rows(), 2u);
  EXPECT_EQ(arrival.host_ns, 20'000'000) << "of the last";
  ASSERT_TRUE(decoder->hand_out(arrival));
  EXPECT_EQ(arrival.rows(), 1u);
  EXPECT_EQ(arrival.host_ns, 500'000'000);
  EXPECT_FALSE(decoder->hand_out(arrival));
}

TEST(FramingPackets, NeedNoLineEndAndHoldLinesDocumentsAndMessages) {
  const auto rows_of = [](std::string_view packet) {
    const auto decoder = Decoder::make(options_of("time=none", Carrier::datagrams)).value();
    for (int k = 0; k < 3; ++k) decoder->take_packet(packet, k);
    EXPECT_TRUE(decoder->settle(true).value());
    Decoded out;
    drain(*decoder, out);
    decoder->describe(out.head);
    return out;
  };
  EXPECT_EQ(rows_of("1,2,3").rows(), 3u);
  EXPECT_EQ(rows_of("1,2,3\n4,5,6\n").rows(), 6u);
  EXPECT_EQ(rows_of("{\n \"x\": 1,\n \"y\": [2, 3]\n}\n").names(), (Names{"x", "y.0", "y.1"}));
  const std::string osc("/accxyz\0,fff\0\0\0\0\x3f\x80\0\0\x40\0\0\0\xbf\x80\0\0", 28);
  const Decoded message = rows_of(osc);
  EXPECT_EQ(message.names(), (Names{"accxyz.0", "accxyz.1", "accxyz.2"}));
  EXPECT_EQ(message.channels[2], (Column{-1.0, -1.0, -1.0}));
  const std::string bundle = std::string("#bundle\0\0\0\0\0\0\0\0\1\0\0\0\x1c", 20) + osc +
                             std::string("\0\0\0\x0c/n\0\0,i\0\0\0\0\0\x07", 16);
  EXPECT_EQ(rows_of(bundle).names(), (Names{"accxyz.0", "accxyz.1", "accxyz.2", "n"}));
}

TEST(FramingPackets, PassOverRowsThatComeLate) {
  const auto decoder = Decoder::make(options_of("counter=n", Carrier::datagrams)).value();
  for (const int n : {1, 2, 3, 5, 4, 6, 6, 9})
    decoder->take_packet(fmt::format("n:{},x:{}", n, n), n);
  ASSERT_TRUE(decoder->settle(true).value());
  Decoded out;
  drain(*decoder, out);
  EXPECT_EQ(out.channels[1], (Column{1.0, 2.0, 3.0, 5.0, 6.0, 9.0}));
  EXPECT_EQ(out.lost_before, (std::vector<std::uint64_t>{0, 0, 0, 1, 0, 2}));
  EXPECT_EQ(decoder->counts().late, 2u);
}

TEST(FramingOptions, RefuseWhatMakesNoSense) {
  const auto refusal = [](const std::string& settings, Carrier carrier = Carrier::stream) {
    SourceUri uri = SourceUri::parse("x:y?" + settings).value();
    const auto options = framing_options(uri, carrier);
    return options ? std::string() : options.error().message;
  };
  EXPECT_NE(refusal("framing=bytes").find("expected lines, cobs, slip or sync:AA55"),
            std::string::npos);
  EXPECT_NE(refusal("framing=sync:A").find("hexadecimal"), std::string::npos);
  EXPECT_NE(refusal("framing=cobs").find("expected fields="), std::string::npos);
  EXPECT_NE(refusal("fields=u8%20x").find("framing=cobs"), std::string::npos);
  EXPECT_NE(refusal("time-unit=min"), "");
  EXPECT_NE(refusal("rate=0"), "");
  EXPECT_EQ(refusal("fields=u8%20x", Carrier::datagrams), "");
}

}  // namespace
}  // namespace proofmass::acquire::framing_packets_test
