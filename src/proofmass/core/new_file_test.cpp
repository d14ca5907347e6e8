#include "proofmass/core/new_file.hpp"

#include <cstddef>
#include <fcntl.h>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <iterator>
#include <string>
#include <sys/stat.h>
#include <thread>
#include <unistd.h>
#include <vector>

namespace proofmass::new_file_test {
namespace {

namespace fs = std::filesystem;

class NewFiles : public testing::Test {
 protected:
  void SetUp() override { fs::create_directories(folder_); }
  void TearDown() override { fs::remove_all(folder_); }

  [[nodiscard]] std::string path(const std::string& name) const { return folder_ / name; }
  [[nodiscard]] std::string text(const std::string& name) const {
    std::ifstream in(folder_ / name, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  void put(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name, std::ios::binary) << text;
  }
  [[nodiscard]] std::ptrdiff_t files() const {
    return std::distance(fs::directory_iterator(folder_), {});
  }
  [[nodiscard]] mode_t mode(const std::string& name) const {
    struct stat found{};
    ::stat(path(name).c_str(), &found);
    return found.st_mode & 07777;
  }

 private:
  fs::path folder_ = fs::temp_directory_path() / ("proofmass_new_file_" + std::to_string(getpid()));
};

TEST_F(NewFiles, LeaveWhatIsThereAloneUntilTheyAreComplete) {
  put("a", "old");
  {
    NewFile file = NewFile::create(path("a")).value();
    ASSERT_TRUE(file.append("new"));
    EXPECT_EQ(text("a"), "old");
    EXPECT_EQ(files(), 2);
  }
  EXPECT_EQ(text("a"), "old");
  EXPECT_EQ(files(), 1);
  ASSERT_TRUE(write_file(path("a"), "new"));
  EXPECT_EQ(text("a"), "new");
  EXPECT_EQ(files(), 1);
}

TEST_F(NewFiles, NeverTakeANameThatSomebodyElseMayHave) {
  put("a.part", "what a recorder has left");
  put("victim", "victim");
  for (const char* name : {"a.part0", "a.part-"}) fs::create_symlink(path("victim"), path(name));
  ASSERT_TRUE(write_file(path("a"), "new"));
  EXPECT_EQ(text("a.part"), "what a recorder has left");
  EXPECT_EQ(text("victim"), "victim");
  // Two concurrent writers have separate files.
  NewFile one = NewFile::create(path("a")).value();
  NewFile other = NewFile::create(path("a")).value();
  EXPECT_NE(one.part_path(), other.part_path());
}

TEST_F(NewFiles, OfManyWritersOneWinsWhole) {
  const std::string bytes(1 << 16, ' ');
  std::vector<std::thread> writers;
  for (char letter = 'a'; letter < 'i'; ++letter)
    writers.emplace_back([&, letter] {
      for (int k = 0; k < 5; ++k)
        EXPECT_TRUE(write_file(path("x"), std::string(bytes.size(), letter)));
    });
  for (std::thread& writer : writers) writer.join();
  const std::string won = text("x");
  EXPECT_EQ(won, std::string(bytes.size(), won[0]));
  EXPECT_EQ(files(), 1);
}

TEST_F(NewFiles, KeepTheModeOfWhatTheyReplaceAndElseFollowTheUmask) {
  put("secret", "");
  ::chmod(path("secret").c_str(), 0600);
  const mode_t before = ::umask(027);
  EXPECT_TRUE(write_file(path("secret"), "new"));
  EXPECT_TRUE(write_file(path("fresh"), "new"));
  ::umask(before);
  EXPECT_EQ(mode("secret"), 0600u);
  EXPECT_EQ(mode("fresh"), 0640u);
}

TEST_F(NewFiles, KeepALinkAndReplaceWhatItLeadsTo) {
  fs::create_directory(path("room"));
  put("room/a", "old");
  fs::create_symlink("room/a", path("link"));
  ASSERT_TRUE(write_file(path("link"), "new"));
  EXPECT_TRUE(fs::is_symlink(path("link")));
  EXPECT_EQ(text("room/a"), "new");
  fs::create_symlink("room/b", path("to_nothing"));
  ASSERT_TRUE(write_file(path("to_nothing"), "made"));
  EXPECT_EQ(text("room/b"), "made");
  fs::create_symlink("round", path("round"));
  const Status round = write_file(path("round"), "");
  ASSERT_FALSE(round);
  EXPECT_NE(round.error().message.find("cannot be written"), std::string::npos);
}

TEST_F(NewFiles, AreWrittenIntoWhatIsNoRegularFile) {
  ASSERT_EQ(::mkfifo(path("pipe").c_str(), 0600), 0);
  std::string read;
  std::thread reader([&] { read = text("pipe"); });
  EXPECT_TRUE(write_file(path("pipe"), "through the pipe"));
  reader.join();
  EXPECT_EQ(read, "through the pipe");
  EXPECT_TRUE(fs::is_fifo(path("pipe")));
  EXPECT_TRUE(is_special_file(path("pipe")));
  // Creating a device node needs privileges; a link to the machine's own does not.
  fs::create_symlink("/dev/null", path("nothing"));
  EXPECT_TRUE(write_file(path("nothing"), "gone"));
  EXPECT_TRUE(fs::is_character_file("/dev/null"));
  EXPECT_TRUE(fs::is_symlink(path("nothing")));
}

TEST_F(NewFiles, SayWhyTheyCannotBe) {
  for (const auto& [name, why] : {std::pair{"none/a", "No such file"}, {".", "Is a directory"}}) {
    const Status written = write_file(path(name), "x");
    ASSERT_FALSE(written);
    EXPECT_EQ(written.error().code, Errc::unwritable);
    EXPECT_NE(written.error().message.find(why), std::string::npos) << written.error().message;
  }
  if (fs::exists("/dev/full")) {
    const Status full = write_file("/dev/full", "x");
    ASSERT_FALSE(full);
    EXPECT_EQ(full.error().message, "/dev/full: cannot be written: No space left on device");
  }
  EXPECT_EQ(files(), 0);
}

TEST_F(NewFiles, HaveRoomForTheirEndingAtAnyLengthOfName) {
  const std::string longest(255, 'n');
  ASSERT_TRUE(write_file(path(longest), "x"));
  EXPECT_EQ(text(longest), "x");
}

TEST_F(NewFiles, AreComparedByWhatTheyAreNotByTheirNames) {
  put("a", "");
  put("b", "");
  fs::create_directory(path("room"));
  put("room/c", "");
  fs::create_hard_link(path("a"), path("hard"));
  fs::create_symlink("a", path("soft"));
  for (const char* name : {"a", "./a", "room/../a", "hard", "soft"})
    EXPECT_TRUE(is_same_or_within(path(name), path("a"))) << name;
  EXPECT_FALSE(is_same_or_within(path("b"), path("a")));
  EXPECT_TRUE(is_same_or_within(path("room/c"), path("room")));
  EXPECT_FALSE(is_same_or_within(path("a"), path("room")));
  EXPECT_FALSE(is_same_or_within(path("room/new"), path("room"))) << "nothing is lost by it";
  EXPECT_TRUE(is_same_or_within(path("new"), path("room/../new")));
  EXPECT_TRUE(is_same_or_within("not_there", "./not_there"));
  EXPECT_FALSE(is_same_or_within("/dev/null", "/dev/null"));
}

}  // namespace
}  // namespace proofmass::new_file_test
