#pragma once

#include <cstddef>
#include <vector>

namespace proofmass::signal {

/// Allan variance of means over so many samples, from so many pairs of neighbouring means.
struct AllanLevel {
  double samples = 1.0, variance = 0.0, pairs = 0.0;
};

/// Allan variances of means over 1, 2, 4, … values that come one by one,
///
///     σ²(m) = ½ mean (ȳ_{2k+1} − ȳ_{2k})²,
///
/// of means that do not overlap. Memory: a few numbers for each octave. Cost: two differences a
/// value.
class DyadicLadder {
 public:
  void add(double value);
  /// No pair reaches over this point: what follows is another stretch.
  void break_off();
  /// Of the octaves that have a pair; a value stands for so many samples.
  [[nodiscard]] std::vector<AllanLevel> levels(double samples_a_value) const;

 private:
  struct Rung {
    double squares = 0.0, pairs = 0.0, waiting = 0.0;
    bool waits = false;
  };
  std::vector<Rung> rungs_;
};

}  // namespace proofmass::signal
