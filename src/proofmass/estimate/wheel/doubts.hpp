#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "proofmass/estimate/wheel/fit.hpp"
#include "proofmass/signal/encoder.hpp"

// Intervals of a fit in which the count of turns is in doubt.
namespace proofmass::estimate {

/// Ambiguous intervals less than half a second apart are merged.
inline void add_doubt(std::size_t k,
                      const Gaussian<wheel::moving>& predicted,
                      const std::vector<double>& time_s,
                      std::vector<WheelDoubt>& doubts) {
  constexpr double apart_s = 0.5;
  const auto variance = [](const Gaussian<wheel::moving>& state) {
    return state.cov(wheel::angle, wheel::angle);
  };
  if (doubts.empty() || time_s[k] - time_s[doubts.back().last] > apart_s)
    doubts.push_back({.first = k});
  WheelDoubt& doubt = doubts.back();
  doubt.last = k;
  if (variance(predicted) <= variance(doubt.predicted)) return;
  doubt.widest = k;
  doubt.predicted = predicted;
}

/// Removes the doubts through which the encoder counted: by its angles before and after, the fit
/// turned as far (to half a radian), at a mean speed within the range of those on both sides, which
/// a counter that starts anew does not show, and no counts were missed.
void drop_counted_doubts(const WheelReadings& readings,
                         const std::vector<signal::CountSlip>& missed,
                         WheelFit& fit);

/// Length, number of readings and least share of g of the windows of GravityShown.
struct GravityWindow {
  double length_s = 0.5, fewest = 20.0, least_share = 0.65;
};

/// Whether the measurements show gravity where the filter predicts it, or the smoother puts it, by
/// windows of half a second or as given: their component along that direction is g on average,
/// whatever the vibration, and nearly 0 if the phase is lost. Then the innovations count as noise,
/// so that neither they nor the predicted covariance show the loss. A gyroscope or an encoder
/// counts on meanwhile.
template <int S>
class GravityShown {
 public:
  using State = typename WheelModel<S>::State;

  GravityShown(const WheelModel<S>& model,
               const WheelReadings& readings,
               std::vector<WheelDoubt>& doubts,
               const GravityWindow& window = {})
      : model_(model), readings_(readings), doubts_(doubts), window_(window) {
    // What the measurements would be at the state itself; about a path from which the state has
    // slipped they are always as predicted.
    model_.about = nullptr;
  }

  void add(std::size_t k, const State& at) {
    if (model_.with_gyro || model_.encoder != nullptr) return;
    model_.measure(at, k, rows_);
    std::size_t next = 0;
    for (std::size_t s = 0; s < static_cast<std::size_t>(S); ++s) {
      if (!model_.has_readings(s, k)) continue;
      const double phase = s > 0 ? model_.phase_rad + at(wheel::phase) : 0.0;
      const double phi = at(wheel::angle) + phase;
      const auto &u = rows_.rows[next], &v = rows_.rows[next + 1];
      along_mps2_ +=
          std::sin(phi) * (u.value - u.predicted) + std::cos(phi) * (v.value - v.predicted);
      count_ += 1.0;
      next += 2;
    }
    if (readings_.time_s[k] - readings_.time_s[first_] < window_.length_s ||
        count_ < window_.fewest)
      return;
    const double share = 1.0 + along_mps2_ / count_ / model_.gravity_mps2;
    if (first_ > 0 && share < window_.least_share) doubt(k);
    first_ = k + 1;
    along_mps2_ = count_ = 0.0;
  }

 private:
  void doubt(std::size_t last) {
    Gaussian<wheel::moving> anywhere{};
    anywhere.cov(wheel::angle, wheel::angle) = std::numeric_limits<double>::infinity();
    if (!doubts_.empty() && doubts_.back().last + 1 >= first_)
      doubts_.back() = {doubts_.back().first, last, last, anywhere};
    else
      doubts_.push_back({first_, last, last, anywhere});
  }

  WheelModel<S> model_;
  const WheelReadings& readings_;
  std::vector<WheelDoubt>& doubts_;
  GravityWindow window_;
  Readings<wheel::states(S), WheelModel<S>::channels> rows_;
  std::size_t first_ = 0;
  double along_mps2_ = 0.0, count_ = 0.0;
};

/// Adds the intervals in which the smoothed motion does not show gravity, and those of `unseen`, in
/// which the predicted does not, unless the smoothed does at every moment of them: a filter that
/// takes the acceleration of a pushed hub for one of the wheel swings about the right angle without
/// losing a turn, while an angle that slips by a turn passes every direction.
template <int S>
void doubt_smoothed(const WheelModel<S>& model,
                    const WheelReadings& readings,
                    Gaussian<wheel::states(S)> end,
                    const std::vector<WheelDoubt>& unseen,
                    WheelFit& fit) {
  constexpr GravityWindow brief{.length_s = 0.1, .fewest = 10.0, .least_share = 0.5};
  constexpr double margin_s = 0.5;
  std::vector<WheelDoubt> doubts, moments;
  GravityShown<S> gravity(model, readings, doubts), in_moments(model, readings, moments, brief);
  for (std::size_t k = 0; k < model.size(); ++k) {
    end.mean.template head<wheel::moving>() = fit.track.path.moving[k];
    gravity.add(k, end.mean);
    if (!unseen.empty()) in_moments.add(k, end.mean);
  }
  for (const WheelDoubt& doubt : unseen) {
    const double from_s = readings.time_s[doubt.first] - margin_s;
    const double to_s = readings.time_s[doubt.last] + margin_s;
    if (std::ranges::any_of(moments, [&](const WheelDoubt& moment) {
          return readings.time_s[moment.last] > from_s && readings.time_s[moment.first] < to_s;
        }))
      doubts.push_back(doubt);
  }
  if (doubts.empty()) return;
  doubts.insert(doubts.end(), fit.doubts.begin(), fit.doubts.end());
  std::ranges::sort(doubts, {}, &WheelDoubt::first);
  fit.doubts.clear();
  for (const WheelDoubt& doubt : doubts) {
    if (fit.doubts.empty() || doubt.first > fit.doubts.back().last + 1) {
      fit.doubts.push_back(doubt);
      continue;
    }
    WheelDoubt& joined = fit.doubts.back();
    const std::size_t first = joined.first, last = std::max(joined.last, doubt.last);
    if (doubt.predicted.cov(wheel::angle, wheel::angle) >
        joined.predicted.cov(wheel::angle, wheel::angle))
      joined = doubt;
    joined.first = first;
    joined.last = last;
  }
}

}  // namespace proofmass::estimate
