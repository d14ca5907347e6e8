#include "proofmass/acquire/source_uri.hpp"

#include <gtest/gtest.h>

#include "proofmass/acquire/source.hpp"

namespace proofmass::acquire::source_uri_test {
namespace {

TEST(SourceUri, HasSchemePlaceAndSettings) {
  SourceUri uri = SourceUri::parse("serial:/dev/ttyACM0?baud=115200&fields=u32%20t,+i16+x").value();
  EXPECT_EQ(uri.scheme(), "serial");
  EXPECT_EQ(uri.place(), "/dev/ttyACM0");
  EXPECT_EQ(uri.number("baud", 0.0).value(), 115200.0);
  EXPECT_EQ(uri.value("fields"), "u32 t,+i16+x");
  EXPECT_TRUE(uri.nothing_unknown());
}

TEST(SourceUri, OfAHostLosesItsSlashes) {
  EXPECT_EQ(SourceUri::parse("phyphox://10.0.0.2:8080").value().place(), "10.0.0.2:8080");
}

TEST(SourceUri, DashIsStandardInput) {
  EXPECT_EQ(SourceUri::parse("-").value().scheme(), "stdin");
}

TEST(SourceUri, NamesTheSettingThatNobodyKnows) {
  SourceUri uri = SourceUri::parse("sim:wheel?rete=100").value();
  (void)uri.value("rate");
  (void)uri.value("rate");
  EXPECT_EQ(uri.nothing_unknown().error().message, "rete: no such setting of sim:, which has rate");
}

TEST(SourceUri, RefusesWhatIsNone) {
  for (const char* text : {"", "/dev/ttyACM0", ":x", "a b:", "sim:?x", "sim:?=1", "sim:?a=1&a=2",
                           "sim:?a=%4", "sim:?a=%zz", "sim:%"})
    EXPECT_FALSE(SourceUri::parse(text)) << text;
}

TEST(SourceUri, NumbersAreHeldToTheirBound) {
  SourceUri uri = SourceUri::parse("sim:?rate=-1&speed=fast&n=1e999").value();
  EXPECT_EQ(uri.number("rate", 0.0).error().message, "rate=-1: expected a number above 0");
  EXPECT_FALSE(uri.number("speed", 0.0));
  EXPECT_FALSE(uri.number("n", 0.0));
  EXPECT_EQ(uri.number("seed", 0.0).value(), std::nullopt);
}

TEST(SourceUri, WholeNumbersAreHeldToTheirRange) {
  SourceUri uri = SourceUri::parse("sim:?axes=4&seed=18446744073709551615&n=2.5&m=-1").value();
  EXPECT_EQ(uri.whole("axes", 2, 3).error().message, "axes=4: expected a whole number from 2 to 3");
  EXPECT_EQ(uri.whole("axes", 2, 4).value(), 4U);
  EXPECT_EQ(uri.whole("seed", 0, UINT64_MAX).value(), UINT64_MAX);
  EXPECT_FALSE(uri.whole("n", 0, 9));
  EXPECT_FALSE(uri.whole("m", 0, 9));
  EXPECT_EQ(uri.whole("k", 0, 9).value(), std::nullopt);
}

TEST(HostPort, ReadsBothKindsOfAddress) {
  EXPECT_EQ(parse_host_port("[::1]:8080").value().host, "::1");
  EXPECT_EQ(parse_host_port("[::1]:8080").value().port, 8080);
  EXPECT_EQ(parse_host_port("phone.local").value().port, std::nullopt);
  for (const char* text : {"", ":80", "[::1", "a:0", "a:65536", "a:x", "a:"})
    EXPECT_FALSE(parse_host_port(text)) << text;
}

TEST(OpenSource, NamesTheKindsThereAre) {
  const auto source = open_source("gpib:7");
  ASSERT_FALSE(source);
  EXPECT_EQ(source.error().code, Errc::invalid_argument);
  EXPECT_NE(source.error().message.find("no such kind of source"), std::string::npos);
}

}  // namespace
}  // namespace proofmass::acquire::source_uri_test
