#include "proofmass/serve/bench.hpp"

#include <chrono>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <thread>

#include "proofmass/serve/temporary.hpp"

namespace proofmass::serve::bench_test {
namespace {

using namespace std::chrono_literals;
using nlohmann::json;

/// Stands in for the program: writes what it was called with as its result; crashes, waits or fails
/// where the file's name says so.
constexpr const char* program = R"sh(#!/bin/sh
case "$2" in
  *crash*) kill -SEGV $$ ;;
  *wait*) echo "progress 40 waiting" >&2; sleep 60 ;;
  *fail*) echo "proofmass: $2: line 3: no number" >&2; exit 3 ;;
esac
for word in "$@"; do
  case "$word" in --json=*) printf '{"called": "%s"}' "$*" >"${word#--json=}" ;; esac
done
)sh";

class BenchTest : public testing::Test {
 protected:
  void SetUp() override {
    std::filesystem::create_directory(home_.path() + "/served");
    std::filesystem::create_directory(home_.path() + "/work");
    for (const char* name : {"a.csv", "crash.csv", "wait.csv", "fail.csv"})
      std::ofstream(home_.path() + "/served/" + name) << "1\n";
    std::ofstream(home_.path() + "/secret.csv") << "1\n";
    std::ofstream(home_.path() + "/program") << program;
    std::filesystem::permissions(home_.path() + "/program", std::filesystem::perms::owner_all);
    bench_ = std::make_unique<Bench>(BenchOptions{
        .folder = Folder::open(home_.path() + "/served").value(),
        .program = home_.path() + "/program",
        .environment = {"PATH=/usr/bin:/bin"},
        .work_folder = home_.path() + "/work",
        .verbs_json = R"({"verbs": [{"name": "noise", "options": [{"name": "rate"}]}]})"});
  }
  Response ask(const std::string& method, const std::string& target, const std::string& body = {}) {
    return bench_->answer({method, parse_target(target).value(), body});
  }
  std::uint64_t begin(const std::string& file) {
    const Response response =
        ask("POST", "/api/analyses", fmt::format(R"({{"verb": "noise", "files": ["{}"]}})", file));
    EXPECT_EQ(response.status, 201U) << response.body;
    return json::parse(response.body).value("id", std::uint64_t{0});
  }
  json state_of(std::uint64_t id) {
    return json::parse(ask("GET", fmt::format("/api/analyses/{}", id)).body);
  }
  json ended(std::uint64_t id) {
    for (int k = 0; k < 6000; ++k) {
      const json state = state_of(id);
      if (state["state"] != "waiting" && state["state"] != "running") return state;
      std::this_thread::sleep_for(10ms);
    }
    return {};
  }

  TemporaryFolder home_ = TemporaryFolder::make(testing::TempDir()).value();
  std::unique_ptr<Bench> bench_;
};

TEST_F(BenchTest, RunsTheProgramAndHandsOutItsResult) {
  const json state = ended(begin("a.csv"));
  EXPECT_EQ(state["state"], "done");
  EXPECT_EQ(state["command"], "proofmass noise a.csv");
  EXPECT_EQ(state["files_made"], json::array({"result.json"}));
  const Response result = ask("GET", "/api/analyses/1/result.json");
  EXPECT_EQ(result.status, 200U);
  EXPECT_TRUE(json::parse(result.body).value("called", "").starts_with("noise a.csv --json="));
}

TEST_F(BenchTest, SaysWhyARunFailed) {
  EXPECT_EQ(ended(begin("fail.csv"))["error"], "fail.csv: line 3: no number");
  EXPECT_EQ(ended(begin("crash.csv"))["error"], "it crashed: Segmentation fault (signal 11)");
  EXPECT_EQ(ended(begin("a.csv"))["state"], "done");
}

TEST_F(BenchTest, ShowsProgressAndCancels) {
  const std::uint64_t id = begin("wait.csv");
  for (int k = 0; k < 6000 && state_of(id)["fraction"] != 0.4; ++k)
    std::this_thread::sleep_for(10ms);
  EXPECT_EQ(state_of(id)["stage"], "waiting");
  EXPECT_EQ(ask("DELETE", fmt::format("/api/analyses/{}", id)).status, 200U);
  EXPECT_EQ(ended(id)["state"], "cancelled");
}

TEST_F(BenchTest, NoFileOutsideTheFolderIsReached) {
  for (const char* route : {"/api/recording", "/api/view"})
    for (const char* file : {"../secret.csv", "%2Fetc%2Fpasswd", "..%2Fsecret.csv", ""})
      EXPECT_EQ(ask("GET", fmt::format("{}?file={}", route, file)).status, 404U) << file;
  EXPECT_EQ(ask("POST", "/api/analyses", R"({"verb": "noise", "files": ["../secret.csv"]})").status,
            400U);
  (void)ended(begin("a.csv"));
  for (const char* name :
       {"../../secret.csv", "..%2F..%2Fsecret.csv", "", "other.json", "page.json"})
    EXPECT_EQ(ask("GET", fmt::format("/api/analyses/1/{}", name)).status, 404U) << name;
}

TEST_F(BenchTest, UnknownThingsAre404AndBadOnes400) {
  EXPECT_EQ(ask("GET", "/api/nothing").status, 404U);
  EXPECT_EQ(ask("POST", "/api/recordings").status, 404U);
  EXPECT_EQ(ask("GET", "/api/analyses/7").status, 404U);
  EXPECT_EQ(ask("POST", "/api/analyses", "no json").status, 400U);
  EXPECT_EQ(ask("POST", "/api/analyses", "[]").status, 400U);
  for (const char* query : {"from=1&to=1&pixels=9", "from=a&to=2&pixels=9", "from=0&to=1&pixels=0",
                            "from=0&to=1&pixels=1e9", "from=nan&to=1&pixels=9"})
    EXPECT_EQ(ask("GET", fmt::format("/api/view/window?file=a.csv&{}", query)).status, 400U)
        << query;
}

TEST_F(BenchTest, AnUploadNeverReplacesAFile) {
  const std::string part = home_.path() + "/served/.part";
  std::ofstream(part) << "22\n";
  const Response response =
      bench_->answer({"PUT", parse_target("/api/files/a.csv").value(), "", part});
  EXPECT_EQ(response.status, 201U);
  EXPECT_EQ(json::parse(response.body)["name"], "a-2.csv");
  EXPECT_EQ(std::filesystem::file_size(home_.path() + "/served/a.csv"), 2U);
  EXPECT_EQ(bench_->answer({"PUT", parse_target("/api/files/..%2Fa.csv").value(), "", part}).status,
            400U);
}

TEST_F(BenchTest, ListsRecordingsAndSensorFiles) {
  std::ofstream(home_.path() + "/served/s.toml") << "\n";
  const json list = json::parse(ask("GET", "/api/recordings").body);
  EXPECT_EQ(list["recordings"].size(), 4U);
  EXPECT_EQ(list["recordings"][0]["name"], "a.csv");
  EXPECT_EQ(list["sensor_files"], json::array({"s.toml"}));
}

}  // namespace
}  // namespace proofmass::serve::bench_test
