#pragma once

#include <algorithm>
#include <chrono>

namespace proofmass::serve {

/// Allows so many events a second on average, and a second's worth at once.
class TokenBucket {
 public:
  using Clock = std::chrono::steady_clock;
  explicit TokenBucket(double per_s) : per_s_(per_s), left_(per_s) {}

  [[nodiscard]] bool take(Clock::time_point now) {
    const double passed_s = std::chrono::duration<double>(now - last_).count();
    last_ = now;
    left_ = std::min(per_s_, left_ + passed_s * per_s_);
    if (left_ < 1.0) return false;
    left_ -= 1.0;
    return true;
  }

 private:
  double per_s_, left_;
  Clock::time_point last_ = Clock::now();
};

}  // namespace proofmass::serve
