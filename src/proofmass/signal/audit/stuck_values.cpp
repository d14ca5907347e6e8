#include "proofmass/signal/audit/stuck_values.hpp"

#include "proofmass/signal/audit/chunk_statistics.hpp"

namespace proofmass::signal {

void RailRuns::add_approach(std::size_t run, double before, double earlier) {
  if (run < shortest_run || approaches.size() >= most_approaches) return;
  const double side = before < rail ? 1.0 : -1.0;
  const double step = std::min(side * (rail - before), side * (before - earlier));
  approaches.push_back(step * std::min(1.0, static_cast<double>(run) / 4.0));
}

bool RailRuns::is_run_into(double lsb) const {
  const auto steep =
      std::ranges::count_if(approaches, [&](double step) { return step > 1.99 * lsb; });
  // A jump between positions ends at an extreme too, but rarely; and if the extreme is a static
  // level, its noise reaches it repeatedly.
  return steep >= 2 && static_cast<std::size_t>(steep) * 4 >= approaches.size();
}

void StuckValues::end_run() {
  if (run_ > 0) take_run(value_, run_, start_);
  run_ = 0;
}

void StuckValues::take_run(double value, std::size_t run, Place start) {
  if (run > longest_ || (run == longest_ && start.sample < longest_start_.sample)) {
    longest_ = run;
    longest_start_ = start;
  }
  const bool is_low = value == low_.rail, is_high = value == high_.rail;
  if (is_low) low_.add(run);
  if (is_high) high_.add(run);
  if (!is_low && !is_high) elsewhere_ = std::max(elsewhere_, run);
}

void StuckValues::move_rails(double low, double high) {
  if (!has_rails_) {
    low_.rail = low;
    high_.rail = high;
    has_rails_ = true;
  }
  if (low < low_.rail) {
    if (low_.rail != high_.rail) elsewhere_ = std::max(elsewhere_, low_.longest);
    low_ = {.rail = low};
  }
  if (high > high_.rail) {
    if (low_.rail != high_.rail) elsewhere_ = std::max(elsewhere_, high_.longest);
    high_ = {.rail = high};
  }
}

void StuckValues::add(
    View<double> values, std::size_t first, const SampleTimes& times, double low, double high) {
  move_rails(low, high);
  std::size_t k = 0;
  if (run_ > 0) {
    while (k < values.size() && values[k] == value_) ++k;
    run_ += k;
    if (k == values.size()) return;
    end_run();
  }
  if (k == values.size()) return;
  const View<double> rest = values.subspan(k);
  if (low == low_.rail || high == high_.rail) take_rail_runs(rest, first + k, times);
  take_long_runs(rest, first + k, times);
}

// All except one that continues beyond the values.
void StuckValues::take_rail_runs(View<double> values, std::size_t first, const SampleTimes& times) {
  const double low = low_.rail, high = high_.rail;
  for (std::size_t k = 0; k < values.size();) {
    if (values[k] != low && values[k] != high) {
      ++k;
      continue;
    }
    std::size_t end = k + 1;
    while (end < values.size() && values[end] == values[k]) ++end;
    if (end < values.size()) {
      take_run(values[k], end - k, times.at(first + k));
      // The values before the chunk are unknown; other runs exist.
      if (k >= 2)
        (values[k] == low ? low_ : high_).add_approach(end - k, values[k - 1], values[k - 2]);
    }
    k = end;
  }
}

// Away from the rails only a run longer than the longest elsewhere counts. One that begins at k or
// later, but not after k + longest, contains that position. Searching backwards from there skips
// most of the values. The run at the end continues.
void StuckValues::take_long_runs(View<double> values, std::size_t first, const SampleTimes& times) {
  std::size_t k = 0;
  const auto start_of = [&](std::size_t at) {
    while (at > k && values[at - 1] == values[at]) --at;
    return at;
  };
  const bool may_be_long = elsewhere_ != 1 || has_repeats(values);
  while (may_be_long && k + elsewhere_ < values.size()) {
    const std::size_t probe = k + elsewhere_;
    if (const std::size_t start = start_of(probe); start > k) {
      k = start;
      continue;
    }
    std::size_t end = probe + 1;
    while (end < values.size() && values[end] == values[k]) ++end;
    if (end == values.size()) break;
    if (values[k] != low_.rail && values[k] != high_.rail)
      take_run(values[k], end - k, times.at(first + k));
    k = end;
  }
  const std::size_t start = start_of(values.size() - 1);
  value_ = values.back();
  run_ = values.size() - start;
  start_ = times.at(first + start);
}

}  // namespace proofmass::signal
