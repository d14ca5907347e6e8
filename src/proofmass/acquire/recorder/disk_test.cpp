#include <algorithm>
#include <csignal>
#include <filesystem>
#include <functional>
#include <gtest/gtest.h>
#include <map>
#include <mutex>
#include <span>
#include <sys/mount.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "proofmass/acquire/recorder/record_test_support.hpp"
#include "proofmass/acquire/recorder/session.hpp"
#include "proofmass/acquire/stream/scripted_source_test_support.hpp"

namespace proofmass::acquire::record_disk_test {
namespace {

/// Behaviour of a disk in memory.
struct DiskPlan {
  std::size_t room = ~std::size_t{0};  ///< total bytes of all files
  std::chrono::milliseconds each{0};   ///< duration of an append
  bool has_no_room_for_the_end = false;
  bool refuses_names = false;
};

/// A disk in memory: its files by name.
struct TestDisk {
  DiskPlan plan;
  std::map<std::string, std::string> files{};
  std::size_t created = 0;
  std::mutex mutex{};  ///< one file is created while another is written

  [[nodiscard]] std::size_t used() const {
    std::size_t bytes = 0;
    for (const auto& [name, file] : files) bytes += file.size();
    return bytes;
  }
};

class TestPart final : public PartFile {
 public:
  TestPart(TestDisk& disk, PartNames names) : disk_(disk), names_(std::move(names)) {
    const std::scoped_lock lock(disk_.mutex);
    disk_.files[names_.part];
  }
  Status append(std::string_view bytes) override {
    std::this_thread::sleep_for(disk_.plan.each);
    const std::scoped_lock lock(disk_.mutex);
    const std::size_t room = disk_.plan.room - std::min(disk_.plan.room, disk_.used());
    disk_.files[names_.part] += bytes.substr(0, room);
    if (bytes.size() <= room) return Done{};
    return Error{Errc::unwritable, names_.part + ": cannot be written: No space left on device"};
  }
  Status sync() override { return Done{}; }
  Status truncate(std::uint64_t bytes) override {
    const std::scoped_lock lock(disk_.mutex);
    disk_.files[names_.part].resize(bytes);
    // Releases the reserved space.
    disk_.plan.room = disk_.plan.has_no_room_for_the_end ? disk_.used() : ~std::size_t{0};
    return Done{};
  }
  Status keep() override {
    const std::scoped_lock lock(disk_.mutex);
    if (disk_.plan.refuses_names) return Error{Errc::unwritable, names_.path + ": is there by now"};
    disk_.files[names_.path] = std::move(disk_.files[names_.part]);
    disk_.files.erase(names_.part);
    return Done{};
  }
  void discard() override {
    const std::scoped_lock lock(disk_.mutex);
    disk_.files.erase(names_.part);
  }

