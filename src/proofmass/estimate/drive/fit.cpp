#include "proofmass/estimate/drive/fit.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>

#include "proofmass/core/statistics.hpp"

namespace proofmass::estimate::drive {
namespace {

using State = Mat<at::states>;

constexpr double gyro_scale_std = 0.015;  // of MEMS gyroscopes as delivered
constexpr double steer_start_std_rad = 0.5, least_start_std_rad = 0.003;
constexpr int relinearisations = 4, most_relinearisations = 10;
constexpr double loose = 100.0, steering_psd = 0.1;
// Priors of the first path, which follows the course of the fixes: standard deviations of the
// initial direction, and, relative, of the radii and the track width.
constexpr double course_std_rad = 0.3, first_radius_std = 0.02, first_track_std = 0.05;
// Fixes are averaged over this time, in which a receiver's noise is correlated. Over longer times
// the wander averages, too: of one of 25 s, averages over 5 s hide a third of its steps.
constexpr double normal_point_s = 1.0;

Gaussian<at::states> prior_of(const Recorded& recorded, const Setting& setting) {
  Gaussian<at::states> prior;
  const auto set = [&](int state, double mean, double std) {
    prior.mean(state) = mean;
    prior.cov(state, state) = square(std);
  };
  set(at::speed, 0.0, 30.0);
  set(at::rate, 0.0, 2.0);
  const Vehicle& vehicle = setting.vehicle;
  for (int i = 0; i < vehicle.wheels; ++i) {
    const auto n = static_cast<std::size_t>(i);
    // All angles are relative to the first, and share its error.
    const double first_std_rad =
        std::max(least_start_std_rad, recorded.wheels[n].angle_std_rad.front());
    set(at::rolled + i, 0.0, first_std_rad * vehicle.radius_m[n]);
    set(at::radius + i, 0.0, setting.radius_std[n]);
    if (recorded.wheels[n].yaw_rad.empty()) continue;
    set(at::drift + i, 0.0, vehicle.steered[n] ? steer_start_std_rad : 0.001);
    set(at::yaw_scale + i, 0.0, gyro_scale_std);
    set(at::rate_bias + i, 0.0, recorded.wheels[n].yaw_bias_std_radps);
  }
  if (recorded.frame) {
    set(at::drift + most_wheels, 0.0, 0.001);
    set(at::yaw_scale + most_wheels, 0.0, gyro_scale_std);
    set(at::rate_bias + most_wheels, 0.0, recorded.frame->yaw_bias_std_radps);
  }
  set(at::track, setting.track_m.value, setting.track_m.std);
  set(at::base, setting.base_m.value, setting.base_m.std);
  for (int c = 1; c < most_clocks; ++c) {
    const auto n = static_cast<std::size_t>(c);
    set(at::clock + c, recorded.offset_s[n], recorded.offset_std_s[n]);
  }
  return prior;
}

// Constants that only fixes determine. The antenna may be anywhere on a car.
void open_chart(double bearing,
                const Mat<2>& origin,
                double wander_m,
                Gaussian<at::states>& prior) {
  const auto set = [&](int state, double mean, double std) {
    prior.mean(state) = mean;
    prior.cov(state, state) = square(std);
  };
  set(at::bearing, bearing, 10.0);
  set(at::origin, origin(0), 30.0);
  set(at::origin + 1, origin(1), 30.0);
  set(at::antenna, 0.0, 1.5);
  set(at::antenna + 1, 0.0, 0.5);
  set(at::wander, 0.0, wander_m);
  set(at::wander + 1, 0.0, wander_m);
}

struct Chart {
  double bearing = 0.0;
  Mat<2> origin = Mat<2>::Zero();
};

// Rotation and shift that bring a path onto the fixes, by least squares.
// Source: B. K. P. Horn, J. Opt. Soc. Am. A 4 (1987) 629, in the plane.
Chart chart_of(const std::vector<Epoch>& epochs, const std::vector<State>& path) {
  Mat<2> mean_p = Mat<2>::Zero(), mean_f = mean_p;
  double n = 0.0;
  for (std::size_t k = 0; k < epochs.size(); ++k) {
    if (std::isnan(epochs[k].fix_east_m)) continue;
    mean_p += path[k].segment<2>(at::x);
    mean_f += Mat<2>(epochs[k].fix_east_m, epochs[k].fix_north_m);
    n += 1.0;
  }
  if (n < 2.0) return {};
  mean_p /= n;
  mean_f /= n;
  double along = 0.0, across = 0.0;
  for (std::size_t k = 0; k < epochs.size(); ++k) {
    if (std::isnan(epochs[k].fix_east_m)) continue;
    const Mat<2> p = path[k].segment<2>(at::x) - mean_p;
    const Mat<2> f = Mat<2>(epochs[k].fix_east_m, epochs[k].fix_north_m) - mean_f;
    along += p.dot(f);
    across += p(0) * f(1) - p(1) * f(0);
  }
  Chart chart;
  chart.bearing = std::atan2(across, along);
  const double c = std::cos(chart.bearing), s = std::sin(chart.bearing);
  chart.origin = mean_f - Mat<2>(c * mean_p(0) - s * mean_p(1), s * mean_p(0) + c * mean_p(1));
  return chart;
}

// Mean square of the second differences of an angle, as the density of a random walk of its rate.
struct RateWalk {
  double sum = 0.0, count = 0.0;

