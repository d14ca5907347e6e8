#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <optional>
#include <thread>
#include <utility>
#include <vector>

#include "proofmass/core/in_parallel.hpp"
#include "proofmass/core/linalg.hpp"
#include "proofmass/estimate/wheel/fit.hpp"
#include "proofmass/estimate/wheel/settle.hpp"

// The uncertainty of a fit due to the parameters that its passes hold: lever arms, delay, rolling
// radius, warm-up.
namespace proofmass::estimate {

/// Between the first epoch and the last, from the state after the last.
template <int S>
Uncertain turns_in(const WheelModel<S>& model, const Gaussian<wheel::states(S)>& end) {
  Mat<wheel::states(S)> first = end.mean;
  first(wheel::angle) = end.mean(wheel::start);
  const auto from = model.motion(first), to = model.motion(end.mean);
  Mat<wheel::states(S)> slope = to.by_angle - from.by_angle;
  slope(wheel::angle) = to.by_angle(wheel::angle);
  slope(wheel::start) = -from.by_angle(wheel::angle);
  return {(to.angle - from.angle) / rad_per_turn,
          std::sqrt(std::max(slope.dot(end.cov * slope), 0.0)) / rad_per_turn};
}

inline void add_in_square(double& std, double more) {
  std = std::hypot(std, more);
}

/// The smoothed motion and the constants of one run, or their differences between two.
struct Run {
  std::vector<double> angle_rad, speed_radps, accel_radps2;
  Eigen::VectorXd constants{};
  double turns = 0.0;  ///< of a difference
};

template <int S>
Run run_at(const WheelModel<S>& model, const WheelPrior& prior) {
  const std::size_t size = model.size();
  Run run{std::vector<double>(size), std::vector<double>(size), std::vector<double>(size)};
  Gaussian<wheel::states(S)> end = prior_state<S>(prior).x;
  smooth_means(
      model, prior_state<S>(prior), wheel_gate,
      [&](std::size_t, const auto& step) { end = step.filtered; },
      [&](std::size_t k, const auto& step, const auto& later) {
        const auto now = model.motion(later.mean(step.filtered));
        run.angle_rad[k] = now.angle;
        run.speed_radps[k] = now.speed;
        run.accel_radps2[k] = now.accel;
      });
  run.constants = end.mean.template tail<wheel::standing(S)>();
  return run;
}

/// The larger of two differences between runs, figure by figure.
inline void widen(Run& change, const Run& other) {
  const auto larger = [](double a, double b) { return std::abs(a) < std::abs(b) ? b : a; };
  for (std::vector<double> Run::* of : {&Run::angle_rad, &Run::speed_radps, &Run::accel_radps2})
    std::ranges::transform(change.*of, other.*of, (change.*of).begin(), larger);
  change.constants = change.constants.binaryExpr(other.constants, larger).eval();
  change.turns = larger(change.turns, other.turns);
}

/// Root sums of squares of differences between runs.
struct RootSums {
  std::vector<double> angle_rad, speed_radps, accel_radps2;
  Eigen::MatrixXd constants_cov;
  double turns = 0.0;

  RootSums(std::size_t epochs, Eigen::Index constants)
      : angle_rad(epochs),
        speed_radps(epochs),
        accel_radps2(epochs),
        constants_cov(Eigen::MatrixXd::Zero(constants, constants)) {}

  void add(const Run& by) {
    const auto add_to = [](std::vector<double>& sums, const std::vector<double>& of) {
      for (std::size_t k = 0; k < sums.size(); ++k) add_in_square(sums[k], of[k]);
    };
    add_to(angle_rad, by.angle_rad);
    add_to(speed_radps, by.speed_radps);
    add_to(accel_radps2, by.accel_radps2);
    constants_cov += by.constants * by.constants.transpose();
    add_in_square(turns, by.turns);
  }
};

/// Contribution of the parameters that the passes hold: the lever arms, the delay of the sensors'
/// filters, the rolling radius and a warm-up; delay and rolling radius are not reliably determined
/// by any likelihood. The smoother is repeated with the parameter changed by a share of its
/// standard deviation, and the differences are extrapolated linearly. For the rolling radius of a
/// vehicle, which may be anything from 0 on, both ends of the range are taken: the skew of a wheel
/// with a ripple changes three times as much from 0 to 0.1 m as from there to 0.4 m.
template <int S>
class HeldFigures {
 public:
  /// The fit's epochs, time_s, may begin before and end after averaged measurements.
  HeldFigures(const WheelReadings& readings,
              const Settled<S>& settled,
              const WheelPath& about,
              const std::vector<double>& time_s)
      : readings_(readings),
        first_s_(time_s.front()),
        last_s_(time_s.back()),
        settled_(settled),
        about_(about),
        levers_(levers_of(about, readings)),
        base_(run_at(model(), settled.prior)),
        base_levers_(pass_of(model())) {}

