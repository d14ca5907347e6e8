#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <string>
#include <utility>

#include "proofmass/io/recording_writers.hpp"
#include "proofmass/io/stamp_reader.hpp"

namespace proofmass::io {
namespace {

void append_figure(std::string& out, double value) {
  if (std::isnan(value)) {
    out += "nan";
    return;
  }
  std::array<char, 32> text;
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value);
  out.append(text.data(), end.ptr);
}

void append_words(std::string& out, std::string words) {
  std::ranges::replace(words, '"', '\'');
  std::ranges::replace_if(words, [](char c) { return c == '\n' || c == '\r'; }, ' ');
  const bool quoted = words.find_first_of(",;\t'#") != std::string::npos;
  out += quoted ? '"' + words + '"' : words;
}

void append_heading(std::string& out, std::string_view name, std::string_view unit) {
  append_words(out, std::string(name) + (unit.empty() ? "" : " (" + std::string(unit) + ")"));
}

std::string header_of(const Recording& recording, bool timed) {
  std::string out = timed ? "time (s)" : "";
  if (!recording.labels.empty()) {
    if (timed) out += ',';
    append_heading(out, recording.label_channel.empty() ? "label" : recording.label_channel, "");
  }
  for (const Channel& channel : recording.channels) {
    if (!out.empty()) out += ',';
    append_heading(out, channel.name, channel.unit.symbol);
  }
  return out + '\n';
}

constexpr int finest = -27;  ///< decimals that a clock of 19 digits leaves room for in 128 bits

/// The shortest decimal that reads back as `value` >= 0, to 10^finest; nullopt if it is finer.
std::optional<Int128> shortest_decimal(double value) {
  std::array<char, 32> text;
  const auto end =
      std::to_chars(text.data(), text.data() + text.size(), value, std::chars_format::scientific);
  Int128 mantissa = 0;
  int exponent = 0;
  const char* p = text.data();
  for (bool behind_point = false; p != end.ptr && *p != 'e'; ++p) {
    if (*p == '.') {
      behind_point = true;
    } else {
      mantissa = mantissa * 10 + (*p - '0');
      if (behind_point) --exponent;
    }
  }
  int power = 0;
  std::from_chars(p + (p[1] == '+' ? 2 : 1), end.ptr, power);
  exponent += power;
  if (mantissa == 0) return Int128{0};
  if (exponent < finest || power > 9) return std::nullopt;
  for (; exponent > finest; --exponent) mantissa *= 10;
  return mantissa;
}

/// Writes the time column: on the recording's own clock, digit for digit the sum of its first
/// stamp and the seconds since; seconds since the first where it has no clock.
class TimeWriter {
 public:
  explicit TimeWriter(const Recording& recording) : time_(recording.time) {
    if (!time_.start_ns || *time_.start_ns == 0) return;
    for (std::size_t k = 0; k < recording.samples(); ++k) {
      const double t = time_.at(k);
      if (!(t >= 0.0) || !shortest_decimal(t)) return;
    }
    on_own_clock_ = true;
  }

  void append(std::string& out, std::size_t k) const {
    if (!on_own_clock_) {
      append_figure(out, time_.at(k));
      return;
    }
    Int128 start = *time_.start_ns;
    for (int e = -9; e > finest; --e) start *= 10;
    append_decimal(out, start + *shortest_decimal(time_.at(k)));
  }

 private:
  static void append_decimal(std::string& out, Int128 value) {
    if (value < 0) {
      out += '-';
      value = -value;
    }
    std::array<char, 48> digits;
    std::size_t count = 0;
    // Zeros behind the last decimal say nothing.
    int decimals = -finest;
    while (decimals > 0 && value % 10 == 0) {
      value /= 10;
      --decimals;
    }
    do {
      digits[count++] = static_cast<char>('0' + static_cast<int>(value % 10));
      value /= 10;
      if (--decimals == 0) digits[count++] = '.';
    } while (value != 0 || decimals >= 0);
    while (count > 0) out += digits[--count];
  }

  const TimeBase& time_;
  bool on_own_clock_ = false;
};

/// Writes the column of labels; a sample without one has an empty field.
class LabelWriter {
 public:
  explicit LabelWriter(const std::vector<Label>& labels) : labels_(labels) {}

  /// Samples must be asked for in order.
  void append(std::string& out, std::size_t k) {
    while (next_ < labels_.size() && labels_[next_].last < k) ++next_;
    if (next_ < labels_.size() && labels_[next_].first <= k) append_words(out, labels_[next_].text);
  }

 private:
  const std::vector<Label>& labels_;
  std::size_t next_ = 0;
};

/// The channels' figures of a sample and the end of its row.
void append_values(std::string& out, const Recording& recording, std::size_t k, bool is_behind) {
  for (const Channel& channel : recording.channels) {
    if (std::exchange(is_behind, true)) out += ',';
    append_figure(out, channel.values[k]);
  }
  out += '\n';
}

}  // namespace

bool write_csv(const Recording& recording, const Sink& sink) {
  const bool timed = recording.time.source != TimeSource::none;
  const bool labelled = !recording.labels.empty();
  const TimeWriter time(recording);
  LabelWriter labels(recording.labels);
  std::string out = header_of(recording, timed);
  for (std::size_t k = 0; k < recording.samples(); ++k) {
    if (timed) time.append(out, k);
    // Not in the last column, where an empty field is taken for none.
    if (timed && labelled) out += ',';
    if (labelled) labels.append(out, k);
    append_values(out, recording, k, timed || labelled);
    if (out.size() < (1u << 16)) continue;
    if (!sink(out)) return false;
    out.clear();
  }
  return sink(out);
}

}  // namespace proofmass::io
