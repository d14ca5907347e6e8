#include "proofmass/serve/live/arguments.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>

#include "proofmass/serve/live/request.hpp"
#include "proofmass/serve/temporary.hpp"

namespace proofmass::serve::live_arguments_test {
namespace {

using nlohmann::json;

class LiveArgumentsTest : public testing::Test {
 protected:
  void SetUp() override {
    std::filesystem::create_directory(place_.path() + "/served");
    std::ofstream(place_.path() + "/served/run.mcap") << "x";
    std::ofstream(place_.path() + "/outside.csv") << "x";
    std::filesystem::create_symlink("/nowhere", place_.path() + "/served/dangling.mcap");
  }
  [[nodiscard]] Result<LiveArguments> of(const json& asked) const {
    return live_arguments(asked, Folder::open(place_.path() + "/served").value());
  }
  [[nodiscard]] bool is_refused(const json& asked) const { return !of(asked); }

  TemporaryFolder place_ = TemporaryFolder::make(testing::TempDir()).value();
};

bool has(const LiveArguments& found, const std::string& word) {
  return std::ranges::find(found.arguments, word) != found.arguments.end();
}

TEST_F(LiveArgumentsTest, AFileIsNewAndWithinTheFolder) {
  const auto found =
      of({{"source", "sim:wheel"}, {"file", "new"}, {"options", {{"estimate", "wheel"}}}});
  ASSERT_TRUE(found);
  EXPECT_EQ(found->file, "new.mcap");
  EXPECT_TRUE(has(*found, "--output=new.mcap"));
  EXPECT_TRUE(has(*found, "--estimate=wheel"));
  for (const char* name : {"run.mcap", "run", "../new.mcap", "/tmp/new.mcap", "a/b.mcap", ".x.mcap",
                           "-x.mcap", "a\nb.mcap", "dangling.mcap", "\xff.mcap"})
    EXPECT_TRUE(is_refused({{"source", "sim:wheel"}, {"file", name}})) << name;
  EXPECT_TRUE(is_refused({{"source", "sim:wheel"}, {"file", std::string(300, 'x')}}));
  EXPECT_TRUE(is_refused({{"source", "sim:wheel"}, {"file", 3}}));
}

TEST_F(LiveArgumentsTest, WithoutAFileNothingIsRecorded) {
  EXPECT_TRUE(has(of({{"source", "sim:wheel"}}).value(), "--no-file"));
  EXPECT_TRUE(has(of({{"source", "sim:wheel"}, {"file", nullptr}}).value(), "--no-file"));
  const auto named = of({{"source", "sim:wheel"}, {"file", ""}});
  ASSERT_TRUE(named);
  EXPECT_TRUE(named->file.starts_with("sim-20") && named->file.ends_with(".mcap")) << named->file;
}

TEST_F(LiveArgumentsTest, NoSourceLeadsOutOfTheFolderOrIsAFlag) {
  EXPECT_TRUE(of({{"source", "replay:run.mcap?speed=max"}}));
  for (const char* source :
       {"", "-", "--list", "stdin:", "wheel", "replay:../outside.csv", "replay:/etc/passwd",
        "replay:%2e%2e/outside.csv", "replay:none.csv", "sim:wheel?file=/etc/passwd",
        "sim:wheel?%66ile=/etc/passwd", "sim:a\nb"})
    EXPECT_TRUE(is_refused({{"source", source}})) << source;
  EXPECT_TRUE(is_refused({{"source", std::string(2000, ':')}}));
}

TEST_F(LiveArgumentsTest, OnlyKnownOptionsAreTaken) {
  EXPECT_TRUE(of({{"source", "sim:"}, {"options", {{"rate", 500}, {"unit", "g"}}}}));
  for (const json& options :
       {json{{"output", "x.mcap"}}, json{{"config", "/etc/passwd"}}, json{{"rate", true}},
        json{{"unit", ""}}, json{{"sensor", "../s.toml"}}, json::array({1})})
    EXPECT_TRUE(is_refused({{"source", "sim:"}, {"options", options}})) << options;
  EXPECT_TRUE(is_refused(json::array()));
  EXPECT_TRUE(is_refused({{"file", "a.mcap"}}));
}

TEST_F(LiveArgumentsTest, EstimatesAreSentToThisMachineOnly) {
  const auto to = [](const char* address) {
    return json{{"source", "sim:wheel"},
                {"options", {{"estimate", "wheel"}, {"send-to", address}}}};
  };
  EXPECT_TRUE(has(of(to("udp:127.0.0.1:5005")).value(), "--send-to=udp:127.0.0.1:5005"));
  EXPECT_TRUE(of(to("udp:localhost:5005")));
  for (const char* address : {"udp:192.168.0.7:5005", "udp:127.0.0.1:", "udp:127.0.0.1:5005:x",
                              "udp:127.0.0.1.example.org:5", "unix:/dev/log", "5005"})
    EXPECT_TRUE(is_refused(to(address))) << address;
}

TEST_F(LiveArgumentsTest, AProcedureEndsWithNewFilesBesideItsRecording) {
  const json procedure{{"procedure", "multi-position"}};
  const auto found =
      of({{"source", "sim:multi-position"}, {"file", "c.mcap"}, {"options", procedure}});
  ASSERT_TRUE(found);
  EXPECT_TRUE(has(*found, "--update-sensor=c.toml"));
  EXPECT_TRUE(has(*found, "--report=c.html"));
  EXPECT_TRUE(is_refused({{"source", "sim:multi-position"}, {"options", procedure}}));
  std::ofstream(place_.path() + "/served/c.toml") << "x";
  EXPECT_TRUE(is_refused({{"source", "sim:"}, {"file", "c.mcap"}, {"options", procedure}}));
}

TEST(LiveRequest, IsOneNumberOrNull) {
  EXPECT_EQ(parse_live_request(R"({"watch": 7})").value().watch, 7U);
  EXPECT_EQ(parse_live_request(R"({"watch": null})").value().watch, 0U);
  for (const char* message :
       {"", "{}", "[]", "null", "7", R"({"watch": 0})", R"({"watch": -1})", R"({"watch": 1.5})",
        R"({"watch": "7"})", R"({"watch": [7]})", R"({"watch": 7, "stop": true})", R"({"stop": 7})",
        R"({"watch": 7)", R"({"watch": 99999999999999999999999})", "\xff\xfe"})
    EXPECT_FALSE(parse_live_request(message)) << message;
  EXPECT_FALSE(parse_live_request(R"({"watch": 7})" + std::string(5000, ' ')));
  EXPECT_FALSE(parse_live_request(std::string(4000, '[')));
}

TEST(LiveFrame, HasTheKindOfItsKeyAndRefusesWhatIsNoJson) {
  EXPECT_EQ(frame_of(R"({"rows":{"t":[]}})")->kind, "rows");
  EXPECT_TRUE(frame_of(R"({"rows":{}})")->may_be_left_out);
  EXPECT_FALSE(frame_of(R"({"event":{}})")->may_be_left_out);
  for (const char* line : {"", "{", "{\"", "{\"rows\":", "rows", "{\"rows\":1}}"})
    EXPECT_EQ(frame_of(line), nullptr) << line;
}

}  // namespace
}  // namespace proofmass::serve::live_arguments_test
