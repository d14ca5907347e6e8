#include "proofmass/estimate/tune/model.hpp"

#include <array>
#include <cmath>

#include "proofmass/core/contract.hpp"
#include "proofmass/estimate/motion_models.hpp"

namespace proofmass::estimate {
namespace {

using enum TuneRole;

// Channel units in m/s²: white in m/s²/√Hz, random_walk in m/s²/√s, jerk_psd in m²/s⁵.
constexpr std::array rest_parameters{TuneParameter{"white", reading, 1, 0.5},
                                     TuneParameter{"random_walk", process, 1, -0.5},
                                     TuneParameter{"markov_std", markov_std, 1, 0.0},
                                     TuneParameter{"markov_time_constant", time_constant, 0, 1.0}};
constexpr std::array pva_parameters{TuneParameter{"accel_variance", reading, 2, 0.0},
                                    TuneParameter{"jerk_psd", process, 2, -1.0},
                                    TuneParameter{"bias_std", markov_std, 1, 0.0},
                                    TuneParameter{"bias_time_constant", time_constant, 0, 1.0}};
constexpr std::array level_parameters{TuneParameter{"reading_variance", reading, 2, 0.0},
                                      TuneParameter{"level_psd", process, 2, -1.0},
                                      TuneParameter{"slope_psd", process, 2, -3.0, 2}};
constexpr std::array position_parameters{TuneParameter{"reading_variance", reading, 2, 0.0},
                                         TuneParameter{"jerk_psd", process, 2, -5.0, 3}};

// A level alone or with the Markov bias: R, Q of the level, σ, τ.
void add_markov(double sigma, double tau_s, double h, TuneSystem& system) {
  const double variance = sigma * sigma, phi = std::exp(-h / tau_s);
  const double gained = -std::expm1(-2.0 * h / tau_s);  // 1 − φ²
  system.F(1, 1) = phi;
  system.Q(1, 1) = variance * gained;
  system.prior(1, 1) = variance;
  TuneDerivative& by_sigma = system.by_log[2];
  by_sigma.Q(1, 1) = 2.0 * variance * gained;
  by_sigma.prior(1, 1) = 2.0 * variance;
  TuneDerivative& by_tau = system.by_log[3];
  by_tau.F(1, 1) = phi * h / tau_s;
  by_tau.Q(1, 1) = -2.0 * variance * phi * phi * h / tau_s;
  system.moves_transition = true;
}

void set_variance(const TuneParameter& parameter,
                  double value,
                  double per_unit,
                  double& into,
                  double& derivative) {
  const int power = parameter.variance_power();
  into = per_unit * (power == 2 ? value * value : value);
  derivative = power * into;
}

int states_of(TuneModel model) {
  switch (model) {
    case TuneModel::rest:
    case TuneModel::pva:
    case TuneModel::local_level:
      return 1;
    case TuneModel::position:
      return 3;
    default:
      return 2;
  }
}

bool has_markov(TuneModel model) {
  return model == TuneModel::rest_markov || model == TuneModel::pva_bias;
}

// Sets F and the noise of unit density that drives the last state.
void set_chain(TuneSystem& system, double h, TuneMatrix& driven) {
  if (system.states == 1) {
    driven(0, 0) = h;
  } else if (system.states == 2) {
    system.F(0, 1) = h;
    driven.topLeftCorner<2, 2>() << h * h * h / 3.0, h * h / 2.0, h * h / 2.0, h;
  } else {
    const LinearModel<3, 1> unit =
        pva_model({.dt_s = h, .jerk_psd_m2ps5 = 1.0, .accel_variance_m2ps4 = 1.0});
    system.F = unit.F;
    driven = unit.Q;
  }
}

}  // namespace

std::string_view name_of(TuneModel model) {
  switch (model) {
    case TuneModel::rest:
      return "rest";
    case TuneModel::rest_markov:
      return "rest-markov";
    case TuneModel::pva:
      return "pva";
    case TuneModel::pva_bias:
      return "pva-bias";
    case TuneModel::local_level:
      return "local-level";
    case TuneModel::local_trend:
      return "local-trend";
    case TuneModel::position:
      return "position";
  }
  return "";
}

std::optional<TuneModel> parse_tune_model(std::string_view name) {
  for (const TuneModel model : all_tune_models) {
    if (name_of(model) == name) return model;
  }
  return std::nullopt;
}

View<TuneParameter> parameters_of(TuneModel model) {
  const View<TuneParameter> rest(rest_parameters), pva(pva_parameters), level(level_parameters);
  switch (model) {
    case TuneModel::rest:
      return rest.first(2);
    case TuneModel::rest_markov:
      return rest;
    case TuneModel::pva:
      return pva.first(2);
    case TuneModel::pva_bias:
      return pva;
    case TuneModel::local_level:
      return level.first(2);
    case TuneModel::local_trend:
      return level;
    case TuneModel::position:
      return position_parameters;
  }
  return {};
}

TuneSystem system_of(TuneModel model, View<double> values, double step_s) {
  const View<TuneParameter> parameters = parameters_of(model);
  PM_EXPECTS(values.size() == parameters.size() && step_s > 0.0);
  TuneSystem system;
  const int n = system.states = states_of(model);
  const bool markov = has_markov(model);
  system.observed = markov ? 2 : 1;
  system.diffuse = markov ? 1 : n;
  system.F.diagonal().head(n).setOnes();
  system.by_log.assign(parameters.size(), TuneDerivative{});
  // White measurement noise given as a density has the variance N² / h.
  const double per_reading = parameters[0].second_power == 0.5 ? 1.0 / step_s : 1.0;
  set_variance(parameters[0], values[0], per_reading, system.R, system.by_log[0].R);
  if (!markov) {
    TuneMatrix driven = TuneMatrix::Zero();
    set_chain(system, step_s, driven);
    const std::size_t last = parameters.size() - 1;
    double density = 0.0, derivative = 0.0;
    set_variance(parameters[last], values[last], 1.0, density, derivative);
    system.Q = density * driven;
    system.by_log[last].Q = derivative * driven;
  }
  if (markov || model == TuneModel::local_trend) {
    double variance = 0.0, derivative = 0.0;
    set_variance(parameters[1], values[1], step_s, variance, derivative);
    system.Q(0, 0) += variance;
    system.by_log[1].Q(0, 0) = derivative;
  }
  if (markov) add_markov(values[2], values[3], step_s, system);
  return system;
}

}  // namespace proofmass::estimate
