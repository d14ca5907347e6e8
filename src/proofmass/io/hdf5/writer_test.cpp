#include <bit>
#include <cmath>
#include <csignal>
#include <cstddef>
#include <cstdlib>
#include <filesystem>
#include <gtest/gtest.h>
#include <iterator>
#include <limits>
#include <random>
#include <sys/resource.h>

#include "proofmass/io/hdf5/library.hpp"
#include "proofmass/io/reading/recording_writers.hpp"
#include "proofmass/io/test_support.hpp"
#include "proofmass/io/written_test_support.hpp"

namespace proofmass::io::hdf5::writer_test {
namespace {

class Written : public testing::Test {
 protected:
  void SetUp() override {
    if (!has_library()) GTEST_SKIP() << "built without the HDF5 library";
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = std::filesystem::temp_directory_path() / ("proofmass_" + std::string(test->name()));
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directory(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  [[nodiscard]] std::string path() const { return folder_ / "a.h5"; }
  [[nodiscard]] std::ptrdiff_t files() const {
    return std::distance(std::filesystem::directory_iterator(folder_), {});
  }

  /// Writes a recording in blocks of the given number of samples.
  [[nodiscard]] Status write(const Recording& recording,
                             std::size_t rows,
                             const WriteOptions& options = {}) const {
    auto file = create_file(path());
    if (!file) return file.error();
    const bool has_stamps = !recording.time.is_uniform();
    auto opened = create(std::move(file).value(), {recording, has_stamps}, options);
    if (!opened) return opened.error();
    return write_in_pieces(**opened, recording, rows);
  }

  [[nodiscard]] Result<Recording> through(const Recording& recording, std::size_t rows) const {
    if (const Status written = write(recording, rows); !written) return written.error();
    return read_recording(path(), {});
  }

 private:
  std::filesystem::path folder_;
};

/// Random doubles of every magnitude with faults of every kind, on a clock with jitter.
Recording troubled(std::size_t samples) {
  Recording recording = troubled_recording(samples, {"z", "a/b", "odd, name", "a_b", "x (g)", "."});
  recording.channels[1].unit = *parse_unit("deg/s");
  recording.channels[3].unit = *parse_unit("degC");
  return recording;
}

void expect_same(const Recording& read, const Recording& written) {
  expect_same_recording(read, written);
  EXPECT_EQ(read.time.start_ns, written.time.start_ns);
}

TEST_F(Written, ComesBackToTheLastBitHoweverItWasCut) {
  const Recording recording = troubled(3000);
  for (const std::size_t rows : {std::size_t{1}, std::size_t{700}, std::size_t{3000}}) {
    const auto back = through(recording, rows);
    ASSERT_TRUE(back) << back.error().message;
    expect_same(recording, *back);
    EXPECT_EQ(back->time.channel, "time");
  }
}

TEST_F(Written, ComesBackWhereItIsLongerThanABlock) {
  Recording recording = troubled(300'000);
  recording.channels.resize(1);
  const auto back = through(recording, 65'536);
  ASSERT_TRUE(back) << back.error().message;
  expect_same(recording, *back);
}

TEST_F(Written, KeepsAnEvenTimeBaseAsARate) {
  for (const auto start_ns : {std::optional<std::int64_t>{}, std::optional<std::int64_t>{-5}}) {
    Recording recording = troubled(100);
    recording.time = {TimeSource::given_rate, "", 100.0 / 3.0, {}, start_ns};
    const auto back = through(recording, 64);
    ASSERT_TRUE(back) << back.error().message;
    expect_same(recording, *back);
    EXPECT_TRUE(back->time.is_uniform());
    EXPECT_EQ(back->time.rate_hz, 100.0 / 3.0);
  }
}

TEST_F(Written, NeedsNoTimeBase) {
  Recording recording = troubled(100);
  recording.time = {};
  const auto back = through(recording, 64);
  ASSERT_TRUE(back) << back.error().message;
  EXPECT_EQ(back->time.source, TimeSource::none);
  expect_same(recording, *back);
}

TEST_F(Written, KeepsLabels) {
  Recording recording = troubled(100);
  recording.labels = {{"x, up", 0, 7}, {"übrig", 8, 8}, {"x, up", 90, 99}};
  recording.label_channel = "part";
  const auto back = through(recording, 64);
  ASSERT_TRUE(back) << back.error().message;
  EXPECT_EQ(back->labels, recording.labels);
  EXPECT_EQ(back->label_channel, "part");
}

TEST_F(Written, HasRoomForTextsOfAnyLength) {
  WriteOptions options;
  options.metadata = {{"command", "proofmass convert"}, {"long", std::string(100'000, 'x')}};
  options.sensor_file = std::string(100'000, '#');
  const Recording recording = troubled(100);
  const Status written = write(recording, 64, options);
  ASSERT_TRUE(written) << written.error().message;
  const auto back = read_recording(path(), {});
  ASSERT_TRUE(back) << back.error().message;
  expect_same(recording, *back);
  EXPECT_TRUE(is_noted(*back, "command: proofmass convert")) << notes_of(*back);
  EXPECT_TRUE(is_noted(*back, "long (text), sensor_file (text)")) << notes_of(*back);
}

TEST_F(Written, HasRoomForManyChannels) {
  Recording recording = troubled(5);
  const Channel first = recording.channels[0];
  recording.channels.assign(500, first);
  for (std::size_t c = 0; c < 500; ++c) recording.channels[c].name = "ch " + std::to_string(c);
  const auto back = through(recording, 2);
  ASSERT_TRUE(back) << back.error().message;
  expect_same(recording, *back);
}

TEST_F(Written, LeavesNothingBehindWhereItIsNotFinished) {
  const Recording recording = troubled(100);
  {
    auto file = create_file(path());
    ASSERT_TRUE(file);
    auto writer = create(std::move(file).value(), {recording, true}, {});
    ASSERT_TRUE(writer) << writer.error().message;
    EXPECT_EQ(files(), 1);
  }
  EXPECT_EQ(files(), 0);
  EXPECT_FALSE(std::filesystem::exists(path()));
}

TEST_F(Written, SaysWhenThereIsNoRoom) {
  const Recording recording = troubled(100);
  const auto has_note = [&] {
    // The same error as for a full disk, except for the wording.
    constexpr rlimit most{4096, 4096};
    std::signal(SIGXFSZ, SIG_IGN);
    ::setrlimit(RLIMIT_FSIZE, &most);
    const Status written = write(recording, 100);
    return !written && written.error().code == Errc::unwritable &&
           written.error().message.find('\n') == std::string::npos;
  };
  // In a child process: the library does not release the memory of a file it cannot write.
  EXPECT_EXIT(std::_Exit(has_note() ? 0 : 1), ::testing::ExitedWithCode(0), "");
}

}  // namespace
}  // namespace proofmass::io::hdf5::writer_test
