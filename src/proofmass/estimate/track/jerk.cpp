#include "proofmass/estimate/track/jerk.hpp"

#include <cmath>
#include <numbers>
#include <utility>

namespace proofmass::estimate {
namespace {

double log_likelihood(const PvaAxis<1>& axis, double speed_std_mps) {
  FilterState<PvaAxis<1>::states> state = axis.start(speed_std_mps);
  double sum = 0.0;
  filter(axis, {0, axis.size()}, Gate{}, state, [&](std::size_t, const StepOf<PvaAxis<1>>& step) {
    for (int i = 0; i < step.count; ++i) {
      const auto& update = step.updates[static_cast<std::size_t>(i)];
      sum -= 0.5 * (std::log(2.0 * std::numbers::pi * update.expected) + update.nis());
    }
  });
  return sum;
}

std::size_t readings_in_motion(const PvaAxis<1>& axis) {
  std::size_t count = 0;
  for (std::size_t k = 0; k < axis.size(); ++k)
    if (!axis.sample(k).resting && axis.reads(k)) ++count;
  return count;
}

}  // namespace

JerkDensity likeliest_jerk(PvaAxis<1> axis, double speed_std_mps) {
  constexpr std::size_t enough = 10;
  constexpr double lowest = -8.0, highest = 10.0, scan = 2.0;  // log₁₀ of the density
  JerkDensity found;
  if (readings_in_motion(axis) < enough) return found;
  const auto at = [&](double log10_psd) {
    axis.noise.jerk_psd_m2ps5 = std::pow(10.0, log10_psd);
    return log_likelihood(axis, speed_std_mps);
  };
  double best = lowest, most = at(lowest);
  for (double x = lowest + scan; x <= highest; x += scan)
    if (const double L = at(x); L > most) best = x, most = L;
  constexpr double golden = 1.0 / std::numbers::phi;
  double a = best - scan, b = best + scan;
  double c = b - golden * (b - a), d = a + golden * (b - a);
  double Lc = at(c), Ld = at(d);
  while (b - a > 0.02) {
    if (Lc > Ld) {
      b = std::exchange(d, c);
      Ld = Lc;
      Lc = at(c = b - golden * (b - a));
    } else {
      a = std::exchange(c, d);
      Lc = Ld;
      Ld = at(d = a + golden * (b - a));
    }
  }
  // The vertex of the parabola through three points also gives the curvature.
  constexpr double step = 0.05;
  const double x = 0.5 * (a + b), low = at(x - step), mid = at(x), high = at(x + step);
  const double slope = (high - low) / (2.0 * step), bend = (high - 2.0 * mid + low) / (step * step);
  const bool peak = bend < 0.0 && std::abs(slope / bend) < 2.0 * step;
  found.psd_m2ps5 = std::pow(10.0, peak ? x - slope / bend : x);
  found.determined = peak && best > lowest && best < highest;
  if (found.determined) found.std_m2ps5 = found.psd_m2ps5 * std::numbers::ln10 / std::sqrt(-bend);
  return found;
}

}  // namespace proofmass::estimate
