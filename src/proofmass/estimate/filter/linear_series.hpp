#pragma once

#include <cmath>
#include <cstddef>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "proofmass/core/result.hpp"
#include "proofmass/estimate/filter/smoother.hpp"

// A linear Gaussian model and the data it is run over.
//
//   state         x[k] = F x[k−1] + B u[k] + w,   w ~ N(0, Q)       N-vector, u a U-vector
//   measurements  z[k] = H x[k] + v,              v ~ N(0, diag R)  M-vector, NaN where missing
//
// Symbols follow S. Särkkä, Bayesian Filtering and Smoothing (2013), with F, H for its A, H.
namespace proofmass::estimate {

/// The transition from one epoch to the next and the measurement there. F, Q and B belong to the
/// step that ends at the epoch.
template <int N, int M, int U = 0>
struct LinearModel {
  Mat<N, N> F;                      ///< state transition
  Mat<N, N> Q;                      ///< process noise, positive semi-definite
  Mat<M, N> H;                      ///< measurement matrix
  Mat<M> R;                         ///< variance of each channel, positive
  Mat<N, U> B = Mat<N, U>::Zero();  ///< effect of a known input on the state
};

/// One epoch: the time since the previous one, the input meanwhile, the measurements.
template <int M, int U = 0>
struct Epoch {
  double dt_s = 0.0;          ///< since the previous epoch, ≥ 0; not used for the first
  Mat<M> z;                   ///< NaN where a channel is missing
  Mat<U> u = Mat<U>::Zero();  ///< known input over the step
};

/// Epochs with the models between them: the input of filter_linear() and smooth_linear().
template <int N, int M, int U = 0>
class LinearSeries {
 public:
  static constexpr int states = N, moving = N, channels = M;
  using Model = LinearModel<N, M, U>;

  /// `model_at(dt_s)` gives the model of a step; it is called again only if dt_s changes. Errors:
  /// invalid_argument (a dt_s below 0 or not finite), not_finite (an infinite measurement or
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

  /// One model for each epoch; dt_s is not used. Errors: as above, and invalid_argument if the
  /// numbers of models and epochs differ.
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

  /// Covariance reset of a diverged filter (see Gate): its mean is kept, its covariance becomes the
  /// prior's.
  void set_reopened(const Mat<N, N>& cov) { reopened_ = cov; }

  // Interface of StateSpaceModel (filter/smoother.hpp).

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

  /// Channel of the i-th measurement of epoch k.
  [[nodiscard]] int channel_of(std::size_t k, int i) const {
    int channel = 0;
    for (; std::isnan(epochs_[k].z(channel)) || i-- > 0; ++channel) {
    }
    return channel;
  }

  void reopen(Gaussian<N>& x, std::size_t) const { x.cov = reopened_; }

 private:
  explicit LinearSeries(std::vector<Epoch<M, U>> epochs)
      : epochs_(std::move(epochs)), model_of_(epochs_.size()) {}

  static std::string epoch(std::size_t k) { return "epoch " + std::to_string(k); }

  static Result<LinearSeries> checked(LinearSeries series) {
    for (std::size_t k = 0; k < series.size(); ++k) {
      const Epoch<M, U>& e = series.epochs_[k];
      if (e.z.array().isInf().any() || !e.u.allFinite())
        return Error{Errc::not_finite,
                     "a measurement or input is infinite; use NaN for a missing one"}
            .at(epoch(k));
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

}  // namespace proofmass::estimate
