#include "proofmass/signal/audit/dyadic_allan.hpp"

namespace proofmass::signal {

void DyadicAllan::add(double value) {
  for (std::size_t k = 0;; ++k) {
    if (k == rungs_.size()) rungs_.emplace_back();
    Rung& rung = rungs_[k];
    rung.waits = !rung.waits;
    if (rung.waits) {
      rung.waiting = value;
      return;
    }
    const double step = value - rung.waiting;
    rung.squares += 0.5 * step * step;
    rung.pairs += 1.0;
    value = rung.waiting + 0.5 * step;
  }
}

void DyadicAllan::break_off() {
  for (Rung& rung : rungs_) rung.waits = false;
}

std::vector<AllanLevel> DyadicAllan::levels(double samples_a_value) const {
  std::vector<AllanLevel> levels;
  double samples = samples_a_value;
  for (const Rung& rung : rungs_) {
    if (rung.pairs > 0.0) levels.push_back({samples, rung.squares / rung.pairs, rung.pairs});
    samples *= 2.0;
  }
  return levels;
}

}  // namespace proofmass::signal
