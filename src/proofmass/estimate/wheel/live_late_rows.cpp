#include "proofmass/estimate/wheel/live_late_rows.hpp"

#include <cmath>
#include <utility>

namespace proofmass::estimate {

bool LiveLateRows::holds(const Block& samples, std::size_t row, double last_s, double rate_hz) {
  constexpr double longest_step = 3.0, early = 0.5, on_time = 0.5;  // in periods
  constexpr std::size_t most = 4096;
  if (samples.stamps_s.empty() || !(rate_hz > 0.0)) return false;
  const double time_s = samples.stamps_s[row];
  if (stamps_s_.empty()) {
    const double step = (time_s - last_s) * rate_hz;
    if (!std::isfinite(step) || !(step > longest_step)) return false;
    from_s_ = last_s;
    keep(samples, row);
    return true;
  }
  const double step = (time_s - stamps_s_.back()) * rate_hz;
  const double late = (time_s - from_s_) * rate_hz - static_cast<double>(stamps_s_.size() + 1);
  if (step >= 0.0 && step < early && late > on_time && stamps_s_.size() < most) {
    keep(samples, row);
    return true;
  }
  if (step >= 0.0) spread(time_s, rate_hz);
  return false;
}

// If rows are missing, too, those that are there are the last ones.
void LiveLateRows::spread(double on_time_s, double rate_hz) {
  constexpr std::size_t fewest = 3;  // fewer follow a gap by chance
  constexpr double all_there = 1.5;
  const std::size_t n = stamps_s_.size();
  if (n < fewest) return;
  const auto rows = static_cast<double>(n + 1);
  const bool is_all = (on_time_s - from_s_) * rate_hz - rows < all_there;
  const double step_s = is_all ? (on_time_s - from_s_) / rows : 1.0 / rate_hz;
  for (std::size_t i = 0; i < n; ++i)
    stamps_s_[i] = on_time_s - static_cast<double>(n - i) * step_s;
  count_ += n;
}

void LiveLateRows::keep(const Block& samples, std::size_t row) {
  channels_.resize(samples.channels.size());
  for (std::size_t c = 0; c < channels_.size(); ++c)
    channels_[c].push_back(samples.channels[c][row]);
  stamps_s_.push_back(samples.stamps_s[row]);
}

Block LiveLateRows::take() {
  taken_ = std::exchange(channels_, {});
  taken_s_ = std::exchange(stamps_s_, {});
  Block block;
  for (const std::vector<double>& channel : taken_) block.channels.emplace_back(channel);
  block.stamps_s = taken_s_;
  return block;
}

std::size_t LiveLateRows::take_count() {
  return std::exchange(count_, 0);
}

}  // namespace proofmass::estimate
