#include "proofmass/estimate/track/turns.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace proofmass::estimate {
namespace {

// Data stored by a pass for each requested epoch.
struct KeptEpoch {
  Gaussian<3> filtered;
  Mat<3, 3> from_last = Mat<3, 3>::Identity();  // Φ since the previous stored one
  BackwardInformation<3> later;
};

Mat<3, 3> error_transition(const StepOf<InertialAxis>& step) {
  Mat<3, 3> Phi = step.F;
  for (int i = 0; i < step.count; ++i) {
    const auto& update = step.updates[static_cast<std::size_t>(i)];
    Phi -= update.gain * (update.h.transpose() * Phi).eval();
  }
  return Phi;
}

}  // namespace

PositionCovariance smoothed_positions(const InertialAxis& model,
                                      const InertialStart& start,
                                      const std::vector<std::size_t>& at) {
  std::vector<KeptEpoch> kept(at.size());
  std::size_t next = 0;
  Mat<3, 3> Phi = Mat<3, 3>::Identity();
  const auto forward = [&](std::size_t k, const StepOf<InertialAxis>& step) {
    Phi = error_transition(step) * Phi;
    if (next == at.size() || at[next] != k) return;
    kept[next].filtered = step.filtered;
    kept[next++].from_last = Phi;
    Phi.setIdentity();
  };
  const auto backward = [&](std::size_t k, const StepOf<InertialAxis>&,
                            const BackwardInformation<3>& later) {
    if (next == 0 || at[next - 1] != k) return;
    kept[--next].later = later;
  };
  smooth(model, inertial_start(start), Gate{}, forward, backward);
  PositionCovariance out;
  const std::size_t n = at.size();
  out.row_by_row.resize(n * n);
  for (const KeptEpoch& one : kept) out.position_m.push_back(one.later.mean(one.filtered)(0));
  for (std::size_t j = 0; j < n; ++j) {
    Mat<3> row = kept[j].filtered.cov.row(0).transpose();  // (P[j|j] Φᵀ)'s first row
    for (std::size_t k = j; k < n; ++k) {
      if (k > j) row = (kept[k].from_last * row).eval();
      const Mat<3> Lp = kept[k].later.Lambda * kept[k].filtered.cov.col(0);
      out.row_by_row[j * n + k] = out.row_by_row[k * n + j] = row(0) - row.dot(Lp);
    }
  }
  return out;
}

namespace {

std::vector<std::size_t> zigzag(View<double> p, std::size_t first, std::size_t last, double least) {
  std::vector<std::size_t> turns;
  std::size_t high = first, low = first;
  int direction = 0;
  for (std::size_t k = first; k <= last; ++k) {
    if (p[k] > p[high]) high = k;
    if (p[k] < p[low]) low = k;
    if (direction >= 0 && p[high] - p[k] >= least) {
      turns.push_back(high);
      direction = -1;
      low = k;
    } else if (direction <= 0 && p[k] - p[low] >= least) {
      turns.push_back(low);
      direction = 1;
      high = k;
    }
  }
  if (direction != 0) turns.push_back(direction > 0 ? high : low);
  return turns;
}

}  // namespace

std::vector<std::vector<std::size_t>> turning_points(View<double> position_m,
                                                     const std::vector<signal::Rest>& rests,
                                                     double least_m) {
  std::vector<std::vector<std::size_t>> motions;
  const auto add = [&](std::size_t first, std::size_t last) {
    if (auto turns = zigzag(position_m, first, last, least_m); !turns.empty())
      motions.push_back(std::move(turns));
  };
  std::size_t first = 0;
  for (const signal::Rest& rest : rests) {
    if (rest.first > first) add(first, rest.first);
    first = rest.last;
  }
  if (first + 1 < position_m.size()) add(first, position_m.size() - 1);
  return motions;
}

std::vector<LegPair> pair_legs(View<double> lengths_m) {
  const auto misfit = [&](std::size_t first, std::size_t last) {
    double sum = 0.0;
    for (std::size_t i = first; i + 1 < last; i += 2) {
      const double off = std::abs(lengths_m[i]) - std::abs(lengths_m[i + 1]);
      sum += off * off;
    }
    return sum;
  };
  const std::size_t n = lengths_m.size();
  std::vector<LegPair> pairs;
  std::size_t i = 0;
  if (n % 2 == 1 && misfit(1, n) < misfit(0, n - 1)) pairs.push_back({i++, false});
  for (; i + 1 < n; i += 2) pairs.push_back({i, true});
  if (i < n) pairs.push_back({i, false});
  return pairs;
}

}  // namespace proofmass::estimate
