// The specimens are written by fuzz/make_hdf5_corpus.py: row k, column c of their tables is
// first + c + k / 4, in 40 rows.
#include <cerrno>
#include <cstdlib>
#include <fstream>
#include <gtest/gtest.h>
#include <iterator>
#include <sys/wait.h>

#include "proofmass/io/bytes/deflate_test_support.hpp"
#include "proofmass/io/hdf5/library.hpp"
#include "proofmass/io/hdf5/reader.hpp"
#include "proofmass/io/test_support.hpp"

namespace proofmass::io::hdf5::hdf5_test {
namespace {

using Names = std::vector<std::string>;

class Hdf5 : public testing::Test {
 protected:
  void SetUp() override {
    if (!has_library()) GTEST_SKIP() << "built without the HDF5 library";
  }
};
class Mat73 : public Hdf5 {};

std::filesystem::path path_of(const std::string& name) {
  return std::filesystem::path(PROOFMASS_SOURCE_DIR) / "fuzz/corpus/hdf5" / name;
}

std::string bytes_of(const std::string& name) {
  std::ifstream file(path_of(name), std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

Result<Recording> read(const std::string& name, const Names& datasets = {}) {
  ReadOptions options;
  options.variables = datasets;
  return read_recording(path_of(name).string(), options);
}

Names names_of(const Recording& recording) {
  Names names;
  for (const Channel& channel : recording.channels) names.push_back(channel.name);
  return names;
}

/// first + k / 4, k = 0 … 39
void expect_ramp(const Recording& recording, const std::string& name, double first) {
  const Channel* channel = recording.find(name);
  ASSERT_NE(channel, nullptr) << name;
  ASSERT_EQ(channel->values.size(), 40u) << name;
  for (std::size_t k = 0; k < 40; ++k)
    ASSERT_EQ(channel->values[k], first + 0.25 * static_cast<double>(k)) << name << ' ' << k;
}

std::string unit_of(const Recording& recording, const std::string& name) {
  const Channel* channel = recording.find(name);
  return channel == nullptr ? "no channel" : std::string(channel->unit.symbol);
}

TEST_F(Hdf5, ReadsAllDatasetsOfOneLengthThatLieTogether) {
  const auto recording = read("groups.h5");
  ASSERT_TRUE(recording) << recording.error().message;
  EXPECT_EQ(recording->format, "HDF5");
  EXPECT_EQ(names_of(*recording),
            (Names{"acc_x", "acc_y", "acc_z", "gyro_x", "gyro_y", "gyro_z", "moving", "phase",
                   "quat_w", "quat_x", "quat_y", "quat_z", "temp", "pos_x", "pos_y", "pos_z"}));
  EXPECT_TRUE(is_noted(*recording, "HDF5: imu/acc (40 x 3 float32), imu/gyro (3 x 40 float64)"))
      << notes_of(*recording);
}

TEST_F(Hdf5, ReadsEveryTypeOrderAndFilterToTheLastBit) {
  const auto recording = read("groups.h5");
  ASSERT_TRUE(recording) << recording.error().message;
  for (const auto& [axis, number] : {std::pair{"x", 0.0}, {"y", 1.0}, {"z", 2.0}}) {
    const std::string end = std::string("_") + axis;
    expect_ramp(*recording, "acc" + end, 1 + number);    // big-endian float32, gzip in chunks
    expect_ramp(*recording, "gyro" + end, 10 + number);  // channels x samples
    expect_ramp(*recording, "quat" + end, 1 + number);   // float16
    expect_ramp(*recording, "pos" + end, 20 + number);   // float64
  }
  for (std::size_t k = 0; k < 40; ++k) {
    EXPECT_EQ(recording->find("temp")->values[k], -28.0 + static_cast<double>(k));  // int16
    EXPECT_EQ(recording->find("moving")->values[k], k % 3 == 0 ? 1.0 : 0.0);
    EXPECT_EQ(recording->find("phase")->values[k], static_cast<double>(k));
  }
}

TEST_F(Hdf5, TakesUnitsFromAttributesAndFromTheTextOfTheFile) {
  const auto recording = read("groups.h5");
  ASSERT_TRUE(recording) << recording.error().message;
  EXPECT_EQ(unit_of(*recording, "acc_z"), "m/s^2");
  EXPECT_EQ(unit_of(*recording, "temp"), "degC");
  EXPECT_EQ(unit_of(*recording, "gyro_y"), "rad/s");
  EXPECT_EQ(unit_of(*recording, "pos_x"), "mm");
  EXPECT_TRUE(is_noted(*recording, "imu/gyro: unit rad/s, as the text \"info\" in the file says"))
      << notes_of(*recording);
}

TEST_F(Hdf5, TakesTheRateFromTheFile) {
  const auto recording = read("groups.h5");
  ASSERT_TRUE(recording) << recording.error().message;
  EXPECT_EQ(recording->time.rate_hz, 100.0);
  EXPECT_TRUE(is_noted(*recording, "attribute fs: the rate, 100 Hz")) << notes_of(*recording);
}

TEST_F(Hdf5, SaysWhatElseThereIsAndFollowsNoLink) {
  const auto recording = read("groups.h5");
  ASSERT_TRUE(recording) << recording.error().message;
  EXPECT_TRUE(
      is_noted(*recording,
               "also in the file: other (7 uint64), rows (40 x 2 compound), far (link), soft "
               "(link), title (text)"))
      << notes_of(*recording);
  EXPECT_TRUE(recommends(*recording, "dataset"));
}

TEST_F(Hdf5, LeavesOtherSensorsWithATimeOfTheirOwnOut) {
  const auto recording = read("sensors.h5");
  ASSERT_TRUE(recording) << recording.error().message;
  EXPECT_EQ(names_of(*recording), (Names{"acc_x", "acc_y", "acc_z"}));
  EXPECT_EQ(recording->time.channel, "time");
  EXPECT_DOUBLE_EQ(recording->time.rate_hz, 200.0);
  EXPECT_EQ(recording->time.start_ns, 1'600'000'000'000'000'000);
  EXPECT_TRUE(is_noted(*recording, "also in the file: right/acc (40 x 3 int64)"))
      << notes_of(*recording);
}

TEST_F(Hdf5, ReadsTheDatasetsAndGroupsThatAreNamed) {
  for (const char* name : {"right", "right/acc", "/right/acc", "Right/Acc"}) {
    const auto recording = read("sensors.h5", {name});
    ASSERT_TRUE(recording) << recording.error().message;
    EXPECT_EQ(names_of(*recording), (Names{"acc_x", "acc_y", "acc_z"}));
    EXPECT_EQ(recording->channels[0].values[0], 5.0);
    EXPECT_EQ(recording->time.channel, "time");
  }
  const auto both = read("sensors.h5", {"left/acc", "right/acc"});
  ASSERT_TRUE(both) << both.error().message;
  EXPECT_EQ(names_of(*both), (Names{"left_acc_x", "left_acc_y", "left_acc_z", "right_acc_x",
                                    "right_acc_y", "right_acc_z"}));
  const auto lengths = read("groups.h5", {"imu/acc", "other"});
  ASSERT_FALSE(lengths);
  EXPECT_NE(lengths.error().message.find("they do not belong together"), std::string::npos);
  for (const char* name : {"", "title", "left"}) {
    const auto absent = read("groups.h5", {name});
    ASSERT_FALSE(absent) << name;
    EXPECT_EQ(absent.error().code, Errc::invalid_argument);
  }
}

TEST_F(Hdf5, CallsColumnsAsAnAttributeDoes) {
  const auto recording = read("columns.h5");
  ASSERT_TRUE(recording) << recording.error().message;
  EXPECT_EQ(names_of(*recording), (Names{"ax", "ay", "az", "T"}));
  EXPECT_EQ(recording->time.rate_hz, 50.0);
  EXPECT_EQ(unit_of(*recording, "ay"), "g");
  EXPECT_EQ(unit_of(*recording, "T"), "degC");
  expect_ramp(*recording, "az", 3.0);
}

TEST_F(Hdf5, ReadsTheFieldsOfACompoundTypeThatAreNumbers) {
  const auto recording = read("compound.h5");
  ASSERT_TRUE(recording) << recording.error().message;
  EXPECT_EQ(names_of(*recording), (Names{"acc_x", "acc_y", "acc_z", "temp", "on"}));
  EXPECT_EQ(recording->time.channel, "time");
  EXPECT_EQ(recording->time.rate_hz, 50.0);
  expect_ramp(*recording, "acc_x", 1.0);
  expect_ramp(*recording, "acc_z", 3.0);
  EXPECT_EQ(recording->find("temp")->values[39], 11.0);
  EXPECT_EQ(recording->find("on")->values[3], 1.0);
  EXPECT_TRUE(is_noted(*recording, "log/imu/word (text), log/imu/grid (arrays in an array)"))
      << notes_of(*recording);
  const auto other = read("compound.h5", {"log/gps"});
  ASSERT_TRUE(other) << other.error().message;
  EXPECT_EQ(names_of(*other), (Names{"lat", "lon"}));
}

TEST_F(Hdf5, KeepsEveryDigitOfStampsAndTheOrderOfAGroupThatHasOne) {
  const auto recording = read("stamps.h5");
  ASSERT_TRUE(recording) << recording.error().message;
  EXPECT_EQ(names_of(*recording), (Names{"z", "x", "y"}));
  EXPECT_EQ(recording->time.start_ns, 1'700'000'000'000'000'001);
  for (std::size_t k = 0; k < 40; ++k)
    EXPECT_DOUBLE_EQ(recording->time.at(k),
                     1e-9 * (5e6 * static_cast<double>(k) + static_cast<double>(k % 3)));
}

TEST_F(Hdf5, ReadsTheSameFromADiskFromMemoryAndCompressed) {
  const std::string bytes = bytes_of("groups.h5");
  const auto from_disk = read("groups.h5");
  for (const std::string& file : {bytes, specimen::deflated(bytes, 16 + 15)}) {
    const auto recording = read_text(file);
    ASSERT_TRUE(recording) << recording.error().message;
    ASSERT_EQ(names_of(*recording), names_of(*from_disk));
    for (std::size_t c = 0; c < recording->channels.size(); ++c)
      EXPECT_EQ(recording->channels[c].values, from_disk->channels[c].values);
  }
}

TEST_F(Hdf5, LeavesNoProcessAndNoOpenFileBehind) {
  using Entries = std::filesystem::directory_iterator;
  const auto open_files = [] { return std::distance(Entries("/proc/self/fd"), Entries()); };
  const auto before = open_files();
  const std::string whole = bytes_of("groups.h5");
  for (const std::size_t size : {whole.size(), whole.size() / 2, std::size_t{100}})
    (void)read_text(whole.substr(0, size));
  (void)read("groups.h5");
  EXPECT_EQ(open_files(), before);
  EXPECT_EQ(::waitpid(-1, nullptr, WNOHANG), -1);
  EXPECT_EQ(errno, ECHILD);
}

#if defined(__SANITIZE_ADDRESS__)
constexpr std::size_t step = 6;  // a process is slow there
#else
constexpr std::size_t step = 1;
#endif

/// Either read, or rejected with a one-line error; never channels of different length.
void expect_sound(const Result<Recording>& recording, std::size_t place) {
  if (!recording) {
    ASSERT_EQ(recording.error().message.find('\n'), std::string::npos) << place;
    return;
  }
  for (const Channel& channel : recording->channels)
    ASSERT_EQ(channel.values.size(), recording->samples()) << place;
}

TEST_F(Hdf5, ThatBreaksOffAnywhereIsRefused) {
  const std::string whole = bytes_of("tiny.h5");
  for (std::size_t size = 8; size < whole.size(); size += step) {  // the signature has 8
    const auto recording = read_text(whole.substr(0, size));
    ASSERT_FALSE(recording) << size;
    ASSERT_EQ(recording.error().code, Errc::corrupt) << recording.error().message;
    expect_sound(recording, size);
  }
}

TEST_F(Hdf5, WhateverByteIsWrongItIsReadOrRefusedInOneLine) {
  unsigned state = 1;  // any sequence, but the same each time
  for (const char* name : {"groups.h5", "sensors.h5", "matlab.mat"}) {
    const std::string whole = bytes_of(name);
    for (std::size_t k = 0; k < 40; k += step) {
      std::string damaged = whole;
      for (int wrong = 0; wrong < 4; ++wrong) {
        state = state * 1664525U + 1013904223U;
        damaged[(state >> 8) % damaged.size()] = static_cast<char>(state >> 24);
      }
      expect_sound(read_text(damaged), k);
    }
  }
}

TEST_F(Hdf5, NoticesFiguresThatFailTheirChecksum) {
  std::string damaged = bytes_of("groups.h5");
  const std::size_t packed = damaged.rfind("\x78\x5e");  // the header of a zlib stream
  ASSERT_NE(packed, std::string::npos);
  damaged[packed + 12] = static_cast<char>(damaged[packed + 12] ^ 0x55);
  const auto recording = read_text(damaged);
  ASSERT_FALSE(recording);
  EXPECT_EQ(recording.error().code, Errc::corrupt);
  EXPECT_NE(recording.error().message.find("imu/acc: sample 0: cannot be unpacked"),
            std::string::npos)
      << recording.error().message;
}

TEST_F(Mat73, IsReadAsTheVersionsBefore) {
  const auto recording = read("matlab.mat");
  ASSERT_TRUE(recording) << recording.error().message;
  EXPECT_EQ(recording->format, "MAT v7.3");
  EXPECT_EQ(names_of(*recording), (Names{"x", "y", "z", "on"}));
  EXPECT_EQ(recording->time.channel, "t");
  EXPECT_EQ(recording->time.rate_hz, 50.0);
  expect_ramp(*recording, "x", 1.0);
  expect_ramp(*recording, "z", 3.0);
  EXPECT_EQ(recording->find("on")->values[1], 1.0);
  EXPECT_TRUE(is_noted(*recording,
                       "MAT v7.3: imu.acc (40 x 3 double), imu.on (40 x 1 logical), "
                       "imu.t (40 x 1 double) read"))
      << notes_of(*recording);
}

TEST_F(Mat73, LooksIntoCellsAndArraysOfStructs) {
  const auto cell = read("matlab.mat", {"parts{2}"});
  ASSERT_TRUE(cell) << cell.error().message;
  EXPECT_TRUE(is_noted(*cell, "MAT v7.3: parts{2} (40 x 3 single) read")) << notes_of(*cell);
  EXPECT_EQ(cell->channels.back().values[4], 23.0);
  const auto field = read("matlab.mat", {"runs(2).acc"});
  ASSERT_TRUE(field) << field.error().message;
  EXPECT_EQ(field->channels.back().values[4], 43.0);
  EXPECT_TRUE(is_noted(*field, "name (text), none (empty) and 1 more")) << notes_of(*field);
}

TEST(Hdf5Signature, IsKnownWithAndWithoutABlockOfTheUser) {
  using namespace std::literals;
  const std::string signature = "\x89HDF\r\n\x1A\n"s;
  EXPECT_TRUE(claims(signature, ""));
  EXPECT_TRUE(claims(std::string(1024, ' ') + signature, ""));
  EXPECT_TRUE(claims("MATLAB 7.3 MAT-file", ""));
  EXPECT_FALSE(claims("MATLAB 5.0 MAT-file", ""));
  EXPECT_FALSE(claims(std::string(700, ' ') + signature, ""));
  const auto bare = read_text(signature);
  ASSERT_FALSE(bare);
  EXPECT_EQ(bare.error().code, has_library() ? Errc::corrupt : Errc::unsupported);
}

}  // namespace
}  // namespace proofmass::io::hdf5::hdf5_test
