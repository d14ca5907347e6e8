#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <string_view>
#include <vector>

#include "proofmass/core/view.hpp"

// Models whose noise can be estimated from one evenly sampled channel.
namespace proofmass::estimate {

/// Model of the channel. h is the step in s, v white noise of variance R.
enum class TuneModel {
  rest,         ///< y = b + v, b a random walk: R = white² / h, Q = random_walk² h
  rest_markov,  ///< rest, plus a bias of first-order Markov noise
  pva,          ///< y = a + v, a driven by white jerk: position and velocity are not observed
  pva_bias,     ///< pva, plus a bias of first-order Markov noise
  local_level,  ///< y = μ + v, μ a random walk: any channel
  local_trend,  ///< y = μ + v, μ' = ν + w₁, ν' = w₂
  position,     ///< y = p + v, p''' white jerk
};

inline constexpr TuneModel all_tune_models[] = {
    TuneModel::rest,        TuneModel::rest_markov, TuneModel::pva,     TuneModel::pva_bias,
    TuneModel::local_level, TuneModel::local_trend, TuneModel::position};

/// "rest", "rest-markov", "pva", …
[[nodiscard]] std::string_view name_of(TuneModel model);
[[nodiscard]] std::optional<TuneModel> parse_tune_model(std::string_view name);

/// Whether the model is one of a sensor at rest, without motion.
[[nodiscard]] constexpr bool is_of_rest(TuneModel model) {
  return model == TuneModel::rest || model == TuneModel::rest_markov;
}

/// Role of a parameter in the model.
enum class TuneRole {
  reading,        ///< R
  process,        ///< a white noise that drives the state: R or Q is proportional to its variance
  markov_std,     ///< σ of the Markov bias, stationary
  time_constant,  ///< τ of the Markov bias
};

/// One unknown parameter of a model.
struct TuneParameter {
  std::string_view name;  ///< "jerk_psd"
  TuneRole role;
  /// Unit: (unit of the channel)^`channel_power` · s^`second_power`.
  int channel_power;
  double second_power;
  int driven = 1;  ///< rank of the driven part
  /// value^variance_power is a variance or a density.
  [[nodiscard]] int variance_power() const { return channel_power == 1 ? 2 : 1; }
};

/// In the order used by every vector of values; R's first.
[[nodiscard]] View<TuneParameter> parameters_of(TuneModel model);

inline constexpr int tune_states = 3;  ///< maximum number of states
/// Only as many rows and columns as there are states are used; the others are zero.
using TuneMatrix = Eigen::Matrix<double, tune_states, tune_states>;

/// Derivatives by one parameter's logarithm.
struct TuneDerivative {
  TuneMatrix F = TuneMatrix::Zero(), Q = TuneMatrix::Zero(), prior = TuneMatrix::Zero();
  double R = 0.0;
};

/// A model with its parameter values, x[k+1] = F x[k] + w, w ~ N(0, Q), y = H x + v, and its
/// derivatives by the logarithm of each parameter. The measurement is the sum of the first
/// `observed` states. The first `diffuse` states start diffuse, the others N(0, prior).
struct TuneSystem {
  int states = 1, observed = 1, diffuse = 1;  ///< the first `diffuse` states are diffuse
  TuneMatrix F = TuneMatrix::Zero(), Q = TuneMatrix::Zero(), prior = TuneMatrix::Zero();
  double R = 0.0;
  std::vector<TuneDerivative> by_log;
  bool moves_transition = false;  ///< a derivative of F is not zero
};

/// Exact discretisation. Expects one value for each parameter, none negative, time constants
/// positive, step_s positive.
[[nodiscard]] TuneSystem system_of(TuneModel model, View<double> values, double step_s);

}  // namespace proofmass::estimate
