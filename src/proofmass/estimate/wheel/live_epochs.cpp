#include "proofmass/estimate/wheel/live_epochs.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <utility>

#include "proofmass/core/contract.hpp"
#include "proofmass/core/statistics.hpp"
#include "proofmass/estimate/live_columns.hpp"
#include "proofmass/estimate/wheel/plane.hpp"
#include "proofmass/signal/unusable.hpp"

namespace proofmass::estimate {
namespace {

/// Samples used to estimate the rate if it is not given.
constexpr std::size_t rate_samples = 64;
/// Number of ascending stamps earlier than the last after which the clock counts as set back.
constexpr std::size_t most_behind = 100;
/// A mean ends if the next sample is this many steps away.
constexpr double longest_steps = 3.0;

double value_of(const Block& samples, const std::optional<std::size_t>& channel, std::size_t row) {
  return channel ? samples.channels[*channel][row] : 0.0;
}

std::size_t samples_of_mean(const LiveClock& clock) {
  return static_cast<std::size_t>(
      std::max(1.0, std::ceil(clock.rate_hz / clock.most_rate_hz - 1e-6)));
}

}  // namespace

Status check_live_times(const LiveTimes& times) {
  const bool sensible = times.rate_hz >= 0.0 && std::isfinite(times.rate_hz) &&
                        times.start_s >= 0.5 && times.start_s <= 20.0 && times.lag_s >= 0.0 &&
                        times.lag_s <= 10.0 && times.most_rate_hz >= 20.0 &&
                        times.most_rate_hz <= 1e4;
  if (sensible) return Done{};
  return Error{Errc::invalid_argument,
               "a live estimate takes a start of 0.5 s to 20 s, a lag of 0 s to 10 s and 20 Hz to "
               "10 kHz of epochs"};
}

std::string at_second(double time_s) {
  std::array<char, 400> text{};
  const auto end =
      std::to_chars(text.data(), text.data() + text.size(), time_s, std::chars_format::fixed, 2);
  return {text.data(), end.ptr};
}

LiveEpochs::LiveEpochs(std::vector<LiveVector> vectors, const LiveClock& clock)
    : vectors_(std::move(vectors)), clock_(clock) {
  PM_EXPECTS(!vectors_.empty() && vectors_.size() <= most_live_vectors);
  PM_EXPECTS(clock.most_rate_hz > 0.0 && clock.rate_hz >= 0.0);
  if (clock_.rate_hz > 0.0) each_ = samples_of_mean(clock_);
  for (Mat<3>& vector : epoch_.vectors) vector.setConstant(std::nan(""));
  constexpr double least_radps = 1.0, least_mps2 = 1.4 * standard_gravity_mps2;
  for (std::size_t i = 0; i < vectors_.size(); ++i)
    for (Range& range : ranges_[i]) range.set_least(vectors_[i].is_rate ? least_radps : least_mps2);
}

Status LiveEpochs::check(const Block& samples) const {
  for (const LiveVector& vector : vectors_)
    for (const auto& channel : {vector.channels.x, vector.channels.y, vector.channels.z})
      if (channel && *channel >= samples.channels.size())
        return Error{Errc::invalid_argument, vector.channels.name + ": there is no channel " +
                                                 std::to_string(*channel) + " in the samples"};
  if (samples.stamps_s.empty() && !(clock_.rate_hz > 0.0))
    return Error{
        Errc::invalid_argument, "the samples have neither time nor rate", {Advice{"rate"}}};
  return Done{};
}

bool LiveEpochs::take(const Block& samples, std::size_t row) {
  const double time_s = samples.stamps_s.empty()
                            ? static_cast<double>(samples.first + row) / clock_.rate_hz
                            : samples.stamps_s[row];
  if (!follows(time_s)) return false;
  if (!(clock_.rate_hz > 0.0)) learn_rate(time_s);
  const bool apart = in_mean_ > 0 && clock_.rate_hz > 0.0 &&
                     (time_s - last_time_s_) * clock_.rate_hz > longest_steps;
  const bool closed = (apart || anew_) && close();
  last_time_s_ = time_s;
  sum_up(samples, row, time_s);
  if (in_mean_ < each_) return closed;
  // Never two at once: if a mean was closed, `each_` is at least two.
  return close();
}

/// Whether a stamp ascends; otherwise the sample is dropped, until there are so many that the clock
/// must have been set back.
bool LiveEpochs::follows(double time_s) {
  if (std::isfinite(time_s) && time_s > last_time_s_) {
    behind_ = 0;
    return true;
  }
  const bool rises = std::isfinite(time_s) && (behind_ == 0 || time_s > last_behind_s_);
  behind_ = rises ? behind_ + 1 : 0;
  last_behind_s_ = time_s;
  if (behind_ <= most_behind) {
    ++backwards_.count;
    backwards_.last_s = last_time_s_;
    return false;
  }
  notes_.push_back({Severity::warning, "the clock stepped back from " + at_second(last_time_s_) +
                                           " s to " + at_second(time_s) +
                                           " s: the estimate restarts there"});
  behind_ = 0;
  anew_ = true;
  last_time_s_ = -std::numeric_limits<double>::infinity();
  return true;
}

void LiveEpochs::learn_rate(double time_s) {
  if (rows_seen_ == 0 || anew_) {
    first_time_s_ = time_s;
    rows_seen_ = 0;
  }
  if (++rows_seen_ < rate_samples) return;
  clock_.rate_hz = static_cast<double>(rows_seen_ - 1) / (time_s - first_time_s_);
  each_ = samples_of_mean(clock_);
}

void LiveEpochs::sum_up(const Block& samples, std::size_t row, double time_s) {
  if (in_mean_++ == 0) {
    first_in_mean_s_ = time_s;
    mean_is_anew_ = std::exchange(anew_, false);
  }
  time_sum_s_ += time_s - first_in_mean_s_;
  for (std::size_t i = 0; i < vectors_.size(); ++i) {
    const Triad& at = vectors_[i].channels;
    const Axis value{value_of(samples, at.x, row), value_of(samples, at.y, row),
                     value_of(samples, at.z, row)};
    if (const char* why = why_not(i, value, time_s); why != nullptr) {
      rejected_[i] = {rejected_[i].count + 1, time_s, why};
      continue;
    }
    sums_[i].total += Mat<3>(value[0], value[1], value[2]);
    sums_[i].count += 1.0;
  }
}

const char* LiveEpochs::why_not(std::size_t vector, const Axis& value, double time_s) {
  const bool is_rate = vectors_[vector].is_rate;
  const char* why = is_rate ? nullptr : why_unbelievable(value);
  if (is_rate && !std::ranges::all_of(value, [](double x) { return std::isfinite(x); }))
    why = "not a finite number";
  if (why != nullptr) return why;
  if (repeats_[vector].is_repeated(value, time_s)) return "the same as the one before";
  bool at_end = false;
  for (std::size_t axis = 0; axis < 3; ++axis) at_end |= ranges_[vector][axis].ends_at(value[axis]);
  return at_end ? "at the limit of its range" : nullptr;
}

bool LiveEpochs::Range::ends_at(double value) {
  constexpr std::size_t fewest = 3;
  if (value == last_) {
    ++equal_;
  } else {
    const double outwards = value < 0.0 ? -1.0 : 1.0;
    equal_ = 1;
    slope_ = std::min(outwards * (value - last_), outwards * (last_ - before_));
    if (!std::isnan(last_)) step_ = std::min(step_, std::abs(value - last_));
  }
  before_ = last_;
  last_ = value;
  most_ = std::max(most_, std::abs(value));
  return equal_ >= fewest && std::abs(value) == most_ && signal::is_cut_off(equal_, slope_, step_);
}

bool LiveEpochs::Repeats::is_repeated(const Axis& value, double time_s) {
  constexpr double longest_s = 3.0;
  bool repeated = added_ > 0;
  for (std::size_t i = 0; i < 3; ++i) repeated = repeated && value[i] == axes_[i].before[0];
  if (repeated) return has_noise() && time_s - last_change_s_ < longest_s;
  last_change_s_ = time_s;
  for (std::size_t i = 0; i < 3; ++i) add(value[i], axes_[i]);
  ++added_;
  return false;
}

void LiveEpochs::Repeats::add(double value, AxisNoise& axis) const {
  constexpr std::size_t each = 32;
  constexpr double fourth_difference = 70.0;  // 1 + 16 + 36 + 16 + 1
  auto& past = axis.before;
  const double step = std::abs(value - past[0]);
  if (added_ > 0 && step > 0.0) axis.step = std::min(axis.step, step);
  if (added_ >= past.size())
    axis.sum2 += square(value - 4.0 * past[0] + 6.0 * past[1] - 4.0 * past[2] + past[3]);
  if (added_ % each == 0) {
    if (added_ > each) axis.noise2 = std::min(axis.noise2, axis.sum2 / (fourth_difference * each));
    axis.sum2 = 0.0;
  }
  past = {value, past[0], past[1], past[2]};
}

bool LiveEpochs::Repeats::has_noise() const {
  return std::ranges::any_of(axes_, [](const AxisNoise& axis) {
    return axis.noise2 < unknown && axis.noise2 > square(axis.step);
  });
}

bool LiveEpochs::close() {
  if (in_mean_ == 0) return false;
  epoch_.anew = mean_is_anew_;
  epoch_.time_s = first_in_mean_s_ + time_sum_s_ / static_cast<double>(in_mean_);
  for (std::size_t i = 0; i < vectors_.size(); ++i) {
    if (sums_[i].count > 0.0)
      epoch_.vectors[i] = sums_[i].total / sums_[i].count;
    else
      epoch_.vectors[i].setConstant(std::nan(""));
    sums_[i] = {};
  }
  time_sum_s_ = 0.0;
  in_mean_ = 0;
  return true;
}

std::vector<Note> LiveEpochs::take_notes() {
  for (std::size_t i = 0; i < vectors_.size(); ++i) {
    const Rejected said = std::exchange(rejected_[i], {});
    if (said.count == 0) continue;
    notes_.push_back(
        {Severity::warning, vectors_[i].channels.name + ": " + std::to_string(said.count) +
                                " measurements excluded from the estimate, the last at " +
                                at_second(said.last_s) + " s: " + said.why});
  }
  if (const std::size_t late = late_.take_count(); late > 0)
    notes_.push_back({Severity::warning,
                      std::to_string(late) +
                          " samples were stamped late, as by a computer that was "
                          "busy, before " +
                          at_second(last_time_s_) + " s: they are taken to be evenly spaced"});
  if (const Rejected said = std::exchange(backwards_, {}); said.count > 0)
    notes_.push_back({Severity::warning, std::to_string(said.count) +
                                             " samples left out of the estimate: their time does "
                                             "not rise, at " +
                                             at_second(said.last_s) + " s"});
  return std::exchange(notes_, {});
}

}  // namespace proofmass::estimate
