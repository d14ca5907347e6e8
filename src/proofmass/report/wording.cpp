#include "proofmass/report/wording.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "proofmass/core/units.hpp"
#include "proofmass/report/json.hpp"

namespace proofmass::report {
namespace {

// Decimals (negative: places before the point) at which rounding leaves std its significant digits.
int decimals_for(double std) {
  const int exponent = static_cast<int>(std::floor(std::log10(std)));
  const double leading = std::round(std / std::pow(10.0, exponent - 2));  // 100 … 1000
  return leading < 355.0 ? 1 - exponent : -exponent;  // 950 … 999 rounds up to one more digit
}

// " (use --from or --to)"; a value with spaces in quotes.
std::string flag_words(const std::vector<Advice>& advice) {
  std::string flags;
  for (const Advice& one : advice) {
    flags += (flags.empty() ? "--" : " or --") + one.option;
    if (one.value.empty()) continue;
    const bool quoted = one.value.find(' ') != std::string::npos;
    flags += fmt::format(" {1}{0}{1}", one.value, quoted ? "\"" : "");
  }
  return flags.empty() ? "" : " (use " + flags + ")";
}

}  // namespace

std::string with_std(const Uncertain& figure, std::string_view unit) {
  const std::string tail = (unit.empty() || unit == "°" ? "" : " ") + std::string(unit);
  if (!std::isfinite(figure.value) || !std::isfinite(figure.std)) return "none";
  if (figure.std <= 0.0) return significant(figure.value, 6) + tail;
  const double size = std::max(std::abs(figure.value), figure.std);
  constexpr double least_plain = 1e-4;
  if (size < least_plain) {
    const int exponent = static_cast<int>(std::floor(std::log10(size)));
    const double unity = std::pow(10.0, exponent);
    return fmt::format("({})e-{:02}{}",
                       with_std(Uncertain{figure.value / unity, figure.std / unity}), -exponent,
                       tail);
  }
  constexpr int most_decimals = 9;
  const int decimals = std::min(decimals_for(figure.std), most_decimals);
  return fmt::format("{} ± {}{}", fixed(figure.value, decimals), fixed(figure.std, decimals), tail);
}

std::string with_std(const std::optional<Uncertain>& figure,
                     std::string_view unit,
                     std::string_view absent) {
  return figure ? with_std(*figure, unit) : std::string(absent);
}

std::string degree_words(const std::optional<Uncertain>& angle_rad) {
  return with_std(scaled(angle_rad, deg_per_rad), "°", absent);
}

std::string length_words(double length_m) {
  if (!std::isfinite(length_m)) return "none";
  const double size = std::abs(length_m);
  if (size >= 1000.0) return significant(length_m / 1000.0, 2) + " km";
  if (size >= 1.0) return significant(length_m, 2) + " m";
  if (size >= 1e-4 || size == 0.0) return significant(length_m * 1e3, 2) + " mm";
  return significant(length_m * 1e6, 2) + " µm";
}

std::string duration_words(double duration_s) {
  if (!std::isfinite(duration_s)) return "none";
  if (duration_s < 600.0) return compact(duration_s, 3) + " s";
  const auto whole = static_cast<long long>(std::llround(duration_s));
  const bool short_one = whole < 3600;
  const long long smaller = short_one ? whole : (whole + 30) / 60;  // seconds or minutes
  std::string text = fmt::format("{} {}", smaller / 60, short_one ? "min" : "h");
  if (smaller % 60 != 0) text += fmt::format(" {} {}", smaller % 60, short_one ? "s" : "min");
  return text;
}

std::string grouped(std::size_t count) {
  std::string digits = std::to_string(count);
  // U+202F, a narrow space that does not break.
  for (std::size_t i = digits.size(); i > 3; i -= 3) digits.insert(i - 3, "\u202f");
  return digits;
}

std::string count_words(std::size_t count, std::string_view noun) {
  return fmt::format("{} {}{}", grouped(count), noun, count == 1 ? "" : "s");
}

std::string print_unit(std::string_view symbol) {
  std::string text(symbol);
  for (const std::string_view power : {"^2", "^3"}) {
    for (std::size_t at = text.find(power); at != std::string::npos; at = text.find(power)) {
      text.replace(at, power.size(), power == "^2" ? "²" : "³");
    }
  }
  for (const std::string_view root : {"sqrt(Hz)", "sqrt(s)"}) {
    const std::size_t at = text.find(root);
    if (at != std::string::npos) text.replace(at, root.size(), root == "sqrt(s)" ? "√s" : "√Hz");
  }
  return text;
}

std::string with_flags(const Note& note) {
  return note.text + flag_words(note.advice);
}

std::string with_flags(const RecordEvent& event) {
  return event.text + flag_words(event.advice);
}

std::string with_flags(const Error& error) {
  return error.message + flag_words(error.advice);
}

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (std::size_t k = 0; k < words.size(); ++k)
    text += (k == 0 ? "" : k + 1 == words.size() ? " and " : ", ") + words[k];
  return text;
}

std::string file_names(const std::vector<std::string>& paths) {
  constexpr std::size_t most = 4;
  std::vector<std::string> names;
  for (std::size_t k = 0; k < std::min(paths.size(), most); ++k)
    names.push_back(file_name(paths[k]));
  if (paths.size() > most) names.push_back(fmt::format("{} more", paths.size() - most));
  return joined(names);
}

std::string file_name(std::string_view path) {
  const std::size_t folder = path.find_last_of('/');
  const bool inside = folder != std::string_view::npos && folder + 1 < path.size();
  return std::string(inside ? path.substr(folder + 1) : path);
}

std::size_t letters(std::string_view text) {
  return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), [](char c) {
    return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U;  // not a continuation byte of a code
                                                              // point
  }));
}

std::string aligned(const std::vector<std::vector<std::string>>& rows) {
  std::vector<std::size_t> widths;
  for (const auto& cells : rows) {
    widths.resize(std::max(widths.size(), cells.size()));
    for (std::size_t k = 0; k < cells.size(); ++k) {
      widths[k] = std::max(widths[k], letters(cells[k]));
    }
  }
  std::string text;
  for (const auto& cells : rows) {
    std::string line;
    for (std::size_t k = 0; k < cells.size(); ++k) {
      line += "  " + cells[k] + std::string(widths[k] - letters(cells[k]), ' ');
    }
    line.erase(line.find_last_not_of(' ') + 1);
    text += line + '\n';
  }
  return text;
}

std::string escaped(std::string_view text) {
  std::string out;
  out.reserve(text.size());
  for (const char c : text) {
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      case '\'':
        out += "&#39;";
        break;
      default:
        if (static_cast<unsigned char>(c) >= 0x20 || c == '\n') out += c;
    }
  }
  return out;
}

}  // namespace proofmass::report
