#pragma once

#include <cmath>
#include <concepts>
#include <cstddef>
#include <limits>
#include <numbers>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "proofmass/core/contract.hpp"
#include "proofmass/core/result.hpp"
#include "proofmass/estimate/kalman.hpp"

// Linear Gaussian filter and smoother with known input, irregular time steps and missing readings.
//
//   state     x[k] = F x[k−1] + B u[k] + w,   w ~ N(0, Q)      N-vector, u a U-vector
//   readings  z[k] = H x[k] + v,              v ~ N(0, diag R)  M-vector, NaN where there is none
//
// This is kalman.hpp's one filter and one smoother with all N states moving. A model that is not
// linear needs nothing more: whatever satisfies StateSpaceModel (kalman.hpp) with a Transition
// whose F and Readings whose h are Jacobians is the extended filter and its smoother; WheelModel is
// one. Symbols follow S. Särkkä, Bayesian Filtering and Smoothing (2013), with F, H for its A, H.
namespace proofmass::estimate {

/// What leads from one epoch to the next and what is read there. F, Q and B belong to the step that
/// ends at the epoch.
template <int N, int M, int U = 0>
struct LinearModel {
  Mat<N, N> F;                      ///< state transition
  Mat<N, N> Q;                      ///< process noise, positive semi-definite
  Mat<M, N> H;                      ///< measurement matrix
  Mat<M> R;                         ///< variance of each channel, positive
  Mat<N, U> B = Mat<N, U>::Zero();  ///< what a known input does to the state
};

/// One instant: how long after the one before, what was put in meanwhile, what was read.
template <int M, int U = 0>
struct Epoch {
  double dt_s = 0.0;  ///< since the epoch before, ≥ 0; nothing moves on the way to the first
  Mat<M> z;           ///< NaN where a channel has no reading
  Mat<U> u = Mat<U>::Zero();  ///< known input over the step
};

/// Epochs with the models between them: what filter_linear() and smooth_linear() run over.
template <int N, int M, int U = 0>
class LinearSeries {
 public:
  static constexpr int states = N, moving = N, channels = M;
  using Model = LinearModel<N, M, U>;

  /// `model_at(dt_s)` gives the model of a step; it is asked again only where dt_s changes.
  /// Errors: invalid_argument (a dt_s below 0 or not finite), not_finite (an infinite reading or
  /// input), not_positive_definite (a variance in R that is not positive), with the number of the
  /// epoch.
  template <class ModelAt>
    requires std::is_invocable_r_v<Model, ModelAt&, double>
  [[nodiscard]] static Result<LinearSeries> make(std::vector<Epoch<M, U>> epochs,
                                                 ModelAt&& model_at) {
    LinearSeries series(std::move(epochs));
    for (std::size_t k = 0; k < series.size(); ++k) {
      const double dt_s = series.epochs_[k].dt_s;
      if (!(dt_s >= 0.0) || std::isinf(dt_s))
        return Error{Errc::invalid_argument, "a time step must be finite and not negative"}.at(
            epoch(k));
      if (k == 0 || dt_s != series.epochs_[k - 1].dt_s) series.models_.push_back(model_at(dt_s));
      series.model_of_[k] = series.models_.size() - 1;
    }
    return checked(std::move(series));
  }

  /// One model for each epoch; dt_s is then not read. Errors: as above, and invalid_argument where
  /// there are not as many models as epochs.
  [[nodiscard]] static Result<LinearSeries> make(std::vector<Epoch<M, U>> epochs,
                                                 std::vector<Model> models) {
    if (models.size() != epochs.size())
      return Error{Errc::invalid_argument, std::to_string(models.size()) + " models for " +
                                               std::to_string(epochs.size()) + " epochs"};
    LinearSeries series(std::move(epochs));
    series.models_ = std::move(models);
    for (std::size_t k = 0; k < series.size(); ++k) series.model_of_[k] = k;
    return checked(std::move(series));
  }

  [[nodiscard]] std::size_t size() const { return epochs_.size(); }
  [[nodiscard]] const Model& model(std::size_t k) const { return models_[model_of_[k]]; }

  /// What a lost filter goes back to (see Gate): its mean stays, its covariance is the prior's.
  void set_reopened(const Mat<N, N>& cov) { reopened_ = cov; }

  // What kalman.hpp's StateSpaceModel asks for.

  [[nodiscard]] Transition<N, N> transition(const Mat<N>& x, std::size_t k) const {
    const Model& m = model(k);
    Transition<N, N> step{m.F * x, m.F, m.Q, Mat<N>::Zero()};
    if constexpr (U > 0) step.mean += m.B * epochs_[k].u;
    return step;
  }

  void measure(const Mat<N>& x, std::size_t k, Readings<N, M>& out) const {
    const Model& m = model(k);
    out.count = 0;
    for (int i = 0; i < M; ++i) {
      const double z = epochs_[k].z(i);
      if (std::isnan(z)) continue;
      out.rows[static_cast<std::size_t>(out.count++)] = {z, m.H.row(i).dot(x), m.R(i),
                                                         m.H.row(i).transpose()};
    }
  }

