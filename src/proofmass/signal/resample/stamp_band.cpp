#include "proofmass/signal/resample/stamp_band.hpp"

#include <algorithm>
#include <cmath>

namespace proofmass::signal {
namespace {

constexpr double drift_per_row = 1.0 / 4096.0;  // drift of the band per row, relative to its width
constexpr double most_reach = 1024.0;           // rows tried on either side of the likeliest
constexpr double slack = 0.02;  // in steps: rounding of sums, and the clock's own jitter

}  // namespace

bool StampBand::holds(double stamp) const {
  return !has_begun_ || stamp - first_ - number_ * step_ <= low_ + width_ + slack * step_;
}

/// Mean distance of the stamps outside the band, if `missing` rows are missing before them. Rounded
/// stamps above the band may be due to further rows missing between them, those below it may not.
double StampBand::outside(View<double> next, double missing) const {
  constexpr double price = 0.1;  // of a further missing row, in steps
  double sum = 0.0;
  double later = 0.0;
  for (std::size_t k = 0; k < next.size(); ++k) {
    double off = next[k] - first_ - (number_ + missing + later + static_cast<double>(k)) * step_;
    const double above = off - (low_ + width_ + slack * step_);
    if (above > 0.0 && k > 0 && missing > 0.0 && is_of_rounding()) {
      const double more = std::ceil(above / step_);
      later += more;
      off -= more * step_;
      sum += price * step_ * more;
    }
    sum += std::max({0.0, off - (low_ + width_), (high_ - width_) - off});
  }
  return sum / static_cast<double>(next.size());
}

double StampBand::missing_before(View<double> next) const {
  if (next.empty() || holds(next.front())) return 0.0;
  const double off = next.front() - first_ - number_ * step_;
  const double likely = std::floor((off - low_) / step_);
  // Limits the count of rows for any jump of a stamp.
  const double reach = std::min(std::ceil(width_ / step_) + 1.0, most_reach);
  const double as_is = outside(next, 0.0);
  double best = 0.0;
  double least = as_is;
  for (double back = reach; back >= -1.0; back -= 1.0) {
    const double missing = std::max(1.0, likely - back);
    const double out = outside(next, missing);
    if (out >= least) continue;
    best = missing;
    least = out;
  }
  return as_is > slack * step_ && least < 0.5 * as_is ? best : 0.0;
}

void StampBand::take(double stamp, double missing) {
  if (!has_begun_) {
    has_begun_ = true;
    first_ = stamp;
    number_ = 1.0;
    return;
  }
  number_ += missing;
  const double off = stamp - first_ - number_ * step_;
  number_ += 1.0;
  strain_ += std::max({0.0, off - (low_ + width_), (high_ - width_) - off});
  low_ = std::min(low_ + drift_per_row * width_, off);
  high_ = std::max(high_ - drift_per_row * width_, off);
  // A stamp outside the band moves it: the latest one counts.
  if (off >= high_) low_ = std::max(low_, high_ - width_);
  if (off <= low_) high_ = std::min(high_, low_ + width_);
  filled_ = std::max(filled_, high_ - low_);
}

namespace {

/// Takes all stamps; `see` is called for each with the number missing before it.
StampBand take_all(View<double> stamps, double step, double width, auto see) {
  StampBand band(step, width);
  for (std::size_t k = 0; k < stamps.size(); ++k) {
    const std::size_t count = std::min(StampBand::ahead, stamps.size() - k);
    const double missing = band.missing_before(stamps.subspan(k, count));
    band.take(stamps[k], missing);
    see(missing);
  }
  return band;
}

}  // namespace

double strain_in_band(View<double> stamps, double step, double width) {
  double missing = 0.0;
  const StampBand band = take_all(stamps, step, width, [&](double more) { missing += more; });
  return band.strain() + 0.01 * step * missing;
}

std::vector<double> numbers_in_band(View<double> stamps, double step, double width) {
  std::vector<double> out;
  out.reserve(stamps.size());
  take_all(stamps, step, width,
           [&](double missing) { out.push_back(out.empty() ? 0.0 : out.back() + 1.0 + missing); });
  return out;
}

}  // namespace proofmass::signal
