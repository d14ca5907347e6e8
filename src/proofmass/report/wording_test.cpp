#include "proofmass/report/wording.hpp"

#include <cmath>
#include <gtest/gtest.h>

namespace proofmass::report::wording_test {
namespace {

// The three examples of the Review of Particle Physics, Introduction, section 5.3.
TEST(WithStd, RoundsAsTheParticleDataGroupDoes) {
  EXPECT_EQ(with_std({0.827, 0.119}), "0.83 ± 0.12");
  EXPECT_EQ(with_std({0.827, 0.367}), "0.8 ± 0.4");
  EXPECT_EQ(with_std({0.827, 0.952}), "0.8 ± 1.0");
}

TEST(WithStd, PutsTheUnitBehindAndADegreeSignCloseUp) {
  EXPECT_EQ(with_std({79.6141, 0.0021}, "turns"), "79.6141 ± 0.0021 turns");
  EXPECT_EQ(with_std({-12.34, 0.5}, "°"), "−12.3 ± 0.5°");
}

TEST(WithStd, RoundsLargeFiguresToWholeTens) {
  EXPECT_EQ(with_std({12345.0, 400.0}), "12300 ± 400");
  EXPECT_EQ(with_std({4.898e-12, 4.7e-14}, "s"), "(4.90 ± 0.05)e-12 s");
  EXPECT_EQ(with_std({1e-13, 2.5e-12}), "(0.1 ± 2.5)e-12");
}

TEST(WithStd, LeavesAwayAStdOfZeroAndSaysNoneOfWhatIsNotFinite) {
  EXPECT_EQ(with_std({1.5, 0.0}, "m"), "1.50000 m");
  EXPECT_EQ(with_std({std::nan(""), 1.0}), "none");
  EXPECT_EQ(with_std(std::nullopt, "m", "not determined"), "not determined");
}

// Cells of table 2.1 of the thesis, where "015 mm" is 15 mm.
TEST(LengthWords, ChoosesTheUnitThatSuits) {
  EXPECT_EQ(length_words(0.00012258), "0.12 mm");
  EXPECT_EQ(length_words(0.0147), "15 mm");
  EXPECT_EQ(length_words(5.3), "5.3 m");
  EXPECT_EQ(length_words(7.943e6), "7900 km");
  EXPECT_EQ(length_words(2.0e-6), "2.0 µm");
}

TEST(DurationWords, CarriesSecondsIntoMinutesAndMinutesIntoHours) {
  EXPECT_EQ(duration_words(91.64), "91.6 s");
  EXPECT_EQ(duration_words(725.0), "12 min 5 s");
  EXPECT_EQ(duration_words(3599.9), "1 h");
  EXPECT_EQ(duration_words(60.0), "60 s");
  EXPECT_EQ(duration_words(12000.0), "3 h 20 min");
}

TEST(CountWords, DistinguishesSingularAndPluralAndSeparatesThousands) {
  EXPECT_EQ(count_words(1, "row"), "1 row");
  EXPECT_EQ(count_words(0, "row"), "0 rows");
  EXPECT_EQ(count_words(1234567, "row"), "1\u202f234\u202f567 rows");
}

TEST(Escaped, EscapesAllMarkup) {
  EXPECT_EQ(escaped("<a href='x'>&\"\x01</a>"), "&lt;a href=&#39;x&#39;&gt;&amp;&quot;&lt;/a&gt;");
}

TEST(Aligned, CountsLettersAndNotBytes) {
  EXPECT_EQ(aligned({{"µm", "1"}, {"m", "22"}}), "  µm  1\n  m   22\n");
}

TEST(FileName, IsTheLastComponentOfThePath) {
  EXPECT_EQ(file_name("/data/run 1/a.csv: acc1"), "a.csv: acc1");
  EXPECT_EQ(file_name("a.csv"), "a.csv");
  EXPECT_EQ(file_name("folder/"), "folder/");
}

TEST(PrintUnit, RaisesPowersAndDrawsRoots) {
  EXPECT_EQ(print_unit("m/s^2"), "m/s²");
  EXPECT_EQ(print_unit("m/s^2/sqrt(Hz)"), "m/s²/√Hz");
  EXPECT_EQ(print_unit("V/sqrt(s)"), "V/√s");
}

TEST(WithFlags, NamesThoseThatHelp) {
  EXPECT_EQ(with_flags(Note{Severity::info, "no rate"}), "no rate");
  EXPECT_EQ(with_flags(Note{Severity::info, "no rate", {Advice{"rate"}}}), "no rate (use --rate)");
  EXPECT_EQ(
      with_flags(
          Error{Errc::not_observable, "no rest", {Advice{"rests", "ends"}, Advice{"still"}}}.at(
              "a.csv")),
      "a.csv: no rest (use --rests ends or --still)");
  EXPECT_EQ(with_flags(Note{Severity::info, "also b", {Advice{"variable", "b c"}}}.at("f")),
            "f: also b (use --variable \"b c\")");
}

TEST(Joined, HasAndBeforeTheLast) {
  EXPECT_EQ(joined({}), "");
  EXPECT_EQ(joined({"a"}), "a");
  EXPECT_EQ(joined({"a", "b", "c"}), "a, b and c");
}

TEST(FileNames, AreThoseOfTheFirstFour) {
  EXPECT_EQ(file_names({"d/a.csv", "b.csv"}), "a.csv and b.csv");
  EXPECT_EQ(file_names({"a", "b", "c", "d", "e", "f"}), "a, b, c, d and 2 more");
}

}  // namespace
}  // namespace proofmass::report::wording_test