  /// Which channel gave the i-th reading of epoch k.
  [[nodiscard]] int channel_of(std::size_t k, int i) const {
    int channel = 0;
    for (; std::isnan(epochs_[k].z(channel)) || i-- > 0; ++channel) {
    }
    return channel;
  }

  void reopen(Gaussian<N>& x) const { x.cov = reopened_; }

 private:
  explicit LinearSeries(std::vector<Epoch<M, U>> epochs)
      : epochs_(std::move(epochs)), model_of_(epochs_.size()) {}

  static std::string epoch(std::size_t k) { return "epoch " + std::to_string(k); }

  static Result<LinearSeries> checked(LinearSeries series) {
    for (std::size_t k = 0; k < series.size(); ++k) {
      const Epoch<M, U>& e = series.epochs_[k];
      if (e.z.array().isInf().any() || !e.u.allFinite())
        return Error{Errc::not_finite, "a reading or input is infinite; NaN says there is none"}.at(
            epoch(k));
      if (!(series.model(k).R.array() > 0.0).all())
        return Error{Errc::not_positive_definite, "a channel's variance in R is not positive"}.at(
            epoch(k));
    }
    return series;
  }

  std::vector<Epoch<M, U>> epochs_;
  std::vector<Model> models_;
  std::vector<std::size_t> model_of_;
  Mat<N, N> reopened_ = Mat<N, N>::Zero();
};

/// What the run says of one epoch.
template <int N, int M>
struct LinearStep {
  Gaussian<N> filtered;  ///< given z[0] … z[k]
  Gaussian<N> smoothed;  ///< given every reading; filter_linear() leaves it as `filtered`
  /// Channel i's reading less what all epochs before and channels 0 … i−1 of this one predict, and
  /// the variance of that under the model: uncorrelated. NaN where there is no reading.
  Mat<M> innovation, innovation_variance;
  int readings = 0;  ///< channels read and let through by the gate
  /// Normalised innovation squared, yᵀ S⁻¹ y over the readings let through: χ² of so many degrees.
  double nis = 0.0;
};

template <int N, int M>
struct LinearRun {
  std::vector<LinearStep<N, M>> steps;
  double log_likelihood = 0.0;  ///< of the readings let through
  double nis = 0.0;             ///< sum over all epochs
  std::size_t readings = 0;
};

namespace detail {

template <int N, int M, int U>
void note(const LinearSeries<N, M, U>& series,
          std::size_t k,
          const Step<N, N, M>& step,
          LinearRun<N, M>& run) {
  LinearStep<N, M>& out = run.steps[k];
  out.filtered = out.smoothed = step.filtered;
  out.innovation.setConstant(std::numeric_limits<double>::quiet_NaN());
  out.innovation_variance = out.innovation;
  for (int i = 0; i < step.count; ++i) {
    const Update<N>& update = step.updates[static_cast<std::size_t>(i)];
    const int channel = series.channel_of(k, i);
    out.innovation(channel) = update.innovation;
    out.innovation_variance(channel) = update.expected;
    if (!update.used) continue;
    ++out.readings;
    out.nis += update.nis();
    run.log_likelihood -= 0.5 * (std::log(2.0 * std::numbers::pi * update.expected) + update.nis());
  }
  run.nis += out.nis;
  run.readings += static_cast<std::size_t>(out.readings);
}

}  // namespace detail

/// Runs the filter. `prior` describes the state at the first epoch, before its readings.
/// Source: Särkkä (2013), theorem 4.2, one channel at a time. Cost: O(epochs · (N³ + M N²)).
template <int N, int M, int U>
[[nodiscard]] LinearRun<N, M> filter_linear(LinearSeries<N, M, U> series,
                                            const Gaussian<N>& prior,
                                            const Gate& gate = {}) {
  LinearRun<N, M> run;
  run.steps.resize(series.size());
  series.set_reopened(prior.cov);
  FilterState<N> state{prior};
  filter(series, 0, series.size(), gate, state,
         [&](std::size_t k, const Step<N, N, M>& step) { detail::note(series, k, step, run); });
  return run;
}

/// Filter and fixed-interval smoother: every state given every reading. Equal to Rauch, Tung and
/// Striebel's (Särkkä, theorem 8.2), without an inverse.
template <int N, int M, int U>
[[nodiscard]] LinearRun<N, M> smooth_linear(LinearSeries<N, M, U> series,
                                            const Gaussian<N>& prior,
                                            const Gate& gate = {}) {
  LinearRun<N, M> run;
  run.steps.resize(series.size());
  series.set_reopened(prior.cov);
  smooth(
      series, FilterState<N>{prior}, gate,
      [&](std::size_t k, const Step<N, N, M>& step) { detail::note(series, k, step, run); },
      [&](std::size_t k, const Step<N, N, M>& step, const Hindsight<N>& later) {
        run.steps[k].smoothed = {later.mean(step.filtered), later.template cov<N>(step.filtered)};
      });
  return run;
}

}  // namespace proofmass::estimate
