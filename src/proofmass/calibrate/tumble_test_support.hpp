#pragma once

#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "proofmass/calibrate/tumble.hpp"
#include "proofmass/core/units.hpp"

// A simulated turntable with known errors.
namespace proofmass::calibrate {

inline constexpr double table_gravity_mps2 = 9.80665;

/// SI units; a servo accelerometer of good quality, with errors ten times larger.
struct TableTruth {
  double K1 = 0.0337, K0 = 0.05, K2 = 3e-6, K3 = 2e-6, Kpp = 8e-6, Koo = -5e-6;
  double delta_o = 2e-3, delta_p = -1e-3, Kip = 4e-6, Kio = -6e-6;
  double drift_mps2 = 0.0;       ///< change of the bias between successive positions
  double hysteresis_mps2 = 0.0;  ///< output forwards minus backwards
  double backlash_rad = 0.0;     ///< angle forwards minus backwards
  double index_cos = 0.0, index_sin = 0.0, index_cos2 = 0.0, index_sin2 = 0.0;  ///< rad
  double noise = 0.0;        ///< std of an output
  double setting_rad = 0.0;  ///< std of the table's angle, equal at each visit
};

/// The model equation.
inline double table_output(const TableTruth& t, const TumblePosition& p, double order) {
  constexpr double g = table_gravity_mps2;
  const double way = 0.5 * p.direction;
  const double phi = p.angle_rad + p.mount_rad + t.index_cos * std::cos(p.angle_rad) +
                     t.index_sin * std::sin(p.angle_rad) +
                     t.index_cos2 * std::cos(2.0 * p.angle_rad) +
                     t.index_sin2 * std::sin(2.0 * p.angle_rad) + way * t.backlash_rad;
  const double ai = g * std::sin(phi), c = g * std::cos(phi);
  const double ap = p.plane == 1 ? c : 0.0, ao = p.plane == 2 ? c : 0.0;
  return t.K1 * (t.K0 + ai + t.K2 * ai * ai + t.K3 * ai * ai * ai + t.delta_o * ap -
                 t.delta_p * ao + t.Kip * ai * ap + t.Kio * ai * ao + t.Kpp * ap * ap +
                 t.Koo * ao * ao + t.drift_mps2 * order + way * t.hysteresis_mps2);
}

/// `count` positions equally spaced over a turn, with a repetition of the first if `closed`.
inline std::vector<TumblePosition> table_turn(int count, bool closed = false, double from = 0.0) {
  std::vector<TumblePosition> plan;
  for (int k = 0; k < count + (closed ? 1 : 0); ++k)
    plan.push_back({.angle_rad = from + 2.0 * std::numbers::pi * (k % count) / count});
  return plan;
}

inline void append(std::vector<TumblePosition>& plan, std::vector<TumblePosition> more) {
  plan.insert(plan.end(), more.begin(), more.end());
}

/// A turn forwards, then backwards.
inline std::vector<TumblePosition> there_and_back(int count) {
  std::vector<TumblePosition> plan = table_turn(count, true), back = plan;
  for (TumblePosition& p : plan) p.direction = 1;
  for (std::size_t k = 0; k < back.size(); ++k) {
    TumblePosition p = back[back.size() - 1 - k];
    p.direction = -1;
    plan.push_back(p);
  }
  return plan;
}

inline std::vector<TumblePosition> in_plane(std::vector<TumblePosition> plan, int plane) {
  for (TumblePosition& p : plan) p.plane = plane;
  return plan;
}

inline std::vector<TumblePosition> mounted_at(std::vector<TumblePosition> plan, double degrees) {
  for (TumblePosition& p : plan) p.mount_rad = degrees * rad_per_deg;
  return plan;
}

/// Noise-free outputs for every position of the plan.
inline std::vector<TumblePosition> read_table(std::vector<TumblePosition> plan,
                                              const TableTruth& truth) {
  for (std::size_t k = 0; k < plan.size(); ++k)
    plan[k].output = table_output(truth, plan[k], static_cast<double>(k));
  return plan;
}

/// Outputs with noise, and with an error of each setting that is equal at each visit.
inline std::vector<TumblePosition> read_table(const std::vector<TumblePosition>& plan,
                                              const TableTruth& truth,
                                              std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  std::vector<TumblePosition> read = plan;
  std::vector<double> setting(plan.size());
  for (std::size_t k = 0; k < plan.size(); ++k) {
    setting[k] = truth.setting_rad * normal(random);
    for (std::size_t j = 0; j < k; ++j)
      if (std::abs(plan[j].angle_rad - plan[k].angle_rad) < 1e-9) setting[k] = setting[j];
    TumblePosition moved = plan[k];
    moved.angle_rad += setting[k];
    read[k].output =
        table_output(truth, moved, static_cast<double>(k)) + truth.noise * normal(random);
  }
  return read;
}

/// Exact angles, and no drift except a linear one.
inline TumbleOptions table_options() {
  return {.gravity_mps2 = table_gravity_mps2,
          .indexing_std_rad = 0.0,
          .drift_std_mps2 = 0.0,
          .output_unit = "V"};
}

/// True value of a coefficient for this number of positions; biases refer to the middle of the
/// test.
inline double true_value(TableTruth t, TumbleQuantity quantity, std::size_t positions = 1) {
  t.K0 += t.drift_mps2 * 0.5 * static_cast<double>(positions - 1);
  constexpr double g = table_gravity_mps2;
  using Q = TumbleQuantity;
  switch (quantity) {
    case Q::K1:
      return t.K1;
    case Q::K0:
      return t.K0 + t.Kpp * g * g;
    case Q::K0_up_down:
      return t.K0 + t.K2 * g * g;
    case Q::misalignment:
      return t.delta_o;
    case Q::K2_minus_Kpp:
      return t.K2 - t.Kpp;
    case Q::Kip:
      return t.Kip;
    case Q::K3:
      return t.K3;
    case Q::third_cosine:
      return 0.0;
    case Q::K0_second:
      return t.K0 + t.Koo * g * g;
    case Q::misalignment_p:
      return t.delta_p;
    case Q::K2_minus_Koo:
      return t.K2 - t.Koo;
    case Q::Kio:
      return t.Kio;
    case Q::drift:
      return t.drift_mps2;
    case Q::temperature:
      return 0.0;
    case Q::hysteresis:
      return t.hysteresis_mps2;
    case Q::backlash:
      return t.backlash_rad;
    case Q::indexing_cos:
      return t.index_cos;
    case Q::indexing_sin:
      return t.index_sin;
    case Q::indexing_cos2:
      return t.index_cos2;
    case Q::indexing_sin2:
      break;
  }
  return t.index_sin2;
}

}  // namespace proofmass::calibrate
