#include "proofmass/io/mcap/salvage.hpp"

#include <fstream>
#include <gtest/gtest.h>
#include <iterator>
#include <random>

#include "proofmass/io/mcap/recording.hpp"
#include "proofmass/io/mcap/specimens.hpp"
#include "proofmass/io/test_support.hpp"

namespace proofmass::io::mcap::salvage_test {
namespace {

using namespace specimen;

struct Saved {
  Result<Recovery> recovery = Recovery{};
  std::string bytes{};
};

Saved salvaged(const std::string& file) {
  Saved out;
  out.recovery = salvage(std::as_bytes(std::span(file)), [&](const std::string& bytes) {
    out.bytes += bytes;
    return Status(Done{});
  });
  return out;
}

std::string words_of(const Recovery& recovery) {
  std::string all;
  for (const Note& note : recovery.notes) all += note.text + "\n";
  return all;
}

TEST(McapSalvage, TakesChunksOfOthersAsTheyAre) {
  for (const char* compression : {"", "zstd", "lz4"}) {
    std::string file = mcap_front("ros2");
    for (int i = 0; i < 10; ++i)
      file += mcap_chunk((i == 0 ? json_channel() : "") + json_messages(10 * i, 10),
                         {.compression = compression});
    const Saved saved = salvaged(file);
    ASSERT_TRUE(saved.recovery) << saved.recovery.error().message;
    EXPECT_EQ(saved.recovery->messages, 100u);
    EXPECT_EQ(saved.recovery->chunks, 10u);
    EXPECT_EQ(saved.recovery->samples, 0u);
    EXPECT_FALSE(saved.recovery->was_whole);
    const auto read = read_text(saved.bytes);
    ASSERT_TRUE(read) << read.error().message;
    EXPECT_EQ(read->samples(), 100u);
    EXPECT_EQ(read->channels[0].values[99], 99.0);
    EXPECT_TRUE(is_noted(*read, "profile ros2")) << notes_of(*read);
    for (const Note& note : read->notes) EXPECT_NE(note.severity, Severity::bad) << note.text;
  }
}

TEST(McapSalvage, GoesOnAtTheNextWholeChunkWhateverIsBroken) {
  const std::string front = mcap_front() + mcap_chunk(json_channel() + json_messages(0, 10));
  const std::string broken = mcap_chunk(json_messages(10, 10));
  const std::string rest = mcap_chunk(json_messages(20, 10));
  for (std::size_t at = 0; at < broken.size(); ++at) {
    for (const char wrong : {'\0', '\x06', '\x0F', '\x02', '\xFF', '\x85'}) {
      std::string bytes = broken;
      if (bytes[at] == wrong) continue;
      bytes[at] = wrong;
      // The times and the compression name of a chunk are not covered by its checksum.
      const Saved saved = salvaged(front + bytes + rest + mcap_end());
      ASSERT_TRUE(saved.recovery);
      ASSERT_GE(saved.recovery->messages, 20u) << at << words_of(*saved.recovery);
      const auto read = read_text(saved.bytes);
      ASSERT_TRUE(read);
      ASSERT_EQ(read->channels[0].values.back(), 29.0);
    }
  }
}

TEST(McapSalvage, LeavesOutWhatNothingSaysTheKindOf) {
  const std::string file = mcap_front() + mcap_chunk(json_messages(0, 10)) +
                           mcap_chunk(json_channel() + json_messages(10, 10)) + mcap_end();
  const Saved saved = salvaged(file);
  ASSERT_TRUE(saved.recovery);
  EXPECT_EQ(saved.recovery->messages, 10u);
  EXPECT_NE(words_of(*saved.recovery).find("10 messages are left out"), std::string::npos);
}

TEST(McapSalvage, KeepsApartWhatHasOneNumber) {
  const std::string file =
      mcap_front() + mcap_chunk(json_channel() + json_messages(0, 10)) +
      mcap_chunk(mcap_channel_record(1, 0, "/other", "json") + json_messages(10, 5)) + mcap_end();
  const Saved saved = salvaged(file);
  ASSERT_TRUE(saved.recovery);
  const auto read = read_text(saved.bytes, {.variables = {"/other"}});
  ASSERT_TRUE(read);
  EXPECT_EQ(read->samples(), 5u);
}

TEST(McapSalvage, TakesMessagesOutsideOfChunksUpToTheDamage) {
  std::string file = mcap_front() + json_channel() + json_messages(0, 50);
  const std::size_t good = file.size();
  file += json_messages(50, 50);
  file[good] = '\0';
  const Saved saved = salvaged(file);
  ASSERT_TRUE(saved.recovery);
  EXPECT_EQ(saved.recovery->messages, 50u);
  EXPECT_EQ(saved.recovery->bytes_lost, file.size() - good);
}

// A whole chunk within what was skipped: the walk goes back, and its bytes are not lost twice.
TEST(McapSalvage, CountsALostByteOnce) {
  std::ifstream corpus(
      std::string(PROOFMASS_SOURCE_DIR) + "/fuzz/corpus/recover/chunk_within_lost_bytes",
      std::ios::binary);
  const std::string file =
      mcap_front().substr(0, 8) + std::string(std::istreambuf_iterator<char>(corpus), {});
  ASSERT_GT(file.size(), 1000u);
  const Saved saved = salvaged(file);
  ASSERT_TRUE(saved.recovery);
  EXPECT_EQ(saved.recovery->messages, 1u);
  EXPECT_LT(saved.recovery->bytes_lost, file.size());
}

TEST(McapSalvage, EndsItsSearchInBytesMadeForIt) {
  // Nested chunk headers, none with a valid checksum.
  std::string file = mcap_front() + std::string(1, '\0');
  const std::string head = mcap_chunk("x").substr(0, 49);
  while (file.size() < 400'000) file += head;
  for (std::size_t at = mcap_front().size() + 1; at + 49 < file.size(); at += 49) {
    const std::string left = le(file.size() - at - 9, 8);
    const std::string packed = le(file.size() - at - 49, 8);
    file.replace(at + 1, 8, left);
    file.replace(at + 25, 8, packed);
    file.replace(at + 41, 8, packed);
  }
  EXPECT_EQ(salvaged(file).recovery.error().code, Errc::corrupt);
}

TEST(McapSalvage, HandsOnThatNothingCanBeWritten) {
  const std::string file = mcap_front() + mcap_chunk(json_channel() + json_messages(0, 10));
  const auto full = salvage(std::as_bytes(std::span(file)), [](const std::string&) {
    return Status(Error{Errc::unreadable, "full"});
  });
  EXPECT_EQ(full.error().message, "full");
}

TEST(RecordingEncoder, TakenBackToAMarkIsAsIfNothingHadFollowed) {
  const std::vector<Channel> columns{{"acc_x", *parse_unit("m/s^2"), {}}};
  const std::vector<double> stamps{0.0, 0.5}, values{1.0, 2.0};
  const auto begun = [&](std::string& bytes) {
    RecordingEncoder file({.is_self_contained = true});
    const auto topic = file.add_samples_topic({.name = "recording", .columns = columns});
    for (std::uint64_t k = 0; k < 4; k += 2) {
      file.add_samples(topic, k, 5 + k, stamps, std::vector<View<double>>{values});
      file.close_chunk();
    }
    bytes = file.take_bytes();
    return file;
  };
  std::string plain, rewound;
  RecordingEncoder first = begun(plain);
  first.finish();
  plain += first.take_bytes();
  RecordingEncoder second = begun(rewound);
  const Mark mark = second.mark();
  EXPECT_EQ(mark.bytes, rewound.size());
  (void)second.add_json_topic("events", std::string(event_schema));
  second.add_json(2, 99, "{}");
  second.add_metadata("summary", {{"a", "b"}});
  second.finish();
  (void)second.take_bytes();
  second.rewind(mark);
  second.finish();
  rewound += second.take_bytes();
  const auto a = read_text(plain), b = read_text(rewound);
  ASSERT_TRUE(a && b);
  EXPECT_EQ(b->channels[0].values, a->channels[0].values);
  for (const Note& note : b->notes) EXPECT_NE(note.severity, Severity::bad) << note.text;
}

// The first message of a topic does not determine the length of the others.
TEST(RecordingEncoder, RowsOfAnotherTopicAreToldWhereTheyAreKnownAndElseNotGuessed) {
  const std::vector<Channel> columns{{"acc_x", *parse_unit("m/s^2"), {}}};
  const std::vector<double> stamps{0.0, 0.5, 1.0}, values{1.0, 2.0, 3.0};
  for (const bool in_one_message : {true, false}) {
    RecordingEncoder file;
    const auto topic = file.add_samples_topic({.name = "recording", .columns = columns});
    const auto other = file.add_samples_topic(
        {.name = "estimates", .columns = columns, .derived_from = "recording"});
    file.add_samples(topic, 0, 0, stamps, std::vector<View<double>>{values});
    file.add_samples(other, 0, 0, stamps, std::vector<View<double>>{values});
    const View<double> last_stamp(&stamps[2], 1), last_value(&values[2], 1);
    if (!in_one_message)
      file.add_samples(other, 3, 0, last_stamp, std::vector<View<double>>{last_value});
    file.finish();
    const auto read = read_text(file.take_bytes());
    ASSERT_TRUE(read) << read.error().message;
    EXPECT_TRUE(is_noted(*read, in_one_message ? "also holds estimates (2 columns, 3 rows)"
                                               : "also holds estimates (2 columns)"))
        << notes_of(*read);
    EXPECT_TRUE(recommends(*read, "variable"));
  }
}

TEST(RecordingEncoder, EventsAreInANoteAndAreNoTable) {
  RecordingEncoder file;
  const std::vector<Channel> columns{{"u", *parse_unit("V"), {}}};
  const std::vector<Channel> derived{{"acc_x", *parse_unit("m/s^2"), {}}};
  const std::vector<double> stamps{0.0, 0.5, 1.0}, values{1.0, 2.0, 3.0};
  const std::vector<View<double>> views{values};
  const auto topic = file.add_samples_topic({.name = "recording", .columns = columns});
  const auto other = file.add_samples_topic(
      {.name = "estimates", .columns = derived, .derived_from = "recording"});
  const auto events = file.add_json_topic("events", std::string(event_schema));
  const auto clock = file.add_json_topic("clock", std::string(clock_schema));
  file.add_json(events, 0, R"({"time_s":0.25,"kind":"gap","rows":7,"text":"a hole"})");
  file.add_samples(topic, 0, 0, stamps, views);
  file.add_samples(other, 0, 0, stamps, views);
  file.add_json(events, 0, R"({"time_s":0.5,"kind":"gap","rows":2,"text":"another"})");
  for (const char* odd : {"", "{", "7", R"({"kind":3})"}) file.add_json(events, 0, odd);
  for (int i = 0; i < 100; ++i) file.add_json(clock, 0, R"({"time_s":0.5,"host_ns":1})");
  file.finish();
  const auto read = read_text(file.take_bytes());
  ASSERT_TRUE(read);
  EXPECT_EQ(read->channels.at(0).name, "u");
  EXPECT_TRUE(is_noted(*read, "2 gap (9 rows); the first at 0.25 s: a hole")) << notes_of(*read);
  EXPECT_FALSE(is_noted(*read, "clock (")) << notes_of(*read);
}

}  // namespace
}  // namespace proofmass::io::mcap::salvage_test
