#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "proofmass/estimate/wheel/likelihood.hpp"

// Effect of coloured innovations on the bands.
//
// The filter's covariances hold for white innovations. If the road or the hand colours them, the
// information on a parameter is not the sum over the measurements: the scores h ν / S of an
// interval accumulate instead of averaging out. Their sums over blocks give the inflation of the
// band. Source: the "sandwich" of P. J. Huber, Proc. 5th Berkeley Symp. 1 (1967) 221, with blocks
// as in H. R. Künsch, Ann. Statist. 17 (1989) 1217.
namespace proofmass::estimate {

/// Mean square of block sums of one score, over the mean of its squares: 1 if it is white.
class BlockVariance {
 public:
  void add(double score) {
    sum_ += score;
    own_ += score * score;
  }
  void end_block() {
    blocks_ += sum_ * sum_;
    sum_ = 0.0;
  }
  /// Never below 1: a smaller value is not used to narrow the band.
  [[nodiscard]] double ratio() const { return own_ > 0.0 ? std::max(1.0, blocks_ / own_) : 1.0; }

 private:
  double sum_ = 0.0, own_ = 0.0, blocks_ = 0.0;
};

/// The scores of the constants (all static states, from wheel::first_of(0) on) summed over blocks:
/// for a measurement z at the smoothed state, h (z − ẑ)/R. The smoothed residual over R is Σ⁻¹
/// times the whole misfit, Σ the covariance of measurements with the motion integrated out, so that
/// these are the scores of the marginal likelihood. Source: S. J. Koopman, Biometrika 80 (1993)
/// 117.
template <int S>
class ScoreBlocks {
 public:
  static constexpr int count = wheel::standing(S);

  explicit ScoreBlocks(double block_s) : block_s_(block_s) {}

  /// Measurements at the smoothed state, of an epoch no later than the last added.
  void add(double time_s, const Readings<wheel::states(S), WheelModel<S>::channels>& readings) {
    if (time_s < end_s_) {
      end_block();
      end_s_ = time_s - block_s_;
    }
    for (int i = 0; i < readings.count; ++i) {
      const auto& row = readings.rows[static_cast<std::size_t>(i)];
      const double most = wheel_gate.huber * std::sqrt(row.variance);
      sum_ += std::clamp(row.value - row.predicted, -most, most) / row.variance *
              row.h.template tail<count>();
    }
  }

  /// Covariance of the scores' sum.
  [[nodiscard]] Eigen::MatrixXd covariance() {
    end_block();
    const double n = std::max(blocks_, 2);
    return n / (n - 1.0) * squares_;
  }

 private:
  void end_block() {
    if (sum_.isZero()) return;
    squares_ += sum_ * sum_.transpose();
    sum_.setZero();
    ++blocks_;
  }

  double block_s_, end_s_ = std::numeric_limits<double>::infinity();
  int blocks_ = 0;
  Mat<count> sum_ = Mat<count>::Zero();
  Mat<count, count> squares_ = Mat<count, count>::Zero();
};

/// Inflation of the angle's standard deviation, from blocks as long as the smoother's effective
/// averaging window.
template <int S>
class AngleColour {
 public:
  void add(const StepOf<WheelModel<S>>& step) {
    double score = 0.0;
    for (int i = 0; i < step.count; ++i) {
      const auto& u = step.updates[static_cast<std::size_t>(i)];
      if (!u.used) continue;
      score += u.h(wheel::angle) * u.innovation / u.variance;
      information_ += u.h(wheel::angle) * u.h(wheel::angle) / u.variance;
    }
    ++epochs_;
    for (std::size_t i = 0; i < lengths_.size(); ++i) {
      lengths_[i].add(score);
      if (epochs_ % (std::size_t{1} << i) == 0) lengths_[i].end_block();
    }
  }

  /// Inflation factor for an angle of this variance.
  [[nodiscard]] double factor(double variance_rad2) const {
    const double each = information_ / static_cast<double>(std::max<std::size_t>(epochs_, 1));
    const double averaged = std::max(1.0, 1.0 / (each * variance_rad2));
    const auto at = static_cast<std::size_t>(
        std::clamp(std::lround(std::log2(averaged)), 0L, static_cast<long>(lengths_.size()) - 1));
    double most = 1.0;
    for (std::size_t i = 0; i <= at; ++i) most = std::max(most, lengths_[i].ratio());
    return std::sqrt(most);
  }

 private:
  std::array<BlockVariance, 11> lengths_{};
  double information_ = 0.0;
  std::size_t epochs_ = 0;
};

}  // namespace proofmass::estimate