  /// Returns false, and adds nothing, if a run's angle slips relative to the fit's, however small
  /// the step: the differences are then meaningless.
  [[nodiscard]] bool add_to(WheelFit& fit) const {
    std::vector<Change> changes;
    vary_places(changes);
    if (readings_.delay_s.std > 0.0)
      changes.push_back(
          [this] { return change_by(&WheelModel<S>::delay_s, readings_.delay_s.std, 1.0); });
    const bool is_state = settled_.prior.spread.rolling_m > 0.0;
    if (readings_.rolling_radius_m.std > 0.0 && !is_state)
      changes.push_back([this] { return change_by_rolling_radius(); });
    vary_warm_up(changes);
    // A few at once, as each holds three figures of every epoch.
    const std::size_t at_once = std::max(1U, std::thread::hardware_concurrency());
    RootSums sums(readings_.time_s.size(), fit.constants.size());
    for (std::size_t first = 0; first < changes.size(); first += at_once) {
      std::vector<std::optional<Run>> found(std::min(at_once, changes.size() - first));
      in_parallel(found.size(), {},
                  [&](std::size_t i, const Progress&) { found[i] = changes[first + i](); });
      for (const std::optional<Run>& change : found) {
        if (!change) return false;
        sums.add(*change);
      }
    }
    add(sums, fit);
    return true;
  }

 private:
  using Change = std::function<std::optional<Run>()>;

  /// Along each principal direction of their covariance, by less than a standard deviation: if the
  /// recording hardly determines the lever arms, that is not a small step.
  void vary_places(std::vector<Change>& changes) const {
    constexpr double longest_step_m = 2e-3;
    const SymmetricEigen axes = symmetric_eigen(settled_.places_cov);
    for (Eigen::Index i = 0; i < axes.values.size(); ++i) {
      const double std_m = std::sqrt(std::max(axes.values(i), 1e-16));
      const auto moved = [this, by = Places(std_m * axes.vectors.col(i))](double share) {
        WheelPrior prior = settled_.prior;
        *prior.places += share * by;
        return run_at(model(), prior);
      };
      changes.push_back([this, moved, share = std::min(1.0, longest_step_m / std_m)] {
        return change_by(moved, share);
      });
    }
  }

  [[nodiscard]] std::optional<Run> change_by_rolling_radius() const {
    const double std_m = readings_.rolling_radius_m.std;
    const bool is_range =
        readings_.shakes && !readings_.given_rolling_radius_m && !readings_.found_rolling_radius_m;
    const double share = is_range ? std::numbers::sqrt3 : 1.0;
    auto change = change_by(&WheelModel<S>::rolling_radius_m, std_m, share);
    if (!is_range || !change) return change;
    const auto other = change_by(&WheelModel<S>::rolling_radius_m, std_m, -share);
    if (!other) return other;
    widen(*change, *other);
    return change;
  }

  /// A warm-up of the biases, as far as the recording does not exclude it: if the speed increases
  /// steadily, it resembles the centripetal force of a longer lever arm.
  void vary_warm_up(std::vector<Change>& changes) const {
    const SymmetricEigen axes = symmetric_eigen(warm_up_information());
    for (int i = 0; i < 2 * S; ++i) {
      const Mat<2 * S> along = axes.vectors.col(i) / std::sqrt(axes.values(i));
      const auto moved = [this, along](double share) {
        Run run = run_anew(warmed_by(share * along));
        for (int axis = 0; axis < 2 * S; ++axis)
          run.constants(bias_of(axis)) += share * along(axis);
        return run;
      };
      changes.push_back([this, moved] { return change_by(moved, 1.0); });
    }
  }

  /// That of the warm-ups as further states, s⁴/m²: from what they change in the innovations of the
  /// pass with lever arms, and from the prior. Source: B. Friedland, IEEE Transactions on Automatic
  /// Control 14 (1969) 359.
  [[nodiscard]] Eigen::MatrixXd warm_up_information() const {
    constexpr double step_mps2 = 0.01;
    const auto innovations = [](const FoundPlaces& pass) {
      return Eigen::Map<const Eigen::ArrayXf>(pass.innovations.data(),
                                              static_cast<Eigen::Index>(pass.innovations.size()));
    };
    Eigen::MatrixXf effect(base_levers_.innovations.size(), 2 * S);
    in_parallel(2 * S, {}, [&](std::size_t of, const Progress&) {
      const auto axis = static_cast<int>(of);
      const FoundPlaces pass = pass_of(warmed_by(step_mps2 * Mat<2 * S>::Unit(axis)));
      const auto by = static_cast<float>(1.0 / (step_mps2 * settled_.widened(bias_of(axis))));
      const Eigen::ArrayXf change = by * (innovations(pass) - innovations(base_levers_));
      effect.col(axis) = change.isFinite().select(change, 0.0F);
    });
    return (effect.transpose() * effect).template cast<double>() +
           Eigen::MatrixXd::Identity(2 * S, 2 * S) / square(warm_up_std_mps2);
  }

  [[nodiscard]] WheelModel<S> warmed_by(const Mat<2 * S>& final_mps2) const {
    auto warmed = model();
    warmed.warm_up_mps2 = final_mps2;
    return warmed;
  }
  /// Index of a bias among the constants; the axes are u and v of each sensor in turn.
  static int bias_of(int axis) {
    return wheel::first_of(axis / 2) - wheel::first_of(0) + wheel::bias + axis % 2;
  }

