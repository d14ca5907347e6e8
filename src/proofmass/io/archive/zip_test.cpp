#include <gtest/gtest.h>

#include "proofmass/io/archive/zip_specimens.hpp"
#include "proofmass/io/test_support.hpp"

namespace proofmass::io::zip_test {
namespace {

using specimen::table_of;
using specimen::zip;

bool has_bad_note(const Recording& recording) {
  for (const Note& note : recording.notes)
    if (note.severity == Severity::bad) return true;
  return false;
}

TEST(Zip, StoredAndDeflatedReadAsTheFileWithin) {
  const auto plain = read_text(table_of(500));
  ASSERT_TRUE(plain.has_value());
  for (const bool deflate : {false, true}) {
    const auto read = read_text(zip({{"run.csv", table_of(500), deflate}}));
    ASSERT_TRUE(read.has_value()) << read.error().message;
    ASSERT_EQ(read->channels.size(), 3u);
    EXPECT_EQ(read->channels[0].values, plain->channels[0].values);
    EXPECT_EQ(read->time.rate_hz, plain->time.rate_hz);
    EXPECT_TRUE(is_noted(*read, "read from its file run.csv")) << notes_of(*read);
  }
}

TEST(Zip, UnpacksWhatIsCompressedWithin) {
  const std::string packed = specimen::deflated(table_of(100), 16 + MAX_WBITS);
  const auto read = read_text(zip({{"run.csv.gz", packed}}));
  ASSERT_TRUE(read.has_value()) << read.error().message;
  EXPECT_EQ(read->samples(), 100u);
}

TEST(Zip, KeepsWhatWasReadBeforeAChecksumFails) {
  const auto read = read_text(zip({{"run.csv", table_of(500), true, 0, -1, true}}));
  ASSERT_TRUE(read.has_value()) << read.error().message;
  EXPECT_EQ(read->samples(), 500u);
  EXPECT_TRUE(is_noted(*read, "checksum")) << notes_of(*read);
  EXPECT_TRUE(has_bad_note(*read));
}

TEST(Zip, TellsDataThatBreakOff) {
  const auto read = read_text(zip({{"run.csv", table_of(500), true, 0, -1, false, 1000}}));
  ASSERT_TRUE(read.has_value()) << read.error().message;
  EXPECT_TRUE(has_bad_note(*read)) << notes_of(*read);
}

TEST(Zip, RefusesWhatItCannotUnpack) {
  const auto encrypted = read_text(zip({{"run.csv", table_of(9), false, 1}}));
  ASSERT_FALSE(encrypted.has_value());
  EXPECT_EQ(encrypted.error().code, Errc::unsupported);
  EXPECT_NE(encrypted.error().message.find("run.csv: is encrypted"), std::string::npos)
      << encrypted.error().message;
  const auto imploded = read_text(zip({{"run.csv", table_of(9), false, 0, 6}}));
  ASSERT_FALSE(imploded.has_value());
  EXPECT_EQ(imploded.error().code, Errc::unsupported);
  EXPECT_NE(imploded.error().message.find("method 6"), std::string::npos)
      << imploded.error().message;
}

TEST(Zip, RefusesNamesThatLeadOut) {
  for (const char* name : {"../run.csv", "a/../../run.csv", "/etc/run.csv", "..\\run.csv"}) {
    const auto read = read_text(zip({{name, table_of(9)}}));
    ASSERT_FALSE(read.has_value()) << name;
    EXPECT_EQ(read.error().code, Errc::corrupt);
    EXPECT_NE(read.error().message.find("leads out"), std::string::npos) << read.error().message;
  }
}

TEST(Zip, RefusesNamesBeyondAllSense) {
  const auto read = read_text(zip({{std::string(5000, 'a') + ".csv", table_of(9)}}));
  ASSERT_FALSE(read.has_value());
  EXPECT_NE(read.error().message.find("longer than"), std::string::npos);
  EXPECT_LT(read.error().message.size(), 300u);
}

TEST(Zip, RefusesAnEmptyArchiveAndAnOfficeDocument) {
  const auto empty = read_text(zip({}));
  ASSERT_FALSE(empty.has_value());
  EXPECT_NE(empty.error().message.find("holds no file"), std::string::npos)
      << empty.error().message;
  const auto sheet = read_text(zip({{"[Content_Types].xml", "<x/>"}, {"xl/a.xml", "<x/>"}}));
  ASSERT_FALSE(sheet.has_value());
  EXPECT_EQ(sheet.error().code, Errc::unsupported);
  EXPECT_NE(sheet.error().message.find("office document"), std::string::npos);
}

TEST(Zip, DoesNotOpenArchivesWithin) {
  const std::string within = zip({{"run.csv", table_of(9)}});
  const auto read = read_text(zip({{"a.zip", within}}));
  ASSERT_FALSE(read.has_value());
  EXPECT_NE(read.error().message.find("archive within"), std::string::npos) << read.error().message;
  const auto beside = read_text(zip({{"a.zip", within}, {"run.csv", table_of(9)}}));
  ASSERT_TRUE(beside.has_value());
  EXPECT_TRUE(is_noted(*beside, "a.zip")) << notes_of(*beside);
}

TEST(Zip, BrokenOffAnywhereIsRefusedInOneLine) {
  const std::string whole =
      zip({{"a/Accelerometer.csv", table_of(20), true}, {"a/note.txt", "words alone"}});
  ASSERT_TRUE(read_text(whole).has_value());
  for (std::size_t size = 0; size < whole.size(); ++size) {
    const auto read = read_text(whole.substr(0, size));
    ASSERT_FALSE(read.has_value()) << size;
    ASSERT_EQ(read.error().message.find('\n'), std::string::npos);
  }
}

TEST(Zip, ControlCharactersOfNamesStayOutOfMessages) {
  const auto read = read_text(zip({{"run\n\x1B[2J.csv", "words"}}));
  ASSERT_FALSE(read.has_value());
  EXPECT_EQ(read.error().message.find('\n'), std::string::npos);
  EXPECT_EQ(read.error().message.find('\x1B'), std::string::npos);
}

}  // namespace
}  // namespace proofmass::io::zip_test
