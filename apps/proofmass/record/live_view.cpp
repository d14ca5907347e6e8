#include "record/live_view.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "proofmass/core/units.hpp"
#include "proofmass/report/record_report.hpp"
#include "proofmass/report/wording.hpp"

namespace proofmass::app {
namespace {

constexpr std::size_t most_channels = 16;
constexpr double normal_95 = 1.96;

// Display unit.
struct Shown {
  double factor;
  std::string unit;
};

Shown shown_as(const Unit& unit) {
  if (unit.symbol == "rad") return {1.0 / rad_per_deg, "°"};
  if (unit.symbol == "rad/s") return {1.0 / radps_per_rpm, " rpm"};
  return {1.0, unit.symbol.empty() ? "" : " " + report::print_unit(unit.symbol)};
}

std::string reading_line(const Channel& channel, double value) {
  const std::string& unit = channel.unit.symbol;
  return fmt::format("  {:<16} {:>12}{}", channel.name, report::significant(value, 5),
                     unit.empty() ? "" : " " + report::print_unit(unit));
}

// The standard deviation of a column, if there is a column for it.
const double* std_of(const std::vector<Channel>& columns,
                     const std::vector<double>& values,
                     const std::string& name) {
  for (std::size_t c = 0; c < columns.size(); ++c)
    if (columns[c].name == name + "_std") return &values[c];
  return nullptr;
}

std::string estimate_line(const std::vector<Channel>& columns,
                          const std::vector<double>& values,
                          std::size_t c) {
  const Shown as = shown_as(columns[c].unit);
  const double value = values[c] * as.factor;
  const double* std = std_of(columns, values, columns[c].name);
  if (std == nullptr)
    return fmt::format("  {:<16} {:>12}{}", columns[c].name, report::significant(value, 5),
                       as.unit);
  return fmt::format("  {:<16} {:>12}{} ± {}{} (95 %)", columns[c].name,
                     report::significant(value, 6), as.unit,
                     report::significant(normal_95 * *std * as.factor, 2), as.unit);
}

void keep_last(const Block& block, std::vector<double>& last) {
  if (block.rows() == 0) return;
  last.resize(block.channels.size());
  for (std::size_t c = 0; c < last.size(); ++c) last[c] = block.channels[c].back();
}

}  // namespace

LiveView::LiveView(std::string source, std::string file, const OutputFlags& flags)
    : source_(std::move(source)), file_(std::move(file)), flags_(flags), panel_(flags) {
  if (panel_.is_shown()) panel_.show({fmt::format("opening {} …", source_)});
}

void LiveView::opened(const std::vector<Channel>& channels) {
  channels_ = channels;
}

void LiveView::estimating(std::vector<Channel> columns) {
  columns_ = std::move(columns);
}

void LiveView::samples(const Block& block) {
  rows_ += block.rows();
  if (!block.stamps_s.empty()) time_s_ = block.stamps_s.back();
  if (panel_.is_shown()) keep_last(block, last_);
}

void LiveView::estimates(const Block& rows) {
  if (panel_.is_shown()) keep_last(rows, last_estimates_);
}

void LiveView::event(const RecordEvent& event) {
  using enum EventKind;
  const bool is_gap = event.kind == lost || event.kind == overrun || event.kind == gap;
  if (is_gap) {
    lost_ += event.rows;
    ++gaps_;
  }
  constexpr std::uint64_t gaps_shown = 20;  // later gaps are only counted: a steady loss would
                                            // fill the terminal
  if (is_gap && gaps_ > gaps_shown) return;
  panel_.wipe();
  show_notes({{event.severity, report::event_words(event)}}, "", flags_);
}

void LiveView::say(const std::string& line) {
  panel_.wipe();
  show_line(line, flags_);
}

void LiveView::refresh() {
  constexpr std::chrono::milliseconds least{100};
  constexpr std::chrono::seconds window{2};
  const Clock::time_point now = Clock::now();
  if (!panel_.is_shown() || now - drawn_ < least) return;
  drawn_ = now;
  pace_.emplace_back(now, rows_);
  while (pace_.size() > 2 && now - pace_.front().first > window) pace_.pop_front();
  if (!channels_.empty()) panel_.show(lines());
}

std::string LiveView::state_line() const {
  const double span_s =
      std::chrono::duration<double>(pace_.back().first - pace_.front().first).count();
  const auto rows = static_cast<double>(pace_.back().second - pace_.front().second);
  const std::string rate = span_s > 0.0 ? report::compact(rows / span_s, 4) + " samples/s" : "";
  return fmt::format("{} → {}   {}   {}   {}", source_, file_, report::duration_words(time_s_),
                     report::count_words(rows_, "sample"), rate);
}

std::vector<std::string> LiveView::lines() const {
  std::vector<std::string> out{state_line()};
  out.push_back(fmt::format("  lost {}   gaps {}   Ctrl-C closes the file", report::grouped(lost_),
                            report::grouped(gaps_)));
  for (std::size_t c = 0; c < std::min(last_.size(), most_channels); ++c)
    out.push_back(reading_line(channels_[c], last_[c]));
  if (last_.size() > most_channels)
    out.push_back(fmt::format("  … and {} more", last_.size() - most_channels));
  for (std::size_t c = 0; c < std::min(columns_.size(), last_estimates_.size()); ++c)
    if (!columns_[c].name.ends_with("_std"))
      out.push_back(estimate_line(columns_, last_estimates_, c));
  if (!guide_.empty()) out.push_back(guide_);
  return out;
}

}  // namespace proofmass::app
