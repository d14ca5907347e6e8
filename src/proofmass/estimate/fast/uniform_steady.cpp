#include <algorithm>
#include <cmath>
#include <limits>

#include "proofmass/estimate/fast/uniform_pass.hpp"

namespace proofmass::estimate::packed {

template <int N>
std::optional<Steady<N>> settle(const LinearModel<N, 1>& model) {
  const Result<SteadyState<N, 1>> limit = steady_state(model);
  if (!limit) return std::nullopt;
  Steady<N> steady{*limit, {}, Mat<N, N>::Identity(), 0.0};
  steady.gain.per_S = 1.0 / limit->innovation_variance(0);
  for (int i = 0; i < N; ++i) {
    steady.gain.K[i] = limit->gain(i);
    for (int j = 0; j < N; ++j) steady.gain.seen[i][j] = limit->seen(i, j);
  }
  Mat<N, N> decay = model.F - limit->gain * (model.H * model.F);
  for (std::size_t left = lane_length; left > 0; left /= 2, decay = (decay * decay).eval())
    if (left % 2 == 1) steady.lane_decay = (steady.lane_decay * decay).eval();
  // Rounding error of a step, and its remainder after many.
  steady.tolerance =
      std::clamp(8.0 * std::numeric_limits<double>::epsilon() * limit->slowest_steps, 1e-12, 1e-10);
  return steady;
}

template <int N>
bool gains_settled(const Steady<N>& steady, const Mat<N, N>& P) {
  const Mat<N, N>& seen = steady.limit.seen;
  for (int j = 0; j < N; ++j) {
    if (seen(j, j) == 0.0) continue;
    for (int i = 0; i < N; ++i) {
      const double size = std::max(std::abs(seen(i, j)), 1e-6 * std::sqrt(P(i, i) * seen(j, j)));
      if (!(std::abs(P(i, j) - seen(i, j)) <= steady.tolerance * size)) return false;
    }
  }
  return true;
}

template <int N>
bool settled(const Symmetric<N>& limit, const Mat<N, N>& P, double tolerance) {
  for (int i = 0; i < N; ++i)
    for (int j = 0; j <= i; ++j)
      if (!(std::abs(P(i, j) - limit(i, j)) <= tolerance * std::sqrt(limit(i, i) * limit(j, j))))
        return false;
  return true;
}

template std::optional<Steady<1>> settle(const LinearModel<1, 1>&);
template bool gains_settled(const Steady<1>&, const Mat<1, 1>&);
template bool settled(const Symmetric<1>&, const Mat<1, 1>&, double);
template std::optional<Steady<2>> settle(const LinearModel<2, 1>&);
template bool gains_settled(const Steady<2>&, const Mat<2, 2>&);
template bool settled(const Symmetric<2>&, const Mat<2, 2>&, double);
template std::optional<Steady<3>> settle(const LinearModel<3, 1>&);
template bool gains_settled(const Steady<3>&, const Mat<3, 3>&);
template bool settled(const Symmetric<3>&, const Mat<3, 3>&, double);
template std::optional<Steady<4>> settle(const LinearModel<4, 1>&);
template bool gains_settled(const Steady<4>&, const Mat<4, 4>&);
template bool settled(const Symmetric<4>&, const Mat<4, 4>&, double);

}  // namespace proofmass::estimate::packed
