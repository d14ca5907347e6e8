#pragma once

#include <cstddef>
#include <vector>

namespace proofmass::signal {

/// Allan variance of means over a number of samples, and the number of pairs of adjacent means
/// used.
struct AllanLevel {
  double samples = 1.0, variance = 0.0, pairs = 0.0;
};

/// Online Allan variances of non-overlapping means over 1, 2, 4, … values,
///
///     σ²(m) = ½ mean (ȳ_{2k+1} − ȳ_{2k})².
///
/// Memory: a few numbers per octave. Cost: two differences per value.
class DyadicAllan {
 public:
  void add(double value);
  /// Starts a new segment: no pair spans this point.
  void break_off();
  /// Levels of the octaves that have a pair; each value represents `samples_a_value` samples.
  [[nodiscard]] std::vector<AllanLevel> levels(double samples_a_value) const;

 private:
  struct Rung {
    double squares = 0.0, pairs = 0.0, waiting = 0.0;
    bool waits = false;
  };
  std::vector<Rung> rungs_;
};

}  // namespace proofmass::signal
