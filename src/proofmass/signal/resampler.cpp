#include "proofmass/signal/resampler.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <limits>

#include "proofmass/core/contract.hpp"
#include "proofmass/core/statistics.hpp"
#include "proofmass/signal/resample/sinc_kernel.hpp"

namespace proofmass::signal {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
/// A time within this fraction of a period of a sample is the sample's: the difference is rounding.
constexpr double same_time = 1e-6;

/// The value at x of the cubic through four points. Source: J. L. Lagrange (1795); E. Waring
/// (1779).
double lagrange(const std::array<double, 4>& at, const std::array<double, 4>& values, double x) {
  double sum = 0.0;
  for (std::size_t i = 0; i < 4; ++i) {
    double weight = 1.0;
    for (std::size_t j = 0; j < 4; ++j)
      if (j != i) weight *= (x - at[j]) / (at[i] - at[j]);
    sum += weight * values[i];
  }
  return sum;
}

/// Linear interpolation. std::lerp() can return a number although the left end is NaN.
double along(double left, double right, double fraction) {
  return left + fraction * (right - left);
}

/// True if four samples are even enough for a cubic not to overshoot.
bool are_near_even(const std::array<double, 4>& at) {
  const auto [least, most] = std::minmax({at[1] - at[0], at[2] - at[1], at[3] - at[2]});
  return least > 0.0 && most <= 3.0 * least;
}

Status check(const TimeBase& time, std::size_t samples, ResampleMethod method, const TimeGrid& to) {
  if (!(to.rate_hz > 0.0) || !std::isfinite(to.rate_hz))
    return Error{Errc::invalid_argument, "cannot be resampled: the new rate must be above zero"};
  if (to.count > (std::size_t{1} << 31))
    return Error{Errc::invalid_argument,
                 fmt::format("cannot be resampled: it would have {} samples", to.count)};
  if (method == ResampleMethod::mean && to.rate_hz > time.rate_hz * 1.0001)
    return Error{Errc::invalid_argument,
                 fmt::format("cannot be resampled from {:.6g} Hz to {:.6g} Hz by mean, which only "
                             "goes to lower rates: take sinc, cubic or linear",
                             time.rate_hz, to.rate_hz)};
  for (std::size_t k = 1; !time.is_uniform() && k < samples; ++k)
    if (!(time.stamps_s[k] >= time.stamps_s[k - 1]))
      return Error{Errc::corrupt,
                   fmt::format("cannot be resampled: time goes back at sample {}: cut it there, or "
                               "state the rate",
                               k),
                   {Advice{"rate"}}};
  return Done{};
}

}  // namespace

Result<Resampler> Resampler::make(const TimeBase& time,
                                  std::size_t samples,
                                  ResampleMethod method,
                                  const TimeGrid& to) {
  if (const Status fine = check(time, samples, method, to); !fine) return fine.error();
  const auto own = even_grid(time, samples);
  if (!own) return own.error();
  Resampler out;
  out.method_ = method;
  out.to_ = to;
  out.own_ = *own;
  for (const Hole& hole : own->holes) out.first_after_.push_back(hole.before);
  out.times_.reserve(samples);
  auto hole = own->holes.begin();
  std::size_t place = 0;
  for (std::size_t k = 0; k < samples; ++k, ++place) {
    if (hole != own->holes.end() && hole->before == k) place += (hole++)->missing;
    out.times_.push_back(time.at(k));
    const double off = time.at(k) * own->rate_hz - static_cast<double>(place);
    out.is_even_ = out.is_even_ && std::abs(off) < 1e-3;
  }
  out.places_ = out.places_of(to);
  if (!out.is_even_ && method == ResampleMethod::sinc) {
    const double last = std::floor(out.times_.back() * own->rate_hz + same_time);
    out.own_places_ = out.places_of({0.0, own->rate_hz, static_cast<std::size_t>(last) + 1});
  }
  return out;
}

std::vector<Resampler::Place> Resampler::places_of(const TimeGrid& grid) const {
  std::vector<Place> out(grid.count, {0, nan});
  if (times_.empty()) return out;
  const double near = same_time / own_.rate_hz;
  auto after = first_after_.begin();
  std::size_t k = 0;
  for (std::size_t j = 0; j < grid.count; ++j) {
    const double t = grid.at(j);
    while (k + 1 < times_.size() && times_[k + 1] <= t + near) ++k;
    if (t < times_[k] - near) continue;
    if (std::abs(t - times_[k]) <= near) {
      out[j] = {k, 0.0};
      continue;
    }
    if (k + 1 == times_.size()) break;
    while (after != first_after_.end() && *after <= k) ++after;
    if (after != first_after_.end() && *after == k + 1) continue;
    out[j] = {k, (t - times_[k]) / (times_[k + 1] - times_[k])};
  }
  return out;
}

std::vector<double> Resampler::nearest(View<double> values) const {
  std::vector<double> out;
  out.reserve(places_.size());
  for (const Place& place : places_)
    out.push_back(
        std::isnan(place.fraction) ? nan : values[place.before + (place.fraction > 0.5 ? 1 : 0)]);
  return out;
}

