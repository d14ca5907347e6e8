#include "proofmass/fleet/manifest.hpp"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>

#include "proofmass/io/parquet/table.hpp"

namespace proofmass::fleet::manifest_test {
namespace {

namespace fs = std::filesystem;

class Manifest : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() /
              ("proofmass_manifest_" +
               std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }
  std::string write(const std::string& name, const std::string& text) const {
    fs::create_directories((folder_ / name).parent_path());
    std::ofstream(folder_ / name) << text;
    return folder_ / name;
  }
  fs::path folder_;
};

TEST_F(Manifest, OfCsvHoldsPathsFlagsAndFreeColumns) {
  const auto jobs = read_manifest(
      write("m.csv",
            "path;sensor;flags;note\na.csv;S1;--rate 100 --channel 'acc x';\"one; \"\"two\"\"\"\n"
            "/b.csv;S2;;\r\ns3://bucket/c.csv;S3;;\n"),
      "");
  ASSERT_TRUE(jobs) << jobs.error().message;
  ASSERT_EQ(jobs->size(), 3U);
  EXPECT_EQ((*jobs)[0].path, folder_ / "a.csv");
  EXPECT_EQ((*jobs)[0].flags, (std::vector<std::string>{"--rate", "100", "--channel", "acc x"}));
  EXPECT_EQ((*jobs)[0].columns, (ManifestFields{{"sensor", "S1"}, {"note", "one; \"two\""}}));
  EXPECT_EQ((*jobs)[1].path, "/b.csv");
  EXPECT_EQ((*jobs)[2].path, "s3://bucket/c.csv");
}

TEST_F(Manifest, OfNdjsonTakesFieldsThatSomeLinesLack) {
  const auto jobs = read_manifest(write("m.ndjson",
                                        "{\"file\": \"a.csv\", \"temperature\": 21.5}\n\n"
                                        "{\"sensor\": \"S2\", \"file\": \"b.csv\"}\n"),
                                  "");
  ASSERT_TRUE(jobs) << jobs.error().message;
  EXPECT_EQ(manifest_field((*jobs)[0].columns, "temperature"), "21.5");
  EXPECT_EQ(manifest_field((*jobs)[1].columns, "sensor"), "S2");
  EXPECT_EQ(manifest_field((*jobs)[1].columns, "temperature"), "");
}

TEST_F(Manifest, OfParquetIsReadAsTheSameTable) {
  const char* given = std::getenv("PROOFMASS_DUCKDB_LIB");
  const auto here = fs::path(PROOFMASS_SOURCE_DIR) /
                    "tests/readers/node_modules/@duckdb/node-bindings-linux-x64/libduckdb.so";
  const std::string library = given != nullptr ? given : fs::exists(here) ? here.string() : "";
  if (library.empty()) GTEST_SKIP() << "no libduckdb.so: set PROOFMASS_DUCKDB_LIB to its path";
  const std::string path = folder_ / "m.parquet";
  auto created = io::parquet::TableWriter::create(path, {{"path", true}, {"temperature", false}});
  ASSERT_TRUE(created);
  io::parquet::TableWriter table = std::move(created).value();
  ASSERT_TRUE(table.add({{std::string("a.csv")}, {21.5}}));
  ASSERT_TRUE(table.finish());
  const auto jobs = read_manifest(path, library);
  ASSERT_TRUE(jobs) << jobs.error().message;
  EXPECT_EQ((*jobs)[0].path, folder_ / "a.csv");
  EXPECT_EQ(manifest_field((*jobs)[0].columns, "temperature"), "21.5");
}

TEST_F(Manifest, OfAFolderHoldsItsRecordingsAndNotWhatLiesBeside) {
  for (const char* name : {"b.csv", "sub/a.tdms", "b.truth.csv", "b.json", "manifest.csv",
                           ".hidden.csv", ".git/c.csv", "sensor.toml"})
    write(name, "x");
  write("results/journal.ndjson", "");
  write("results/results.parquet", "");
  const auto jobs = read_manifest(folder_, "");
  ASSERT_TRUE(jobs);
  ASSERT_EQ(jobs->size(), 2U);
  EXPECT_EQ((*jobs)[0].path, folder_ / "b.csv");
  EXPECT_EQ((*jobs)[1].path, folder_ / "sub/a.tdms");
}

TEST_F(Manifest, SaysWhatIsWrongWithIt) {
  const auto error = [&](const std::string& name, const std::string& text) {
    const auto jobs = read_manifest(write(name, text), "");
    return jobs ? std::string() : jobs.error().message;
  };
  EXPECT_NE(error("a.csv", "name,sensor\nx,S1\n").find("has no column path"), std::string::npos);
  EXPECT_NE(error("b.csv", "path,sensor\nx\n").find("row 1: 1 fields, but the head has 2"),
            std::string::npos);
  EXPECT_NE(error("c.csv", "path\nx\nx\n").find("row 2"), std::string::npos);
  EXPECT_NE(error("d.csv", "path\n").find("lists no recording"), std::string::npos);
  EXPECT_NE(error("e.ndjson", "{\"path\": \"a\"}\nno\n").find("line 2"), std::string::npos);
  EXPECT_NE(error("f.csv", "path,flags\nx,--channel 'a\n").find("is not closed"),
            std::string::npos);
}

TEST(MergedFlags, AreTheCommonOnesLessThoseThatTheRecordingHasItself) {
  EXPECT_EQ(merged_flags({"--rate", "100", "--unit=g", "--from", "-5"}, {"--rate=50"}),
            (std::vector<std::string>{"--unit=g", "--from", "-5", "--rate=50"}));
}

TEST(ShardOf, DividesAllJobsAmongTheShards) {
  std::vector<Job> jobs;
  for (int k = 0; k < 10; ++k) jobs.push_back({std::to_string(k), {}, {}});
  std::vector<std::string> seen;
  for (std::size_t i = 0; i < 4; ++i)
    for (const Job& job : shard_of(jobs, i, 4)) seen.push_back(job.path);
  std::ranges::sort(seen);
  EXPECT_EQ(seen, (std::vector<std::string>{"0", "1", "2", "3", "4", "5", "6", "7", "8", "9"}));
}

TEST(DayOf, CountsDaysSince1970) {
  EXPECT_EQ(day_of("1970-01-02"), 1.0);
  EXPECT_EQ(day_of("2000-03-01"), 11017.0);
  EXPECT_EQ(day_of("1970-01-01T12:00:00Z"), 0.5);
  EXPECT_EQ(day_of("1970-01-02T00:00:13.5"), 1.0 + 13.5 / 86400.0);
  EXPECT_EQ(day_of("1970-01-01T12:00:00-06:00"), 0.75);
  EXPECT_EQ(day_of("1970-01-01T12:00+06"), 0.25);
  for (const char* bad : {"", "yesterday", "2026-13-01", "01.02.2026"})
    EXPECT_FALSE(day_of(bad)) << bad;
}

Job dated(const char* path, const char* sensor, const char* date) {
  return {.path = path,
          .flags = {},
          .columns = {{"sensor", sensor}, {"date", date}, {"batch", "7"}, {"note", path}}};
}

TEST(GroupedBy, OrdersTheRecordingsOfASensorByDate) {
  const auto groups = grouped_by(
      {dated("c", "S1", "2026-01-01T02:00:00Z"), dated("x", "S0", "2026-01-01T00:00:00Z"),
       dated("a", "S1", "2026-01-01T00:00:00Z"), dated("b", "S1", "2026-01-01T01:00:00.5Z")},
      "sensor");
  ASSERT_TRUE(groups);
  ASSERT_EQ(groups->size(), 2U);
  const Job& job = (*groups)[1];
  EXPECT_EQ(job.path, "S1");
  EXPECT_EQ(job.parts, (std::vector<std::string>{"a", "b", "c"}));
  EXPECT_EQ(job.starts_s, (std::vector<double>{0.0, 3600.5, 7200.0}));
  EXPECT_EQ(job.columns,
            (ManifestFields{{"sensor", "S1"}, {"date", "2026-01-01T00:00:00Z"}, {"batch", "7"}}));
}

TEST(GroupedBy, KnowsNoStartsByDatesWithoutATimeOfDay) {
  const auto groups =
      grouped_by({dated("a", "S1", "2026-01-01"), dated("b", "S1", "2026-01-02")}, "sensor");
  ASSERT_TRUE(groups);
  EXPECT_TRUE((*groups)[0].starts_s.empty());
}

TEST(GroupedBy, RefusesRecordingsWithoutAValueOrWithDifferentFlags) {
  EXPECT_FALSE(grouped_by({dated("a", "", "2026-01-01")}, "sensor"));
  EXPECT_FALSE(grouped_by({dated("a", "S1", "2026-01-01")}, "serial"));
  Job other = dated("b", "S1", "2026-01-02");
  other.flags = {"--rate", "50"};
  const auto groups = grouped_by({dated("a", "S1", "2026-01-01"), other}, "sensor");
  ASSERT_FALSE(groups);
  EXPECT_EQ(groups.error().message, "a and b are of sensor S1, and have different flags");
}

}  // namespace
}  // namespace proofmass::fleet::manifest_test
