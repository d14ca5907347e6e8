// Tables whose numbers are easily misread.
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <functional>
#include <gtest/gtest.h>
#include <string>
#include <vector>

#include "proofmass/io/test_support.hpp"

namespace proofmass::io::csv_misreading_test {
namespace {

/// A table of rows, header first, with the given separator and decimal mark.
std::string table(const std::vector<std::string>& header,
                  std::size_t rows,
                  char separator,
                  const std::function<std::string(std::size_t, std::size_t)>& cell) {
  std::string text;
  for (std::size_t c = 0; c < header.size(); ++c)
    text += (c == 0 ? "" : std::string(1, separator)) + header[c];
  for (std::size_t r = 0; r < rows; ++r) {
    text += '\n';
    for (std::size_t c = 0; c < header.size(); ++c)
      text += (c == 0 ? "" : std::string(1, separator)) + cell(r, c);
  }
  return text + '\n';
}

std::string with_comma(std::string figure) {
  std::ranges::replace(figure, '.', ',');
  return figure;
}

bool is_bad(const Recording& recording, std::string_view part) {
  return std::ranges::any_of(recording.notes, [&](const Note& note) {
    return note.severity == Severity::bad && note.text.find(part) != std::string::npos;
  });
}

TEST(CsvMisreading, OfAShortTableWithTabsAndAnEmptyFieldIsNone) {
  const std::vector<std::string> header{"time (s)", "ax (g)", "ay (g)", "az (g)"};
  for (const char point : {'.', ','})
    for (std::size_t rows = 3; rows < 60; ++rows)
      for (const std::size_t empty : {1u, 2u, 3u}) {
        const auto cell = [&](std::size_t r, std::size_t c) -> std::string {
          if (r == rows / 2 && c == empty) return "";
          const auto figure = c == 0 ? fmt::format("{:.2f}", 0.01 * static_cast<double>(r))
                                     : fmt::format("{}.5", 10 * r + c);
          return point == ',' ? with_comma(figure) : figure;
        };
        const auto read = read_text(table(header, rows, '\t', cell));
        ASSERT_TRUE(read) << rows << ": " << read.error().message;
        ASSERT_EQ(read->channels.size(), 3u) << rows;
        ASSERT_EQ(read->samples(), rows);
        for (std::size_t c = 1; c < 4; ++c)
          for (std::size_t r = 0; r < rows; ++r) {
            const double value = read->channels[c - 1].values[r];
            if (r == rows / 2 && c == empty)
              ASSERT_TRUE(std::isnan(value)) << rows << ' ' << r << ' ' << c;
            else
              ASSERT_EQ(value, static_cast<double>(10 * r + c) + 0.5) << rows << ' ' << r;
          }
      }
}

TEST(CsvMisreading, OfAColumnThatIsAlwaysEmptyIsNone) {
  const std::string text = table(
      {"time (s)", "ax (g)", "ay (g)", "az (g)"}, 6, '\t',
      [](std::size_t r, std::size_t c) { return c == 2 ? "" : fmt::format("{}", 10 * r + c); });
  const auto read = read_text(text);
  ASSERT_TRUE(read);
  ASSERT_NE(read->find("az"), nullptr);
  EXPECT_EQ(read->find("az")->values[1], 13.0);
  ASSERT_NE(read->find("ay"), nullptr);
  EXPECT_TRUE(std::isnan(read->find("ay")->values[1]));
}

TEST(CsvMisreading, OfALastColumnFilledInTheFirstRowOnlyIsNone) {
  for (const char point : {'.', ','}) {
    const std::string text = table({"time (s)", "ax (g)", "ay (g)", "az (g)", "T (degC)"}, 12, '\t',
                                   [&](std::size_t r, std::size_t c) -> std::string {
                                     if (c == 4 && r > 0) return "";
                                     const auto figure = fmt::format("{}.25", 10 * r + c);
                                     return point == ',' ? with_comma(figure) : figure;
                                   });
    const auto read = read_text(text);
    ASSERT_TRUE(read);
    ASSERT_EQ(read->samples(), 12u) << notes_of(*read);
    ASSERT_NE(read->find("ax"), nullptr);
    EXPECT_EQ(read->find("ax")->values[0], 1.25);
  }
}

TEST(CsvMisreading, KeepsTablesThatBlanksAlign) {
  // Occasional tabs, as inserted by an editor: the columns are separated by blanks.
  const auto read = read_text("t ax ay\n0.0\t1 2\n0.1 \t 3 4\n0.2  5\t\t6\n0.3 7  8\n");
  ASSERT_TRUE(read);
  ASSERT_EQ(read->channels.size(), 2u) << notes_of(*read);
  EXPECT_EQ(read->channels[1].values, (std::vector<double>{2, 4, 6, 8}));
}

TEST(CsvMisreading, OfThousandsAsDecimalsIsNone) {
  const auto counts = [](std::size_t r, std::size_t c) -> std::string {
    const std::size_t value = c == 0 ? 10 * r : 980 + r;
    return value < 1000 ? fmt::format("{}", value)
                        : fmt::format("{},{:03}", value / 1000, value % 1000);
  };
  const auto read = read_text(table({"t (ms)", "ax (counts)"}, 40, ';', counts));
  ASSERT_TRUE(read);
  ASSERT_EQ(read->samples(), 40u);
  for (std::size_t r = 0; r < 40; ++r)
    EXPECT_EQ(read->channels[0].values[r], 980.0 + static_cast<double>(r));
  EXPECT_TRUE(is_noted(*read,
                       "ax: thousands are separated, as in \"1,000\" on line 22, read as "
                       "1000"))
      << notes_of(*read);
}

TEST(CsvMisreading, OfDecimalsAsThousandsIsNone) {
  // Trimmed decimals, some of which happen to have three digits; and fixed ones that all have
  // three.
  const auto trimmed = read_text("t;ax\n0;1,125\n1;2\n2;3,375\n3;1,125\n4;2\n");
  ASSERT_TRUE(trimmed);
  EXPECT_EQ(trimmed->channels[0].values, (std::vector<double>{1.125, 2, 3.375, 1.125, 2}));
  const auto fixed = read_text("t;ax\n0;9,812\n1;9,803\n2;9,807\n");
  ASSERT_TRUE(fixed);
  EXPECT_EQ(fixed->channels[0].values, (std::vector<double>{9.812, 9.803, 9.807}));
}

TEST(CsvMisreading, KnowsThousandsOfEveryCountry) {
  struct Spelling {
    const char* figures;
    char separator, point;
  };
  for (const auto& [figures, separator, point] : {Spelling{"\"1,234.5\"", ',', '.'},
                                                  {"1,234.5", ';', '.'},
                                                  {"1.234,5", ';', ','},
                                                  {"1'234.5", ',', '.'},
                                                  {"1 234,5", ';', ','},
                                                  {"1\xC2\xA0"
                                                   "234,5",
                                                   '\t', ','},
                                                  {"1\xE2\x80\xAF"
                                                   "234,5",
                                                   ';', ','},
                                                  {"1_234.5", ',', '.'}}) {
    const std::string text =
        table({"t", "ax (counts)", "ay (counts)"}, 8, separator, [&](std::size_t r, std::size_t c) {
          std::string time = fmt::format("0.{}1", r);
          if (c == 0) return point == ',' ? with_comma(time) : time;
          return c == 1 ? std::string(figures) : fmt::format("{}", r + 1);
        });
    const auto read = read_text(text);
    ASSERT_TRUE(read) << figures << ": " << read.error().message;
    ASSERT_EQ(read->channels.size(), 2u) << figures << '\n' << notes_of(*read);
    EXPECT_EQ(read->channels[0].values, std::vector<double>(8, 1234.5)) << figures;
    EXPECT_EQ(read->channels[1].values[2], 3.0) << figures;
    EXPECT_TRUE(is_noted(*read, "thousands are separated")) << figures;
  }
}

TEST(CsvMisreading, KnowsTheThousandsOfAGermanTable) {
  const auto read = read_text(
      "Zeit (s);ax (counts);ay (counts)\n0,00;1.234;2,5\n0,01;1.235;2,75\n0,02;998;3,5\n");
  ASSERT_TRUE(read);
  ASSERT_EQ(read->channels.size(), 2u) << notes_of(*read);
  EXPECT_EQ(read->channels[0].values, (std::vector<double>{1234, 1235, 998}));
  EXPECT_EQ(read->channels[1].values, (std::vector<double>{2.5, 2.75, 3.5}));
}

TEST(CsvMisreading, OfAChannelAsLabelsIsBadData) {
  for (const char* figure :
       {"(0.5)", "5%", "5 %", "1.5D-03", "\xEF\xBC\x91\xEF\xBC\x92", "0.5 g"}) {
    const auto read =
        read_text(table({"t", "reading", "ay"}, 5, ';', [&](std::size_t r, std::size_t c) {
          return c == 1 ? std::string(figure) : fmt::format("{}", r + c);
        }));
    ASSERT_TRUE(read) << figure;
    EXPECT_TRUE(is_bad(*read, "reading: its fields are not numbers")) << figure << notes_of(*read);
  }
  const auto with_unit = read_text("t,ax (g),ay (g)\n0,low,1\n1,high,2\n2,low,3\n");
  ASSERT_TRUE(with_unit);
  EXPECT_TRUE(is_bad(*with_unit, "ax: its fields are not numbers")) << notes_of(*with_unit);
  for (const char* label : {"x_up", "pose 3", "1a", "1-2", "2024-01-05x", "+x"}) {
    const auto read =
        read_text(table({"t", "pose", "ay"}, 5, ';', [&](std::size_t r, std::size_t c) {
          return c == 1 ? std::string(label) : fmt::format("{}", r + c);
        }));
    ASSERT_TRUE(read) << label;
    EXPECT_FALSE(is_bad(*read, "")) << label << notes_of(*read);
  }
}

TEST(CsvMisreading, BehindASecondHeaderWithAnotherUnitIsRefused) {
  const auto refused = [](const std::string& text) {
    const auto read = read_text(text);
    return read ? "read" : read.error().message;
  };
  const std::string first = "t (s),ax (m/s^2),ay (m/s^2)\n0,9.8,1\n1,9.7,2\n";
  EXPECT_EQ(refused(first + "t (s),ax (g),ay (g)\n2,1.0,0.1\n3,1.0,0.2\n"),
            "text: line 4: a second header, by which ax is in g from here on, not in m/s^2: split "
            "the file there");
  EXPECT_EQ(refused(first + "s,g,g\n2,1.0,0.1\n"),
            "text: line 4: a second header, by which ax is in g from here on, not in m/s^2: split "
            "the file there");
  EXPECT_EQ(refused(first + "t (s),ay (m/s^2),ax (m/s^2)\n2,1,9.8\n"),
            "text: line 4: a second header, by which ay is column 2 from here on, not 3: split "
            "the file there");
  EXPECT_EQ(refused(first + "t (s),ax (m/s²),ay (m/s2)\n2,9.8,1\n"), "read");
  EXPECT_EQ(refused(first + "so,much,text\n2,9.8,1\n"), "read");
}

TEST(CsvMisreading, OfSixteenBitTextIsNoneHoweverShort) {
  const std::string wide("2\0,\0003\0\n\0", 8);
  const auto read = read_text(wide);
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(read->channels[0].values, (std::vector<double>{2}));
}

TEST(CsvMisreading, AQuotedTextOfSeveralLinesIsOneField) {
  std::string text = "t,a,note\n";
  for (int k = 0; k < 8; ++k)
    text += std::to_string(k) + "," + std::to_string(10 + k) +
            (k % 3 == 1 ? ",\"seen:\n5,6,7\nand 8\"\n" : ",still\n");
  const auto read = read_text(text);
  ASSERT_TRUE(read.has_value());
  ASSERT_EQ(read->samples(), 8U);
  for (std::size_t k = 0; k < 8; ++k)
    EXPECT_EQ(read->channels[0].values[k], 10.0 + static_cast<double>(k));
}

TEST(CsvMisreading, AQuoteThatNothingClosesIsAMarkLikeAnyOther) {
  const auto read = read_text("t,a,note\n0,1,\"5 in\n1,2,x\n2,3,x\n3,4,x\n");
  ASSERT_TRUE(read.has_value());
  EXPECT_EQ(read->samples(), 4U);
}

}  // namespace
}  // namespace proofmass::io::csv_misreading_test
