#include "proofmass/estimate/motor/filter.hpp"

#include <cmath>

namespace proofmass::estimate::motor {
namespace {

using Eigen::Matrix4d;
using Eigen::RowVector4d;
using Eigen::Vector4d;

struct Update {
  RowVector4d H;
  Vector4d gain;
  double innovation, variance;
};

Update update(const RowVector4d& H, double predicted_error, double noise_variance, State& state) {
  const Vector4d PH = state.P * H.transpose();
  const double S = H * PH + noise_variance;
  const Update out{.H = H, .gain = PH / S, .innovation = predicted_error, .variance = S};
  state.x += out.gain * predicted_error;
  state.P -= out.gain * PH.transpose();
  state.P = 0.5 * (state.P + state.P.transpose()).eval();
  return out;
}

struct Forward {
  std::vector<State> after;
  std::vector<std::vector<Update>> updates;
  std::vector<Matrix4d> F;
};

// The one pass behind innovations and smoother.
template <class See, class Advance>
void run(const Series& series,
         const Regimes& regimes,
         const Parameters& p,
         const See& see,
         const Advance& advanced) {
  const Transitions steps = transitions(series, regimes, p);
  const double angle_variance = std::pow(p.si(angle_noise), 2);
  const double current_variance = std::pow(p.si(current_noise), 2);
  const RowVector4d of_angle(1.0, -p.value[delay], 0.0, 0.0), of_current(0.0, 0.0, 1.0, 0.0),
      of_voltage(0.0, 0.0, 0.0, 1.0);
  const double voltage_variance = std::pow(p.si(voltage_error), 2);
  State state = first_state(series, regimes);
  for (std::size_t k = 0; k < series.size(); ++k) {
    if (regimes.contact[k] != 0 && std::isfinite(series.angle_rad[k])) {
      const double error = series.angle_rad[k] - angle_error(series, regimes, p, k) +
                           regimes.contact[k] * p.value[half_backlash] - of_angle * state.x;
      see(k, 0, update(of_angle, error, angle_variance, state));
    }
    if (series.has_current() && std::isfinite(series.current_a[k]))
      see(k, 1, update(of_current, series.current_a[k] - state.x(2), current_variance, state));
    see(k, 2, update(of_voltage, series.voltage_v[k] - state.x(3), voltage_variance, state));
    const Transition& step = regimes.rests[k] != 0     ? steps.rests
                             : regimes.contact[k] != 0 ? steps.moves
                                                       : steps.floats;
    advanced(k, state, step);
    if (k + 1 < series.size()) advance(step, inputs(series, regimes, p, k), state);
  }
}

}  // namespace

double Innovations::cost() const {
  double sum = 0.0;
  for (std::size_t i = 0; i < value.size(); ++i)
    if (variance[i] > 0.0) sum += value[i] * value[i] / variance[i] + std::log(variance[i]);
  return sum;
}

Transitions transitions(const Series& series, const Regimes& regimes, const Parameters& p) {
  // Shares of the dry friction that are unknown in each step. At rest all of it is; without a
  // current nothing else shows the speed then, and the friction is the same for many steps.
  const double in_gap = 0.5 * regimes.dry_torque;
  const double at_rest = (series.has_current() ? 1.5 : 5.0) * regimes.dry_torque;
  Transitions out;
  out.moves = out.rests = out.floats = moving(p, series.has_current(), series.step_s);
  const Matrix4d unit = out.moves.from_torque * out.moves.from_torque.transpose();
  out.floats.Q += in_gap * in_gap * unit;
  out.rests.Q += at_rest * at_rest * unit;
  return out;
}

double angle_error(const Series& series,
                   const Regimes& regimes,
                   const Parameters& p,
                   std::size_t k) {
  const double angle = regimes.angle_rad[k], c = std::cos(angle), s = std::sin(angle);
  double error = p.value[once_cos] * c + p.value[once_sin] * s +
                 p.value[twice_cos] * (c * c - s * s) + p.value[twice_sin] * 2.0 * s * c;
  if (series.from_gravity) {
    const double w = regimes.speed_radps[k];
    error -= p.value[radius] * (w * w * c + regimes.accel_radps2[k] * s) / series.gravity_mps2;
  }
  return error;
}

Inputs inputs(const Series& series, const Regimes& regimes, const Parameters& p, std::size_t k) {
  const double w = 0.5 * (regimes.speed_radps[k] + regimes.speed_radps[k + 1]);
  const double angle = 0.5 * (regimes.angle_rad[k] + regimes.angle_rad[k + 1]);
  const double brushes = 0.5 * (regimes.current_sign[k] + regimes.current_sign[k + 1]);
  return {.voltage_v = -p.value[brush_drop] * brushes,
          .torque_nm = -(regimes.rests[k] != 0 ? 0.0 : dry_friction_nm(p, w)) - p.value[load_torque] -
                       p.value[unbalance_cos] * std::cos(angle) -
                       p.value[unbalance_sin] * std::sin(angle)};
}

State first_state(const Series& series, const Regimes& regimes) {
  State state{.x = {series.angle_rad[0], regimes.speed_radps[0], 0.0, series.voltage_v[0]}, .P = Matrix4d::Zero()};
  state.P(0, 0) = 0.1;
  state.P(1, 1) = std::pow(10.0 * regimes.rest_radps, 2);
  state.P(3, 3) = 1.0;
  if (series.has_current()) {
    state.x(2) = series.current_a[0];
    state.P(2, 2) = 1.0;
  }
  return state;
}

void advance(const Transition& step, const Inputs& in, State& state) {
  state.x = (step.F * state.x + step.from_voltage * in.voltage_v +
             step.from_torque * in.torque_nm)
                .eval();
  state.P = (step.F * state.P * step.F.transpose() + step.Q).eval();
}

void filter(const Series& series, const Regimes& regimes, const Parameters& p, Innovations& out) {
  out.value.assign(3 * series.size(), 0.0);
  out.variance.assign(3 * series.size(), 0.0);
  run(
      series, regimes, p,
      [&](std::size_t k, std::size_t channel, const Update& one) {
        // A current predicted through open torque would reward whatever makes it change slowly.
        const std::size_t before = k > 0 ? k - 1 : 0;
        if (channel == 1 && (regimes.rests[k] != 0 || regimes.rests[before] != 0 ||
                             regimes.contact[before] == 0))
          return;
        out.value[3 * k + channel] = one.innovation;
        out.variance[3 * k + channel] = one.variance;
      },
      [](std::size_t, const State&, const Transition&) {});
}

Smoothed smooth(const Series& series, const Regimes& regimes, const Parameters& p) {
  const std::size_t n = series.size();
  Forward pass{.after = {}, .updates = std::vector<std::vector<Update>>(n), .F = {}};
  run(
      series, regimes, p,
      [&](std::size_t k, std::size_t, const Update& one) { pass.updates[k].push_back(one); },
      [&](std::size_t, const State& state, const Transition& step) {
        pass.after.push_back(state);
        pass.F.push_back(step.F);
      });
  Smoothed out{.angle_rad = std::vector<double>(n), .speed_radps = std::vector<double>(n),
               .speed_std_radps = std::vector<double>(n), .current_a = std::vector<double>(n)};
  Vector4d lambda = Vector4d::Zero();
  Matrix4d Lambda = Matrix4d::Zero();
  for (std::size_t k = n; k-- > 0;) {
    const State& state = pass.after[k];
    if (k + 1 < n) {
      lambda = (pass.F[k].transpose() * lambda).eval();
      Lambda = (pass.F[k].transpose() * Lambda * pass.F[k]).eval();
    }
    const Vector4d x = state.x - state.P * lambda;
    const Matrix4d P = state.P - state.P * Lambda * state.P;
    out.angle_rad[k] = x(0);
    out.speed_radps[k] = x(1);
    out.speed_std_radps[k] = std::sqrt(std::max(P(1, 1), 0.0));
    out.current_a[k] = x(2);
    for (std::size_t j = pass.updates[k].size(); j-- > 0;) {
      const Update& one = pass.updates[k][j];
      const Matrix4d kept = Matrix4d::Identity() - one.gain * one.H;
      lambda = (kept.transpose() * lambda - one.H.transpose() * (one.innovation / one.variance))
                   .eval();
      Lambda = (kept.transpose() * Lambda * kept +
                one.H.transpose() * one.H / one.variance)
                   .eval();
    }
  }
  return out;
}

}  // namespace proofmass::estimate::motor
