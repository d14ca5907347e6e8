#include "proofmass/acquire/clock/stamp_watch.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace proofmass::acquire {

bool is_dead(const std::vector<std::int64_t>& stamps_ns) {
  if (stamps_ns.empty()) return true;
  if (std::ranges::all_of(stamps_ns, [](std::int64_t stamp) { return stamp == 0; })) return true;
  return stamps_ns.size() > 1 && std::ranges::all_of(stamps_ns, [&](std::int64_t stamp) {
           return stamp == stamps_ns.front();
         });
}

void StampWatch::look(const std::vector<std::int64_t>& stamps_ns, std::vector<Note>& notes) {
  double worst_s = 0.0;  // invalid stamps may differ by more than an integer holds
  for (const std::int64_t stamp : stamps_ns) {
    if (last_ns_ && stamp == *last_ns_) ++repeated_.seen;
    if (last_ns_ && stamp < *last_ns_) {
      ++backwards_.seen;
      worst_s =
          std::max(worst_s, (static_cast<double>(*last_ns_) - static_cast<double>(stamp)) * 1e-9);
    }
    last_ns_ = stamp;
  }
  if (repeated_.is_due()) {
    notes.push_back({Severity::warning,
                     fmt::format("the device stamped {} rows with the time of the row before",
                                 repeated_.seen)});
    repeated_.reported = repeated_.seen;
  }
  if (backwards_.is_due()) {
    notes.push_back({Severity::warning,
                     fmt::format("the device's stamps stepped back {} times, by {:.6g} s here",
                                 backwards_.seen, worst_s)});
    backwards_.reported = backwards_.seen;
  }
}

}  // namespace proofmass::acquire
