#include "proofmass/serve/http/gate.hpp"

#include <gtest/gtest.h>
#include <set>

namespace proofmass::serve::gate_test {
namespace {

const std::string token = "0123456789abcdef0123456789abcdef";
const Gate loopback{token, "127.0.0.1", 8080};

RequestHead asked(std::string target, std::string host = "127.0.0.1:8080") {
  return {.method = "GET", .target = std::move(target), .host = std::move(host)};
}

unsigned status_of(const std::optional<Response>& refused) {
  return refused ? refused->status : 0U;
}

TEST(Gate, LetsInWhoNamesTheHostAndHasTheToken) {
  EXPECT_FALSE(refusal(loopback, asked("/api/info?token=" + token)));
  EXPECT_FALSE(refusal(loopback, asked("/?a=1&token=" + token, "localhost:8080")));
  RequestHead head = asked("/api/info");
  head.authorization = "Bearer " + token;
  head.origin = "http://127.0.0.1:8080";
  EXPECT_FALSE(refusal(loopback, head));
}

TEST(Gate, RefusesAnotherHostWith421EvenWithTheToken) {
  for (const char* host : {"evil.example:8080", "127.0.0.1", "127.0.0.1:81", "127.0.0.2:8080", "",
                           "127.0.0.1:8080, 127.0.0.1:8080", "[::1]:8080", "127.1:8080"})
    EXPECT_EQ(status_of(refusal(loopback, asked("/?token=" + token, host))), 421U) << host;
  RequestHead head = asked("/?token=" + token);
  head.host.reset();
  EXPECT_EQ(status_of(refusal(loopback, head)), 421U);
}

TEST(Gate, RefusesAForeignOriginWith403EvenWithTheToken) {
  for (const char* origin :
       {"http://evil.example", "null", "https://127.0.0.1:8080", "http://127.0.0.1:81", ""}) {
    RequestHead head = asked("/?token=" + token);
    head.origin = origin;
    EXPECT_EQ(status_of(refusal(loopback, head)), 403U) << origin;
  }
}

TEST(Gate, RefusesEveryOtherTokenWith403) {
  std::string one_off = token;
  one_off.back() = 'e';
  for (const std::string& other :
       {std::string(), one_off, token + "0", token.substr(1), token + token})
    EXPECT_EQ(status_of(refusal(loopback, asked("/api/info?token=" + other))), 403U) << other;
  EXPECT_EQ(status_of(refusal(loopback, asked("/api/info"))), 403U);
  RequestHead head = asked("/api/info");
  head.authorization = "Basic " + token;
  EXPECT_EQ(status_of(refusal(loopback, head)), 403U);
}

TEST(Gate, LetsNobodyInWhereThereIsNoToken) {
  EXPECT_EQ(status_of(refusal({"", "127.0.0.1", 8080}, asked("/?token="))), 403U);
}

TEST(Gate, RefusesUnknownMethodsWith405) {
  RequestHead head = asked("/?token=" + token);
  for (const char* method : {"OPTIONS", "TRACE", "CONNECT", "HEAD", "get"}) {
    head.method = method;
    EXPECT_EQ(status_of(refusal(loopback, head)), 405U) << method;
  }
}

TEST(Gate, OnAllAddressesTakesAnyAddressButNoName) {
  const Gate open{token, "0.0.0.0", 8080};
  EXPECT_TRUE(is_our_host(open, "192.168.1.7:8080"));
  EXPECT_TRUE(is_our_host(open, "[fe80::1]:8080"));
  EXPECT_TRUE(is_our_host(open, "LocalHost:8080"));
  EXPECT_FALSE(is_our_host(open, "rebound.example:8080"));
}

TEST(Gate, KnowsLoopbackAddresses) {
  EXPECT_TRUE(is_loopback("127.0.0.1"));
  EXPECT_TRUE(is_loopback("127.9.9.9"));
  EXPECT_TRUE(is_loopback("::1"));
  EXPECT_FALSE(is_loopback("0.0.0.0"));
  EXPECT_FALSE(is_loopback("192.168.1.7"));
  EXPECT_TRUE(is_our_host({token, "::1", 80}, "[::1]"));
}

TEST(Gate, TokensAre128BitsAndDiffer) {
  std::set<std::string> tokens;
  for (int k = 0; k < 100; ++k) {
    const std::string one = random_token().value();
    EXPECT_EQ(one.size(), 32U);
    EXPECT_EQ(one.find_first_not_of("0123456789abcdef"), std::string::npos);
    tokens.insert(one);
  }
  EXPECT_EQ(tokens.size(), 100U);
}

TEST(Target, IsDecodedOnce) {
  const Target target = parse_target("/api/view?file=a%20b%2Fc.csv&x&y=%2525#z").value();
  EXPECT_EQ(target.path, "/api/view");
  EXPECT_EQ(target.find("file"), "a b/c.csv");
  EXPECT_EQ(target.find("x"), "");
  EXPECT_EQ(target.find("y"), "%25");
  EXPECT_FALSE(target.find("z"));
}

TEST(Target, RefusesBrokenEscapesControlCharactersAndForeignForms) {
  for (const char* text : {"", "*", "http://127.0.0.1/", "/%", "/%4", "/%zz", "/a%00b", "/?a=%0a",
                           "/%ff", "/%c0%af", "/%ed%a0%80", "/%f4%90%80%80"})
    EXPECT_FALSE(parse_target(text)) << text;
  EXPECT_FALSE(parse_target("/" + std::string(most_target_bytes, 'a')));
  EXPECT_TRUE(parse_target("/%c3%a9%e2%82%ac%f0%9f%98%80"));
}

}  // namespace
}  // namespace proofmass::serve::gate_test
