#include "proofmass/fleet/results.hpp"

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <iterator>

namespace proofmass::fleet::results_test {
namespace {

namespace fs = std::filesystem;

Entry entry(const std::string& path, double white, double ended_s) {
  Entry one;
  one.verb = "noise";
  one.path = path;
  one.flags = {"--rate", "100"};
  one.columns = {{"sensor", "S1"}, {"serial", "0012"}, {"temperature", "21.5"}};
  one.ended_s = ended_s;
  one.document = "documents/" + path + ".json";
  one.rows = {{{"channel", std::string("x")}, {"white", white}}};
  return one;
}

class ResultsFolder : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() /
              ("proofmass_results_" +
               std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));
    fs::remove_all(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }
  [[nodiscard]] std::string text(const char* name) const {
    std::ifstream file(folder_ / name, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }
  void add(const std::vector<Entry>& entries, const Shard& shard = {}) const {
    auto opened = Results::open(folder_, shard);
    ASSERT_TRUE(opened) << opened.error().message;
    Results results = std::move(opened).value();
    for (const Entry& one : entries) ASSERT_TRUE(results.append(one));
  }
  [[nodiscard]] std::vector<double> whites() const {
    std::vector<double> found;
    const auto results = Results::read(folder_);
    if (!results) return found;
    const Status read = results->visit([&](const Entry& one) -> Status {
      found.push_back(std::get<double>(one.rows[0][1].second));
      return Done{};
    });
    EXPECT_TRUE(read);
    return found;
  }
  fs::path folder_;
};

TEST_F(ResultsFolder, KeepsOfSeveralResultsForARecordingTheLast) {
  add({entry("b.csv", 1.0, 10.0), entry("a.csv", 2.0, 11.0), entry("b.csv", 3.0, 12.0)});
  EXPECT_EQ(whites(), (std::vector<double>{2.0, 3.0}));
}

TEST_F(ResultsFolder, PassesOverALineThatAKillLeftUnfinished) {
  add({entry("a.csv", 1.0, 10.0)});
  const std::string whole = text("journal.ndjson");
  for (const std::size_t length : {1UL, 20UL, whole.size() - 1}) {
    std::ofstream(folder_ / "journal.ndjson", std::ios::binary) << whole << whole.substr(0, length);
    EXPECT_EQ(whites(), (std::vector<double>{1.0})) << length;
    add({entry("c.csv", 2.0, 11.0)});
    EXPECT_EQ(whites(), (std::vector<double>{1.0, 2.0})) << length;
  }
}

TEST_F(ResultsFolder, GathersTheShards) {
  add({entry("a.csv", 1.0, 10.0)}, {0, 2});
  add({entry("b.csv", 2.0, 10.0)}, {1, 2});
  EXPECT_EQ(whites(), (std::vector<double>{1.0, 2.0}));
}

TEST_F(ResultsFolder, IsAddedToByOneProcessOnly) {
  const auto first = Results::open(folder_, {});
  ASSERT_TRUE(first);
  const auto second = Results::open(folder_, {});
  ASSERT_FALSE(second);
  EXPECT_NE(second.error().message.find("another process adds to it"), std::string::npos);
  EXPECT_TRUE(Results::open(folder_, {0, 2}));
}

TEST_F(ResultsFolder, GivesBackAnEntryAsItWas) {
  Entry one = entry("ä \"b\".csv", 0.1, 1.5);
  one.own_flags = {"--channel", "acc x"};
  one.inputs = {{"ä \"b\".csv", "00ff"}};
  one.failure = "no\nrow";
  one.is_lasting = true;
  add({one});
  const auto results = Results::read(folder_);
  ASSERT_TRUE(results);
  const auto found = results->find(one.id());
  ASSERT_TRUE(found);
  EXPECT_EQ(found->path, one.path);
  EXPECT_EQ(found->own_flags, one.own_flags);
  EXPECT_EQ(found->columns, one.columns);
  EXPECT_EQ(found->inputs[0].sha256, "00ff");
  EXPECT_EQ(found->failure, one.failure);
  EXPECT_TRUE(found->is_lasting);
  EXPECT_EQ(found->rows, one.rows);
}

TEST_F(ResultsFolder, MakesTablesThatOthersRead) {
  const char* given = std::getenv("PROOFMASS_DUCKDB_LIB");
  const auto here = fs::path(PROOFMASS_SOURCE_DIR) /
                    "tests/readers/node_modules/@duckdb/node-bindings-linux-x64/libduckdb.so";
  const std::string library = given != nullptr ? given : fs::exists(here) ? here.string() : "";
  Entry failed = entry("c.csv", 0.0, 3.0);
  failed.rows.clear();
  failed.failure = "is broken";
  add({entry("b.csv", 2.0, 1.0), failed, entry("a.csv", 1.0, 2.0)});
  ASSERT_TRUE(write_tables(folder_));
  EXPECT_EQ(text("failures.ndjson"),
            "{\"file\":\"c.csv\",\"reason\":\"is broken\",\"verb\":\"noise\",\"flags\":[\"--rate\","
            "\"100\"],\"sensor\":\"S1\",\"serial\":\"0012\",\"temperature\":\"21.5\"}\n");
  if (library.empty()) GTEST_SKIP() << "no libduckdb.so: set PROOFMASS_DUCKDB_LIB to its path";
  const auto csv = io::parquet::as_csv((folder_ / "results.parquet").string(), library);
  ASSERT_TRUE(csv) << csv.error().message;
  EXPECT_EQ(
      *csv,
      "\"file\",\"sensor\",\"serial\",\"temperature\",\"verb\",\"channel\",\"white\",\"flags\","
      "\"document\"\n"
      "\"a.csv\",\"S1\",\"0012\",\"21.5\",\"noise\",\"x\",\"1.0\",\"--rate 100\","
      "\"documents/a.csv.json\"\n"
      "\"b.csv\",\"S1\",\"0012\",\"21.5\",\"noise\",\"x\",\"2.0\",\"--rate 100\","
      "\"documents/b.csv.json\"\n");
}

TEST_F(ResultsFolder, IsRefusedWhereThereIsNone) {
  const auto results = Results::read(folder_);
  ASSERT_FALSE(results);
  EXPECT_NE(results.error().message.find("holds no results of a fleet"), std::string::npos);
}

TEST(DocumentStem, DiffersWithThePathAndTheFlags) {
  const std::string stem = document_stem({"x/a.csv", {}, {}});
  EXPECT_TRUE(stem.starts_with("a.csv-"));
  EXPECT_NE(stem, document_stem({"y/a.csv", {}, {}}));
  EXPECT_NE(stem, document_stem({"x/a.csv", {"--rate", "1"}, {}}));
  EXPECT_EQ(stem, document_stem({"x/a.csv", {}, {{"sensor", "S1"}}}));
}

}  // namespace
}  // namespace proofmass::fleet::results_test