std::vector<double> Resampler::linear(View<double> values) const {
  std::vector<double> out;
  out.reserve(places_.size());
  for (const auto& [before, fraction] : places_) {
    if (std::isnan(fraction))
      out.push_back(nan);
    else
      out.push_back(fraction == 0.0 ? values[before]
                                    : along(values[before], values[before + 1], fraction));
  }
  return out;
}

// By the four samples around the place, or the four at the end, of a segment from `begin` to `end`;
// by two if it has fewer, or the stamps are too uneven.
double Resampler::curved(View<double> values,
                         const Place& place,
                         std::size_t begin,
                         std::size_t end) const {
  const auto& [before, fraction] = place;
  const double straight = along(values[before], values[before + 1], fraction);
  if (end - begin < 4) return straight;
  const std::size_t first = std::clamp(before == 0 ? 0 : before - 1, begin, end - 4);
  const std::array<double, 4> at{times_[first], times_[first + 1], times_[first + 2],
                                 times_[first + 3]};
  if (!are_near_even(at)) return straight;
  const std::array<double, 4> four{values[first], values[first + 1], values[first + 2],
                                   values[first + 3]};
  const double t = along(times_[before], times_[before + 1], fraction);
  const double value = lagrange(at, four, t);
  return std::isfinite(value) ? value : straight;
}

std::vector<double> Resampler::cubic(View<double> values, const std::vector<Place>& places) const {
  std::vector<double> out;
  out.reserve(places.size());
  auto after = first_after_.begin();
  for (const Place& place : places) {
    if (std::isnan(place.fraction) || place.fraction == 0.0) {
      out.push_back(std::isnan(place.fraction) ? nan : values[place.before]);
      continue;
    }
    // The segment without gaps.
    while (after != first_after_.end() && *after <= place.before) ++after;
    const std::size_t begin = after == first_after_.begin() ? 0 : *std::prev(after);
    const std::size_t end = after == first_after_.end() ? values.size() : *after;
    out.push_back(curved(values, place, begin, end));
  }
  return out;
}

std::vector<double> Resampler::on_own_grid(View<double> values) const {
  if (is_even_) return on_even_grid(std::vector(values.begin(), values.end()), own_).take();
  return cubic(values, own_places_);
}

std::vector<double> Resampler::sinc(View<double> values) const {
  const std::vector<double> even = on_own_grid(values);
  const bool is_down = to_.rate_hz < own_.rate_hz * (1.0 - 1e-9);
  const SincKernel kernel(is_down ? 0.92 * to_.rate_hz / own_.rate_hz : 1.0);
  const double last = static_cast<double>(even.size()) - 1.0;
  std::vector<double> out;
  out.reserve(places_.size());
  for (std::size_t j = 0; j < places_.size(); ++j) {
    out.push_back(nan);
    if (std::isnan(places_[j].fraction)) continue;
    const double place = std::clamp(to_.at(j) * own_.rate_hz, 0.0, last);
    const auto before = static_cast<std::size_t>(place + same_time);
    const bool is_on = std::abs(place - static_cast<double>(before)) <= same_time;
    if (!std::isfinite(even[before]) || (!is_on && !std::isfinite(even[before + 1]))) continue;
    const double from = std::max(0.0, std::ceil(place - kernel.half_width()));
    const double to = std::min(last, std::floor(place + kernel.half_width()));
    double sum = 0.0;
    double total = 0.0;
    for (auto i = static_cast<std::size_t>(from); i <= static_cast<std::size_t>(to); ++i) {
      if (!std::isfinite(even[i])) continue;
      const double weight = kernel.at(static_cast<double>(i) - place);
      sum += weight * even[i];
      total += weight;
    }
    out.back() = sum / total;
  }
  return out;
}

std::vector<double> Resampler::mean(View<double> values) const {
  const double half_s = 0.5 / to_.rate_hz;
  const double expected = own_.rate_hz / to_.rate_hz;
  std::vector<double> out;
  out.reserve(to_.count);
  std::size_t first = 0;
  for (std::size_t j = 0; j < to_.count; ++j) {
    const double t = to_.at(j);
    while (first < times_.size() && times_[first] < t - half_s) ++first;
    Moments within;
    for (std::size_t k = first; k < times_.size() && times_[k] < t + half_s; ++k)
      within.add(values[k]);
    // At the ends half of them exist, which is sufficient.
    out.push_back(static_cast<double>(within.count) >= 0.4 * expected ? within.mean : nan);
  }
  return out;
}

std::vector<double> Resampler::apply(View<double> values) const {
  PM_EXPECTS(values.size() == times_.size());
  switch (method_) {
    case ResampleMethod::linear:
      return linear(values);
    case ResampleMethod::cubic:
      return cubic(values, places_);
    case ResampleMethod::nearest:
      return nearest(values);
    case ResampleMethod::mean:
      return mean(values);
    case ResampleMethod::sinc:
      break;
  }
  return sinc(values);
}

}  // namespace proofmass::signal
