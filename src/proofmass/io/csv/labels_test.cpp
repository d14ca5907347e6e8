#include <cmath>
#include <gtest/gtest.h>

#include "proofmass/io/csv/word_runs.hpp"
#include "proofmass/io/positions/direction_label.hpp"
#include "proofmass/io/test_support.hpp"

namespace proofmass::io::csv_labels_test {
namespace {

using Labels = std::vector<Label>;

TEST(CsvLabels, KeepAColumnOfWordsAsRuns) {
  const auto read = read_text("part,t,a\nx_a,0,1\nx_a,0.1,2\nx_p,0.2,3\nx_p,0.3,4\nx_a,0.4,5\n");
  ASSERT_TRUE(read.has_value());
  EXPECT_EQ(read->label_channel, "part");
  EXPECT_EQ(read->labels, (Labels{{"x_a", 0, 1}, {"x_p", 2, 3}, {"x_a", 4, 4}}));
  EXPECT_TRUE(is_noted(*read, "part: words, kept as labels")) << notes_of(*read);
  EXPECT_FALSE(is_noted(*read, "left out"));
}

TEST(CsvLabels, MayBeQuotedBlankSeparatedOrLastOnTheLine) {
  const auto quoted = read_text("t,a,part\r\n0,1,\"x, up\"\r\n1,2,\"x, up\"\r\n2,3,down\r\n");
  ASSERT_TRUE(quoted.has_value());
  EXPECT_EQ(quoted->labels, (Labels{{"x, up", 0, 1}, {"down", 2, 2}}));
  const auto plain = read_text("t,a,part\r\n0,1,up\r\n1,2,up\r\n2,3,down\r\n");
  ASSERT_TRUE(plain.has_value());
  EXPECT_EQ(plain->labels, (Labels{{"up", 0, 1}, {"down", 2, 2}}));
  const auto blanks = read_text("t part a\n0 up 1\n1 up 2\n2 down 3\n");
  ASSERT_TRUE(blanks.has_value());
  EXPECT_EQ(blanks->labels, (Labels{{"up", 0, 1}, {"down", 2, 2}}));
}

TEST(CsvLabels, LeaveSamplesWithoutAWordOut) {
  const auto read = read_text(
      "t,part,a\n0,up,1\n1,,2\n2,up,3\n3,-,4\n4,None,5\n5,up,6\n6,up,7\n7,up,8\n8,up,9\n");
  ASSERT_TRUE(read.has_value());
  EXPECT_EQ(read->labels, (Labels{{"up", 0, 0}, {"up", 2, 2}, {"up", 5, 8}}));
}

TEST(CsvLabels, CountSamplesAndNotLines) {
  const auto read = read_text(
      "part,t,a\nup,0,1\n\n# a remark\nup,1,2\nup,***,lost\nup,2,3\ndown,3\ndown,4,nan\n"
      "down,5,6,7,8\n\"down\",6,7\n");
  ASSERT_TRUE(read.has_value());
  ASSERT_EQ(read->samples(), 7u) << notes_of(*read);
  EXPECT_EQ(read->labels, (Labels{{"up", 0, 2}, {"down", 3, 6}}));
}

TEST(CsvLabels, StayWithTheirSamplesWhereStampsAreMended) {
  const auto read = read_text(
      "t,part,a\n0,up,1\n1,up,2\n1e9,up,3\n3,down,4\nbad,down,5\n5,down,6\n4,side,7\n7,side,8\n");
  ASSERT_TRUE(read.has_value());
  ASSERT_EQ(read->samples(), 8u) << notes_of(*read);
  EXPECT_EQ(read->labels, (Labels{{"up", 0, 2}, {"down", 3, 5}, {"side", 6, 7}}));
}

TEST(CsvLabels, AreFoundWhereverTheyBegin) {
  for (const int first : {0, 150, 1500, 40'000}) {
    std::string text = "t,part,a\n";
    const int rows = 60'000;
    for (int k = 0; k < rows; ++k)
      text += std::to_string(k) + (k >= first && k < first + 100 ? ",up," : ",,") + "1.5\n";
    const auto read = read_text(text);
    ASSERT_TRUE(read.has_value()) << read.error().message;
    ASSERT_EQ(read->samples(), static_cast<std::size_t>(rows)) << notes_of(*read);
    const auto begin = static_cast<std::size_t>(first);
    EXPECT_EQ(read->labels, (Labels{{"up", begin, begin + 99}})) << notes_of(*read);
    ASSERT_EQ(read->channels.size(), 1u);
    EXPECT_EQ(read->channels[0].name, "a");
    EXPECT_FALSE(is_noted(*read, "no number")) << notes_of(*read);
  }
}

TEST(CsvLabels, AreNoWordsAmongNumbers) {
  const auto read = read_text("t,a,b\n0,1,2\n1,lost,3\n2,4,5\n3,6,7\n");
  ASSERT_TRUE(read.has_value());
  EXPECT_TRUE(read->labels.empty());
  EXPECT_TRUE(std::isnan(read->channels[0].values[1]));
  EXPECT_TRUE(is_noted(*read, "a: 1 field is not a number, the first \"lost\" on line 3"));
  std::string late = "t,a,b\n";
  for (int k = 0; k < 300; ++k) late += std::to_string(k) + ",,2\n";
  const auto mixed = read_text(late + "300,lost,3\n301,5,6\n302,,6\n" + late.substr(6));
  ASSERT_TRUE(mixed.has_value());
  EXPECT_TRUE(mixed->labels.empty());
  EXPECT_EQ(mixed->channels.size(), 2u) << "a column with a figure in it is a channel";
}

TEST(CsvLabels, AreTheFirstWordsThatChange) {
  const auto two =
      read_text("dev,t,part,a,b,c\nimu,0,up,1,1,1\nimu,1,up,2,2,2\nimu,2,down,3,3,3\n");
  ASSERT_TRUE(two.has_value());
  EXPECT_EQ(two->label_channel, "part");
  EXPECT_TRUE(is_noted(*two, "dev: left out, being words")) << notes_of(*two);
  const auto one = read_text("dev,t,a\nimu,0,1\nimu,1,2\n");
  ASSERT_TRUE(one.has_value());
  EXPECT_EQ(one->labels, (Labels{{"imu", 0, 1}}));
}

TEST(CsvLabels, AreNotTextThatNeverRepeats) {
  std::string text = "message,t,a\n";
  for (int k = 0; k < 1000; ++k)
    text += "m" + std::to_string(k) + "q," + std::to_string(k) + ",1\n";
  const auto read = read_text(text);
  ASSERT_TRUE(read.has_value());
  EXPECT_EQ(read->samples(), 1000u);
  EXPECT_TRUE(read->labels.empty());
  EXPECT_TRUE(read->label_channel.empty());
  EXPECT_TRUE(is_noted(*read, "message: left out, being words")) << notes_of(*read);
}

TEST(CsvLabels, NeedNoTimeColumn) {
  const auto read = read_text("part,a (g)\nup,1\nup,2\ndown,3\n");
  ASSERT_TRUE(read.has_value()) << read.error().message;
  EXPECT_EQ(read->labels, (Labels{{"up", 0, 1}, {"down", 2, 2}}));
  EXPECT_FALSE(read_text("t,part\n0,up\n1,up\n2,down\n").has_value()) << "labels of nothing";
}

TEST(CsvLabels, ReadThePublishedFerrarisSession) {
  const auto file = published_data() / "imucal-ferraris/annotated_session.csv.xz";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "no published recordings here";
  const auto read = read_recording(file, {});
  ASSERT_TRUE(read.has_value()) << read.error().message;
  EXPECT_EQ(read->label_channel, "part");
  // Counted by a script of ten lines.
  ASSERT_EQ(read->labels.size(), 9u);
  EXPECT_EQ(read->labels[0], (Label{"x_a", 0, 1060}));
  EXPECT_EQ(read->labels[1], (Label{"x_p", 1061, 2088}));
  EXPECT_EQ(read->labels[2], (Label{"x_rot", 2089, 3393}));
  EXPECT_EQ(read->labels[8].text, "z_rot");
  EXPECT_EQ(read->labels[8].last, read->samples() - 1);
  for (const Label& label : read->labels) {
    const auto up = direction_of_label(label.text);
    ASSERT_EQ(up.has_value(), !label.text.ends_with("rot")) << label.text;
    if (!up) continue;
    double along = 0.0;
    for (std::size_t axis = 0; axis < 3; ++axis)
      along += (*up)[axis] * read->find("acc_" + std::string(1, static_cast<char>('x' + axis)))
                                 ->values[label.first + 10];
    EXPECT_GT(along, 1500.0) << label.text << ": about 2048 counts along the force";
  }
}

TEST(WordRuns, GiveUpWhereTheWordsAreNoNames) {
  WordRuns names;
  for (std::size_t k = 0; k <= WordRuns::most_names; ++k) names.add(k, std::to_string(k) + "a");
  EXPECT_EQ(names.runs(), 0u);
  WordRuns runs;
  for (std::size_t k = 0; k <= WordRuns::most_runs; ++k) runs.add(k, k % 2 == 0 ? "a" : "b");
  EXPECT_EQ(runs.runs(), 0u);
  runs.add(WordRuns::most_runs + 1, "a");
  EXPECT_EQ(runs.runs(), 0u);
  WordRuns longer;
  longer.add(0, std::string(WordRuns::longest_name + 1, 'a'));
  EXPECT_EQ(longer.runs(), 0u);
}

TEST(WordRuns, EndWhereARowIsMissing) {
  WordRuns words;
  words.add(3, "up");
  words.add(4, " up");
  words.add(6, "up");
  EXPECT_EQ(words.labels(), (Labels{{"up", 3, 4}, {"up", 6, 6}}));
  EXPECT_EQ(words.names(), 1u);
}

}  // namespace
}  // namespace proofmass::io::csv_labels_test
