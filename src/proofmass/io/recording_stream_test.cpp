// A recording that is read in blocks equals the one that is read as a whole.
#include "proofmass/io/recording_stream.hpp"

#include <bit>
#include <cmath>
#include <cstdint>
#include <fmt/format.h>
#include <fstream>
#include <gtest/gtest.h>

#include "proofmass/io/test_support.hpp"

namespace proofmass::io::recording_stream_test {
namespace {

std::filesystem::path scratch_file(const std::string& name) {
  return std::filesystem::path(::testing::TempDir()) / ("proofmass_stream_" + name);
}

std::string write(const std::string& name, const std::string& text) {
  const auto path = scratch_file(name);
  std::ofstream(path, std::ios::binary) << text;
  return path.string();
}

/// All blocks of a stream, concatenated.
Result<Recording> gathered(const std::string& path, const ReadOptions& options) {
  auto opened = open_recording(path, options, 0);
  if (!opened) return opened.error();
  auto value = std::move(opened).value();
  auto& stream = std::get<RecordingStream>(value);
  std::vector<std::vector<double>> channels(stream.head().channels.size());
  std::vector<double> times_s;
  for (;;) {
    const auto block = stream.next();
    if (!block) return block.error();
    if (block->rows() == 0) break;
    EXPECT_EQ(block->first, times_s.size());
    for (std::size_t c = 0; c < channels.size(); ++c)
      channels[c].insert(channels[c].end(), block->channels[c].begin(), block->channels[c].end());
    for (std::size_t r = 0; r < block->rows(); ++r)
      times_s.push_back(stream.has_stamps() ? block->stamps_s[r]
                                            : stream.head().time.at(block->first + r));
  }
  Recording all = stream.head();
  for (std::size_t c = 0; c < channels.size(); ++c) all.channels[c].values = std::move(channels[c]);
  all.time.stamps_s = std::move(times_s);
  return all;
}

void expect_same(const std::string& path, const ReadOptions& options = {}) {
  const auto whole = read_recording(path, options);
  const auto pieces = gathered(path, options);
  ASSERT_EQ(whole.has_value(), pieces.has_value()) << path;
  if (!whole) {
    EXPECT_EQ(whole.error().message, pieces.error().message);
    return;
  }
  ASSERT_EQ(whole->channels.size(), pieces->channels.size());
  ASSERT_EQ(whole->samples(), pieces->samples());
  for (std::size_t c = 0; c < whole->channels.size(); ++c) {
    EXPECT_EQ(whole->channels[c].name, pieces->channels[c].name);
    EXPECT_EQ(whole->channels[c].unit, pieces->channels[c].unit);
    for (std::size_t k = 0; k < whole->samples(); ++k)
      ASSERT_EQ(std::bit_cast<std::uint64_t>(whole->channels[c].values[k]),
                std::bit_cast<std::uint64_t>(pieces->channels[c].values[k]))
          << c << " " << k;
  }
  for (std::size_t k = 0; k < whole->samples(); ++k)
    ASSERT_EQ(whole->time.at(k), pieces->time.stamps_s[k]) << k;
  // That a counter never skips is known at the end only.
  if (!options.rate_hz) {
    EXPECT_EQ(whole->time.source, pieces->time.source);
  }
  EXPECT_EQ(whole->time.start_ns, pieces->time.start_ns);
  EXPECT_EQ(whole->time.mended, pieces->time.mended);
  EXPECT_EQ(whole->labels, pieces->labels);
  EXPECT_EQ(whole->first_line, pieces->first_line);
}

/// 200 000 rows, some of them malicious.
std::string large_csv() {
  std::string text = "time (us),packet,ax (g),ay (g),az (g)\n";
  std::uint64_t stamp = 4'200'000'000;
  for (std::size_t k = 0; k < 200'000; ++k) {
    stamp += 5000 + (k * 7919) % 13;
    if (k == 70'000) stamp += 3'000'000;
    text += k == 131'071 ? std::string("nan") : fmt::format("{}", stamp % (1ull << 32));
    text +=
        fmt::format(",{},{:.4f},{:.4f},{}\n", k, 0.001 * static_cast<double>(k % 37),
                    -0.002 * static_cast<double>(k % 11),
                    k == 65'536 ? "" : fmt::format("{:.3f}", 1.0 - 1e-6 * static_cast<double>(k)));
  }
  return text;
}

TEST(RecordingStream, OfALargeCsvWithAWrappingClockIsTheWholeRecording) {
  expect_same(write("large.csv", large_csv()));
}

TEST(RecordingStream, KeepsTheChannelsAskedForAndTheRateGiven) {
  const std::string path = write("chosen.csv", large_csv());
  expect_same(path, {.channels = {"az", "ax"}});
  expect_same(path, {.rate_hz = 200.0});
}

TEST(RecordingStream, OfEveryCsvSpecimenIsTheWholeRecording) {
  const auto folder = std::filesystem::path(PROOFMASS_SOURCE_DIR) / "fuzz/corpus/csv";
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    SCOPED_TRACE(entry.path());
    if (const auto read = read_recording(entry.path().string(), {}); read && read->labels.empty())
      expect_same(entry.path().string());
  }
}

TEST(RecordingStream, IsReadWholeWhereItFits) {
  const std::string path = write("small.csv", "t,x\n0,1\n1,2\n2,3\n");
  auto opened = open_recording(path, {}, 1'000'000);
  ASSERT_TRUE(opened) << opened.error().message;
  const auto* recording = std::get_if<Recording>(&*opened);
  ASSERT_NE(recording, nullptr);
  EXPECT_EQ(recording->samples(), 3u);
  EXPECT_EQ(recording->source, path);
}

TEST(RecordingStream, NamesTheFileInWhatItSays) {
  const auto missing = open_recording("/nowhere/at.csv", {}, 0);
  ASSERT_FALSE(missing);
  EXPECT_TRUE(missing.error().message.starts_with("/nowhere/at.csv: ")) << missing.error().message;
  const auto chosen = open_recording(write("few.csv", "t,x\n0,1\n1,2\n"), {.channels = {"y"}}, 0);
  ASSERT_FALSE(chosen);
  EXPECT_NE(chosen.error().message.find("has no channel y"), std::string::npos);
}

}  // namespace
}  // namespace proofmass::io::recording_stream_test
