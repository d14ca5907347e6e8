#pragma once

#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>

#include "proofmass/core/result.hpp"
#include "proofmass/estimate/filter/fixed_lag.hpp"
#include "proofmass/estimate/filter/linear_series.hpp"

// The linear filter and its fixed-lag smoother online, one epoch at a time.
namespace proofmass::estimate {

/// Online filter. The equations are filter_linear()'s; results are bitwise identical. Memory is
/// fixed at construction: a step does not allocate or block, and takes the same time however long
/// the filter has run.
template <int N, int M, int U = 0>
class LiveFilter {
 public:
  struct Options {
    Gate gate = {};
    std::size_t lag = 0;  ///< epochs after which lagged() returns the smoothed state
  };

  /// `prior` describes the state at the first epoch, before its measurements.
  explicit LiveFilter(const Gaussian<N>& prior, const Options& options = {})
      : gate_(options.gate), state_{prior}, reopened_(prior.cov), window_(options.lag) {
    step_.filtered = prior;
    none();
  }

  /// Processes one epoch: the transition of `model` to it, and its measurements. The first has no
  /// transition. The model may differ at each step; epoch.dt_s is what it was made for, and is not
  /// used here. Errors: not_finite (an infinite measurement, a non-finite input),
  /// not_positive_definite (a variance in R that is not positive); the filter is then unchanged.
  /// Cost: O(N³ + M N²), and O(lag · N² (N + M)) with a lag.
  [[nodiscard]] Status step(const LinearModel<N, M, U>& model, const Epoch<M, U>& epoch) {
    if (epoch.z.array().isInf().any() || !epoch.u.allFinite())
      return Error{Errc::not_finite,
                   "a measurement or input is infinite; use NaN for a missing one"};
    if (!(model.R.array() > 0.0).all())
      return Error{Errc::not_positive_definite, "a channel's variance in R is not positive"};
    advance(EpochModel{model, epoch, reopened_}, epochs_ == 0 ? 0 : 1, gate_, state_, step_);
    ++epochs_;
    judge(epoch);
    if (window_.lag() > 0) window_.push(step_);
    return Done{};
  }

  [[nodiscard]] std::size_t epochs() const { return epochs_; }
  /// The state at the last epoch given all measurements so far; the prior before the first.
  [[nodiscard]] const Gaussian<N>& state() const { return step_.filtered; }
  /// The state `lag` epochs before the last given all measurements so far; the oldest available in
  /// the first epochs; null before the first and without a lag.
  [[nodiscard]] const Gaussian<N>* lagged() const {
    return window_.size() == 0 ? nullptr : &window_.state(window_.size() - 1);
  }
  /// All states from the last back to lagged().
  [[nodiscard]] const FixedLag<N>& window() const { return window_; }

  /// Innovation of channel i given all earlier epochs and channels 0 … i−1 of this one, and its
  /// variance under the model. NaN without a measurement.
  [[nodiscard]] const Mat<M>& innovation() const { return innovation_; }
  [[nodiscard]] const Mat<M>& innovation_variance() const { return innovation_variance_; }
  /// NIS of the last epoch: χ² with readings() degrees of freedom if the model is correct.
  [[nodiscard]] double nis() const { return nis_; }
  /// Channels measured at the last epoch and accepted by the gate.
  [[nodiscard]] int readings() const { return readings_; }
  /// ln p of all measurements accepted so far.
  [[nodiscard]] double log_likelihood() const { return log_likelihood_; }

 private:
  /// One epoch as a StateSpaceModel; 0 is the first and 1 any later.
  struct EpochModel {
    static constexpr int states = N, moving = N, channels = M;
    const LinearModel<N, M, U>& model;
    const Epoch<M, U>& epoch;
    const Mat<N, N>& reopened;

    [[nodiscard]] std::size_t size() const { return 2; }
    [[nodiscard]] Transition<N, N> transition(const Mat<N>& x, std::size_t) const {
      Transition<N, N> step{model.F * x, model.F, model.Q, Mat<N>::Zero()};
      if constexpr (U > 0) step.mean += model.B * epoch.u;
      return step;
    }
    void measure(const Mat<N>& x, std::size_t, Readings<N, M>& out) const {
      out.count = 0;
      for (int i = 0; i < M; ++i) {
        if (std::isnan(epoch.z(i))) continue;
        out.rows[static_cast<std::size_t>(out.count++)] = {epoch.z(i), model.H.row(i).dot(x),
                                                           model.R(i), model.H.row(i).transpose()};
      }
    }
    void reopen(Gaussian<N>& x, std::size_t) const { x.cov = reopened; }
  };

  void none() {
    innovation_.setConstant(std::numeric_limits<double>::quiet_NaN());
    innovation_variance_ = innovation_;
    readings_ = 0;
    nis_ = 0.0;
  }

  void judge(const Epoch<M, U>& epoch) {
    none();
    std::size_t row = 0;
    for (int channel = 0; channel < M; ++channel) {
      if (std::isnan(epoch.z(channel))) continue;
      const Update<N>& update = step_.updates[row++];
      innovation_(channel) = update.innovation;
      innovation_variance_(channel) = update.expected;
      if (!update.used) continue;
      ++readings_;
      nis_ += update.nis();
      log_likelihood_ -= 0.5 * (std::log(2.0 * std::numbers::pi * update.expected) + update.nis());
    }
  }

  Gate gate_;
  FilterState<N> state_;
  Mat<N, N> reopened_;
  FixedLag<N> window_;
  Step<N, N, M> step_;
  Mat<M> innovation_, innovation_variance_;
  double nis_ = 0.0, log_likelihood_ = 0.0;
  int readings_ = 0;
  std::size_t epochs_ = 0;
};

}  // namespace proofmass::estimate
