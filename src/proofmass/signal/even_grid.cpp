#include "proofmass/signal/even_grid.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <utility>

#include "proofmass/core/contract.hpp"
#include "proofmass/core/statistics.hpp"
#include "proofmass/signal/audit/chunk_statistics.hpp"
#include "proofmass/signal/resample/hole_finder.hpp"

namespace proofmass::signal {

Result<EvenGrid> even_grid(const TimeBase& time, std::size_t samples) {
  if (!(time.rate_hz > 0.0)) return Error{Errc::invalid_argument, "no sample rate is known"};
  if (time.is_uniform() || samples < 2)
    return EvenGrid{.rate_hz = time.rate_hz, .recorded = samples, .missing = 0, .holes = {}};
  const View<double> stamps_s = time.stamps_s;
  PM_EXPECTS(stamps_s.size() == samples);
  HoleFinder finder(time.rate_hz, time.band_s);
  std::vector<Hole> holes;
  constexpr std::size_t piece = 4096;
  for (std::size_t from = 0; from < samples; from += piece)
    finder.add(stamps_s.subspan(from, std::min(piece, samples - from)), holes);
  finder.finish(holes);
  if (Status possible = finder.check(samples, 0.0); !possible) return possible.error();
  EvenGrid grid = finder.grid();
  grid.holes = std::move(holes);
  return grid;
}

Samples on_even_grid(Samples values, const EvenGrid& grid) {
  PM_EXPECTS(values.size() == grid.recorded);
  bool any = false;
  for_each_implausible(values, [&](std::size_t k) { any = any || !std::isnan(values[k]); });
  if (any)
    for (double& value : values.edit()) value = plausible_or_nan(value);
  if (grid.holes.empty()) return values;
  std::vector<double> series;
  series.reserve(grid.recorded + grid.missing);
  const double* from = values.begin();
  const auto append = [&](std::size_t end) {
    const double* last = values.begin() + end;
    series.insert(series.end(), from, last);
    from = last;
  };
  for (const Hole& hole : grid.holes) {
    append(hole.before);
    series.insert(series.end(), hole.missing, std::numeric_limits<double>::quiet_NaN());
  }
  append(values.size());
  return series;
}

namespace {

// The numbers of the samples on the grid.
std::vector<double> numbers_on(const EvenGrid& grid) {
  std::vector<double> numbers;
  numbers.reserve(grid.recorded);
  std::size_t missing = 0;
  auto hole = grid.holes.begin();
  for (std::size_t k = 0; k < grid.recorded; ++k) {
    for (; hole != grid.holes.end() && hole->before == k; ++hole) missing += hole->missing;
    numbers.push_back(static_cast<double>(k + missing));
  }
  return numbers;
}

bool are_regular(View<double> stamps_s, double rate_hz) {
  constexpr double clear = 0.25;
  std::vector<double> off;
  for (std::size_t k = 1; k < stamps_s.size(); ++k)
    off.push_back(std::abs((stamps_s[k] - stamps_s[k - 1]) * rate_hz - 1.0));
  return median(std::move(off)).value_or(1.0) < clear;
}

// Stamps against an even grid.
class LateRows {
 public:
  LateRows(std::vector<double>& stamps_s, const EvenGrid& grid, double rate_hz)
      : stamps_s_(stamps_s), numbers_(numbers_on(grid)), rate_hz_(rate_hz) {}

  // The first row that is on time again; k itself if it is, or if none follows soon.
  [[nodiscard]] std::size_t on_time_from(std::size_t k) const {
    constexpr double on_time = 0.5;
    const double before = usual_before(k);
    const std::size_t last = std::min(stamps_s_.size(), k + HoleFinder::most_undecided);
    for (std::size_t m = k; m < last; ++m)
      if (lateness(m) - before <= on_time) return m;
    return k;
  }

  // Puts the rows from k to before m evenly between those beside them.
  void spread(std::size_t k, std::size_t m) {
    const double from_s = stamps_s_[k - 1], from = numbers_[k - 1];
    const double step_s = (stamps_s_[m] - from_s) / (numbers_[m] - from);
    for (std::size_t i = k; i < m; ++i) {
      const double even_s = from_s + (numbers_[i] - from) * step_s;
      most_s_ = std::max(most_s_, stamps_s_[i] - even_s);
      stamps_s_[i] = even_s;
    }
    count_ += m - k;
  }

  [[nodiscard]] std::size_t count() const { return count_; }
  [[nodiscard]] double most_s() const { return most_s_; }

 private:
  // In periods.
  [[nodiscard]] double lateness(std::size_t k) const {
    return (stamps_s_[k] - stamps_s_[0]) * rate_hz_ - numbers_[k];
  }
  [[nodiscard]] double usual_before(std::size_t k) const {
    constexpr std::size_t nearby = 8;
    std::vector<double> some;
    for (std::size_t i = k - std::min(k, nearby); i < k; ++i) some.push_back(lateness(i));
    return *median(std::move(some));
  }

  std::vector<double>& stamps_s_;
  std::vector<double> numbers_;
  double rate_hz_;
  std::size_t count_ = 0;
  double most_s_ = 0.0;
};

}  // namespace

Recording without_late_stamps(Recording recording) {
  constexpr double longest_step = 2.0;
  constexpr std::size_t fewest_late = 2;
  TimeBase& time = recording.time;
  if (time.is_uniform() || time.band_s > 0.0 || !are_regular(time.stamps_s, time.rate_hz))
    return recording;
  const Result<EvenGrid> grid = even_grid(time, recording.samples());
  if (!grid) return recording;
  LateRows rows(time.stamps_s, *grid, grid->rate_hz);
  for (std::size_t k = 1; k < time.stamps_s.size(); ++k) {
    if (!((time.stamps_s[k] - time.stamps_s[k - 1]) * grid->rate_hz > longest_step)) continue;
    const std::size_t again = rows.on_time_from(k);
    if (again >= k + fewest_late) rows.spread(k, again);
  }
  if (rows.count() > 0)
    recording.notes.push_back(
        {Severity::warning,
         fmt::format("{}: {} rows were stamped late, by up to {:.3g} s, as by a computer that was "
                     "busy: they are taken to be evenly spaced",
                     time.channel, rows.count(), rows.most_s())});
  return recording;
}

Recording with_even_stamps(Recording recording) {
  TimeBase& time = recording.time;
  if (!(time.band_s > 0.0) || time.is_uniform()) return recording;
  const Result<EvenGrid> grid = even_grid(time, recording.samples());
  if (!grid) return recording;
  std::vector<double> late_s;
  const std::vector<double> numbers = numbers_on(*grid);
  for (std::size_t k = 0; k < time.stamps_s.size(); ++k) {
    const double even_s = numbers[k] / time.rate_hz;
    late_s.push_back(time.stamps_s[k] - even_s);
    time.stamps_s[k] = even_s;
  }
  constexpr double ns_per_s = 1e9;
  if (time.start_ns) *time.start_ns += std::llround(*median(std::move(late_s)) * ns_per_s);
  time.band_s = 0.0;
  recording.notes.push_back(
      {Severity::info, time.channel + ": the stamps do not show single intervals: the samples are "
                                      "taken to be evenly spaced"});
  return recording;
}

}  // namespace proofmass::signal
