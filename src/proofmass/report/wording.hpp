#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "proofmass/core/number_words.hpp"
#include "proofmass/core/quantity.hpp"

// Figures as people read them. Never the process locale: the decimal mark is a point.
namespace proofmass::report {

/// "79.614 ± 0.002 turns": the standard deviation rounded to the one or two digits that mean
/// something, the value to the same place; "−" for a minus sign; "(4.90 ± 0.05)e-12 s" where both
/// lie below 1e-4. A std of 0 is left away. Source: Particle Data Group, Review of Particle
/// Physics, Introduction, section 5.3 (rounding).
[[nodiscard]] std::string with_std(const Uncertain& figure, std::string_view unit = "");

/// The same, or `absent` where there is no figure.
[[nodiscard]] std::string with_std(const std::optional<Uncertain>& figure,
                                   std::string_view unit,
                                   std::string_view absent);

/// Shown for a value that could not be determined.
inline constexpr std::string_view absent = "not determined";

using proofmass::compact;
using proofmass::fixed;
using proofmass::significant;

/// An angle in degrees, or `absent`.
[[nodiscard]] std::string degree_words(const std::optional<Uncertain>& angle_rad);

/// A length in the unit that suits it: "0.12 mm", "15 mm", "1.6 m", "7900 km".
[[nodiscard]] std::string length_words(double length_m);

/// A duration: "0.52 s", "91.6 s", "12 min 5 s", "3 h 20 min", "1 h".
[[nodiscard]] std::string duration_words(double duration_s);

/// "12 000": thousands apart.
[[nodiscard]] std::string grouped(std::size_t count);

/// "1 sample", "12 000 samples": a count with its noun, thousands apart.
[[nodiscard]] std::string count_words(std::size_t count, std::string_view noun);

/// "m/s^2/sqrt(Hz)" as print has it: "m/s²/√Hz".
[[nodiscard]] std::string print_unit(std::string_view symbol);

/// "a, b and c".
[[nodiscard]] std::string joined(const std::vector<std::string>& words);

/// Names of the first four files: "a.csv and b.csv", "a.csv, b.csv, c.csv, d.csv and 3 more".
[[nodiscard]] std::string file_names(const std::vector<std::string>& paths);

/// A file's name without the folders before it, and whatever stands behind it ("a/b.csv: acc1" is
/// "b.csv: acc1").
[[nodiscard]] std::string file_name(std::string_view path);

/// Letters (code points) of UTF-8 text.
[[nodiscard]] std::size_t letters(std::string_view text);

/// Rows of cells for a terminal: each line begins with two blanks, columns flush left and two
/// blanks apart. Rows may be of different lengths.
[[nodiscard]] std::string aligned(const std::vector<std::vector<std::string>>& rows);

/// Text as it may stand inside HTML and SVG: & < > " ' escaped, control characters left away.
[[nodiscard]] std::string escaped(std::string_view text);

}  // namespace proofmass::report
