#include "proofmass/io/hdf5_catalogue.hpp"

#include <algorithm>
#include <cstring>

namespace proofmass::io {
namespace {

constexpr std::size_t longest_text = 4096;

class Writer {
 public:
  void number(std::uint64_t value) { append(&value, sizeof value); }
  void text(std::string_view value) {
    value = value.substr(0, longest_text);
    number(value.size());
    bytes_ += value;
  }
  void figure(const std::optional<double>& value) {
    number(value.has_value() ? 1 : 0);
    const double figure = value.value_or(0.0);
    append(&figure, sizeof figure);
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

/// Text of one line, with whatever is no character of one made a blank.
std::string printable(std::string_view bytes) {
  std::string text(bytes);
  for (char& c : text)
    if (static_cast<unsigned char>(c) < 32 || c == 127) c = ' ';
  return text;
}

/// Reads what Writer wrote; once something does not fit, nothing does.
class Reader {
 public:
  explicit Reader(std::string_view bytes) : bytes_(bytes) {}

  std::uint64_t number() {
    std::uint64_t value = 0;
    take(&value, sizeof value);
    return value;
  }
  std::string text() {
    const std::uint64_t size = number();
    if (size > longest_text || size > bytes_.size()) {
      fail();
      return {};
    }
    const std::string text = printable(bytes_.substr(0, size));
    bytes_.remove_prefix(size);
    return text;
  }
  std::optional<double> figure() {
    const bool is_there = number() == 1;
    double value = 0.0;
    take(&value, sizeof value);
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

/// Whether there can be so many figures.
bool is_possible(const Hdf5Dataset& dataset) {
  constexpr std::uint64_t most_figures = std::uint64_t{1} << 48;
  std::uint64_t figures = 1;
  for (const std::uint64_t length : dataset.shape)
    if (__builtin_mul_overflow(figures, length, &figures) || length > most_figures) return false;
  return figures <= most_figures && !dataset.path.empty() &&
         dataset.group_length < dataset.path.size();
}

Hdf5Dataset read_dataset(Reader& from) {
  constexpr std::size_t most_dimensions = 32;
  Hdf5Dataset dataset;
  dataset.path = from.text();
  dataset.address = from.text();
  dataset.type = from.text();
  dataset.shape = from.list(most_dimensions, [&] { return from.number(); });
  dataset.group_length = from.number();
  dataset.is_complex = from.number() != 0;
  dataset.figure = from.figure();
  return dataset;
}

Hdf5Attribute read_attribute(Reader& from) {
  constexpr std::size_t most_texts = 64;
  Hdf5Attribute attribute;
  attribute.owner = from.text();
  attribute.name = from.text();
  attribute.texts = from.list(most_texts, [&] { return from.text(); });
  attribute.figure = from.figure();
  return attribute;
}

}  // namespace

std::string encode(const Hdf5Catalogue& catalogue) {
  Writer to;
  to.list(catalogue.datasets, [&](const Hdf5Dataset& dataset) {
    to.text(dataset.path);
    to.text(dataset.address);
    to.text(dataset.type);
    to.list(dataset.shape, [&](std::uint64_t length) { to.number(length); });
    to.number(dataset.group_length);
    to.number(dataset.is_complex ? 1 : 0);
    to.figure(dataset.figure);
  });
  to.list(catalogue.attributes, [&](const Hdf5Attribute& attribute) {
    to.text(attribute.owner);
    to.text(attribute.name);
    to.list(attribute.texts, [&](const std::string& text) { to.text(text); });
    to.figure(attribute.figure);
  });
  to.list(catalogue.skipped, [&](const std::string& text) { to.text(text); });
  to.number(catalogue.is_cut ? 1 : 0);
  return to.take();
}

Result<Hdf5Catalogue> decode(std::string_view bytes) {
  Reader from(bytes);
  Hdf5Catalogue catalogue;
  catalogue.datasets = from.list(most_hdf5_objects, [&] { return read_dataset(from); });
  catalogue.attributes = from.list(most_hdf5_objects, [&] { return read_attribute(from); });
  catalogue.skipped = from.list(most_hdf5_objects, [&] { return from.text(); });
  catalogue.is_cut = from.number() != 0;
  if (!from.is_good() || !from.is_at_end() || !std::ranges::all_of(catalogue.datasets, is_possible))
    return Error{Errc::corrupt, "is damaged: its contents cannot be listed"};
  return catalogue;
}

}  // namespace proofmass::io
