#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <string>
#include <utility>

#include "proofmass/io/cell.hpp"
#include "proofmass/io/reading/recording_writers.hpp"
#include "proofmass/io/stamp_reader.hpp"
#include "proofmass/io/time/row_times.hpp"

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

/// A name or a label. Spreadsheets evaluate text that begins with one of these characters as a
/// formula: a preceding apostrophe, which the reader removes again, marks it as text.
/// Source: OWASP, "CSV Injection".
void append_words(std::string& out, std::string words) {
  if (is_formula(words)) words.insert(0, 1, '\'');
  std::ranges::replace(words, '"', '\'');
  std::ranges::replace_if(words, [](char c) { return c == '\n' || c == '\r'; }, ' ');
  const bool quoted = words.find_first_of(",;\t'#") != std::string::npos;
  out += quoted ? '"' + words + '"' : words;
}

void append_heading(std::string& out, std::string_view name, std::string_view unit) {
  append_words(out, std::string(name) + (unit.empty() ? "" : " (" + std::string(unit) + ")"));
}

std::string header_of(const Recording& recording) {
  const bool timed = recording.time.source != TimeSource::none;
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

constexpr int finest = -27;  ///< decimals that fit into 128 bits for a clock of 19 digits

/// A number as a decimal of the shortest form that reads back, to 10^finest; nullopt beyond 317
/// years.
std::optional<Int128> shortest_decimal(double value) {
  std::array<char, 32> text;
  const auto end = std::to_chars(text.data(), text.data() + text.size(), std::abs(value),
                                 std::chars_format::scientific);
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
  if (power > 9) return std::nullopt;
  for (; exponent > finest; --exponent) mantissa *= 10;
  for (; exponent < finest; ++exponent) mantissa /= 10;
  return value < 0.0 ? -mantissa : mantissa;
}

/// Writes the time column: on the recording's own clock, the exact sum of its first stamp and the
/// seconds from it; seconds from the first if it has no clock.
class TimeWriter {
 public:
  explicit TimeWriter(const TimeBase& time) : start_(time.start_ns.value_or(0)) {
    for (int e = -9; e > finest; --e) start_ *= 10;
  }

  void append(std::string& out, double time_s) const {
    const auto since = start_ != 0 ? shortest_decimal(time_s) : std::nullopt;
    if (since)
      append_decimal(out, start_ + *since);
    else
      append_figure(out, time_s);
  }

 private:
  static void append_decimal(std::string& out, Int128 value) {
    if (value < 0) {
      out += '-';
      value = -value;
    }
    std::array<char, 48> digits;
    std::size_t count = 0;
    // Trailing zeros are omitted.
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

  Int128 start_;
};

/// Writes the label column; a sample without one has an empty field.
class LabelWriter {
 public:
  explicit LabelWriter(const std::vector<Label>& labels) : labels_(labels) {}

  /// Samples must be requested in order.
  void append(std::string& out, std::size_t k) {
    while (next_ < labels_.size() && labels_[next_].last < k) ++next_;
    if (next_ < labels_.size() && labels_[next_].first <= k) append_words(out, labels_[next_].text);
  }

 private:
  const std::vector<Label>& labels_;
  std::size_t next_ = 0;
};

class CsvWriter final : public RecordingWriter {
 public:
  CsvWriter(std::unique_ptr<OutputFile> file, const Recording& head, std::string header)
      : file_(std::move(file)),
        out_(std::move(header)),
        times_(head.time),
        clock_(head.time),
        labels_(head.labels) {}

  [[nodiscard]] Status write(const Block& block) override {
    const bool timed = times_.is_timed();
    const bool labelled = !labels_.empty();
    LabelWriter labels(labels_);
    for (std::size_t r = 0; r < block.rows(); ++r) {
      if (timed) clock_.append(out_, times_.at(block, r));
      // Not in the last column, where an empty field would not be read as one.
      if (timed && labelled) out_ += ',';
      if (labelled) labels.append(out_, block.first + r);
      append_values(block, r, timed || labelled);
      if (out_.size() < (1u << 16)) continue;
      if (const Status done = pass_on(); !done) return done;
    }
    return Done{};
  }
  [[nodiscard]] Status finish(const Recording&) override {
    const Status done = pass_on();
    return done ? file_->keep() : done;
  }

 private:
  /// The channels' values of a row and the line end.
  void append_values(const Block& block, std::size_t row, bool is_behind) {
    for (const View<double>& channel : block.channels) {
      if (std::exchange(is_behind, true)) out_ += ',';
      append_figure(out_, channel[row]);
    }
    out_ += '\n';
  }
  Status pass_on() {
    const Status done = file_->append(out_);
    out_.clear();
    return done;
  }

  std::unique_ptr<OutputFile> file_;
  std::string out_;
  RowTimes times_;
  TimeWriter clock_;
  std::vector<Label> labels_;
};

}  // namespace

Result<std::unique_ptr<RecordingWriter>> create_csv(std::unique_ptr<OutputFile> file,
                                                    const WriterHead& head,
                                                    const WriteOptions&) {
  const Recording& recording = head.recording;
  return std::unique_ptr<RecordingWriter>(
      std::make_unique<CsvWriter>(std::move(file), recording, header_of(recording)));
}

}  // namespace proofmass::io