  void add(double second_difference, double step_s) {
    if (std::isnan(second_difference)) return;
    sum += square(second_difference / step_s) / step_s;
    count += 1.0;
  }
  [[nodiscard]] double psd() const { return count > 0.0 ? sum / count : 0.0; }
};

// The first wheels of the left and of the right of an axle, whose difference is the yaw.
std::optional<std::array<std::size_t, 2>> opposite_wheels(const Vehicle& vehicle) {
  for (std::size_t i = 0; i < static_cast<std::size_t>(vehicle.wheels); ++i)
    for (std::size_t j = 0; j < static_cast<std::size_t>(vehicle.wheels); ++j)
      if (vehicle.side[i] > 0.0 && vehicle.side[j] < 0.0 &&
          vehicle.steered[i] == vehicle.steered[j])
        return std::array{i, j};
  return std::nullopt;
}

// Densities of the random walks of speed and yaw rate: those of the changes that the recordings
// show, times `loose`. A density that fits the changes makes their size at the nominal scale the
// most probable one, and so has a say in the scale; the measurements are precise enough to need no
// smoothing. Where nothing measures turns, the yaw rate has the density of a car's steering.
void set_motion_noise(const std::vector<Epoch>& epochs, const Setting& setting, Noise& noise) {
  const Vehicle& vehicle = setting.vehicle;
  const auto opposite = opposite_wheels(vehicle);
  RateWalk speed, rate, difference;
  for (std::size_t k = 2; k < epochs.size(); ++k) {
    const double h = epochs[k].dt_s;
    const auto bend = [&](const auto& of) {
      return of(epochs[k]) - 2.0 * of(epochs[k - 1]) + of(epochs[k - 2]);
    };
    const auto rolled = [&](std::size_t i) {
      return bend([i](const Epoch& epoch) { return epoch.angle_rad[i]; }) * vehicle.radius_m[i];
    };
    for (std::size_t i = 0; i < static_cast<std::size_t>(vehicle.wheels); ++i)
      speed.add(rolled(i), h);
    for (std::size_t j = 0; j < most_drive_wheels + 1; ++j)
      rate.add(bend([j](const Epoch& epoch) { return epoch.yaw_rad[j]; }), h);
    if (opposite)
      difference.add((rolled((*opposite)[1]) - rolled((*opposite)[0])) / setting.track_m.value, h);
  }
  if (speed.count > 0.0) noise.speed_psd = loose * std::max(0.05, speed.psd());
  noise.rate_psd = rate.count > 0.0 ? loose * std::max(0.01, rate.psd())
                   : opposite       ? loose * std::max(steering_psd, difference.psd())
                                    : steering_psd;
}

// The variance of the wander at the start.
void set_wander(const Model& model, Gaussian<at::states>& prior) {
  if (!model.with_fixes) return;
  for (const int i : {at::wander, at::wander + 1})
    prior.cov(i, i) = square(model.noise.wander_std_m);
}

// The noise parameters whose probability given the recordings is highest, on a logarithmic grid
// that is refined; each has a prior, since a short recording says little of a slow wander.
class NoiseSearch {
 public:
  NoiseSearch(Model& model, const Gaussian<at::states>& prior, const std::vector<State>& path)
      : model_(model), prior_(prior), path_(path) {}

