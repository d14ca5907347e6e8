#include <bit>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <iterator>
#include <limits>
#include <random>

#include "proofmass/io/parquet/child.hpp"
#include "proofmass/io/parquet/duckdb_library.hpp"
#include "proofmass/io/parquet/reader.hpp"
#include "proofmass/io/reading/recording_writers.hpp"
#include "proofmass/io/test_support.hpp"
#include "proofmass/io/written_test_support.hpp"

namespace proofmass::io::parquet::parquet_test {
namespace {

/// DuckDB's library if it is installed; else empty.
std::string duckdb_library() {
  if (const char* given = std::getenv("PROOFMASS_DUCKDB_LIB")) return given;
  const auto here = std::filesystem::path(PROOFMASS_SOURCE_DIR) /
                    "tests/readers/node_modules/@duckdb/node-bindings-linux-x64/libduckdb.so";
  return std::filesystem::exists(here) ? here.string() : "";
}

class Parquet : public testing::Test {
 protected:
  void SetUp() override {
    if (duckdb_library().empty())
      GTEST_SKIP() << "no libduckdb.so: set PROOFMASS_DUCKDB_LIB to its path";
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = std::filesystem::temp_directory_path() / ("proofmass_" + std::string(test->name()));
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directory(folder_);
  }
  void TearDown() override {
    if (!folder_.empty()) std::filesystem::remove_all(folder_);
  }

  [[nodiscard]] std::string path() const { return folder_ / "a.parquet"; }
  [[nodiscard]] std::size_t files() const {
    using Entries = std::filesystem::directory_iterator;
    return static_cast<std::size_t>(std::distance(Entries(folder_), Entries()));
  }

  [[nodiscard]] Status write(const Recording& recording, std::size_t rows) const {
    auto file = create_file(path());
    if (!file) return file.error();
    const bool has_stamps = !recording.time.is_uniform();
    WriteOptions options{.metadata = {{"command", "it's one"}}, .duckdb_library = duckdb_library()};
    auto opened = create(std::move(file).value(), {recording, has_stamps}, options);
    if (!opened) return opened.error();
    return write_in_pieces(**opened, recording, rows);
  }

  [[nodiscard]] Result<Recording> read(const std::string& time = {}) const {
    ReadOptions options;
    options.duckdb_library = duckdb_library();
    options.time_channel = time;
    return read_recording(path(), options);
  }

  /// DuckDB's result for a query on the file, its first row.
  [[nodiscard]] std::vector<double> ask(const std::string& what) const {
    const auto database = Duckdb::open(duckdb_library(), "");
    if (!database) return {};
    auto asked = database->query("SELECT " + what + " FROM " + sql_text(path()));
    if (!asked) return {};
    DuckdbRows rows = std::move(asked).value();
    if (const auto count = rows.next(); !count || *count == 0) return {};
    std::vector<double> answer(rows.columns());
    for (std::size_t c = 0; c < answer.size(); ++c) rows.copy(c, std::span(answer).subspan(c, 1));
    return answer;
  }

  /// Creates a file with DuckDB itself.
  void make(const std::string& query) const {
    const auto database = Duckdb::open(duckdb_library(), "");
    ASSERT_TRUE(database) << database.error().message;
    const Status made =
        database->run("COPY (" + query + ") TO " + sql_text(path()) + " (FORMAT parquet)");
    ASSERT_TRUE(made) << made.error().message;
  }