  /// The lever arms are estimated anew with the changed parameter.
  [[nodiscard]] std::optional<Run> change_by(double WheelModel<S>::* figure,
                                             double std,
                                             double share) const {
    const auto moved = [&](double part) {
      auto other = model();
      other.*figure += part * std;
      return run_anew(other);
    };
    return change_by(moved, share);
  }
  [[nodiscard]] Run run_anew(const WheelModel<S>& changed) const {
    WheelPrior prior = settled_.prior;
    *prior.places += pass_of(changed).mean - base_levers_.mean;
    return run_at(changed, prior);
  }

  /// A run that slips is tried again with a smaller share; nullopt if that slips, too.
  template <class RunAt>
  [[nodiscard]] std::optional<Run> change_by(const RunAt& moved, double share) const {
    Run run = moved(share);
    for (int again = 0; slips(run) && again < 3; ++again) run = moved(share *= 0.1);
    if (slips(run)) return std::nullopt;
    const double reach = 1.0 / share;
    const auto difference = [&](double a, double b) { return reach * (a - b); };
    for (std::vector<double> Run::* of : {&Run::angle_rad, &Run::speed_radps, &Run::accel_radps2})
      std::ranges::transform(run.*of, base_.*of, (run.*of).begin(), difference);
    run.constants = reach * (run.constants - base_.constants);
    const std::size_t last = run.angle_rad.size() - 1;
    run.turns = (between(run.angle_rad, last - 1, last_s_) - between(run.angle_rad, 0, first_s_)) /
                rad_per_turn;
    return run;
  }

  /// A figure of the runs at a time, by the line through its values at epochs k and k + 1.
  [[nodiscard]] double between(const std::vector<double>& of, std::size_t k, double time_s) const {
    const double* at = readings_.time_s.data() + k;
    if (!(at[1] > at[0])) return of[k + 1];
    return std::lerp(of[k], of[k + 1], (time_s - at[0]) / (at[1] - at[0]));
  }

  [[nodiscard]] WheelModel<S> model() const {
    return held_model<S>(readings_, settled_.noise, about_);
  }
  [[nodiscard]] FoundPlaces pass_of(const WheelModel<S>& model) const {
    return places_by_levers(model, levers_, settled_.prior, settled_.belief);
  }

  /// Whether the run's angle slips.
  [[nodiscard]] bool slips(const Run& run) const {
    constexpr double slip_rad = 0.5;
    return !std::ranges::equal(run.angle_rad, base_.angle_rad,
                               [](double a, double b) { return std::abs(a - b) < slip_rad; });
  }

  void add(const RootSums& sums, WheelFit& fit) const {
    WheelSeries& series = fit.series;
    std::size_t at = 0;
    for (std::size_t k = 0; k < series.time_s.size(); ++k) {
      const auto& times = readings_.time_s;
      while (at + 2 < times.size() && times[at + 1] <= series.time_s[k]) ++at;
      const auto off = [&](const std::vector<double>& of) {
        return between(of, at, series.time_s[k]);
      };
      add_in_square(series.angle_std_rad[k], off(sums.angle_rad));
      add_in_square(series.filtered_angle_std_rad[k], off(sums.angle_rad));
      add_in_square(series.speed_std_radps[k], off(sums.speed_radps));
      add_in_square(series.accel_std_radps2[k], off(sums.accel_radps2));
    }
    fit.constants_cov += sums.constants_cov;
    add_in_square(fit.turns.std, sums.turns);
  }

  const WheelReadings& readings_;
  double first_s_, last_s_;
  const Settled<S>& settled_;
  const WheelPath& about_;
  WheelLevers levers_;
  Run base_;
  FoundPlaces base_levers_;
};

/// Adds the contribution of the held parameters, from runs on the averaged measurements, since
/// differences are smooth, or on all of them if those slip. If these slip too, the recording does
/// not determine the constants, and the angle has the uncertainty of the delay.
template <int S>
void add_held_figures(const Settled<S>& settled,
                      const WheelReadings& averaged,
                      const WheelPath& averaged_path,
                      const WheelReadings& readings,
                      const WheelPath& path,
                      WheelFit& fit) {
  if (HeldFigures<S>(averaged, settled, averaged_path, readings.time_s).add_to(fit)) return;
  if (averaged.epochs.size() < readings.epochs.size() &&
      HeldFigures<S>(readings, settled, path, readings.time_s).add_to(fit))
    return;
  fit.constants_cov += fit.constants_prior_cov;
  const std::vector<double>& speed_radps = fit.series.speed_radps;
  if (speed_radps.empty()) return;
  const double late_s = readings.delay_s.std;
  for (std::size_t k = 0; k < speed_radps.size(); ++k) {
    add_in_square(fit.series.angle_std_rad[k], late_s * speed_radps[k]);
    add_in_square(fit.series.filtered_angle_std_rad[k], late_s * speed_radps[k]);
  }
  add_in_square(fit.turns.std, late_s * (speed_radps.back() - speed_radps.front()) / rad_per_turn);
}

}  // namespace proofmass::estimate
