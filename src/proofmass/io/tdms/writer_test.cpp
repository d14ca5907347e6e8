#include <bit>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <iterator>
#include <random>

#include "proofmass/io/tdms/tdms_test_support.hpp"
#include "proofmass/io/test_support.hpp"
#include "proofmass/io/write_recording.hpp"
#include "proofmass/io/written_test_support.hpp"

namespace proofmass::io::tdms::writer_test {
namespace {

class Writing : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::temp_directory_path() /
              ("proofmass_tdms_" +
               std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  [[nodiscard]] std::string path() const { return (folder_ / "a.tdms").string(); }
  [[nodiscard]] std::string bytes() const {
    std::ifstream file(path(), std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }
  [[nodiscard]] Recording through(const Recording& recording,
                                  const WriteOptions& options = {}) const {
    const Status written = write_recording(recording, path(), options);
    EXPECT_TRUE(written.has_value()) << (written ? "" : written.error().message);
    auto back = read_recording(path(), ReadOptions{});
    EXPECT_TRUE(back.has_value()) << (back ? "" : back.error().message);
    return back ? std::move(back).value() : Recording{};
  }

 private:
  std::filesystem::path folder_;
};

Recording troubled(std::size_t rows) {
  Recording recording = troubled_recording(rows, {"acc_x", "it's", "no unit"});
  recording.channels[1].unit = *parse_unit("mV");
  recording.channels[2].unit = {};
  return recording;
}

TEST_F(Writing, EveryBitComesBack) {
  for (const std::size_t rows : {9U, 32768U, 70'000U}) {
    const Recording recording = troubled(rows);
    const Recording back = through(recording);
    expect_same_recording(back, recording);
    EXPECT_EQ(back.time.stamps_s, recording.time.stamps_s);
    EXPECT_EQ(back.time.start_ns, recording.time.start_ns);
  }
}

TEST_F(Writing, AnEvenBaseStaysEven) {
  for (const double rate_hz : {200.0, 120.005, 1000.0, 204.8, 100.0 / 3.0, 7.0}) {
    Recording recording;
    recording.time = {TimeSource::given_rate, "", rate_hz, {}, -5};
    recording.channels.push_back({"a", *parse_unit("V"), {}});
    for (int k = 0; k < 500; ++k) recording.channels[0].values.edit().push_back(std::sin(k));
    const Recording back = through(recording);
    EXPECT_TRUE(back.time.is_uniform());
    EXPECT_EQ(back.time.rate_hz, rate_hz);
    EXPECT_EQ(back.time.start_ns, -5);
    EXPECT_EQ(back.channels[0].values, recording.channels[0].values);
  }
}

TEST_F(Writing, NoTimeBaseIsNone) {
  Recording recording;
  recording.channels.push_back({"a", *parse_unit("g"), {1.5, 2.5, 1.0}});
  const Recording back = through(recording);
  EXPECT_EQ(back.time.source, TimeSource::none);
  EXPECT_EQ(back.channels[0].values, recording.channels[0].values);
}

TEST_F(Writing, ChannelsKeepTheirNamesWhateverTheyAre) {
  Recording recording = troubled(20);
  recording.channels[0].name = "time";
  recording.channels[1].name = "a/b'c";
  recording.channels[2].name = "";
  const Recording back = through(recording);
  ASSERT_EQ(back.channels.size(), 3u);
  EXPECT_EQ(back.channels[0].name, "time");
  EXPECT_EQ(back.channels[1].name, "a/b'c");
}

TEST_F(Writing, MetadataAndSensorFileStandInTheFile) {
  const WriteOptions options{{{"command", "proofmass convert x"}}, "[sensor]\nname = \"A\"\n"};
  ASSERT_TRUE(write_recording(troubled(10), path(), options).has_value());
  const auto contents = tdms_contents(bytes());
  ASSERT_TRUE(contents.has_value());
  const Properties& said = (*contents)->map.properties_of("");
  EXPECT_EQ(text_of(said, "command"), "proofmass convert x");
  EXPECT_EQ(text_of(said, "sensor_file"), options.sensor_file);
}

TEST_F(Writing, LabelsComeBack) {
  Recording recording = troubled(3000);
  recording.labels = {{"#1", 5, 7}, {"x, \"up\"\n", 8, 8}, {"x", 700, 2999}};
  recording.label_channel = "part; of";
  const Recording back = through(recording);
  recording.labels[1].text.back() = ' ';  // texts are read as one line
  EXPECT_EQ(back.labels, recording.labels);
  EXPECT_EQ(back.label_channel, recording.label_channel);
}

TEST_F(Writing, ACutFileLosesItsLastPieceOnlyAndAllChannelsEndTogether) {
  const Recording recording = troubled(70'000);
  ASSERT_TRUE(write_recording(recording, path()).has_value());
  const std::string whole = bytes();
  for (const double part : {0.2, 0.5, 0.77, 0.999}) {
    const auto size = static_cast<std::size_t>(part * static_cast<double>(whole.size()));
    const auto cut = read_tdms(whole.substr(0, size), 0, 50'000);
    ASSERT_TRUE(cut.has_value()) << cut.error().message;
    const std::size_t rows = cut->columns[0].size();
    // 32 bytes per row; the truncated row still has its first values.
    EXPECT_NEAR(static_cast<double>(rows) * 32.0, static_cast<double>(size), 1500.0);
    for (std::size_t k = 0; k + 1 < rows; ++k)
      for (std::size_t c = 0; c < 3; ++c)
        ASSERT_EQ(std::bit_cast<std::uint64_t>(cut->columns[c + 1][k]),
                  std::bit_cast<std::uint64_t>(recording.channels[c].values[k]));
  }
}

TEST_F(Writing, SegmentsAfterTheFirstHaveNoMetadata) {
  ASSERT_TRUE(write_recording(troubled(32768 * 3), path()).has_value());
  const std::string file = bytes();
  const auto contents = tdms_contents(file);
  ASSERT_TRUE(contents.has_value());
  EXPECT_EQ((*contents)->map.segments, 3u);
  // The first segment's metadata are all data besides values and lead-ins.
  EXPECT_LT(file.size() - std::size_t{32768} * 3 * 32 - 3 * std::size_t{28}, 1000u);
}

}  // namespace
}  // namespace proofmass::io::tdms::writer_test
