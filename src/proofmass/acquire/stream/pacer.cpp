#include "proofmass/acquire/stream/pacer.hpp"

#include <algorithm>
#include <cmath>
#include <ctime>

#include "proofmass/acquire/source.hpp"
#include "proofmass/core/contract.hpp"

namespace proofmass::acquire {
namespace {

constexpr std::int64_t ns_per_ms = 1'000'000;

}  // namespace

Pacer::Pacer(double speed) : speed_(speed) {
  PM_EXPECTS(speed > 0.0);
}

std::int64_t Pacer::now_ns() {
  const std::int64_t host_ns = host_now_ns();
  if (start_ns_ == 0) start_ns_ = host_ns;
  const double passed_ns = static_cast<double>(host_ns - start_ns_) * speed_;
  constexpr double most_ns = 9e18;  // range of an int64; at any speed
  return static_cast<std::int64_t>(std::min(passed_ns, most_ns));
}

bool Pacer::wait_until(std::int64_t time_ns, std::chrono::milliseconds patience) {
  if (now_ns() >= time_ns) return true;
  const double wanted_ms = static_cast<double>(start_ns_) / ns_per_ms +
                           static_cast<double>(time_ns) / speed_ / static_cast<double>(ns_per_ms);
  const double latest_ms = static_cast<double>(host_now_ns()) / ns_per_ms +
                           static_cast<double>(std::max<std::int64_t>(patience.count(), 0));
  const auto deadline_ms = static_cast<std::int64_t>(std::ceil(std::min(wanted_ms, latest_ms)));
  const timespec deadline{deadline_ms * ns_per_ms / ns_per_s, deadline_ms * ns_per_ms % ns_per_s};
  (void)clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &deadline, nullptr);
  return now_ns() >= time_ns;
}

}  // namespace proofmass::acquire
