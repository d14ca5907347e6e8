#include <bit>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <iterator>
#include <limits>
#include <random>

#include "proofmass/io/bytes/column_spool.hpp"
#include "proofmass/io/bytes/output_file.hpp"
#include "proofmass/io/matlab/mat5_writing.hpp"
#include "proofmass/io/matlab/mat_names.hpp"
#include "proofmass/io/reading/recording_writers.hpp"
#include "proofmass/io/test_support.hpp"
#include "proofmass/io/write_recording.hpp"
#include "proofmass/io/written_test_support.hpp"

namespace proofmass::io::matlab::mat_writer_test {
namespace {

/// A temporary folder, removed after the test.
class Writer : public testing::Test {
 public:
  ~Writer() override { std::filesystem::remove_all(folder_); }

 protected:
  Writer() {
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    folder_ =
        std::filesystem::temp_directory_path() / ("proofmass_mat_" + std::string(test->name()));
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directory(folder_);
  }

  [[nodiscard]] std::string path(const std::string& name) const { return folder_ / name; }
  Result<Recording> through(const Recording& recording) const {
    if (const Status written = write_recording(recording, path("a.mat"), {}); !written)
      return written.error();
    return read_recording(path("a.mat"), {});
  }

 private:
  std::filesystem::path folder_;
};

Recording uniform(std::size_t samples, double rate_hz) {
  Recording recording;
  recording.time = {TimeSource::given_rate, "", rate_hz, {}, {}};
  recording.channels.push_back({"acc_x", *parse_unit("m/s^2"), {}});
  recording.channels.push_back({"Gyro Y", *parse_unit("deg/s"), {}});
  for (std::size_t k = 0; k < samples; ++k) {
    recording.channels[0].values.edit().push_back(std::sin(static_cast<double>(k)));
    recording.channels[1].values.edit().push_back(-static_cast<double>(k % 7));
  }
  return recording;
}

TEST_F(Writer, KeepsEveryBitNamesUnitsAndTimes) {
  std::mt19937_64 random(11);
  std::uniform_real_distribution<double> jitter(0.0, 0.004);
  for (const auto start_ns :
       {std::optional<std::int64_t>{}, std::optional<std::int64_t>{1'705'479'286'000'000'123}}) {
    Recording recording;
    recording.time = {TimeSource::stamps, "clock", 100.0, {}, start_ns};
    for (const char* name :
         {"acc_x", "acc_X", "odd, (name)", "end", "2nd", "Temperatur Gerät", "fs"})
      recording.channels.push_back({name, *parse_unit("m/s^2"), {}});
    recording.channels[5].unit = *parse_unit("°C");
    for (int k = 0; k < 3000; ++k) {
      recording.time.stamps_s.push_back(k == 0 ? 0.0 : 0.01 * k + jitter(random));
      for (Channel& channel : recording.channels)
        channel.values.edit().push_back(std::bit_cast<double>(random()));
    }
    recording.channels[0].values.edit()[6] = -std::numeric_limits<double>::infinity();
    recording.channels[0].values.edit()[7] = 5e-324;
    const auto back = through(recording);
    ASSERT_TRUE(back.has_value()) << back.error().message;
    EXPECT_EQ(back->format, "MAT v5");
    EXPECT_EQ(back->time.channel, "clock");
    EXPECT_EQ(back->time.start_ns.value_or(0), start_ns.value_or(0));
    expect_same_recording(recording, *back);
  }
}

TEST_F(Writer, AUniformBaseStaysUniform) {
  for (const double rate_hz : {200.0, 120.005, 204.8, 100.0 / 3.0}) {
    Recording recording = uniform(500, rate_hz);
    recording.time.start_ns = 1'705'479'286'000'000'123;
    const auto back = through(recording);
    ASSERT_TRUE(back.has_value()) << back.error().message;
    EXPECT_TRUE(back->time.is_uniform()) << rate_hz;
    EXPECT_EQ(back->time.start_ns, recording.time.start_ns);
    expect_same_recording(recording, *back);
  }
}

TEST_F(Writer, NeedsNoTime) {
  Recording recording = uniform(9, 100.0);
  recording.time = {};
  const auto back = through(recording);
  ASSERT_TRUE(back.has_value()) << back.error().message;
  EXPECT_EQ(back->time.source, TimeSource::none);
  expect_same_recording(recording, *back);
}

TEST_F(Writer, ColumnsOfAnyLengthComeBackFromTheSpool) {
  constexpr std::size_t columns = 3000;
  constexpr std::size_t rows = 1000;
  ColumnSpool spool(columns, path("a.mat.part"));
  std::vector<double> row(columns);
  for (std::size_t r = 0; r < rows; ++r) {
    for (std::size_t c = 0; c < columns; ++c) row[c] = static_cast<double>(r * columns + c);
    ASSERT_TRUE(spool.add(row).has_value());
  }
  EXPECT_EQ(spool.rows(), rows);
  for (const std::size_t c : {std::size_t{0}, std::size_t{17}, columns - 1}) {
    std::string all;
    const auto take = [&](std::string_view bytes) {
      all += bytes;
      return Status(Done{});
    };
    ASSERT_TRUE(spool.give(c, take).has_value());
    ASSERT_EQ(all.size(), 8 * rows);
    for (std::size_t r = 0; r < rows; ++r) {
      double value = 0.0;
      std::memcpy(&value, all.data() + 8 * r, sizeof value);
      ASSERT_EQ(value, static_cast<double>(r * columns + c));
    }
  }
  EXPECT_TRUE(std::filesystem::is_empty(std::filesystem::path(path("x")).parent_path()));
}

TEST_F(Writer, TellsWhereARecordingIsTooLarge) {
  struct Nowhere final : OutputFile {
    Status append(std::string_view) override { return Done{}; }
    Status overwrite(std::uint64_t, std::string_view) override { return Done{}; }
    std::uint64_t size() const override { return 0; }
    const std::string& part_path() const override { return path_; }
    Status keep() override { return Done{}; }
    std::string path_ = "a.mat.part";
  };
  const Recording head = uniform(0, 100.0);
  auto writer = create(std::make_unique<Nowhere>(), {.recording = head}, {});
  ASSERT_TRUE(writer.has_value());
  // The values of a rejected block are not read.
  const double figure = 0.0;
  Block block;
  for (int c = 0; c < 2; ++c)
    block.channels.push_back(View<double>(&figure, most_mat5_doubles + 1));
  const Status refused = (*writer)->write(block);
  ASSERT_FALSE(refused.has_value());
  EXPECT_EQ(refused.error().code, Errc::unsupported);
  EXPECT_NE(refused.error().message.find("write .h5"), std::string::npos);
}

TEST(Names, AreWhatMatlabTakes) {
  Names names;
  EXPECT_EQ(names.name_for("acc_x"), "acc_x");
  EXPECT_EQ(names.name_for("Acc X"), "Acc_X_2");
  EXPECT_EQ(names.name_for("acc-x"), "acc_x_3");
  EXPECT_EQ(names.name_for("2nd (raw)"), "x_2nd_raw");
  EXPECT_EQ(names.name_for("end"), "x_end");
  EXPECT_EQ(names.name_for("µ"), "channel");
  EXPECT_EQ(names.name_for(""), "channel_2");
  EXPECT_EQ(names.name_for(std::string(80, 'a')), std::string(63, 'a'));
  EXPECT_EQ(names.name_for(std::string(90, 'a')), std::string(61, 'a') + "_2");
}

TEST(PlainTextMatrix, CalledMatIsReadAsATable) {
  const std::string text =
      "  0.01  0.1  0.2  9.81\n  0.02  0.1  0.2  9.80\n  0.03  0.1  0.2  9.79\n";
  const auto read = read_recording(std::as_bytes(std::span(text)), "xsens_acc.mat", {});
  ASSERT_TRUE(read.has_value()) << read.error().message;
  EXPECT_EQ(read->format, "CSV");
  EXPECT_NEAR(read->time.rate_hz, 100.0, 1e-6);
  EXPECT_EQ(read->channels.size(), 3u);
}

}  // namespace
}  // namespace proofmass::io::matlab::mat_writer_test
