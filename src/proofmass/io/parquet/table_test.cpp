#include "proofmass/io/parquet/table.hpp"

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <iterator>
#include <limits>

namespace proofmass::io::parquet::table_test {
namespace {

namespace fs = std::filesystem;

std::string library() {
  if (const char* given = std::getenv("PROOFMASS_DUCKDB_LIB")) return given;
  const auto here = fs::path(PROOFMASS_SOURCE_DIR) /
                    "tests/readers/node_modules/@duckdb/node-bindings-linux-x64/libduckdb.so";
  return fs::exists(here) ? here.string() : "";
}

class Tables : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() /
              ("proofmass_table_" +
               std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));
    fs::remove_all(folder_);
    fs::create_directory(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }
  [[nodiscard]] std::string path() const { return folder_ / "a.parquet"; }

  fs::path folder_;
};

TEST_F(Tables, AreReadByDuckdbAsTheyWereWritten) {
  if (library().empty()) GTEST_SKIP() << "no libduckdb.so: set PROOFMASS_DUCKDB_LIB to its path";
  auto created = TableWriter::create(path(), {{"file", true}, {"white", false}});
  ASSERT_TRUE(created);
  TableWriter writer = std::move(created).value();
  ASSERT_TRUE(writer.add({{std::string("a \"b\".csv"), std::monostate{}, 2.5},
                          {0.1, std::nan(""), std::string("no figure")}}));
  std::vector<TableCell> texts(20, std::string("µ")), figures(20, -1e-300);
  ASSERT_TRUE(writer.add({texts, figures}));
  ASSERT_TRUE(writer.finish());
  const auto csv = as_csv(path(), library());
  ASSERT_TRUE(csv) << csv.error().message;
  std::string expected =
      "\"file\",\"white\"\n\"a \"\"b\"\".csv\",\"0.1\"\n\"\",\"\"\n\"2.5\",\"\"\n";
  for (int k = 0; k < 20; ++k) expected += "\"µ\",\"-1e-300\"\n";
  EXPECT_EQ(*csv, expected);
}

TEST_F(Tables, BeginAndEndWithTheMagicWordAndHoldFiguresAsEightBytes) {
  auto created = TableWriter::create(path(), {{"x", false}});
  ASSERT_TRUE(created);
  TableWriter writer = std::move(created).value();
  ASSERT_TRUE(writer.add({{1.0}}));
  ASSERT_TRUE(writer.finish());
  std::ifstream file(path(), std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(file), {}};
  EXPECT_TRUE(bytes.starts_with("PAR1"));
  EXPECT_TRUE(bytes.ends_with("PAR1"));
  // Levels: four bytes of length, one run of 8 bits of which the first is set; then 1.0.
  const std::string page("\x02\0\0\0\x03\x01\0\0\0\0\0\0\xf0\x3f", 14);
  EXPECT_NE(bytes.find(page), std::string::npos);
}

TEST_F(Tables, TakeTheirNameOnlyWhenFinished) {
  {
    auto created = TableWriter::create(path(), {{"x", false}});
    ASSERT_TRUE(created);
    TableWriter writer = std::move(created).value();
    EXPECT_TRUE(writer.add({{1.0}}));
  }
  EXPECT_TRUE(fs::is_empty(folder_));
}

TEST_F(Tables, ThatAreDamagedAreRefused) {
  if (library().empty()) GTEST_SKIP() << "no libduckdb.so: set PROOFMASS_DUCKDB_LIB to its path";
  std::ofstream(path()) << "PAR1 and nothing";
  const auto csv = as_csv(path(), library());
  ASSERT_FALSE(csv);
  EXPECT_EQ(csv.error().code, Errc::corrupt);
}

}  // namespace
}  // namespace proofmass::io::parquet::table_test
