#include <gtest/gtest.h>

#include "proofmass/io/mcap/specimens.hpp"
#include "proofmass/io/test_support.hpp"

namespace proofmass::io::mcap::mcap_test {
namespace {

using namespace specimen;

std::size_t bad_notes(const Recording& recording) {
  std::size_t count = 0;
  for (const Note& note : recording.notes) count += note.severity == Severity::bad ? 1 : 0;
  return count;
}

/// Reads a file that must be readable: `samples` of the test's channel, in order.
Recording expect_samples(const std::string& file, std::size_t samples) {
  const auto read = read_text(file);
  EXPECT_TRUE(read.has_value()) << read.error().message;
  if (!read) return {};
  EXPECT_EQ(read->format, "MCAP");
  EXPECT_EQ(read->samples(), samples) << notes_of(*read);
  return *read;
}

TEST(Mcap, ReadsMessagesOutsideOfChunks) {
  const auto read =
      expect_samples(mcap_front() + json_channel() + json_messages(0, 30) + mcap_end(), 30);
  ASSERT_EQ(read.channels.size(), 3u);
  EXPECT_EQ(read.channels[0].name, "ax");
  EXPECT_EQ(read.channels[0].values[29], 29.0);
  EXPECT_EQ(read.time.rate_hz, 100.0);
  EXPECT_EQ(read.time.start_ns, 1'700'000'000'000'000'000);
  EXPECT_EQ(bad_notes(read), 0u) << notes_of(read);
  EXPECT_TRUE(is_noted(read, "written by a test"));
}

TEST(Mcap, ReadsChunksOfEveryCompression) {
  for (const char* compression : {"", "zstd", "lz4"}) {
    const auto read = expect_samples(
        mcap_front() +
            mcap_chunk(json_channel() + json_messages(0, 20), {.compression = compression}) +
            mcap_record(7, le(1, 2) + le(0, 4)) +
            mcap_chunk(json_messages(20, 20), {.compression = compression}) + mcap_end(),
        40);
    EXPECT_EQ(read.channels.at(0).values.copy().at(39), 39.0);
    EXPECT_EQ(bad_notes(read), 0u) << notes_of(read);
  }
}

TEST(Mcap, PassesOverWhatItDoesNotKnow) {
  const std::string front = mcap_front() + mcap_record(0x42, "new in a later version") +
                            mcap_record(0x85, std::string(300, 'x')) + json_channel();
  const auto read = expect_samples(front + json_messages(0, 5) + mcap_end(), 5);
  EXPECT_EQ(bad_notes(read), 0u);
}

TEST(Mcap, TellsMetadataAndAttachments) {
  const std::string sensor = "[sensor]\nname = \"s\"\n";
  const std::string attachment =
      mcap_record(9, le(0, 16) + mcap_text("sensor.toml") + mcap_text("application/toml") +
                         le(sensor.size(), 8) + sensor + le(0, 4));
  const auto read = expect_samples(
      mcap_front("ros2") +
          mcap_record(12, mcap_text("bench") + mcap_pairs({{"operator", "A"}, {"rig", "7"}})) +
          json_channel() + json_messages(0, 5) + attachment + mcap_end(),
      5);
  EXPECT_TRUE(is_noted(read, "metadata \"bench\": operator = A; rig = 7")) << notes_of(read);
  EXPECT_TRUE(is_noted(read, "attached: \"sensor.toml\", 20 bytes"));
  EXPECT_TRUE(is_noted(read, "profile ros2"));
}

TEST(Mcap, PassesOverADamagedChunkAndNamesItsTime) {
  for (const char* compression : {"", "zstd", "lz4"}) {
    std::string chunk =
        mcap_chunk(json_messages(10, 10), {.compression = compression, .crc = 0x12345678});
    const auto read =
        expect_samples(mcap_front() + mcap_chunk(json_channel() + json_messages(0, 10)) + chunk +
                           mcap_chunk(json_messages(20, 10)) + mcap_end(),
                       20);
    EXPECT_TRUE(is_noted(read,
                         "(5.000 s … 6.000 s on the clock of the file) is skipped: its "
                         "checksum is wrong"))
        << notes_of(read);
    EXPECT_EQ(bad_notes(read), 1u);
    EXPECT_EQ(read.channels[0].values[10], 20.0);
  }
}

TEST(Mcap, BelievesNoSizeOfAChunk) {
  const std::string records = json_messages(10, 10);
  for (const std::uint64_t size :
       {std::uint64_t{0}, std::uint64_t{5}, std::uint64_t{100'000}, std::uint64_t{1} << 29,
        std::uint64_t{1} << 31, ~std::uint64_t{0} - 1}) {
    for (const char* compression : {"", "zstd", "lz4"}) {
      const auto read = expect_samples(
          mcap_front() + json_channel() + json_messages(0, 10) +
              mcap_chunk(records, {.compression = compression, .unpacked_bytes = size}) +
              json_messages(20, 10) + mcap_end(),
          20);
      EXPECT_EQ(bad_notes(read), 1u) << size << compression << notes_of(read);
    }
  }
}

TEST(Mcap, SaysWhichCompressionItDoesNotKnow) {
  const auto read = expect_samples(mcap_front() + json_channel() + json_messages(0, 3) +
                                       mcap_chunk("xxxx", {.compression = "brotli"}) + mcap_end(),
                                   3);
  EXPECT_TRUE(is_noted(read, "compressed by brotli")) << notes_of(read);
}

TEST(Mcap, KeepsWhatIsBeforeTheBreak) {
  const std::string whole = mcap_front() + mcap_chunk(json_channel() + json_messages(0, 10));
  const auto unclosed = expect_samples(whole, 10);
  EXPECT_TRUE(is_noted(unclosed, "without its closing records"));
  const auto cut = expect_samples(whole + mcap_chunk(json_messages(10, 10)).substr(0, 200), 10);
  EXPECT_TRUE(
      is_noted(cut, "breaks off at byte " + std::to_string(whole.size()) + ", within a chunk"))
      << notes_of(cut);
  const auto zeros = expect_samples(whole + std::string(4096, '\0'), 10);
  EXPECT_TRUE(is_noted(zeros, "there is a zero")) << notes_of(zeros);
}

TEST(Mcap, GoesOnAtTheNextChunkThatTheSummaryKnows) {
  std::string file = mcap_front() + mcap_chunk(json_channel() + json_messages(0, 10));
  std::vector<std::uint64_t> starts{mcap_front().size()};
  const std::size_t damaged = file.size();
  starts.push_back(damaged);
  file += mcap_chunk(json_messages(10, 10));
  starts.push_back(file.size());
  file += mcap_chunk(json_messages(20, 10));
  const std::string end = mcap_end_with_summary(file, {{1, 30}}, starts);
  file[damaged + 6] = '\x7F';  // its length
  const auto read = expect_samples(file + end, 20);
  EXPECT_TRUE(is_noted(read, "skipped up to byte " + std::to_string(starts[2]))) << notes_of(read);
}

TEST(Mcap, ComparesTheChecksumOfTheDataSection) {
  std::string data = mcap_front() + json_channel() + json_messages(0, 10);
  const std::string end = mcap_end_with_summary(data, {{1, 10}});
  EXPECT_EQ(bad_notes(expect_samples(data + end, 10)), 0u);
  data[data.size() - 3] = '2';
  EXPECT_TRUE(is_noted(expect_samples(data + end, 10), "checksum of the data section is wrong"));
}

TEST(Mcap, DoesWithoutASummaryThatIsDamaged) {
  const std::string data = mcap_front() + json_channel() + json_messages(0, 10);
  std::string end = mcap_end_with_summary(data, {{1, 10}, {7, 3}});
  EXPECT_EQ(bad_notes(expect_samples(data + end, 10)), 0u);  // counts messages that do not exist
  end[40] = static_cast<char>(end[40] ^ 1);
  EXPECT_TRUE(is_noted(expect_samples(data + end, 10), "its checksum is wrong"));
}

TEST(Mcap, TellsMessagesThatTheSummaryLeavesOut) {
  const std::string data = mcap_front() + json_channel() +
                           mcap_channel_record(2, 0, "/other", "json") + json_messages(0, 10) +
                           mcap_message_record(2, 5, "{\"b\": 1}");
  const auto read = expect_samples(data + mcap_end_with_summary(data, {{1, 10}}), 10);
  EXPECT_TRUE(is_noted(read, "1 messages are not looked at")) << notes_of(read);
}

TEST(Mcap, StaysOnOneLineWhateverTheFileSays) {
  const auto error_of = [](const std::string& encoding, const std::string& topic) {
    return read_text(mcap_front() + mcap_channel_record(1, 0, topic, encoding) +
                     mcap_message_record(1, 5, "xx") + mcap_end())
        .error()
        .message;
  };
  for (const char* text : {"two\nlines", "\x1B[31m", "\xFF\xFE"}) {
    for (const std::string& message :
         {error_of(text, "/t"), error_of("protobuf", text), error_of("cdr", text)})
      EXPECT_EQ(message.find_first_of("\n\x1B\xFF"), std::string::npos) << message;
  }
}

TEST(Mcap, JoinsThePublishersOfATopicAndTellsTopicsThatAreNotRead) {
  const auto read = expect_samples(
      mcap_front() + json_channel() + mcap_channel_record(2, 0, "/acc", "json") +
          mcap_channel_record(3, 0, "/camera", "protobuf") +
          mcap_message_record(1, 10, "{\"a\": 1}") + mcap_message_record(2, 20, "{\"a\": 2}") +
          mcap_message_record(3, 25, "xx") + mcap_message_record(1, 30, "{\"a\": 3}") + mcap_end(),
      3);
  EXPECT_TRUE(is_noted(read, "1 messages of topic /camera are not read: they are in protobuf"))
      << notes_of(read);
  EXPECT_TRUE(is_noted(read, "2 publishers"));
}

TEST(Mcap, ReadsTheTopicAskedFor) {
  const std::string file = mcap_front() + json_channel() +
                           mcap_channel_record(2, 0, "/battery", "json") + json_messages(0, 5) +
                           mcap_message_record(2, 10, "{\"voltage\": 12.5}") + mcap_end();
  ReadOptions options;
  options.variables = {"/battery"};
  const auto read = read_text(file, options);
  ASSERT_TRUE(read.has_value()) << read.error().message;
  ASSERT_NE(read->find("voltage"), nullptr);
  EXPECT_EQ(read->find("voltage")->values, std::vector{12.5});
  EXPECT_EQ(expect_samples(file, 5).channels.size(), 3u);
}

TEST(Mcap, RefusesInOneLine) {
  const auto error_of = [](const std::string& file) { return read_text(file).error(); };
  EXPECT_EQ(error_of(std::string("\x89MCAP0\r\n", 8)).code, Errc::corrupt);
  EXPECT_EQ(error_of(std::string("\x89MCAP7\r\n", 8)).code, Errc::corrupt);
  EXPECT_EQ(error_of(mcap_front() + mcap_end()).code, Errc::too_few_samples);
  const Error none = error_of(mcap_front() + mcap_channel_record(3, 0, "/camera", "protobuf") +
                              mcap_message_record(3, 25, "xx") + mcap_end());
  EXPECT_EQ(none.code, Errc::unsupported);
  EXPECT_NE(none.message.find("/camera"), std::string::npos) << none.message;
  EXPECT_EQ(error_of(mcap_front() + std::string("\x05\xFF\xFF\xFF\xFF\xFF\xFF\xFF\xFF", 9)).code,
            Errc::corrupt);
}

TEST(Mcap, IsReadOrRefusedWhereverItIsBrokenOff) {
  const std::string data =
      mcap_front() + mcap_chunk(json_channel() + json_messages(0, 4), {.compression = "zstd"}) +
      json_messages(4, 4) + mcap_chunk(json_messages(8, 4), {"lz4"});
  const std::string file = data + mcap_end_with_summary(data, {{1, 12}});
  std::size_t most = 0;
  for (std::size_t size = 0; size <= file.size(); ++size) {
    const auto read = read_text(file.substr(0, size));
    if (!read) {
      EXPECT_EQ(read.error().message.find('\n'), std::string::npos);
      EXPECT_LT(most, 1u) << "what was read of less is gone at " << size;
      continue;
    }
    EXPECT_GE(read->samples(), most) << size;
    most = read->samples();
    EXPECT_TRUE(size >= data.size() || bad_notes(*read) > 0) << size;
  }
  EXPECT_EQ(most, 12u);
}

}  // namespace
}  // namespace proofmass::io::mcap::mcap_test
