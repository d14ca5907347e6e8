#include <bit>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <iterator>
#include <limits>
#include <random>

#include "proofmass/io/mcap/specimens.hpp"
#include "proofmass/io/reading/recording_writers.hpp"
#include "proofmass/io/test_support.hpp"
#include "proofmass/io/written_test_support.hpp"

namespace proofmass::io::mcap::writer_test {
namespace {

/// A file in memory.
class MemoryFile final : public OutputFile {
 public:
  explicit MemoryFile(std::string& bytes) : bytes_(bytes) {}
  Status append(std::string_view bytes) override {
    bytes_ += bytes;
    return Done{};
  }
  Status overwrite(std::uint64_t, std::string_view) override {
    return Error{Errc::unsupported, "a recorder only appends"};
  }
  [[nodiscard]] std::uint64_t size() const override { return bytes_.size(); }
  [[nodiscard]] const std::string& part_path() const override { return path_; }
  Status keep() override { return Done{}; }

 private:
  std::string& bytes_;
  std::string path_ = "memory";
};

/// The bytes of a recording written in blocks of the given number of samples.
std::string written(const Recording& recording,
                    std::size_t rows,
                    const WriteOptions& options = {}) {
  std::string bytes;
  const bool has_stamps = !recording.time.is_uniform();
  auto opened = create(std::make_unique<MemoryFile>(bytes), {recording, has_stamps}, options);
  EXPECT_TRUE(opened.has_value());
  EXPECT_TRUE(write_in_pieces(**opened, recording, rows).has_value());
  return bytes;
}

Recording troubled(std::size_t samples, bool has_stamps) {
  Recording recording = troubled_recording(samples, {"acc_x", "acc_y", "odd, \"name\"", "temp"});
  recording.source = "rig.csv";
  recording.format = "CSV";
  recording.channels[3].unit = *parse_unit("degC");
  if (!has_stamps)
    recording.time = {TimeSource::given_rate, "", 128.0, {}, recording.time.start_ns};
  return recording;
}

void expect_same(const Recording& read, const Recording& written) {
  expect_same_recording(read, written);
  EXPECT_EQ(read.time.start_ns, written.time.start_ns);
}

TEST(McapWritten, ReadsBackBitForBitHoweverItIsCutIntoBlocks) {
  for (const bool has_stamps : {false, true}) {
    const Recording recording = troubled(5000, has_stamps);
    for (const std::size_t rows : {1, 77, 5000}) {
      const auto read = read_text(written(recording, rows));
      ASSERT_TRUE(read.has_value()) << read.error().message;
      expect_same(*read, recording);
      if (!has_stamps) {
        EXPECT_EQ(read->time.rate_hz, 128.0);
      }
      for (const Note& note : read->notes) EXPECT_EQ(note.severity, Severity::info) << note.text;
    }
    EXPECT_EQ(written(recording, 77), written(recording, 5000));
  }
}

TEST(McapWritten, KeepsLabelsSettingsAndTheSensorFile) {
  Recording recording = troubled(300, false);
  recording.labels = {{"x_up", 3, 40}, {"walking, \"fast\"", 41, 299}};
  recording.label_channel = "pose";
  const WriteOptions options{.metadata = {{"command", "proofmass convert"}},
                             .sensor_file = "[sensor]\n"};
  const auto read = read_text(written(recording, 64, options));
  ASSERT_TRUE(read.has_value()) << read.error().message;
  ASSERT_EQ(read->labels.size(), 2u);
  EXPECT_EQ(read->labels[0], recording.labels[0]);
  EXPECT_EQ(read->labels[1].text, "walking, 'fast'");
  EXPECT_EQ(read->labels[1].last, 299u);
  EXPECT_EQ(read->label_channel, "pose");
  EXPECT_TRUE(is_noted(*read, "command = proofmass convert")) << notes_of(*read);
  EXPECT_TRUE(is_noted(*read, "source = rig.csv"));
  EXPECT_TRUE(is_noted(*read, "attached: \"sensor.toml\", 9 bytes"));
  std::string damaged = written(recording, 64, options);
  damaged[damaged.find("[sensor]") + 1] = 'S';
  damaged[damaged.find("walking")] = 'W';
  const auto other = read_text(damaged);
  ASSERT_TRUE(other.has_value());
  EXPECT_TRUE(other->labels.empty());
  EXPECT_TRUE(is_noted(*other, "\"sensor.toml\", 9 bytes, damaged")) << notes_of(*other);
  EXPECT_TRUE(is_noted(*other, "\"labels.csv\"")) << notes_of(*other);
}

TEST(McapWritten, WithoutATimeBaseHasNone) {
  Recording recording = troubled(300, false);
  recording.time = {};
  const auto read = read_text(written(recording, 64));
  ASSERT_TRUE(read.has_value());
  EXPECT_EQ(read->time.source, TimeSource::none);
  EXPECT_EQ(read->samples(), 300u);
}

TEST(McapWritten, OpensUpToTheLastWholeChunkWhereverItIsCut) {
  // Several chunks of a mebibyte, truncated at random bytes.
  const Recording recording = troubled(100'000, false);
  const std::string bytes = written(recording, 4096);
  std::mt19937_64 random(4);
  for (int i = 0; i < 20; ++i) {
    const std::size_t size = random() % bytes.size();
    const auto read = read_text(std::string_view(bytes).substr(0, size));
    const std::size_t chunk_rows = (std::size_t{1} << 20) / (4 * 8);
    if (size < (std::size_t{1} << 20)) continue;
    ASSERT_TRUE(read.has_value()) << size << read.error().message;
    EXPECT_GE(read->samples() + chunk_rows + 4096, size / 32) << size;
    bool bad = false;
    for (const Note& note : read->notes) bad = bad || note.severity == Severity::bad;
    EXPECT_TRUE(bad);
    for (std::size_t k = 3; k < read->samples(); k += 997)
      ASSERT_EQ(std::bit_cast<std::uint64_t>(read->channels[0].values[k]),
                std::bit_cast<std::uint64_t>(recording.channels[0].values[k]));
  }
}

TEST(McapWritten, LeavesALostChunkEmptyWhereOnlyTheRateTellsTheTime) {
  Recording recording = troubled(100'000, false);
  for (Channel& channel : recording.channels)
    for (std::size_t k = 0; k < channel.values.size(); ++k)
      channel.values.edit()[k] = static_cast<double>(k);
  std::string bytes = written(recording, 4096);
  bytes[std::size_t{3} << 19] ^= 1;  // in the second chunk
  const auto read = read_text(bytes);
  ASSERT_TRUE(read.has_value());
  EXPECT_TRUE(is_noted(*read, "its checksum is wrong")) << notes_of(*read);
  EXPECT_TRUE(is_noted(*read, "they are left empty")) << notes_of(*read);
  ASSERT_EQ(read->samples(), 100'000u);
  std::size_t empty = 0;
  for (std::size_t k = 0; k < read->samples(); ++k) {
    const double value = read->channels[2].values[k];
    if (std::isnan(value))
      ++empty;
    else
      ASSERT_EQ(value, static_cast<double>(k));
  }
  EXPECT_GT(empty, 30'000u);
  EXPECT_LT(empty, 36'000u);
}

/// A block in our own encoding with arbitrary claims.
std::string block(int version,
                  int flags,
                  int columns,
                  std::uint32_t rows,
                  std::uint64_t first,
                  const std::vector<double>& figures) {
  std::string out =
      specimen::le(std::uint64_t(version), 1) + specimen::le(std::uint64_t(flags), 1) +
      specimen::le(std::uint64_t(columns), 2) + specimen::le(rows, 4) + specimen::le(first, 8);
  for (const double figure : figures) out += specimen::le(std::bit_cast<std::uint64_t>(figure), 8);
  return out;
}

std::string block_file(const std::vector<std::string>& blocks) {
  std::string file =
      specimen::mcap_front() +
      specimen::mcap_schema_record(1, "s", "jsonschema",
                                   R"({"columns":[{"name":"a","unit":"g"}]})") +
      specimen::mcap_channel_record(1, 1, "t", "proofmass-samples", {{"rate_hz", "10"}});
  for (const std::string& message : blocks) file += specimen::mcap_message_record(1, 0, message);
  return file + specimen::mcap_end();
}

TEST(McapSamples, BelievesNoCountInABlock) {
  for (const std::string& wrong : {block(1, 0, 1, 0xFFFFFFFF, 2, {1}), block(1, 0, 2, 1, 2, {1, 2}),
                                   block(1, 1, 1, 1, 2, {1, 2}), block(2, 0, 1, 1, 2, {1}),
                                   block(1, 0, 0, 0xFFFFFFFF, 2, {}), std::string("\1\0\1", 3)}) {
    const auto read =
        read_text(block_file({block(1, 0, 1, 2, 0, {1, 2}), wrong, block(1, 0, 1, 2, 2, {3, 4})}));
    ASSERT_TRUE(read.has_value()) << read.error().message;
    EXPECT_EQ(read->channels.at(0).values, (std::vector<double>{1, 2, 3, 4}));
    EXPECT_TRUE(is_noted(*read, "a message is skipped")) << notes_of(*read);
  }
}

TEST(McapSamples, FillsNoGapThatNothingStandsFor) {
  for (const std::uint64_t first : {std::uint64_t{1} << 40, ~std::uint64_t{0} - 1}) {
    const auto read =
        read_text(block_file({block(1, 0, 1, 2, 0, {1, 2}), block(1, 0, 1, 2, first, {3, 4}),
                              block(1, 0, 1, 1, 3, {5})}));
    ASSERT_TRUE(read.has_value());
    EXPECT_EQ(read->channels.at(0).values, (std::vector<double>{1, 2, 3, 4, 5}));
    EXPECT_TRUE(is_noted(*read, "come too early")) << notes_of(*read);
    EXPECT_TRUE(is_noted(*read, "begin before the end")) << notes_of(*read);
  }
}

}  // namespace
}  // namespace proofmass::io::mcap::writer_test