  void search() {
    double best = probability();
    for (const double factor : {2.0, 2.0, 1.41})
      for (const Parameter& parameter : parameters) {
        if (parameter.of_fixes && !model_.with_fixes) continue;
        climb(model_.noise.*parameter.value, factor, best);
        climb(model_.noise.*parameter.value, 1.0 / factor, best);
      }
    if (model_.with_fixes) take_mean_square(model_.noise.wander_std_m);
  }

 private:
  // Multiplies a parameter by `step` as long as the probability increases, thrice at most.
  void climb(double& value, double step, double& best) const {
    for (int tries = 0; tries < 3; ++tries) {
      const double before = value;
      value *= step;
      const double now = probability();
      if (!(now > best)) {
        value = before;
        return;
      }
      best = now;
    }
  }

  // From the most probable value s to the root mean square over its log-normal distribution,
  // s e^(σ²) with the variance σ² of the logarithm: a few swings of a slow wander leave its size
  // open, and with it the weight of the fixes.
  void take_mean_square(double& value) const {
    constexpr double step = 0.35;  // of the logarithm
    const double best = value, at_best = probability();
    value = best * std::exp(step);
    const double above = probability();
    value = best * std::exp(-step);
    const double below = probability();
    const double curvature = (2.0 * at_best - above - below) / square(step);
    constexpr double widest = 0.5;
    const double variance =
        curvature > 0.0 ? std::min(1.0 / curvature, square(widest)) : square(widest);
    value = best * std::exp(variance);
  }

  struct Parameter {
    double Noise::* value;
    double usual, spread;  ///< median, and standard deviation of the logarithm
    bool of_fixes;
  };
  static constexpr std::array<Parameter, 4> parameters{{{&Noise::slip_m_per_rtm, 0.004, 0.7, false},
                                                        {&Noise::fix_std_m, 0.15, 1.0, true},
                                                        {&Noise::wander_std_m, 0.7, 1.0, true},
                                                        {&Noise::wander_s, 30.0, 0.5, true}}};

  [[nodiscard]] double probability() const {
    Gaussian<at::states> prior = prior_;
    set_wander(model_, prior);
    double sum = run(model_, prior, path_, false).log_likelihood;
    for (const Parameter& parameter : parameters)
      if (!parameter.of_fixes || model_.with_fixes)
        sum -= 0.5 *
               square(std::log(model_.noise.*parameter.value / parameter.usual) / parameter.spread);
    return sum;
  }

