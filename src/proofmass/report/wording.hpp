#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "proofmass/core/number_words.hpp"
#include "proofmass/core/quantity.hpp"
#include "proofmass/core/recording.hpp"
#include "proofmass/core/recording_log.hpp"

// Formatted figures. Independent of the process's locale: the decimal mark is a point.
namespace proofmass::report {

/// "79.614 ± 0.002 turns": the standard deviation rounded to one or two significant digits and the
/// value to the same decimal; "−" as minus sign; "(4.90 ± 0.05)e-12 s" if both are below 1e-4. A
/// std of 0 is omitted. Source: Particle Data Group, Review of Particle Physics, Introduction,
/// section 5.3 (rounding).
[[nodiscard]] std::string with_std(const Uncertain& figure, std::string_view unit = "");

/// The same, or `absent` if there is no figure.
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

/// A length in a suitable unit: "0.12 mm", "15 mm", "1.6 m", "7900 km".
[[nodiscard]] std::string length_words(double length_m);

/// A duration: "0.52 s", "91.6 s", "12 min 5 s", "3 h 20 min", "1 h".
[[nodiscard]] std::string duration_words(double duration_s);

/// "12 000": thousands separated.
[[nodiscard]] std::string grouped(std::size_t count);

/// "1 sample", "12 000 samples": a count with its noun, thousands separated.
[[nodiscard]] std::string count_words(std::size_t count, std::string_view noun);

/// "m/s^2/sqrt(Hz)" as printed: "m/s²/√Hz".
[[nodiscard]] std::string print_unit(std::string_view symbol);

/// The text with the options that would help, as the program spells them: "the samples have neither
/// time nor rate (use --rate)".
[[nodiscard]] std::string with_flags(const Note& note);
[[nodiscard]] std::string with_flags(const Error& error);
[[nodiscard]] std::string with_flags(const RecordEvent& event);

/// "a, b and c".
[[nodiscard]] std::string joined(const std::vector<std::string>& words);

/// Names of the first four files: "a.csv and b.csv", "a.csv, b.csv, c.csv, d.csv and 3 more".
[[nodiscard]] std::string file_names(const std::vector<std::string>& paths);

/// The last component of a path; text after the path is kept ("a/b.csv: acc1" becomes "b.csv:
/// acc1").
[[nodiscard]] std::string file_name(std::string_view path);

/// Number of code points in UTF-8 text.
[[nodiscard]] std::size_t letters(std::string_view text);

/// Rows of cells for a terminal: each line begins with two blanks; columns are left-aligned, two
/// blanks apart. Rows may be of different lengths.
[[nodiscard]] std::string aligned(const std::vector<std::vector<std::string>>& rows);

/// Text for use in HTML and SVG: & < > " ' escaped, control characters removed.
[[nodiscard]] std::string escaped(std::string_view text);

}  // namespace proofmass::report