 private:
  TestDisk& disk_;
  PartNames names_;
};

Result<RecordSummary> record_on(TestDisk& disk,
                                const OpenSource& open,
                                const RecordOptions& options,
                                const RecordWatch& watch = {}) {
  const MakeAnalysis none;
  // Rotated files are numbered by the contents of a folder, which does not exist here.
  const auto create = [&](PartNames names) {
    const std::string number = std::to_string(disk.created++);
    if (options.rotate_s) names = {number, number + ".part"};
    return Result<std::unique_ptr<PartFile>>(std::make_unique<TestPart>(disk, std::move(names)));
  };
  RecordSession session(open, options, watch, none, create);
  return session.run();
}

Recording read_bytes(const std::string& bytes) {
  auto read = io::read_recording(std::as_bytes(std::span(bytes)), "disk", {});
  if (!read) ADD_FAILURE() << read.error().message;
  return read ? std::move(read).value() : Recording{};
}

/// True if a recording has any fault.
bool is_flawed(const Recording& recording) {
  return std::ranges::any_of(recording.notes,
                             [](const Note& note) { return note.severity != Severity::info; });
}

TEST(RecordDisk, KeepsAndClosesWhatADiskTookThatIsFull) {
  TestDisk disk{{.room = 3'000'000}};
  const auto summary =
      record_on(disk, open_scripts({{.acts = arrivals(20'000)}}), {.path = "run.mcap"});
  ASSERT_TRUE(summary);
  EXPECT_EQ(summary->end, RecordEnd::disk_failed);
  EXPECT_EQ(summary->end_reason, "run.mcap.part: cannot be written: No space left on device");
  EXPECT_EQ(summary->files, std::vector<std::string>{"run.mcap"});
  const Recording read = read_bytes(disk.files.at("run.mcap"));
  EXPECT_FALSE(is_flawed(read)) << all_notes(read);
  EXPECT_EQ(read.samples(), summary->samples);
  EXPECT_GT(read.samples(), 50'000u);
  EXPECT_GT(summary->not_written, 0u);
  EXPECT_EQ(summary->lost, summary->not_written);
  EXPECT_NE(all_notes(read).find("1 disk_full"), std::string::npos) << all_notes(read);
  for (std::size_t k = 0; k < read.samples(); ++k)
    ASSERT_EQ(read.channels[0].values[k], static_cast<double>(k));
}

TEST(RecordDisk, KeepsWholeChunksWhereNoEndFits) {
  TestDisk disk{{.room = 3'000'000, .has_no_room_for_the_end = true}};
  const auto summary =
      record_on(disk, open_scripts({{.acts = arrivals(20'000)}}), {.path = "run.mcap"});
  ASSERT_TRUE(summary);
  EXPECT_EQ(summary->end, RecordEnd::disk_failed);
  const Recording read = read_bytes(disk.files.at("run.mcap"));
  EXPECT_EQ(read.samples(), summary->samples);
  EXPECT_GT(read.samples(), 50'000u);
  EXPECT_NE(all_notes(read).find("without its closing records"), std::string::npos);
}

TEST(RecordDisk, TellsAFileThatGotNoName) {
  TestDisk disk{{.refuses_names = true}};
  const auto summary =
      record_on(disk, open_scripts({{.acts = arrivals(100)}}), {.path = "run.mcap"});
  ASSERT_TRUE(summary);
  EXPECT_EQ(summary->end, RecordEnd::disk_failed);
  EXPECT_EQ(summary->end_reason, "run.mcap: is there by now");
  EXPECT_TRUE(summary->files.empty());
  EXPECT_EQ(read_bytes(disk.files.at("run.mcap.part")).samples(), 1000u);
  EXPECT_EQ(summary->not_written, 0u);
}

TEST(RecordDisk, CountsTheRowsOfAllFilesThatItFailedUnder) {
  TestDisk disk{{.room = 5'000'000}};
  const auto summary = record_on(disk, open_scripts({{.acts = arrivals(40'000)}}),
                                 {.path = "no-such-folder/run.mcap", .rotate_s = 500.0});
  ASSERT_TRUE(summary);
  EXPECT_EQ(summary->end, RecordEnd::disk_failed);
  std::uint64_t rows = 0;
  for (const auto& [name, bytes] : disk.files)
    if (const auto read = io::read_recording(std::as_bytes(std::span(bytes)), name, {}))
      rows += read->samples();
  EXPECT_EQ(summary->samples, rows);
  EXPECT_GT(summary->not_written, 0u);
}

TEST(RecordDisk, HoldsNoMoreThanItMayWhileTheDiskIsSlow) {
  TestDisk disk{{.each = std::chrono::milliseconds(30)}};
  Script script{.acts = arrivals(3000, {.rows = 100}), .has_device_clock = false};
  script.is_paced = true;
  const auto summary =
      record_on(disk, open_scripts({script}), {.path = "run.mcap", .queue_bytes = 400'000});
  ASSERT_TRUE(summary);
  EXPECT_EQ(summary->samples + summary->overrun, 300'000u);
  // 300 000 rows are 7 MB: those neither queued nor written were dropped and counted.
  EXPECT_GT(summary->overrun, 0u);
  EXPECT_EQ(read_bytes(disk.files.at("run.mcap")).samples(), summary->samples);
}

/// Runs in a child process with its own limits; true if it succeeded.
bool in_child(const std::function<bool()>& work) {
  const pid_t child = ::fork();
  if (child == 0) ::_exit(work() ? 0 : 1);
  int status = 0;
  ::waitpid(child, &status, 0);
  return WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

TEST(RecordDisk, IsClosedUnderALimitOfTheFilesSize) {
  const TestFolder folder;
  const std::string path = folder.file("run.mcap");
  EXPECT_TRUE(in_child([&] {
    std::signal(SIGXFSZ, SIG_IGN);
    const rlimit limit{1'500'000, 1'500'000};
    if (::setrlimit(RLIMIT_FSIZE, &limit) != 0) return false;
    const auto summary = record(open_scripts({{.acts = arrivals(20'000)}}), {.path = path});
    return summary && summary->end == RecordEnd::disk_failed && summary->samples > 20'000 &&
           summary->files == std::vector{path} && summary->not_written > 0;
  }));
  const Recording read = read_back(path);
  EXPECT_GT(read.samples(), 20'000u);
  EXPECT_FALSE(is_flawed(read)) << all_notes(read);
}

TEST(RecordDisk, IsClosedOnAFileSystemThatIsFull) {
  const TestFolder folder;
  const std::string place = folder.file("small");
  std::filesystem::create_directory(place);
  if (::mount("tmpfs", place.c_str(), "tmpfs", 0, "size=4m") != 0)
    GTEST_SKIP() << "a small file system cannot be mounted here: run it as root";
  const std::string path = place + "/run.mcap";
  const auto summary = record(open_scripts({{.acts = arrivals(30'000)}}), {.path = path});
  ASSERT_TRUE(summary);
  EXPECT_EQ(summary->end, RecordEnd::disk_failed);
  EXPECT_NE(summary->end_reason.find("No space left"), std::string::npos);
  const Recording read = read_back(path);
  EXPECT_EQ(read.samples(), summary->samples);
  EXPECT_GT(read.samples(), 50'000u);
  EXPECT_FALSE(is_flawed(read)) << all_notes(read);
  ::umount2(place.c_str(), MNT_DETACH);
}

}  // namespace
}  // namespace proofmass::acquire::record_disk_test