 private:
  std::filesystem::path folder_;
};

Recording troubled(std::size_t samples) {
  Recording recording = troubled_recording(samples, {"Acc", "acc", "it's \"odd\", here", "temp"});
  recording.channels[3].unit = *parse_unit("degC");
  return recording;
}

void expect_same(const Recording& read, const Recording& written) {
  expect_same_recording(read, written);
  EXPECT_EQ(read.time.start_ns, written.time.start_ns);
  EXPECT_EQ(read.labels, written.labels);
  EXPECT_EQ(read.label_channel, written.label_channel);
}

TEST_F(Parquet, ComesBackToTheLastBitHoweverItWasCut) {
  Recording recording = troubled(5000);
  recording.labels = {{"x, up", 0, 7}, {"übrig '", 8, 8}, {"x, up", 90, 4999}};
  recording.label_channel = "part";
  for (const std::size_t rows : {std::size_t{700}, std::size_t{5000}}) {
    const Status written = write(recording, rows);
    ASSERT_TRUE(written) << written.error().message;
    EXPECT_EQ(files(), 1u);
    const auto back = read();
    ASSERT_TRUE(back) << back.error().message;
    EXPECT_EQ(back->format, "Parquet");
    expect_same(recording, *back);
    EXPECT_TRUE(is_noted(*back, "command: it's one")) << notes_of(*back);
  }
}

TEST_F(Parquet, KeepsAnEvenTimeBaseAsARateAndHasItsTimes) {
  for (const auto start_ns : {std::optional<std::int64_t>{}, std::optional<std::int64_t>{-5}}) {
    Recording recording = troubled(100);
    recording.time = {TimeSource::given_rate, "", 100.0 / 3.0, {}, start_ns};
    ASSERT_TRUE(write(recording, 64));
    const auto back = read();
    ASSERT_TRUE(back) << back.error().message;
    expect_same(recording, *back);
    EXPECT_TRUE(back->time.is_uniform());
    EXPECT_EQ(back->time.rate_hz, 100.0 / 3.0);
    EXPECT_EQ(ask("max(time), CAST(count(*) AS DOUBLE)"),
              (std::vector<double>{99.0 / (100.0 / 3.0), 100.0}));
  }
}

TEST_F(Parquet, NeedsNoTimeBase) {
  Recording recording = troubled(100);
  recording.time = {};
  ASSERT_TRUE(write(recording, 64));
  const auto back = read();
  ASSERT_TRUE(back) << back.error().message;
  EXPECT_EQ(back->time.source, TimeSource::none);
  expect_same(recording, *back);
}

TEST_F(Parquet, OfOthersIsReadWithEveryDigitOfItsStamps) {
  make(
      "SELECT make_timestamp_ns(1700000000000000001 + 10000000 * i + i % 3) AS time, "
      "CAST(i AS SMALLINT) AS \"Acc X (g)\", CASE WHEN i % 2 = 0 THEN 0.5 END AS half, "
      "i % 2 = 0 AS even, 'word' AS word, [1, 2] AS list, CAST(i AS DECIMAL(9, 2)) AS d "
      "FROM range(10000) r(i)");
  const auto read_back = read();
  ASSERT_TRUE(read_back) << read_back.error().message;
  ASSERT_EQ(read_back->samples(), 10'000u);
  ASSERT_EQ(read_back->channels.size(), 4u);
  EXPECT_EQ(read_back->time.start_ns, 1'700'000'000'000'000'001);
  for (const std::size_t k : {1u, 5u, 9'999u})
    EXPECT_DOUBLE_EQ(read_back->time.at(k),
                     1e-9 * (1e7 * static_cast<double>(k) + static_cast<double>(k % 3)));
  EXPECT_EQ(read_back->channels[0].name, "Acc X");
  EXPECT_EQ(read_back->channels[0].unit.symbol, "g");
  EXPECT_EQ(read_back->channels[0].values[9'999], 9'999.0);
  EXPECT_EQ(read_back->channels[1].values[4], 0.5);
  EXPECT_TRUE(std::isnan(read_back->channels[1].values[5]));
  EXPECT_EQ(read_back->channels[2].values[4], 1.0);
  EXPECT_EQ(read_back->channels[3].values[77], 77.0);
  EXPECT_TRUE(is_noted(*read_back, "also in the file: word (VARCHAR), list (INTEGER[])"))
      << notes_of(*read_back);
}

TEST_F(Parquet, WithoutNumbersIsRefused) {
  make("SELECT 'word' AS word FROM range(10)");
  const auto refused = read();
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, Errc::too_few_samples);
  EXPECT_NE(refused.error().message.find("it has word (VARCHAR)"), std::string::npos)
      << refused.error().message;
}

TEST_F(Parquet, WhateverIsWrongItIsReadOrRefusedInOneLine) {
  make("SELECT i / 100 AS time, sin(i) AS acc_x FROM range(3000) r(i)");
  std::ifstream file(path(), std::ios::binary);
  const std::string whole(std::istreambuf_iterator<char>(file), {});
  ReadOptions options;
  options.duckdb_library = duckdb_library();
  const auto expect_sound = [&](const std::string& bytes) {
    const auto recording = read_text(bytes, options);
    if (!recording) {
      ASSERT_EQ(recording.error().message.find('\n'), std::string::npos);
      return;
    }
    for (const Channel& channel : recording->channels)
      ASSERT_EQ(channel.values.size(), recording->samples());
  };
  expect_sound(whole);
  for (const std::size_t size : {std::size_t{4}, whole.size() / 2, whole.size() - 1}) {
    expect_sound(whole.substr(0, size));
    EXPECT_FALSE(read_text(whole.substr(0, size), options)) << size;
  }
  unsigned state = 1;  // any sequence, but the same each time
  for (int round = 0; round < 12; ++round) {
    std::string damaged = whole;
    for (int wrong = 0; wrong < 4; ++wrong) {
      state = state * 1664525U + 1013904223U;
      damaged[4 + (state >> 8) % (damaged.size() - 4)] = static_cast<char>(state >> 24);
    }
    expect_sound(damaged);
  }
}

TEST(ParquetWithoutItsLibrary, SaysWhereItWasLookedForAndHowToGetIt) {
  ReadOptions options;
  options.duckdb_library = "/nowhere/libduckdb.so";
  const auto refused = read_text("PAR1PAR1", options);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, Errc::unsupported);
  for (const char* part : {"looked for as /nowhere/libduckdb.so", "duckdb.org",
                           "@duckdb/node-bindings-linux-x64", "PROOFMASS_DUCKDB_LIB"})
    EXPECT_NE(refused.error().message.find(part), std::string::npos) << refused.error().message;
  EXPECT_EQ(refused.error().message.find('\n'), std::string::npos);
}

TEST(Head, ComesBackAsItWasAndBelievesNoLength) {
  Head head;
  head.columns = {{"time", "s", "DOUBLE"}, {"acc", "m/s^2", "FLOAT"}};
  head.rows = 12;
  head.facts = {{"labels", "1 2 x y\n3 3 z\n"}, {"key", "two\nlines"}};
  head.stamps = 0;
  head.origin = -7;
  const std::string whole = encode(head);
  EXPECT_EQ(head_bytes(whole), whole.size());
  const auto back = decode(whole);
  ASSERT_TRUE(back) << back.error().message;
  EXPECT_EQ(back->columns[1].unit, "m/s^2");
  EXPECT_EQ(back->rows, 12u);
  EXPECT_EQ(back->fact("key"), "two\nlines");
  EXPECT_EQ(back->labels(), (std::vector<Label>{{"x y", 1, 2}, {"z", 3, 3}}));
  EXPECT_EQ(back->stamps, 0u);
  EXPECT_EQ(back->origin, -7);
  for (std::size_t size = 0; size < whole.size(); ++size)
    EXPECT_FALSE(decode(std::string_view(whole).substr(0, size))) << size;
  for (std::size_t byte = 0; byte < whole.size(); ++byte)
    for (const char value : {'\x01', '\x7F', '\xFF'}) {
      std::string changed = whole;
      changed[byte] = value;
      if (const auto read = decode(changed)) (void)read->labels();
    }
}

}  // namespace
}  // namespace proofmass::io::parquet::parquet_test
