#include "proofmass/estimate/motor/contact_bank.hpp"

#include <algorithm>
#include <cmath>

namespace proofmass::estimate::motor {
namespace {

using Eigen::RowVector4d;
using Eigen::Vector4d;
using Weights = std::array<double, 3>;

// Mean duration on a flank, and in the gap.
constexpr double flank_s = 1.0, gap_s = 0.03;

// Probability of each contact (row: before) after a step. The flanks change through the gap.
std::array<Weights, 3> chain(double step_s) {
  const double leave = std::min(0.5, step_s / flank_s), arrive = std::min(0.9, step_s / gap_s);
  return {Weights{1.0 - leave, leave, 0.0}, Weights{0.5 * arrive, 1.0 - arrive, 0.5 * arrive},
          Weights{0.0, leave, 1.0 - leave}};
}

// Likelihood of a scalar measurement, which also updates the state.
double take(const RowVector4d& H, double error, double noise_variance, State& state) {
  const Vector4d PH = state.P * H.transpose();
  const double S = H * PH + noise_variance;
  state.x += PH * (error / S);
  state.P -= PH * PH.transpose() / S;
  // A floor against measurements that fit none of the three.
  return std::max(std::exp(-0.5 * error * error / S), 1e-12) / std::sqrt(S);
}

State mixed(const std::array<State, 3>& states, const Weights& weights) {
  State out{.x = Vector4d::Zero(), .P = Eigen::Matrix4d::Zero()};
  for (std::size_t i = 0; i < 3; ++i) out.x += weights[i] * states[i].x;
  for (std::size_t i = 0; i < 3; ++i) {
    const Vector4d apart = states[i].x - out.x;
    out.P += weights[i] * (states[i].P + apart * apart.transpose());
  }
  return out;
}

double normalise(Weights& weights) {
  const double sum = weights[0] + weights[1] + weights[2];
  for (double& w : weights) w = sum > 0.0 ? w / sum : 1.0 / 3.0;
  return sum;
}

class Bank {
 public:
  Bank(const Series& series, const Regimes& regimes, const Parameters& p)
      : series_(series),
        regimes_(regimes),
        p_(p),
        steps_(transitions(series, regimes, p)),
        chain_(chain(series.step_s)),
        states_{first_state(series, regimes), first_state(series, regimes),
                first_state(series, regimes)} {}

  [[nodiscard]] Weights take_sample(std::size_t k) {
    std::array<State, 3> next = states_;
    if (k > 0) mix(next);
    const double half = p_.value[half_backlash];
    const double angle_variance = std::pow(p_.si(angle_noise), 2);
    const double current_variance = std::pow(p_.si(current_noise), 2);
    const RowVector4d of_angle(1.0, -p_.value[delay], 0.0, 0.0), of_current(0.0, 0.0, 1.0, 0.0),
        of_voltage(0.0, 0.0, 0.0, 1.0);
    const double voltage_variance = std::pow(p_.si(voltage_error), 2);
    for (std::size_t j = 0; j < 3; ++j) {
      const double flank = static_cast<double>(j) - 1.0;
      const double error = series_.angle_rad[k] - angle_error(series_, regimes_, p_, k) +
                           flank * half - of_angle * next[j].x;
      const double variance = angle_variance + (j == 1 ? half * half / 3.0 : 0.0);
      weights_[j] *= take(of_angle, error, variance, next[j]);
      if (series_.has_current())
        take(of_current, series_.current_a[k] - next[j].x(2), current_variance, next[j]);
      take(of_voltage, series_.voltage_v[k] - next[j].x(3), voltage_variance, next[j]);
    }
    normalise(weights_);
    states_ = next;
    return weights_;
  }

  void advance_to_next(std::size_t k) {
    const Inputs in = inputs(series_, regimes_, p_, k);
    for (std::size_t j = 0; j < 3; ++j) {
      const Transition& step = regimes_.rests[k] != 0 ? steps_.rests
                               : j == 1               ? steps_.floats
                                                      : steps_.moves;
      advance(step, in, states_[j]);
    }
  }

  [[nodiscard]] const std::array<Weights, 3>& markov() const { return chain_; }

 private:
  void mix(std::array<State, 3>& next) {
    Weights before{};
    for (std::size_t j = 0; j < 3; ++j) {
      Weights from{};
      for (std::size_t i = 0; i < 3; ++i) from[i] = chain_[i][j] * weights_[i];
      before[j] = normalise(from);
      next[j] = mixed(states_, from);
    }
    weights_ = before;
  }

  const Series& series_;
  const Regimes& regimes_;
  const Parameters& p_;
  Transitions steps_;
  std::array<Weights, 3> chain_;
  std::array<State, 3> states_;
  Weights weights_{1.0 / 3.0, 1.0 / 3.0, 1.0 / 3.0};
};

}  // namespace

ContactProbabilities contact_probabilities(const Series& series,
                                           const Regimes& regimes,
                                           const Parameters& p) {
  Bank bank(series, regimes, p);
  ContactProbabilities out;
  for (std::size_t k = 0; k < series.size(); ++k) {
    out.push_back(bank.take_sample(k));
    if (k + 1 < series.size()) bank.advance_to_next(k);
  }
  const auto& chain = bank.markov();
  for (std::size_t k = out.size() - 1; k-- > 0;) {
    Weights predicted{}, later{};
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = 0; j < 3; ++j) predicted[j] += chain[i][j] * out[k][i];
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = 0; j < 3; ++j)
        if (predicted[j] > 0.0)
          later[i] += out[k + 1][j] * chain[i][j] * out[k][i] / predicted[j];
    normalise(later);
    out[k] = later;
  }
  return out;
}

std::vector<std::int8_t> certain_contacts(const ContactProbabilities& probabilities,
                                          const std::vector<double>& speed_radps,
                                          double least) {
  constexpr std::size_t ends = 6;
  const std::size_t n = probabilities.size();
  std::vector<std::int8_t> likely(n, 0), contacts(n, 0);
  for (std::size_t k = 0; k < n; ++k) {
    if (probabilities[k][0] > least && speed_radps[k] < 0.0) likely[k] = -1;
    if (probabilities[k][2] > least && speed_radps[k] > 0.0) likely[k] = 1;
  }
  for (std::size_t k = ends; k + ends < n; ++k) {
    bool inside = true;
    for (std::size_t j = k - ends; j <= k + ends; ++j) inside = inside && likely[j] == likely[k];
    if (inside) contacts[k] = likely[k];
  }
  return contacts;
}

}  // namespace proofmass::estimate::motor
