#include "proofmass/io/messages/clock.hpp"

#include <cmath>
#include <fmt/format.h>
#include <limits>

#include "proofmass/io/text/wording.hpp"

namespace proofmass::io {
namespace {

constexpr std::int64_t latest_ns = 9'000'000'000'000'000'000;

std::optional<std::int64_t> log_stamp_ns(std::uint64_t log_ns) {
  if (log_ns > static_cast<std::uint64_t>(latest_ns)) return std::nullopt;
  return static_cast<std::int64_t>(log_ns);
}

double difference_s(std::int64_t a_ns, std::int64_t b_ns) {
  return static_cast<double>(Int128{a_ns} - b_ns) * 1e-9;
}

}  // namespace

std::optional<std::int64_t> stamp_ns(std::int64_t seconds, std::int64_t nanoseconds) {
  std::int64_t ns = 0;
  if (__builtin_mul_overflow(seconds, std::int64_t{1'000'000'000}, &ns) ||
      __builtin_add_overflow(ns, nanoseconds, &ns) || ns > latest_ns || ns < -latest_ns)
    return std::nullopt;
  return ns;
}

MessageClock::MessageClock(std::optional<std::int64_t> stamp_ns,
                           std::uint64_t log_ns,
                           std::string stamp_name)
    // A driver without a clock leaves the stamp at zero.
    : has_stamps_(stamp_ns.value_or(0) != 0),
      name_(has_stamps_ ? std::move(stamp_name) : "log_time"),
      last_log_ns_(log_ns) {
  const auto logged = log_stamp_ns(log_ns);
  origin_ns_ = has_stamps_ ? *stamp_ns : logged.value_or(0);
  if (has_stamps_ && logged) first_offset_s_ = difference_s(*logged, origin_ns_);
}

DeclaredStamps MessageClock::declared() const {
  return {0, *parse_unit("ns"), {Int128{origin_ns_}, 0}};
}

double MessageClock::take(std::optional<std::int64_t> stamp_ns, std::uint64_t log_ns) {
  if (log_ns < last_log_ns_) ++backwards_;
  last_log_ns_ = log_ns;
  const auto logged = log_stamp_ns(log_ns);
  const auto stamp = has_stamps_ ? stamp_ns : logged;
  if (!stamp) return std::numeric_limits<double>::quiet_NaN();
  if (has_stamps_ && logged)
    compare(difference_s(*stamp, origin_ns_), difference_s(*logged, *stamp) - first_offset_s_);
  return static_cast<double>(Int128{*stamp} - origin_ns_);
}

void MessageClock::compare(double device_s, double host_less_device_s) {
  count_ += 1.0;
  const double t = device_s - mean_t_;
  const double d = host_less_device_s - mean_d_;
  mean_t_ += t / count_;
  mean_d_ += d / count_;
  sum_tt_ += t * (device_s - mean_t_);
  sum_td_ += t * (host_less_device_s - mean_d_);
  sum_dd_ += d * (host_less_device_s - mean_d_);
}

std::vector<Note> MessageClock::notes() const {
  std::vector<Note> notes;
  if (backwards_ > 0)
    notes.push_back({Severity::info,
                     fmt::format("the host logged messages out of order, {}: rows are in the order "
                                 "of the file",
                                 times(backwards_))});
  constexpr double enough = 10.0;
  if (!has_stamps_ || count_ < enough || !(sum_tt_ > 0.0)) return notes;
  const double drift = sum_td_ / sum_tt_;
  const double residual = std::max(0.0, sum_dd_ - drift * sum_td_) / (count_ - 2.0);
  notes.push_back(
      {Severity::info,
       fmt::format("the clock of the host (log_time) is ahead of the device's ({}) by {} s on "
                   "average and gains {} ± {} ppm on it (one standard deviation, if delays are "
                   "independent); it scatters by {} ms",
                   name_, in_words(first_offset_s_ + mean_d_), in_words(1e6 * drift),
                   in_words(1e6 * std::sqrt(residual / sum_tt_)),
                   in_words(1e3 * std::sqrt(residual)))});
  return notes;
}

}  // namespace proofmass::io
