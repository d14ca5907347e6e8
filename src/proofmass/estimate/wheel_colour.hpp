#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "proofmass/estimate/wheel_passes.hpp"

// What coloured innovations make of the bands. Private to the module's wheel_*.cpp.
//
// The filter's covariances hold for white innovations. Where the road or the hand colours them, the
// information of a figure is not the sum over the readings: the scores h ν / S of a stretch add up
// instead of cancelling. Their sums over blocks say how much wider the band is. Source: the
// "sandwich" of P. J. Huber, Proc. 5th Berkeley Symp. 1 (1967) 221, with blocks as of H. R.
// Künsch, Ann. Statist. 17 (1989) 1217.
namespace proofmass::estimate {

/// Squares of block sums of one score, over the sum of its squares: 1 where it is white.
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
  /// Never below 1: what cancels better than chance is no gain to count on.
  [[nodiscard]] double ratio() const { return own_ > 0.0 ? std::max(1.0, blocks_ / own_) : 1.0; }

 private:
  double sum_ = 0.0, own_ = 0.0, blocks_ = 0.0;
};

/// Inflation of the standard deviations of all constant states (from wheel::first_of(0) on), from
/// blocks of a fortieth of the recording, at least one second.
template <int S>
class StandingColour {
 public:
  explicit StandingColour(const std::vector<double>& time_s)
      : time_s_(time_s), block_s_(std::max(1.0, (time_s.back() - time_s.front()) / 40.0)) {}

  void add(std::size_t k, const StepOf<WheelModel<S>>& step) {
    if (time_s_[k] - time_s_.front() >= end_s_) {
      for (BlockVariance& of_state : states_) of_state.end_block();
      end_s_ = time_s_[k] - time_s_.front() + block_s_;
    }
    for (int i = 0; i < step.count; ++i) {
      const auto& u = step.updates[static_cast<std::size_t>(i)];
      if (!u.used) continue;
      const double pull = u.innovation / u.variance;
      for (int j = 0; j < wheel::standing(S); ++j)
        states_[static_cast<std::size_t>(j)].add(u.h(wheel::first_of(0) + j) * pull);
    }
  }

  /// By which each standard deviation grows.
  [[nodiscard]] Eigen::VectorXd factors() {
    Eigen::VectorXd factors(wheel::standing(S));
    for (int j = 0; j < wheel::standing(S); ++j) {
      BlockVariance& of_state = states_[static_cast<std::size_t>(j)];
      of_state.end_block();
      factors(j) = std::sqrt(of_state.ratio());
    }
    return factors;
  }

 private:
  const std::vector<double>& time_s_;
  double block_s_, end_s_ = 0.0;
  std::array<BlockVariance, static_cast<std::size_t>(wheel::standing(S))> states_{};
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
    ++instants_;
    for (std::size_t i = 0; i < lengths_.size(); ++i) {
      lengths_[i].add(score);
      if (instants_ % (std::size_t{1} << i) == 0) lengths_[i].end_block();
    }
  }

  /// By which the standard deviation of an angle of this variance grows.
  [[nodiscard]] double factor(double variance_rad2) const {
    const double each = information_ / static_cast<double>(std::max<std::size_t>(instants_, 1));
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
  std::size_t instants_ = 0;
};

}  // namespace proofmass::estimate
