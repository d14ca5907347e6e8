#include "proofmass/acquire/phone/phyphox_cursor.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <fmt/format.h>
#include <iterator>

namespace proofmass::acquire {
namespace {

/// Overlap of requests, so that a backward clock step is detected.
constexpr double overlap_s = 0.05;
/// Overlap after a backward clock step: more than the time until it is detected.
constexpr double search_s = 10.0;
constexpr std::size_t most_had = 16;

double eighth_place(double time_s) {
  return time_s == 0.0 ? 0.0 : std::pow(10.0, std::floor(std::log10(std::abs(time_s))) - 7.0);
}

/// Source: Fowler, Noll, Vo, FNV-1a, over words instead of bytes.
std::uint64_t print_of(std::span<const std::vector<double>> columns, std::size_t row) {
  std::uint64_t print = 0xcbf29ce484222325U;
  for (const auto& column : columns)
    print = (print ^ std::bit_cast<std::uint64_t>(column[row])) * 0x100000001b3U;
  return print;
}

}  // namespace

std::optional<double> PhyphoxCursor::wanted_from_s() const {
  if (set_back_to_s_) return *set_back_to_s_ - search_s;
  if (had_.empty()) return std::nullopt;
  return had_.back().time_s - overlap_s;
}

std::string PhyphoxCursor::threshold() const {
  const auto from_s = wanted_from_s();
  return from_s ? fmt::format("{:.10g}", *from_s - 2.0 * eighth_place(*from_s)) : "full";
}

std::size_t PhyphoxCursor::first_new(std::span<const std::vector<double>> columns) const {
  const std::vector<double>& times_s = columns.front();
  if (had_.empty()) return 0;
  std::vector<std::size_t> rows(times_s.size());
  for (std::size_t k = 0; k < rows.size(); ++k) rows[k] = k;
  const auto is_same = [&](std::size_t row, const Row& had) {
    return times_s[row] == had.time_s && (!had.print || print_of(columns, row) == *had.print);
  };
  const auto wanted =
      std::ranges::find_if(had_, [&](const Row& row) { return row.time_s >= *wanted_from_s(); });
  const auto found = std::search(rows.begin(), rows.end(), wanted, had_.end(), is_same);
  if (found != rows.end())
    return static_cast<std::size_t>(found - rows.begin() + (had_.end() - wanted));
  // A buffer of low capacity may have dropped them; one that was cleared begins below.
  const auto after =
      std::ranges::find_if(times_s, [&](double time_s) { return time_s > had_.back().time_s; });
  return after == times_s.end() ? 0 : static_cast<std::size_t>(after - times_s.begin());
}

PhyphoxCursor::Range PhyphoxCursor::take(std::span<const std::vector<double>> columns) {
  const std::vector<double>& times_s = columns.front();
  const std::size_t first = first_new(columns);
  std::size_t end = first;
  double last_s = had_.empty() ? times_s.empty() ? 0.0 : times_s.front() : had_.back().time_s;
  // After a backward step, rows below the threshold are missing: they come with a lower threshold.
  const bool has_all = set_back_to_s_ || had_.empty();
  while (end < times_s.size() && (has_all || times_s[end] >= last_s)) last_s = times_s[end++];
  if (end > first) set_back_to_s_.reset();
  if (end < times_s.size()) set_back_to_s_ = times_s[end];
  for (std::size_t k = std::max(first, end - std::min(end, most_had)); k < end; ++k)
    had_.push_back({times_s[k], print_of(columns, k)});
  while (had_.size() > most_had) had_.pop_front();
  return {first, end};
}

void PhyphoxCursor::start_behind(double last_s) {
  *this = {};
  had_.push_back({last_s, std::nullopt});
}

void PhyphoxCursor::see_end(double end_s) {
  if (!had_.empty() && end_s < had_.back().time_s) set_back_to_s_ = end_s;
}

}  // namespace proofmass::acquire
