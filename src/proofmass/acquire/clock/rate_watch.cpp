#include "proofmass/acquire/clock/rate_watch.hpp"

#include <cmath>

namespace proofmass::acquire {

double RateWatch::rate_hz(const Mark& from, const Mark& to) {
  return (to.rows - from.rows) / (to.host_s - from.host_s);
}

std::optional<OtherRate> RateWatch::add(std::uint64_t rows, double host_s) {
  constexpr double least_s = 5.0, least_rows = 40.0, most_off = 0.05;
  constexpr int enough = 3;
  if (is_reported_ || !(granted_hz_ > 0.0)) return std::nullopt;
  const Mark now{static_cast<double>(rows), host_s};
  if (!since_) since_ = now;
  if (now.host_s - since_->host_s < least_s || now.rows - since_->rows < least_rows)
    return std::nullopt;
  const double off = rate_hz(*since_, now) / granted_hz_ - 1.0;
  const int side = off > 0.0 ? 1 : -1;
  if (std::abs(off) <= most_off)
    times_ = 0;
  else
    times_ = times_ * side > 0 ? times_ + side : side;
  if (std::abs(times_) == 1) differs_ = since_;
  since_ = now;
  if (std::abs(times_) < enough) return std::nullopt;
  is_reported_ = true;
  return OtherRate{rate_hz(*differs_, now), now.host_s - differs_->host_s};
}

}  // namespace proofmass::acquire
