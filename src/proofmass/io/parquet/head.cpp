#include <algorithm>
#include <charconv>

#include "proofmass/io/bytes/subprocess_words.hpp"
#include "proofmass/io/parquet/child.hpp"
#include "proofmass/io/parquet/facts.hpp"

namespace proofmass::io::parquet {
namespace {

constexpr std::size_t most_facts = 8192;
constexpr std::size_t longest_fact = std::size_t{16} << 20;

std::optional<std::uint64_t> take_number(std::string_view& line) {
  std::uint64_t value = 0;
  const auto [stop, error] = std::from_chars(line.data(), line.data() + line.size(), value);
  if (error != std::errc() || stop == line.data() + line.size() || *stop != ' ')
    return std::nullopt;
  line.remove_prefix(static_cast<std::size_t>(stop - line.data()) + 1);
  return value;
}

}  // namespace

std::string_view Head::fact(std::string_view key) const {
  const auto found = facts.find(key);
  return found == facts.end() ? std::string_view{} : std::string_view(found->second);
}

std::vector<Label> Head::labels() const {
  std::vector<Label> labels;
  std::string_view lines = fact(parquet::labels_key);
  while (!lines.empty()) {
    std::string_view line = lines.substr(0, lines.find('\n'));
    lines.remove_prefix(std::min(lines.size(), line.size() + 1));
    const auto first = take_number(line);
    const auto last = first ? take_number(line) : std::nullopt;
    if (!last) return {};
    labels.push_back({std::string(line), *first, *last});
  }
  return labels;
}

std::string encode(const Head& head) {
  WordWriter to;
  to.list(head.columns, [&](const Column& column) {
    to.text(column.name);
    to.text(column.unit);
    to.text(column.type);
  });
  to.number(head.rows);
  to.number(head.facts.size());
  for (const auto& [key, text] : head.facts) {
    to.text(key);
    to.text(text, longest_fact);
  }
  to.text(head.skipped);
  to.integer(head.stamps);
  to.number(static_cast<std::uint64_t>(head.origin));
  to.number(head.is_since_start ? 1 : 0);
  const std::string words = to.take();
  WordWriter whole;
  whole.text(words, words.size());
  return whole.take();
}

std::optional<std::uint64_t> head_bytes(std::string_view bytes) {
  if (bytes.size() < sizeof(std::uint64_t)) return std::nullopt;
  const std::uint64_t size = WordReader(bytes).number();
  // An impossible size is larger than any available data.
  return size > size + sizeof size ? size : size + sizeof size;
}

Result<Head> decode(std::string_view bytes) {
  WordReader whole(bytes);
  const std::string words = whole.bytes_text(bytes.size());
  WordReader from(words);
  Head head;
  head.columns = from.list(most_columns, [&] {
    Column column;
    column.name = from.text();
    column.unit = from.text();
    column.type = from.text();
    return column;
  });
  head.rows = from.number();
  const std::uint64_t facts = from.number();
  bool is_sound = facts <= most_facts;
  for (std::uint64_t i = 0; is_sound && from.is_good() && i < facts; ++i) {
    std::string key = from.text();
    head.facts.insert_or_assign(std::move(key), from.bytes_text(longest_fact));
  }
  head.skipped = from.text();
  if (const auto stamps = from.integer()) head.stamps = static_cast<std::size_t>(*stamps);
  head.origin = static_cast<std::int64_t>(from.number());
  head.is_since_start = from.number() != 0;
  is_sound = is_sound && from.is_good() && from.is_at_end() && whole.is_good() &&
             whole.is_at_end() && !head.columns.empty() &&
             head.stamps.value_or(0) < head.columns.size();
  if (!is_sound) return Error{Errc::corrupt, "is damaged: its contents cannot be listed"};
  return head;
}

}  // namespace proofmass::io::parquet