  Model& model_;
  const Gaussian<at::states>& prior_;
  const std::vector<State>& path_;
};

void set_in_path(const Gaussian<at::states>& prior, std::vector<State>& path) {
  for (State& x : path) x.segment<3>(at::bearing) = prior.mean.segment<3>(at::bearing);
}

// Track width from the yaw that the course of the fixes shows (as the frame's) and the difference
// of two opposite wheels, by regression on the difference, whose noise is far smaller.
std::optional<double> track_by_course(const std::vector<Epoch>& epochs, const Vehicle& vehicle) {
  constexpr std::size_t window = 20;
  const auto opposite = opposite_wheels(vehicle);
  if (!opposite) return std::nullopt;
  const auto [left, right] = *opposite;
  double difference2 = 0.0, product = 0.0;
  for (std::size_t k = window; k < epochs.size(); ++k) {
    const Epoch &from = epochs[k - window], &to = epochs[k];
    const double difference =
        (to.angle_rad[right] - from.angle_rad[right]) * vehicle.radius_m[right] -
        (to.angle_rad[left] - from.angle_rad[left]) * vehicle.radius_m[left];
    const double turn = to.yaw_rad[most_drive_wheels] - from.yaw_rad[most_drive_wheels];
    if (std::isnan(difference) || std::isnan(turn)) continue;
    difference2 += square(difference);
    product += difference * turn;
  }
  return product > 0.0 ? std::optional(difference2 / product) : std::nullopt;
}

// The first path, without the fixes' positions. Where nothing else measures turns, their course is
// that of the frame. The filter is linearised about this path, and would not converge
// about that of a vehicle of another size: the scale is held at that of the fixes' speed, the track
// width at that of their course.
Pass first_pass(const Model& model, const Gaussian<at::states>& prior, bool use_course) {
  if (!use_course) return run(model, prior, {}, true);
  std::vector<Epoch> epochs = *model.epochs;
  add_course(model.vehicle, epochs);
  Gaussian<at::states> own = prior;
  const auto narrow = [&own](int state, double std) {
    own.cov(state, state) = std::min(own.cov(state, state), square(std));
  };
  own.cov(at::drift + most_wheels, at::drift + most_wheels) = square(course_std_rad);
  for (int i = 0; i < model.vehicle.wheels; ++i) narrow(at::radius + i, first_radius_std);
  if (const auto track_m = track_by_course(epochs, model.vehicle);
      track_m && prior.cov(at::track, at::track) > square(first_track_std * *track_m)) {
    own.mean(at::track) = *track_m;
    narrow(at::track, first_track_std * *track_m);
  }
  Model with_course = model;
  with_course.epochs = &epochs;
  return run(with_course, own, {}, true);
}

// Whether the end of a path moved by less than a part of its uncertainty.
bool has_settled(const Gaussian<at::states>& before, const Gaussian<at::states>& now) {
  constexpr double part = 0.3;
  return std::ranges::all_of(std::array{at::x, at::y, at::heading, at::path, at::track},
                             [&](int state) {
                               const double moved = now.mean(state) - before.mean(state);
                               return square(moved) <= square(part) * now.cov(state, state);
                             });
}

// The model of the vehicle's sensors, without fixes.
Model model_of(const std::vector<Epoch>& epochs, const Setting& setting, Effort effort) {
  Model model{.epochs = &epochs, .vehicle = setting.vehicle, .noise = {}};
  set_motion_noise(epochs, setting, model.noise);
  if (effort == Effort::comparison) {
    // A steered wheel's angle is predicted from the yaw rate: walks wider than the motion's would
    // count against every hypothesis that has one, by the likelihood.
    model.noise.speed_psd /= loose;
    model.noise.rate_psd /= loose;
  }
  return model;
}

// Adds the fixes, given the first path.
void add_fixes(Model& model, Gaussian<at::states>& prior, std::vector<State>& path) {
  model.with_fixes = true;
  const Chart chart = chart_of(*model.epochs, path);
  open_chart(chart.bearing, chart.origin, model.noise.wander_std_m, prior);
  set_in_path(prior, path);
}

void take_clocks(const Gaussian<at::states>& end, Vehicle& vehicle) {
  for (std::size_t c = 1; c < most_clocks; ++c)
    vehicle.offset_s[c] = end.mean(at::clock + static_cast<int>(c));
}

int usual_passes(Effort effort) {
  return effort == Effort::quick_comparison ? 2 : relinearisations;
}

// Whether no further pass is needed, or none would help.
bool is_enough(int passes, Effort effort, bool converged) {
  return passes >= most_relinearisations ||
         (passes >= usual_passes(effort) && (effort != Effort::full || converged));
}

}  // namespace

Fitted fit_path(const Recorded& recorded,
                const Setting& setting,
                Effort effort,
                const Progress& progress) {
  Fitted fitted{.setting = setting, .noise = {}, .pass = {}};
  Vehicle& vehicle = fitted.setting.vehicle;
  vehicle.offset_s = recorded.offset_s;
  std::vector<Epoch> epochs = epochs_of(recorded, vehicle);
  Model model = model_of(epochs, fitted.setting, effort);
  Gaussian<at::states> prior = prior_of(recorded, setting);
  fitted.pass = first_pass(model, prior, recorded.fixes && !recorded.has_yaw());
  if (recorded.fixes) add_fixes(model, prior, fitted.pass.path);
  model.comparing = effort != Effort::full;
  for (int i = 0;; ++i) {
    if (progress) progress("path", std::min(1.0, static_cast<double>(i) / usual_passes(effort)));
    if (recorded.fixes) form_normal_points(vehicle, fitted.pass.path, normal_point_s, epochs);
    if (i == 1 && effort != Effort::quick_comparison)
      NoiseSearch(model, prior, fitted.pass.path).search();
    set_wander(model, prior);
    const Gaussian<at::states> before = fitted.pass.end;
    fitted.pass = run(model, prior, fitted.pass.path, true);
    fitted.converged = has_settled(before, fitted.pass.end);
    if (is_enough(i + 1, effort, fitted.converged)) break;
    take_clocks(fitted.pass.end, vehicle);
    epochs = epochs_of(recorded, vehicle);
    model.vehicle = vehicle;
  }
  fitted.noise = model.noise;
  return fitted;
}

}  // namespace proofmass::estimate::drive
