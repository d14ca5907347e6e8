#include "proofmass/characterise/record_overview.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <iterator>

#include "proofmass/characterise/allan/difference_kernels.hpp"
#include "proofmass/core/contract.hpp"
#include "proofmass/core/number_words.hpp"
#include "proofmass/signal/audit/chunk_statistics.hpp"

namespace proofmass::characterise {
namespace {

// Size of the subsample in the stored state of a part.
constexpr std::size_t most_of_sample = signal::Subsample::usual_capacity / 16;

}  // namespace

void RecordOverview::add(View<double> samples) {
  constexpr std::size_t longest_look = 1024;
  for (std::size_t from = 0; from < samples.size(); from += longest_look) {
    const View<double> part = samples.subspan(from, std::min(longest_look, samples.size() - from));
    add_sums(part);
    if (all_finite(part.data(), part.size())) {
      look_at_extremes(part);
      continue;
    }
    finite_.clear();
    std::ranges::copy_if(part, std::back_inserter(finite_),
                         [](double x) { return std::isfinite(x); });
    missing_ += part.size() - finite_.size();
    look_at_extremes(finite_);
  }
}

void RecordOverview::append(const RecordOverview& part) {
  PM_EXPECTS(part.before_ == (before_ + samples_) % block);
  const std::size_t of_head = part.head_.size();
  add_sums(part.head_);
  missing_ += part.missing_;
  add_extremes(part);
  if (part.samples_ == of_head) return;
  samples_ += part.samples_ - of_head;
  total_ += part.total_;
  squares_ += part.squares_;
  freedom_ += part.freedom_;
  open_ = part.open_;
}

void RecordOverview::add_extremes(const RecordOverview& part) {
  const auto take = [](Extreme& extreme, const Extreme& other, bool is_beyond) {
    if (is_beyond)
      extreme = other;
    else if (other.value == extreme.value)
      extreme.count += other.count;
  };
  take(low_, part.low_, part.low_.value < low_.value);
  take(high_, part.high_, part.high_.value > high_.value);
  sample_.append(part.sample_);
  lowest_.append(part.lowest_);
  highest_.append(part.highest_);
}

void RecordOverview::exchange(StateBytes& bytes) {
  for (std::size_t* count : {&samples_, &missing_, &low_.count, &high_.count}) bytes(*count);
  for (double* value : {&total_, &squares_, &freedom_, &low_.value, &high_.value}) bytes(*value);
  bytes(head_);
  bytes(open_);
  sample_.exchange(bytes, most_of_sample);
  lowest_.exchange(bytes);
  highest_.exchange(bytes);
  const std::size_t wanted = before_ == 0 ? 0 : block - before_;
  const std::size_t open = samples_ < wanted ? 0 : (samples_ - wanted) % block;
  if (head_.size() != std::min(wanted, samples_) || open_.size() != open || missing_ > samples_)
    bytes.fail();
}

void RecordOverview::add_sums(View<double> samples) {
  while (!samples.empty()) {
    const std::size_t count = std::min(samples.size(), block - (before_ + samples_) % block);
    const View<double> next = samples.first(count);
    const bool is_head = before_ > 0 && before_ + samples_ < block;
    samples_ += count;
    samples = samples.subspan(count);
    if (is_head) {
      head_.insert(head_.end(), next.begin(), next.end());
      continue;
    }
    if (count == block) {
      add_block(next);
      continue;
    }
    open_.insert(open_.end(), next.begin(), next.end());
    if (open_.size() < block) continue;
    add_block(open_);
    open_.clear();
  }
}

void RecordOverview::add_block(View<double> samples) {
  const Sums sums = sums_of(samples);
  total_ += sums.total;
  squares_ += sums.squares;
  freedom_ += std::max(0.0, sums.count - 1.0);
}

RecordOverview::Sums RecordOverview::sums_of(View<double> samples) {
  PM_EXPECTS(samples.size() <= block);
  std::array<double, block> finite{};
  std::size_t count = samples.size();
  if (count > 0 && !all_finite(samples.data(), count)) {
    const auto end = std::ranges::copy_if(samples, finite.begin(), [](double x) {
                       return std::isfinite(x);
                     }).out;
    count = static_cast<std::size_t>(end - finite.begin());
    samples = View<double>(finite.data(), count);
  }
  if (count == 0) return {};
  // Relative to the first sample, so that an offset costs no digits.
  const signal::DepartureSums departures = signal::sum_departures(samples);
  const auto n = static_cast<double>(count);
  return {n * samples.front() + departures.sum,
          departures.squares - departures.sum * departures.sum / n, n};
}

void RecordOverview::look_at_extremes(View<double> finite) {
  if (finite.empty()) return;
  const signal::ChunkStatistics figures = signal::chunk_statistics(finite);
  const auto take = [&](double value, bool is_new, Extreme& extreme) {
    if (is_new) extreme = {.value = value};
    if (value == extreme.value)
      extreme.count += static_cast<std::size_t>(std::ranges::count(finite, value));
  };
  take(figures.min, figures.min < low_.value, low_);
  take(figures.max, figures.max > high_.value, high_);
  sample_.add(finite);
  lowest_.add(finite, figures.min);
  highest_.add(finite, figures.max);
}

double RecordOverview::mean() const {
  const auto present = static_cast<double>(samples_ - missing_);
  return present > 0.0 ? (total_ + sums_of(open_).total) / present : 0.0;
}

double RecordOverview::short_term_std() const {
  const Sums last = sums_of(open_);
  const double freedom = freedom_ + std::max(0.0, last.count - 1.0);
  return freedom > 0.0 ? std::sqrt(std::max(0.0, squares_ + last.squares) / freedom) : 0.0;
}

// With noise of half a step or more, quantisation is additional white noise of variance step²/12:
// B. Widrow, I. Kollár, Quantization Noise (2008), section 4.
Status RecordOverview::check_spread(std::optional<double> lsb) const {
  if (missing_ == samples_) return Error{Errc::not_finite, "no sample is a number"};
  const double spread = short_term_std();
  if (!(spread > 0.0)) return Error{Errc::not_observable, "the samples do not vary"};
  // The likelihood divides by fourth powers.
  constexpr double least_spread = 1e-60, most_spread = 1e60;
  if (spread < least_spread || spread > most_spread)
    return Error{Errc::not_observable,
                 fmt::format("the samples spread by {:.3g}, expected {:g} to {:g}: bring them to "
                             "another unit",
                             spread, least_spread, most_spread)};
  if (!lsb) return Done{};
  const double added = *lsb * *lsb / 12.0, least = 0.25 * *lsb * *lsb;
  if (spread * spread - added >= least) return Done{};
  return Error{
      Errc::not_observable,
      fmt::format("the standard deviation is {:.2f} quantisation steps, of which "
                  "quantisation itself contributes 0.29: noise below half a step is not "
                  "distinguishable from rounding: record with a finer converter or more gain",
                  spread / *lsb)};
}

// The density of noise falls towards its extremes. If the extreme value is more frequent than all
// values near it, the converter, or the sensor, is saturated.
Status RecordOverview::check_rails(std::optional<double> lsb) const {
  constexpr double beside_share = 0.02, times = 1.3;
  constexpr std::size_t fewest = 10;
  const double width =
      std::max(beside_share * (high_.value - low_.value), 1.01 * lsb.value_or(0.0));
  const auto is_rail = [&](const Extreme& extreme, const signal::ClippingTail& tail) {
    if (extreme.count < fewest) return false;
    const double beside = tail.beside(std::nextafter(width, 0.0), sample_);
    return static_cast<double>(extreme.count) > times * beside;
  };
  for (const bool lowest : {true, false}) {
    const Extreme& extreme = lowest ? low_ : high_;
    if (!is_rail(extreme, lowest ? lowest_ : highest_)) continue;
    return Error{Errc::not_observable,
                 fmt::format("clipped: {} of {} samples read exactly {}, the {} value there is: "
                             "what is cut off there is not in the figures",
                             extreme.count, samples_, compact(extreme.value, 6),
                             lowest ? "lowest" : "highest")};
  }
  return Done{};
}

}  // namespace proofmass::characterise
