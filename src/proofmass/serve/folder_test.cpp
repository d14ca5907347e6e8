#include "proofmass/serve/folder.hpp"

#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>

#include "proofmass/serve/temporary.hpp"

namespace proofmass::serve::folder_test {
namespace {

namespace fs = std::filesystem;

class FolderTest : public testing::Test {
 protected:
  void SetUp() override {
    write("served/a.csv", "1,2\n");
    write("served/sub/b.csv", "1\n");
    write("served/.hidden.csv", "1\n");
    write("served/notes.txt.bak", "1\n");
    write("served-next/c.csv", "1\n");
    write("secret.csv", "1\n");
    fs::create_symlink(root() / "secret.csv", root() / "served/leak.csv");
    fs::create_symlink(root(), root() / "served/up");
    fs::create_symlink("a.csv", root() / "served/alias.csv");
  }
  void write(const std::string& name, const std::string& text) {
    fs::create_directories((root() / name).parent_path());
    std::ofstream(root() / name) << text;
  }
  [[nodiscard]] fs::path root() const { return home_.path(); }
  [[nodiscard]] Folder served() const { return Folder::open((root() / "served").string()).value(); }

  TemporaryFolder home_ = TemporaryFolder::make(testing::TempDir()).value();
};

TEST_F(FolderTest, FindsFilesWithinIt) {
  EXPECT_EQ(served().existing("a.csv").value(), "a.csv");
  EXPECT_EQ(served().existing("./sub//b.csv").value(), "sub/b.csv");
  EXPECT_EQ(served().existing("alias.csv").value(), "alias.csv");
}

TEST_F(FolderTest, NoNameLeadsOutOfIt) {
  const std::string absolute = (root() / "secret.csv").string();
  for (const std::string& name : {std::string("../secret.csv"), std::string("sub/../../secret.csv"),
                                  std::string("sub/../a.csv"), absolute, std::string("leak.csv"),
                                  std::string("up/secret.csv"), std::string("up/served-next/c.csv"),
                                  std::string("../served-next/c.csv"), std::string(),
                                  std::string("."), std::string("a.csv\0b", 7)}) {
    const auto found = served().existing(name);
    ASSERT_FALSE(found) << name;
  }
  EXPECT_EQ(served().existing("leak.csv").error().code, Errc::invalid_argument);
  EXPECT_EQ(served().existing("up/secret.csv").error().code, Errc::invalid_argument);
  EXPECT_EQ(served().existing("none.csv").error().code, Errc::unreadable);
  EXPECT_EQ(served().existing("sub").error().code, Errc::unreadable);
}

TEST_F(FolderTest, ListsWhatEndsLikeARecordingWithoutLinksOutOfIt) {
  std::vector<std::string> names;
  for (const FolderEntry& entry : served().list({".csv"}, 100)) names.push_back(entry.name);
  EXPECT_EQ(names, (std::vector<std::string>{"a.csv", "alias.csv", "sub/b.csv"}));
  EXPECT_EQ(served().list({".csv"}, 100).front().bytes, 4U);
  EXPECT_EQ(served().list({".csv"}, 2).size(), 2U);
}

TEST_F(FolderTest, OfOneFileServesNothingElse) {
  const Folder one = Folder::open((root() / "served/a.csv").string()).value();
  EXPECT_EQ(one.only(), "a.csv");
  EXPECT_TRUE(one.existing("a.csv"));
  EXPECT_FALSE(one.existing("alias.csv"));
  EXPECT_FALSE(one.existing("sub/b.csv"));
  EXPECT_EQ(one.list({".csv"}, 100).size(), 1U);
  EXPECT_FALSE(one.adopt((root() / "served/sub/b.csv").string(), "new.csv"));
}

TEST_F(FolderTest, NeverWritesOverAFile) {
  write("served/.part", "new\n");
  const std::string part = (root() / "served/.part").string();
  EXPECT_EQ(served().adopt(part, "a.csv").value(), "a-2.csv");
  EXPECT_EQ(served().adopt(part, "a.csv").value(), "a-3.csv");
  EXPECT_EQ(fs::file_size(root() / "served/a.csv"), 4U);
  EXPECT_EQ(served().adopt(part, "leak.csv").value(), "leak-2.csv");
  EXPECT_EQ(fs::file_size(root() / "secret.csv"), 2U);
}

TEST_F(FolderTest, TakesNoNameWithAPath) {
  write("served/.part", "new\n");
  const std::string part = (root() / "served/.part").string();
  for (const std::string& name :
       {std::string("../x.csv"), std::string("sub/x.csv"), std::string("/x.csv"),
        std::string(".x.csv"), std::string(), std::string(201, 'x'), std::string("x\xff.csv")})
    EXPECT_FALSE(served().adopt(part, name)) << name;
}

TEST_F(FolderTest, IsAFolderOrAFileThatExists) {
  EXPECT_FALSE(Folder::open((root() / "none").string()));
}

}  // namespace
}  // namespace proofmass::serve::folder_test
