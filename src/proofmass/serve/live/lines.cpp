#include "proofmass/serve/live/lines.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <nlohmann/json.hpp>
#include <utility>

#include "proofmass/report/wording.hpp"
#include "proofmass/serve/live/json_numbers.hpp"

namespace proofmass::serve {
namespace {

using OrderedJson = nlohmann::ordered_json;

constexpr double most_buckets_per_s = 1000.0;
constexpr int value_digits = 7, time_digits = 12;

// What is not UTF-8 in a device's names becomes U+FFFD.
std::string dumped(const OrderedJson& json) {
  return json.dump(-1, ' ', false, OrderedJson::error_handler_t::replace);
}

OrderedJson json_of(const std::vector<Channel>& channels) {
  OrderedJson out = OrderedJson::array();
  for (const Channel& channel : channels)
    out.push_back({{"name", channel.name},
                   {"unit", channel.unit.symbol},
                   {"to_si", channel.unit.to_si},
                   {"is_acceleration", channel.unit.quantity == Quantity::acceleration}});
  return out;
}

const char* word_of(Severity severity) {
  if (severity == Severity::bad) return "bad";
  return severity == Severity::warning ? "warning" : "info";
}

const char* word_of(RecordEnd end) {
  switch (end) {
    case RecordEnd::duration:
      return "duration";
    case RecordEnd::stopped:
      return "stopped";
    case RecordEnd::source_end:
      return "source_end";
    case RecordEnd::source_gone:
      return "source_gone";
    case RecordEnd::disk_failed:
      break;
  }
  return "disk_failed";
}

std::int64_t time_of_day_ms() {
  const auto since_1970 = std::chrono::system_clock::now().time_since_epoch();
  return std::chrono::duration_cast<std::chrono::milliseconds>(since_1970).count();
}

}  // namespace

std::string live_line(std::string_view key, std::string_view value) {
  std::string line = fmt::format("{{\"{}\":", key);
  // In JSON a line's end stands between tokens only: a string has it escaped.
  while (!value.empty()) {
    const std::size_t end = std::min(value.find('\n'), value.size());
    line += value.substr(0, end);
    value.remove_prefix(std::min(value.find_first_not_of("\n ", end), value.size()));
  }
  return line += '}';
}

LiveLines::LiveLines(std::function<void(std::string_view line)> write) : write_(std::move(write)) {}

void LiveLines::opened(const Recording& head, const std::string& file) {
  const double rate_hz = head.time.rate_hz;
  every_ = static_cast<std::size_t>(std::max(1.0, std::ceil(rate_hz / most_buckets_per_s)));
  in_bucket_ = 0;
  times_s_.clear();
  min_.assign(head.channels.size(), {});
  max_.assign(head.channels.size(), {});
  write_(live_line("head", dumped({{"source", head.source},
                                   {"format", head.format},
                                   {"rate_hz", rate_hz > 0.0 ? OrderedJson(rate_hz) : nullptr},
                                   {"channels", json_of(head.channels)},
                                   {"file", file.empty() ? OrderedJson() : OrderedJson(file)}})));
}

void LiveLines::estimating(const std::vector<Channel>& columns) {
  write_(live_line("columns", dumped(json_of(columns))));
}

void LiveLines::samples(const Block& block, Clock::time_point now) {
  if (block.channels.size() != min_.size() || block.rows() == 0) return;
  if (times_s_.empty()) arrived_ms_ = time_of_day_ms();
  for (std::size_t row = 0; row < block.rows(); ++row) add_row(block, row);
  samples_ += block.rows();
  last_time_s_ = block.stamps_s.empty() ? last_time_s_ : block.stamps_s.back();
  heard_ = now;
  refresh(now);
}

void LiveLines::add_row(const Block& block, std::size_t row) {
  if (in_bucket_ == 0 || times_s_.empty()) {
    times_s_.push_back(block.stamps_s.empty() ? static_cast<double>(block.first + row)
                                              : block.stamps_s[row]);
    for (std::size_t c = 0; c < min_.size(); ++c) {
      min_[c].push_back(block.channels[c][row]);
      max_[c].push_back(block.channels[c][row]);
    }
  } else {
    // fmin and fmax pass over a NaN where the other is a number.
    for (std::size_t c = 0; c < min_.size(); ++c) {
      min_[c].back() = std::fmin(min_[c].back(), block.channels[c][row]);
      max_[c].back() = std::fmax(max_[c].back(), block.channels[c][row]);
    }
  }
  in_bucket_ = (in_bucket_ + 1) % every_;
}

void LiveLines::estimates(const Block& rows) {
  if (rows.rows() == 0) return;
  estimates_.resize(rows.channels.size());
  for (std::size_t c = 0; c < estimates_.size(); ++c) estimates_[c] = rows.channels[c].back();
  estimates_time_s_ = rows.stamps_s.empty() ? 0.0 : rows.stamps_s.back();
}

void LiveLines::event(const RecordEvent& event) {
  using enum EventKind;
  if (event.kind == lost || event.kind == overrun || event.kind == gap) {
    lost_ += event.rows;
    ++gaps_;
  }
  write_(live_line("event", dumped({{"kind", std::string(name_of(event.kind))},
                                    {"severity", word_of(event.severity)},
                                    {"start_s", event.time_s},
                                    {"duration_s", event.duration_s},
                                    {"rows", event.rows},
                                    {"text", report::with_flags(event)}})));
}

void LiveLines::refresh(Clock::time_point now) {
  constexpr std::chrono::milliseconds frame{25}, state{200};
  if (now - framed_ >= frame) {
    framed_ = now;
    write_rows();
  }
  if (now - stated_ >= state) {
    stated_ = now;
    write_state(now);
  }
}

void LiveLines::write_rows() {
  if (!estimates_.empty()) {
    std::string text = "{\"estimates\":{\"t\":";
    append_number(text, estimates_time_s_, time_digits);
    text += ",\"values\":";
    append_numbers(text, estimates_, time_digits);
    write_(text += "}}");
    estimates_.clear();
  }
  if (times_s_.empty()) return;
  std::string text =
      fmt::format("{{\"rows\":{{\"every\":{},\"arrived_ms\":{},\"t\":", every_, arrived_ms_);
  append_numbers(text, times_s_, time_digits);
  text += ",\"min\":";
  append_lists(text, min_, value_digits);
  if (every_ > 1) {
    text += ",\"max\":";
    append_lists(text, max_, value_digits);
  }
  write_(text += "}}");
  times_s_.clear();
  in_bucket_ = 0;
  for (std::size_t c = 0; c < min_.size(); ++c) {
    min_[c].clear();
    max_[c].clear();
  }
}

void LiveLines::write_state(Clock::time_point now) {
  const bool has_come = samples_ > 0;
  const double silence_s = std::chrono::duration<double>(now - heard_).count();
  write_(live_line("state", dumped({{"time_s", last_time_s_},
                                    {"samples", samples_},
                                    {"lost", lost_},
                                    {"gaps", gaps_},
                                    {"silence_s", has_come ? OrderedJson(silence_s) : nullptr}})));
}

void LiveLines::ended(const RecordSummary& summary) {
  write_rows();
  OrderedJson audit = OrderedJson::array();
  for (const Note& note : summary.audit)
    audit.push_back({{"severity", word_of(note.severity)}, {"text", report::with_flags(note)}});
  write_(live_line("end", dumped({{"how", word_of(summary.end)},
                                  {"reason", summary.end_reason},
                                  {"files", summary.files},
                                  {"samples", summary.samples},
                                  {"lost", summary.lost},
                                  {"gaps", summary.gap_count},
                                  {"duration_s", summary.duration_s},
                                  {"audit", audit}})));
}

}  // namespace proofmass::serve
