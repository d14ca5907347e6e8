#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <memory>
#include <vector>

#include "proofmass/estimate/filter/fixed_lag.hpp"
#include "proofmass/estimate/live_tilt.hpp"
#include "proofmass/estimate/tilt/accel.hpp"
#include "proofmass/estimate/tilt/model.hpp"
#include "proofmass/estimate/wheel/live_epochs.hpp"

// tilt/model.hpp's filter, online.
namespace proofmass::estimate {

/// Correlation time of the base's acceleration, from the correlation of its departures with those a
/// tenth of a second before.
class RunningCorrelation {
 public:
  explicit RunningCorrelation(std::size_t epochs_apart) : ring_(epochs_apart) {}
  void add(const Mat<3>& departure, double weight);
  /// In units of the distance, at least one half.
  [[nodiscard]] double time() const;

 private:
  std::vector<Mat<3>> ring_;
  std::size_t added_ = 0;
  double product_ = 0.0, square_ = 0.0;
};

/// Correlation time of a first-order process with the variance and the low-frequency density of the
/// departures, as in base_accel(): from sums over blocks of 1/4 to 4 s, each of which forgets.
class RunningDensity {
 public:
  RunningDensity(double step_s, double memory_s);
  void add(const Mat<3>& departure);
  /// The sums are of vectors in the sensor's axes: rotates them with it.
  void turn(const Mat<3, 3>& R);
  [[nodiscard]] double time_s() const;

 private:
  struct Block {
    std::size_t length = 1, count = 0;
    Mat<3> sum = Mat<3>::Zero();
    double square = 0.0, weight = 0.0;  ///< fading sums
  };
  double step_s_, memory_s_;
  std::array<Block, 5> blocks_;
  double square_ = 0.0, weight_ = 0.0;
};

/// White noise of a measurement, vibration included: from second differences, which rotation hardly
/// enters, over the last second or the last 6 s, whichever gives more.
class RunningNoise {
 public:
  RunningNoise(double step_s, double std_mps2);
  /// NaN if missing.
  void add(const Mat<3>& force);
  [[nodiscard]] double std_mps2() const { return std::sqrt(std::max(short_, long_)); }

 private:
  double short_weight_, long_weight_;
  double short_, long_;  ///< variances, (m/s²)²
  std::array<Mat<3>, 2> before_;
};

class LiveTiltFilter {
 public:
  /// Initialised from the first epochs; at least two of them.
  LiveTiltFilter(const std::vector<LiveEpoch>& first, const LiveTiltOptions& options);

  /// Processes one epoch. Does not allocate.
  void step(const LiveEpoch& epoch);

  /// Direction of gravity's reaction at the last epoch, m/s².
  [[nodiscard]] const Gaussian<3>& now() const { return window_.state(0); }
  /// Gravity's reaction `lag_s` before; null if that is before the first epoch.
  [[nodiscard]] const Gaussian<3>* lagged() const {
    return window_.size() > window_.lag() ? &window_.state(window_.lag()) : nullptr;
  }
  [[nodiscard]] double lagged_time_s() const { return times_s_[epochs_ % times_s_.size()]; }
  [[nodiscard]] double nis() const { return nis_; }

  /// Scales the assumed strength of the base's rotation from here on.
  void turn_more(double factor) { motion_.drive *= factor; }
  [[nodiscard]] double drive() const { return motion_.drive; }
  /// ln L of the innovations of the last seconds.
  [[nodiscard]] double predicted() const { return predicted_; }

 private:
  [[nodiscard]] double unseen_drive() const;
  void learn_rate();
  [[nodiscard]] bool is_unseen(const LiveEpoch& epoch) const;
  [[nodiscard]] bool has_lost_gravity(const LiveEpoch& epoch) const;
  void restart();
  void read(const LiveEpoch& epoch);
  void follow_motion();

  bool gyroscope_;
  double usual_step_s_ = 0.01;
  TiltEpochs now_;  ///< two epochs: 0 the first, 1 any later
  TiltKnown known_;
  TiltMotion motion_;
  std::vector<BaseScatter> scatters_;  ///< over the last 6 s, 30 s, and with gyroscope 1 s
  double unknown_ = 1.0;  ///< remaining share of the initial uncertainty of the base's acceleration
  RunningCorrelation correlation_;
  RunningDensity density_;
  RunningNoise noise_;
  double apart_s_ = 0.1;
  FilterState<9> state_;
  StepOf<TiltModel> step_;
  FixedLag<9, 3> window_;
  std::vector<double> times_s_;
  double time_s_ = 0.0, nis_ = std::numeric_limits<double>::quiet_NaN();
  double measured_s_ = 0.0;  ///< of the last measurement
  double rate2_ = 0.0;       ///< mean square of the rate of rotation, rad²/s²; without gyroscope
  std::size_t epochs_ = 0;
  double predicted_ = 0.0;
};

/// The filter; without gyroscope also two parallel ones that assume √10 times stronger and weaker
/// rotation of the base. If one of them has predicted the last seconds better, all are shifted.
class LiveTiltBank {
 public:
  LiveTiltBank(const std::vector<LiveEpoch>& first, const LiveTiltOptions& options);
  void step(const LiveEpoch& epoch);
  [[nodiscard]] const LiveTiltFilter& best() const { return *filters_.front(); }

 private:
  static constexpr double apart = 3.1622776601683795;
  void choose();

  std::vector<std::unique_ptr<LiveTiltFilter>> filters_;  ///< the middle, the stronger, the weaker
  double next_s_ = -std::numeric_limits<double>::infinity();
};

}  // namespace proofmass::estimate
