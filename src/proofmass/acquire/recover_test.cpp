#include "proofmass/acquire/recover.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <csignal>
#include <fstream>
#include <gtest/gtest.h>
#include <iterator>
#include <random>
#include <span>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include "proofmass/acquire/recorder/record_test_support.hpp"
#include "proofmass/acquire/stream/scripted_source_test_support.hpp"
#include "proofmass/io/mcap/salvage.hpp"

namespace proofmass::acquire::recover_test {
namespace {

std::string bytes_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

void put(const std::string& path, std::string_view bytes) {
  std::ofstream(path, std::ios::binary) << bytes;
}

std::string words_of(const Recovery& recovery) {
  std::string all;
  for (const Note& note : recovery.notes) all += note.text + "\n";
  return all;
}

/// A recording of several chunks: each delay ends one.
std::string recorded(const TestFolder& folder, std::size_t count) {
  const std::string path = folder.file("run.mcap");
  const auto summary = record(open_scripts({{.acts = arrivals(count)}}),
                              {.path = path, .sensor_files = {"[sensor]\n"}}, {}, doubled);
  EXPECT_TRUE(summary);
  return bytes_of(path);
}

TEST(Recover, MakesNoFileOfAPartThatHoldsNoMessage) {
  const TestFolder folder;
  const std::string whole = recorded(folder, 200);
  // A second of a recording, and only its header: what remains after a crash within the first
  // second.
  const std::size_t head = whole.find("sensor.toml") + 200;
  put(folder.file("cut.mcap"), std::string_view(whole).substr(0, head));
  const auto saved = recover(folder.file("cut.mcap"), folder.file("new.mcap"));
  ASSERT_FALSE(saved);
  EXPECT_EQ(saved.error().code, Errc::corrupt);
  EXPECT_FALSE(std::filesystem::exists(folder.file("new.mcap")));
  EXPECT_FALSE(std::filesystem::exists(folder.file("new.mcap.recovered.part")));
}

TEST(Recover, LeavesNothingOutOfAFileThatIsWhole) {
  const TestFolder folder;
  (void)recorded(folder, 200);
  const auto saved = recover(folder.file("run.mcap"), folder.file("new.mcap"));
  ASSERT_TRUE(saved) << saved.error().message;
  EXPECT_TRUE(saved->was_whole) << words_of(*saved);
  EXPECT_EQ(saved->samples, 2000u);
  EXPECT_EQ(saved->missing_rows, 0u);
  EXPECT_EQ(saved->bytes_lost, 0u);
  EXPECT_NEAR(saved->last_s, 19.99, 1e-9);
  EXPECT_EQ(saved->file, folder.file("new.mcap"));
  const Recording read = read_back(folder.file("new.mcap"));
  const Recording before = read_back(folder.file("run.mcap"));
  EXPECT_EQ(read.channels[1].values, before.channels[1].values);
  EXPECT_EQ(read.time.start_ns, before.time.start_ns);
  EXPECT_NE(all_notes(read).find("saved from what was written by proofmass"), std::string::npos);
  EXPECT_EQ(read_back(folder.file("new.mcap"), "estimates").samples(), 2000u);
}

TEST(Recover, SavesWhatIsWholeWhereverAFileIsCut) {
  const TestFolder folder;
  const std::string whole = recorded(folder, 2);
  std::uint64_t most = 0;
  for (std::size_t size = 0; size < whole.size(); ++size) {
    std::string made;
    const auto put = [&](const std::string& bytes) {
      made += bytes;
      return Status(Done{});
    };
    const auto cut = std::as_bytes(std::span(whole).first(size));
    const auto saved = io::mcap::salvage(cut, put);
    if (!saved) {
      ASSERT_EQ(saved.error().code, Errc::corrupt);
      ASSERT_EQ(most, 0u);
      continue;
    }
    ASSERT_FALSE(saved->was_whole) << size;
    ASSERT_FALSE(saved->notes.empty()) << size;
    ASSERT_GE(saved->samples, most) << size;
    most = saved->samples;
    if (most == 0) continue;
    const auto read = io::read_recording(std::as_bytes(std::span(made)), "made", {});
    ASSERT_TRUE(read) << size;
    ASSERT_EQ(read->samples(), most);
    for (const Note& note : read->notes) ASSERT_EQ(note.severity, Severity::info) << note.text;
  }
  EXPECT_EQ(most, 20u);
}

TEST(Recover, PassesOverGarbageInTheMiddleAndSaysWhatIsMissing) {
  const TestFolder folder;
  const std::string whole = recorded(folder, 12'000);
  ASSERT_GT(whole.size(), 3'000'000u);
  std::mt19937_64 random(8);
  for (int trial = 0; trial < 12; ++trial) {
    // Without its end a file has no list of its chunks.
    std::string bytes = whole.substr(0, trial % 2 == 0 ? whole.size() : whole.size() - 5000);
    const std::size_t at = 1'200'000 + random() % 1'000'000;
    for (std::size_t i = at; i < at + 3000; ++i) bytes[i] = static_cast<char>(random());
    put(folder.file("bad.mcap"), bytes);
    const auto saved = recover(folder.file("bad.mcap"), folder.file("new.mcap"));
    ASSERT_TRUE(saved) << saved.error().message;
    EXPECT_FALSE(saved->was_whole);
    EXPECT_GT(saved->samples, 30'000u);
    EXPECT_GT(saved->missing_rows, 0u) << words_of(*saved);
    EXPECT_GT(saved->bytes_lost, 3000u);
    EXPECT_NE(words_of(*saved).find("rows are missing from row"), std::string::npos);
    const Recording read = read_back(folder.file("new.mcap"));
    ASSERT_EQ(read.samples(), saved->samples);
    for (std::size_t k = 0; k < read.samples(); k += 17)
      ASSERT_NEAR(read.time.at(k), 0.01 * read.channels[0].values[k], 1e-6);
    std::filesystem::remove(folder.file("new.mcap"));
  }
}

TEST(Recover, WritesOverNothing) {
  const TestFolder folder;
  const std::string whole = recorded(folder, 2);
  const std::string path = folder.file("run.mcap"), other = folder.file("other.mcap");
  EXPECT_EQ(recover(path, path).error().code, Errc::invalid_argument);
  std::filesystem::create_hard_link(path, folder.file("link.mcap"));
  EXPECT_EQ(recover(path, folder.file("link.mcap")).error().code, Errc::invalid_argument);
  put(other, "precious");
  EXPECT_EQ(recover(path, other).error().code, Errc::invalid_argument);
  EXPECT_EQ(bytes_of(other), "precious");
  EXPECT_EQ(bytes_of(path), whole);
}

TEST(Recover, RefusesInOneLine) {
  const TestFolder folder;
  const std::string from = folder.file("a"), to = folder.file("b");
  EXPECT_EQ(recover(from, to).error().code, Errc::unreadable);
  for (const std::string& bytes : {std::string(), std::string("x,y\n1,2\n"), std::string(5000, 6),
                                   std::string("\x89MCAP0\r\n", 8)}) {
    put(from, bytes);
    const auto saved = recover(from, to);
    ASSERT_FALSE(saved);
    EXPECT_EQ(saved.error().code, Errc::corrupt) << saved.error().message;
    EXPECT_TRUE(saved.error().message.starts_with(from));
    EXPECT_FALSE(std::filesystem::exists(to));
  }
}

/// Delivers a thousand rows per second on the host's clock.
class RealTimeSource final : public Source {
 public:
  RealTimeSource() : head_(head_of({.is_paced = true, .rate_hz = 1000.0, .channels = 3})) {}
  [[nodiscard]] const SourceHead& head() const override { return head_; }
  [[nodiscard]] Result<Arrived> read(Arrival& arrival, std::chrono::milliseconds) override {
    arrival.clear(3);
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
    const std::int64_t now_ns = host_now_ns();
    for (; start_ns_ + row_ * 1'000'000 <= now_ns; ++row_) {
      for (std::vector<double>& channel : arrival.channels)
        channel.push_back(static_cast<double>(row_));
      arrival.device_ns.push_back(row_ * 1'000'000);
    }
    arrival.host_ns = now_ns;
    return arrival.rows() > 0 ? Arrived::rows : Arrived::nothing;
  }

 private:
  SourceHead head_;
  std::int64_t start_ns_ = host_now_ns();
  std::int64_t row_ = 0;
};

/// Status that a child reports while it lives.
struct Life {
  struct Beat {
    std::int64_t host_ns;
    std::uint64_t rows;
  };
  std::atomic<std::size_t> beats;
  std::array<Beat, 20'000> beat;
};

void record_until_killed(const std::string& path, Life& life) {
  std::uint64_t rows = 0;
  const auto beat = [&] {
    const std::size_t n = life.beats;
    life.beat[n] = {host_now_ns(), rows};
    life.beats = std::min(n + 1, life.beat.size() - 1);
  };
  const RecordWatch watch{.stopped =
                              [&] {
                                beat();
                                return false;
                              },
                          .samples = [&](const Block& block) { rows += block.rows(); }};
  const OpenSource open = [] {
    return Result<std::unique_ptr<Source>>(std::make_unique<RealTimeSource>());
  };
  (void)record(open, {.path = path}, watch);
}

/// Rows that had arrived a second before the end, excluding time lost by the machine itself.
std::uint64_t rows_due(const Life& life, std::int64_t end_ns) {
  std::int64_t longest_ns = 0;
  const std::size_t beats = life.beats;
  for (std::size_t i = 1; i < beats; ++i)
    longest_ns = std::max(longest_ns, life.beat[i].host_ns - life.beat[i - 1].host_ns);
  if (beats > 0) longest_ns = std::max(longest_ns, end_ns - life.beat[beats - 1].host_ns);
  const std::int64_t due_ns = end_ns - 1'000'000'000 - 4 * longest_ns;
  std::uint64_t rows = 0;
  for (std::size_t i = 0; i < beats; ++i)
    if (life.beat[i].host_ns < due_ns) rows = life.beat[i].rows;
  return rows;
}

TEST(Recover, HasAllButTheLastSecondOfARecorderThatWasKilled) {
  const TestFolder folder;
  std::mt19937_64 random(20);
  std::uint64_t due_in_all = 0;
  constexpr int kills = 20;
  constexpr int at_once = 5;
  for (int first = 0; first < kills; first += at_once) {
    std::array<Life*, at_once> lives{};
    std::array<pid_t, at_once> children{};
    for (int i = 0; i < at_once; ++i) {
      void* shared =
          ::mmap(nullptr, sizeof(Life), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
      ASSERT_NE(shared, MAP_FAILED);
      lives[std::size_t(i)] = new (shared) Life{};
      children[std::size_t(i)] = ::fork();
      if (children[std::size_t(i)] == 0) {
        record_until_killed(folder.file(std::to_string(first + i)), *lives[std::size_t(i)]);
        ::_exit(0);
      }
    }
    for (std::size_t i = 0; i < at_once; ++i) {
      std::this_thread::sleep_for(std::chrono::milliseconds(i == 0 ? 1500 : random() % 400));
      const std::int64_t end_ns = host_now_ns();
      ::kill(children[i], SIGKILL);
      ::waitpid(children[i], nullptr, 0);
      const std::uint64_t due = rows_due(*lives[i], end_ns);
      due_in_all += due;
      const std::string part = folder.file(std::to_string(std::size_t(first) + i)) + ".part";
      const auto saved = recover(part, part + ".mcap");
      if (!saved) {
        EXPECT_EQ(due, 0u) << saved.error().message;
        continue;
      }
      EXPECT_GE(saved->samples, due) << words_of(*saved);
      EXPECT_EQ(saved->missing_rows, 0u);
      if (saved->samples == 0) continue;
      const Recording read = read_back(part + ".mcap");
      for (std::size_t k = 0; k < read.samples(); ++k)
        ASSERT_EQ(read.channels[2].values[k], static_cast<double>(k));
    }
    for (Life* life : lives) ::munmap(life, sizeof(Life));
  }
  RecordProperty("rows_due", std::to_string(due_in_all));
}

}  // namespace
}  // namespace proofmass::acquire::recover_test
