#include "proofmass/io/mcap/rows_account.hpp"

#include <fmt/format.h>
#include <span>

#include "proofmass/io/bytes/little_endian.hpp"
#include "proofmass/io/mcap/samples.hpp"

namespace proofmass::io::mcap {
namespace {

double double_at(std::string_view bytes, std::size_t index) {
  double value = 0.0;
  load_doubles(bytes.data() + 8 * index, std::span(&value, 1));
  return value;
}

}  // namespace

void RowsAccount::add(const ChannelRecord& channel, const Message& message) {
  if (channel.topic != "recording" || channel.encoding != samples_encoding) return;
  const auto head = read_samples_head(message.data);
  if (!head || head->rows == 0) return;
  const std::string_view figures = message.data.substr(samples_head_bytes);
  const double first_s = head->has_stamps ? double_at(figures, 0) : 0.0;
  if (head->first > expected_) note_missing(head->first, first_s);
  if (!has_rows_) first_s_ = first_s;
  has_rows_ = true;
  has_stamps_ = head->has_stamps;
  last_s_ = head->has_stamps ? double_at(figures, head->rows - 1) : 0.0;
  samples_ += head->rows;
  if (__builtin_add_overflow(head->first, std::uint64_t{head->rows}, &expected_))
    expected_ = ~std::uint64_t{0};
}

void RowsAccount::note_missing(std::uint64_t first, double first_s) {
  const std::uint64_t missing = first - expected_;
  if (__builtin_add_overflow(missing_, missing, &missing_)) missing_ = ~std::uint64_t{0};
  constexpr std::size_t most_listed = 16;
  if (notes_.size() == most_listed) return;
  std::string text = fmt::format("{} rows are missing from row {} on", missing, expected_);
  if (has_rows_ && has_stamps_)
    text += fmt::format(", between {:.6g} s and {:.6g} s", last_s_, first_s);
  notes_.push_back({Severity::bad, std::move(text)});
}

void RowsAccount::report(Recovery& out) const {
  out.samples = samples_;
  out.first_s = first_s_;
  out.last_s = last_s_;
  out.missing_rows = missing_;
  out.notes.insert(out.notes.end(), notes_.begin(), notes_.end());
}

}  // namespace proofmass::io::mcap
