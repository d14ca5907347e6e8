#pragma once

#include <cstdint>

namespace proofmass::acquire {

/// A line through host's times against rows that is carried along: the delivery's jitter goes, a
/// slow change of the rate is followed. It begins as the least-squares line through all and ends as
/// one that forgets after some fifty arrivals.
/// Source: Brookner, Tracking and Kalman Filtering Made Easy (1998), 1.2.10 (growing memory and
/// fading gains of the g-h filter).
class RunningLine {
 public:
  void restart(double time_s, double step_s);
  /// So many rows later something arrived at `time_s`; what the line says instead. Times that
  /// scatter as much as they are apart stay as they are.
  [[nodiscard]] double follow(double rows, double time_s);
  [[nodiscard]] double step_s() const { return step_s_; }

 private:
  double time_s_ = 0.0;
  double step_s_ = 0.0;
  double squares_ = 0.0;   ///< of what the line missed by, fading
  double interval_ = 0.0;  ///< between arrivals, fading
  unsigned count_ = 0;
};

}  // namespace proofmass::acquire
