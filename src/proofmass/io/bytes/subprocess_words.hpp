#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace proofmass::io {

inline constexpr std::size_t usual_text = 4096;

/// Serialises numbers and texts sent by a child process.
class WordWriter {
 public:
  void number(std::uint64_t value) { append(&value, sizeof value); }
  /// A longer text is truncated.
  void text(std::string_view value, std::size_t longest = usual_text) {
    value = value.substr(0, longest);
    number(value.size());
    bytes_ += value;
  }
  void figure(const std::optional<double>& value) {
    number(value.has_value() ? 1 : 0);
    const double figure = value.value_or(0.0);
    append(&figure, sizeof figure);
  }
  void integer(const std::optional<std::int64_t>& value) {
    number(value.has_value() ? 1 : 0);
    number(static_cast<std::uint64_t>(value.value_or(0)));
  }
  template <class T, class Write>
  void list(const std::vector<T>& items, const Write& write) {
    number(items.size());
    for (const T& item : items) write(item);
  }
  [[nodiscard]] std::string take() { return std::move(bytes_); }

 private:
  void append(const void* from, std::size_t count) {
    bytes_.append(static_cast<const char*>(from), count);
  }

  std::string bytes_;
};

/// Text on one line, with a blank for each non-printable character.
inline std::string printable(std::string text) {
  for (char& c : text)
    if (static_cast<unsigned char>(c) < 32 || c == 127) c = ' ';
  return text;
}

/// Parses the output of WordWriter, or what claims to be: after the first mismatch everything
/// fails.
class WordReader {
 public:
  explicit WordReader(std::string_view bytes) : bytes_(bytes) {}

  std::uint64_t number() {
    std::uint64_t value = 0;
    take(&value, sizeof value);
    return value;
  }
  /// Printable, other characters replaced by blanks.
  std::string text(std::size_t longest = usual_text) { return printable(bytes_text(longest)); }
  /// Unchanged bytes.
  std::string bytes_text(std::size_t longest) {
    const std::uint64_t size = number();
    if (size > longest || size > bytes_.size()) {
      fail();
      return {};
    }
    std::string text(bytes_.substr(0, size));
    bytes_.remove_prefix(size);
    return text;
  }
  std::optional<double> figure() {
    const bool is_there = number() == 1;
    double value = 0.0;
    take(&value, sizeof value);
    return is_there && is_good_ ? std::optional(value) : std::nullopt;
  }
  std::optional<std::int64_t> integer() {
    const bool is_there = number() == 1;
    const auto value = static_cast<std::int64_t>(number());
    return is_there && is_good_ ? std::optional(value) : std::nullopt;
  }
  template <class Read>
  auto list(std::size_t most, const Read& read) {
    std::vector<decltype(read())> items;
    const std::uint64_t count = number();
    if (count > most) fail();
    for (std::uint64_t i = 0; is_good_ && i < count; ++i) items.push_back(read());
    return items;
  }
  [[nodiscard]] bool is_good() const { return is_good_; }
  [[nodiscard]] bool is_at_end() const { return bytes_.empty(); }

 private:
  void take(void* into, std::size_t count) {
    if (count > bytes_.size()) {
      fail();
      return;
    }
    std::memcpy(into, bytes_.data(), count);
    bytes_.remove_prefix(count);
  }
  void fail() {
    is_good_ = false;
    bytes_ = {};
  }

  std::string_view bytes_;
  bool is_good_ = true;
};

}  // namespace proofmass::io
