#include "proofmass/io/positions/direction_label.hpp"

#include <algorithm>
#include <string>
#include <vector>

#include "proofmass/io/names.hpp"

namespace proofmass::io {
namespace {

bool is_alphanumeric(char c) {
  return is_lower_letter(c) || (c >= '0' && c <= '9');
}

/// +1, -1, or 0 if the word is not a sign; single letters count only after the axis: "xa" is a
/// position, "ax" an acceleration.
int sign_of(std::string_view word, bool is_behind_axis) {
  if (is_any_of(word, {"pos", "positive", "plus", "up", "upward", "upwards"})) return 1;
  if (is_any_of(word, {"neg", "negative", "minus", "down", "downward", "downwards"})) return -1;
  if (!is_behind_axis) return 0;
  if (word == "p") return 1;
  return is_any_of(word, {"a", "n"}) ? -1 : 0;
}

/// State of parsing a label.
class Reading {
 public:
  void take_sign(int sign) {
    ++signs_;
    sign_ = sign;
  }

  /// A run of letters: an axis, a sign, both in one, or an irrelevant word.
  void take_word(std::string_view word) {
    if (is_any_of(word, {"axis", "g"})) return;
    if (const int sign = sign_of(word, axes_ > 0); sign != 0) return take_sign(sign);
    if (is_axis(word.front())) {
      const int sign = sign_of(word.substr(1), true);
      take_axis(word.front());
      if (sign != 0) take_sign(sign);
      if (sign == 0 && word.size() > 1) is_known_ = false;
    } else if (is_axis(word.back()) && sign_of(word.substr(0, word.size() - 1), false) != 0) {
      take_axis(word.back());
      take_sign(sign_of(word.substr(0, word.size() - 1), false));
    } else {
      is_known_ = false;
    }
  }

  [[nodiscard]] std::optional<std::array<double, 3>> direction() const {
    if (!is_known_ || axes_ != 1 || signs_ != 1) return std::nullopt;
    std::array<double, 3> direction{};
    direction[axis_] = sign_;
    return direction;
  }

 private:
  static bool is_axis(char c) { return c >= 'x' && c <= 'z'; }
  void take_axis(char c) {
    ++axes_;
    axis_ = static_cast<std::size_t>(c - 'x');
  }

  bool is_known_ = true;
  int axes_ = 0;
  int signs_ = 0;
  std::size_t axis_ = 0;
  int sign_ = 0;
};

/// Lower case, with a plain minus for the typographic one.
std::string plain(std::string_view label) {
  std::string text = lower(label);
  constexpr std::string_view minus = "\u2212";
  for (std::size_t at = text.find(minus); at != std::string::npos; at = text.find(minus))
    text.replace(at, minus.size(), "-");
  return text;
}

}  // namespace

std::optional<std::array<double, 3>> direction_of_label(std::string_view label) {
  const std::string text = plain(label);
  Reading reading;
  for (std::size_t i = 0; i < text.size();) {
    if (is_lower_letter(text[i])) {
      const std::size_t begin = i;
      while (i < text.size() && is_lower_letter(text[i])) ++i;
      reading.take_word(std::string_view(text).substr(begin, i - begin));
      continue;
    }
    // Between two words a hyphen only joins them.
    const bool joins = i > 0 && i + 1 < text.size() && is_alphanumeric(text[i - 1]) &&
                       is_alphanumeric(text[i + 1]);
    if (text[i] == '+') reading.take_sign(1);
    if (text[i] == '-' && !joins) reading.take_sign(-1);
    ++i;
  }
  return reading.direction();
}

}  // namespace proofmass::io
