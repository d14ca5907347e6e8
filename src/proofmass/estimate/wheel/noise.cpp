#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "proofmass/core/in_parallel.hpp"
#include "proofmass/core/statistics.hpp"
#include "proofmass/estimate/wheel/fix_scatter.hpp"
#include "proofmass/estimate/wheel/likelihood.hpp"

namespace proofmass::estimate {
namespace {

constexpr double fewest_readings = 20.0;

/// Sums over one interval of a sensor's measurements: squared innovations, and the part explained
/// by the state's own uncertainty. The remainder is the measurement noise there, at least `least`.
struct NoiseStretch {
  double innovation2 = 0.0, explained = 0.0, readings = 0.0, least = 0.0;
  [[nodiscard]] double variance() const {
    return std::max(std::max(innovation2 - explained, 0.2 * innovation2) / readings, least);
  }
  /// Adds a measurement's update, given its present noise variance. Strongly down-weighted
  /// measurements contain little information on the noise.
  template <class Update>
  void add(const Update& update, double noise_variance) {
    if (!update.used) return;
    innovation2 += std::min(update.nis(), 4.0 * wheel_gate.huber) * update.expected;
    explained += update.expected - noise_variance;
    readings += 1.0;
  }
  void append(const NoiseStretch& later) {
    innovation2 += later.innovation2;
    explained += later.explained;
    readings += later.readings;
  }
};

/// The stretches of each sensor, and sums over the whole recording for what does not change.
struct GatheredNoise {
  explicit GatheredNoise(std::size_t count) {
    for (auto& of_sensor : stretches) of_sensor.resize(count);
  }
  void append(const GatheredNoise& later) {
    for (std::size_t s = 0; s < stretches.size(); ++s) {
      for (std::size_t i = 0; i < stretches[s].size(); ++i)
        stretches[s][i].append(later.stretches[s][i]);
      gyros[s].append(later.gyros[s]);
    }
  }

  std::array<std::vector<NoiseStretch>, 2> stretches;
  std::array<NoiseStretch, 2> gyros;
  FixScatter fixes;
};

/// A variance over time: its logarithm linear between the middles of intervals, or one value for
/// all if their scatter does not exceed the statistical one.
class VarianceProfile {
 public:
  VarianceProfile(const std::vector<NoiseStretch>& stretches, double length_s) {
    double count = 0.0;
    for (std::size_t i = 0; i < stretches.size(); ++i) {
      const NoiseStretch& stretch = stretches[i];
      if (stretch.readings < fewest_readings) continue;
      middle_s_.push_back((static_cast<double>(i) + 0.5) * length_s);
      log_variance_.push_back(std::log(stretch.variance()));
      overall_ += stretch.variance() * stretch.readings;
      count += stretch.readings;
    }
    if (count == 0.0) return;
    overall_ /= count;
    const auto used = static_cast<double>(middle_s_.size());
    const double expected = std::sqrt(2.0 * used / count);
    steady_ = used < 3.0 || *robust_std(log_variance_) < 2.0 * expected;
    widen();
  }

  [[nodiscard]] bool empty() const { return middle_s_.empty(); }

  [[nodiscard]] double at(double t_s) const {
    if (steady_) return overall_;
    const auto above = std::ranges::upper_bound(middle_s_, t_s) - middle_s_.begin();
    const auto i =
        std::clamp<std::size_t>(static_cast<std::size_t>(above), 1, middle_s_.size() - 1);
    const double part = (t_s - middle_s_[i - 1]) / (middle_s_[i] - middle_s_[i - 1]);
    return std::exp(std::lerp(log_variance_[i - 1], log_variance_[i], std::clamp(part, 0.0, 1.0)));
  }

 private:
  /// Each interval takes the maximum of itself and its neighbours: where vibration begins within
  /// one, an average of the two would reject the first shocks.
  void widen() {
    const std::vector<double> own = log_variance_;
    for (std::size_t i = 0; i < own.size(); ++i) {
      if (i > 0) log_variance_[i] = std::max(log_variance_[i], own[i - 1]);
      if (i + 1 < own.size()) log_variance_[i] = std::max(log_variance_[i], own[i + 1]);
    }
  }

  std::vector<double> middle_s_, log_variance_;
  double overall_ = 0.0;
  bool steady_ = true;
};

/// The channels of epoch k that belong to each sensor, in the order written by measure(): two for
/// each sensor measured, one for its gyroscope, one for the encoder.
template <int S>
void gather(const WheelReadings& readings,
            std::size_t k,
            const StepOf<WheelModel<S>>& step,
            std::size_t stretch,
            GatheredNoise& noise) {
  int channel = 0;
  for (std::size_t s = 0; s < readings.sensors.size() && channel < step.count; ++s) {
    const std::int64_t row = readings.epochs[k].row[s];
    if (row == WheelEpoch::no_row) continue;
    const PlanarReadings& sensor = readings.sensors[s];
    const auto at = static_cast<std::size_t>(row);
    if (!sensor.has(at)) continue;
    for (int axis = 0; axis < 2; ++axis, ++channel)
      noise.stretches[s][stretch].add(step.updates[static_cast<std::size_t>(channel)],
                                      sensor.variance_m2ps4[at]);
    if (sensor.speed_radps.empty() || std::isnan(sensor.speed_radps[at])) continue;
    const auto& u = step.updates[static_cast<std::size_t>(channel++)];
    // At the start the state's variance is thousands of times the noise's: a few such epochs would
    // outweigh all others.
    constexpr double most_explained = 10.0;
    if (u.expected <= most_explained * sensor.speed_variance)
      noise.gyros[s].add(u, sensor.speed_variance);
  }
  if (!readings.encoder || !readings.encoder->has(k)) return;
  const auto& u = step.updates[static_cast<std::size_t>(channel)];
  const double speed_radps = step.filtered.mean(wheel::speed);
  noise.fixes.add(speed_radps, u.innovation,
                  u.expected - readings.encoder->more.variance_rad2(speed_radps));
}

/// Variance of white noise in the measurements from their third differences, to which a slowly
/// rotating wheel contributes little; 0 if it turns by more than a tenth of a radian. With
/// innovations alone, a filter that follows every measurement would find no noise, and then
/// overweight each of them. A third difference of white noise has 1 + 9 + 9 + 1 times its variance.
double least_variance(const PlanarReadings& sensor, double rate_hz, const WheelPath& path) {
  constexpr double smooth_rad = 0.1, gain = 20.0;
  for (const Mat<wheel::moving>& at : path.moving)
    if (!(std::abs(at(wheel::speed)) < smooth_rad * rate_hz)) return 0.0;
  double least = std::numeric_limits<double>::infinity();
  for (const std::vector<double>* axis : {&sensor.u_mps2, &sensor.v_mps2}) {
    std::vector<double> differences;
    for (std::size_t k = 3; k < axis->size(); ++k) {
      const double third =
          (*axis)[k] - 3.0 * (*axis)[k - 1] + 3.0 * (*axis)[k - 2] - (*axis)[k - 3];
      if (!std::isnan(third)) differences.push_back(third);
    }
    const auto std = robust_std(differences);
    least = std::min(least, std ? square(*std) / gain : 0.0);
  }
  return least;
}

/// Residuals of a sensor's two axes about a path, and the direction perpendicular to gravity.
struct Misfit {
  double u, v, across_u, across_v;
};

/// Variance of the residuals along gravity, from their median absolute value. The mean of each axis
/// is subtracted first, because biases walk. nullopt for fewer than ten residuals.
std::optional<double> variance_along_gravity(const std::vector<Misfit>& misfits) {
  if (2.0 * static_cast<double>(misfits.size()) < fewest_readings) return std::nullopt;
  Moments u, v;
  for (const Misfit& of : misfits) u.add(of.u), v.add(of.v);
  std::vector<double> sizes;
  for (const Misfit& of : misfits)
    sizes.push_back(std::abs(of.across_v * (of.u - u.mean) - of.across_u * (of.v - v.mean)) /
                    std::hypot(of.across_u, of.across_v));
  constexpr double of_normal = 1.4826;
  return square(of_normal * *median(sizes));
}

/// Residuals of a sensor's measurements about the model's path, by stretches of length_s.
template <int S>
std::vector<std::vector<Misfit>> misfits_of(const WheelModel<S>& model,
                                            const WheelReadings& readings,
                                            std::size_t sensor,
                                            double length_s,
                                            std::size_t count) {
  using Model = WheelModel<S>;
  std::vector<std::vector<Misfit>> misfits(count);
  auto x = Model::State::Zero().eval();
  x.template tail<wheel::standing(S)>() = model.about->standing;
  Readings<Model::states, Model::channels> out;
  for (std::size_t k = 0; k < model.size(); ++k) {
    if (!model.has_readings(sensor, k)) continue;
    x.template head<wheel::moving>() = model.about->moving[k];
    model.measure(x, k, out);
    const std::size_t first = sensor == 0 || !model.has_readings(0, k) ? 0
                              : model.has_speed(0, k)                  ? 3
                                                                       : 2;
    const auto &u = out.rows[first], &v = out.rows[first + 1];
    const double since_s = readings.time_s[k] - readings.time_s.front();
    misfits[static_cast<std::size_t>(since_s / length_s)].push_back(
        {u.value - u.predicted, v.value - v.predicted, u.h(wheel::angle), v.h(wheel::angle)});
  }
  return misfits;
}

bool shows_shaking(const std::vector<double>& variance_m2ps4, double rate_hz) {
  constexpr double shaking_density = 1e-4;  // (m/s²)²/Hz: no sensor's noise is above 1 mg/√Hz
  constexpr double loud_ratio = 4.0, loud_mps2 = 0.05;
  const auto loud = quantile(variance_m2ps4, 0.9), quiet = quantile(variance_m2ps4, 0.05);
  return loud && ((*loud >= loud_ratio * *quiet && *loud > square(loud_mps2)) ||
                  2.0 * *loud > shaking_density * rate_hz);
}

/// Sets the lower bound of the variance in a sensor's stretches from the residuals along gravity,
/// which no rotation of the wheel explains: it moves the measurements perpendicular to gravity.
/// Returns whether the hub vibrates.
template <int S>
bool set_least(const WheelModel<S>& model,
               const WheelReadings& readings,
               std::size_t sensor,
               double length_s,
               std::vector<NoiseStretch>& stretches) {
  const auto misfits = misfits_of(model, readings, sensor, length_s, stretches.size());
  std::vector<double> all;
  for (std::size_t i = 0; i < stretches.size(); ++i) {
    const auto variance = variance_along_gravity(misfits[i]);
    if (!variance) continue;
    all.push_back(*variance);
    // Minus one standard deviation of a variance from a median: its efficiency is 37 %.
    const double scatter = std::sqrt(2.0 / (0.37 * static_cast<double>(misfits[i].size())));
    stretches[i].least = *variance * std::max(0.0, 1.0 - scatter);
  }
  return shows_shaking(all, readings.rate_hz());
}

/// From as many epochs on, two halves of a recording are filtered side by side.
constexpr std::size_t worth_a_thread = 400'000;

/// The state of a filter that starts on its model's path at epoch `first`, with the constants at
/// their prior. Sets the model's first turn.
template <int S>
FilterState<wheel::states(S)> state_on_path(WheelModel<S>& model,
                                            std::size_t first,
                                            WheelPrior prior) {
  model.first_turn = turned_after(*model.about, first);
  prior.beginning.angle_rad = model.about->moving[first](wheel::angle);
  prior.beginning.speed_radps = model.about->moving[first](wheel::speed);
  return prior_state<S>(prior);
}

/// Search limits of the motion noise. A bias that drifted faster could replace gravity.
constexpr WheelNoise lowest{1e-9, 1e-9, 1e-10}, highest{1e5, 1e8, 1e-4};

/// Gathers over the whole recording; long ones in two halves side by side.
template <int S>
void gather_all(const WheelModel<S>& model,
                const WheelPrior& prior,
                const WheelReadings& readings,
                double length_s,
                GatheredNoise& noise) {
  const double start_s = readings.time_s.front();
  const auto gather_from = [&](std::size_t first, std::size_t last, GatheredNoise& into) {
    auto part = model;
    auto state = first == 0 ? prior_state<S>(prior) : state_on_path(part, first, prior);
    filter(part, {first, last}, wheel_gate, state, [&](std::size_t k, const auto& step) {
      const auto stretch = static_cast<std::size_t>((readings.time_s[k] - start_s) / length_s);
      gather<S>(readings, k, step, stretch, into);
    });
  };
  const std::size_t size = model.size();
  if (size < worth_a_thread || model.about == nullptr || readings.encoder) {
    gather_from(0, size, noise);
  } else {
    GatheredNoise later(noise.stretches[0].size());
    run_tasks(size, {[&] { gather_from(0, size / 2, noise); },
                     [&] { gather_from(size / 2, size, later); }});
    noise.append(later);
  }
}

/// Sets the variance of each measurement of a sensor.
void set_variance(std::size_t s,
                  const VarianceProfile& profile,
                  double least,
                  WheelReadings& readings) {
  for (std::size_t k = 0; k < readings.epochs.size(); ++k) {
    const std::int64_t row = readings.epochs[k].row[s];
    if (row != WheelEpoch::no_row)
      readings.sensors[s].variance_m2ps4[static_cast<std::size_t>(row)] =
          std::max(profile.at(readings.time_s[k] - readings.time_s.front()), least);
  }
}

}  // namespace

template <int S>
void settle_variance(const WheelModel<S>& model, const WheelPrior& prior, WheelReadings& readings) {
  const double length_s = std::max(0.5, 40.0 / std::max(readings.rate_hz(), 1e-9));
  const double duration_s = readings.time_s.back() - readings.time_s.front();
  const auto count = static_cast<std::size_t>(duration_s / length_s) + 1;
  GatheredNoise noise(count);
  for (std::size_t s = 0; model.about != nullptr && s < readings.sensors.size(); ++s) {
    const bool shakes = set_least(model, readings, s, length_s, noise.stretches[s]);
    if (s == 0) readings.shakes = shakes;
  }
  gather_all(model, prior, readings, length_s, noise);
  if (const auto of_fixes = noise.fixes.noise()) readings.encoder->more = *of_fixes;
  for (std::size_t s = 0; s < readings.sensors.size(); ++s) {
    if (noise.gyros[s].readings > fewest_readings)
      readings.sensors[s].speed_variance = noise.gyros[s].variance();
    const VarianceProfile profile(noise.stretches[s], length_s);
    if (profile.empty()) continue;
    const double least = model.about == nullptr ? 0.0
                                                : least_variance(readings.sensors[s],
                                                                 readings.rate_hz(), *model.about);
    set_variance(s, profile, least, readings);
  }
}

template <int S>
Excerpt<S> excerpt_to_tune(const WheelModel<S>& model, const WheelPrior& prior) {
  constexpr std::size_t most_epochs = 12'000, parts = 4;
  const std::size_t size = model.size();
  auto state = prior_state<S>(prior);
  Excerpt<S> best{0, std::min(size, most_epochs), state};
  if (best.last == size) return best;
  const std::size_t stride = most_epochs / parts;
  std::vector<FilterState<wheel::states(S)>> states;
  std::vector<double> change;
  for (std::size_t first = 0; first < size; first += stride) {
    states.push_back(state);
    double sum = 0.0;
    filter(model, {first, std::min(first + stride, size)}, wheel_gate, state,
           [&](std::size_t, const auto& s) { sum += std::pow(s.filtered.mean(wheel::accel), 2); });
    change.push_back(sum);
  }
  double most = -1.0;
  for (std::size_t i = 0; i + parts <= change.size(); ++i) {
    double sum = 0.0;
    for (std::size_t part = 0; part < parts; ++part) sum += change[i + part];
    if (sum <= most) continue;
    most = sum;
    best = {i * stride, std::min(i * stride + most_epochs, size), states[i]};
  }
  return best;
}

namespace {

/// Multiplies one parameter by `step` as long as the likelihood increases; returns whether it did.
template <class Likelihood>
bool climb_by(double step,
              double WheelNoise::* figure,
              const Likelihood& likelihood,
              TunedNoise& best) {
  constexpr int most_steps = 8;
  for (int tries = 0; tries < most_steps; ++tries) {
    WheelNoise candidate = best.noise;
    candidate.*figure *= step;
    if (candidate.*figure < lowest.*figure || candidate.*figure > highest.*figure) return tries > 0;
    const double value = likelihood(candidate);
    if (!(value > best.log_likelihood)) return tries > 0;
    best = {candidate, value};
  }
  return true;
}

/// Climbs from `start`: each parameter in turn by steps of a shrinking factor.
template <class Likelihood>
TunedNoise climb(const Likelihood& likelihood, const WheelNoise& start, double first_factor) {
  TunedNoise best{start, likelihood(start)};
  for (double factor = first_factor; factor > 1.4; factor = std::sqrt(factor))
    for (double WheelNoise::* figure :
         {&WheelNoise::jerk_psd, &WheelNoise::snap_psd, &WheelNoise::bias_walk_psd})
      if (!climb_by(factor, figure, likelihood, best))
        climb_by(1.0 / factor, figure, likelihood, best);
  return best;
}

/// `start` with the likeliest of some values of one parameter and its own. Much too strong a motion
/// noise lets a filter slip, and there the likelihood has local maxima.
template <class Likelihood>
WheelNoise likeliest_start(const Likelihood& likelihood,
                           const WheelNoise& start,
                           double WheelNoise::* figure) {
  TunedNoise best{start, likelihood(start)};
  for (const double value : {1e2, 1.0, 1e-2, 1e-4, 1e-7}) {
    WheelNoise candidate = start;
    candidate.*figure = value;
    const double log_likelihood = likelihood(candidate);
    if (log_likelihood > best.log_likelihood) best = {candidate, log_likelihood};
  }
  return best.noise;
}

}  // namespace

template <int S>
TunedNoise tune_noise(WheelModel<S> model, const Excerpt<S>& excerpt, bool tuned) {
  const auto likelihood = [&](const WheelNoise& noise) {
    model.noise = noise;
    return log_likelihood_of(model, excerpt.state, excerpt.first, excerpt.last);
  };
  WheelNoise start = model.noise;
  start.snap_psd = std::max(start.snap_psd, lowest.snap_psd);
  const double first_factor = tuned ? std::sqrt(10.0) : 10.0;
  if (!tuned) start = likeliest_start(likelihood, start, &WheelNoise::jerk_psd);
  const TunedNoise rough = climb(likelihood, start, first_factor);
  // The likelihood has two maxima, a motion driven by jerk and one by snap, with low values in
  // between.
  WheelNoise other = rough.noise;
  const bool by_jerk = rough.noise.jerk_psd > rough.noise.snap_psd;
  (by_jerk ? other.snap_psd : other.jerk_psd) =
      std::max(rough.noise.jerk_psd, rough.noise.snap_psd);
  (by_jerk ? other.jerk_psd : other.snap_psd) = by_jerk ? lowest.jerk_psd : lowest.snap_psd;
  const TunedNoise smooth = climb(likelihood, other, first_factor);
  return smooth.log_likelihood > rough.log_likelihood ? smooth : rough;
}

template void settle_variance(const WheelModel<1>&, const WheelPrior&, WheelReadings&);
template void settle_variance(const WheelModel<2>&, const WheelPrior&, WheelReadings&);
template Excerpt<1> excerpt_to_tune(const WheelModel<1>&, const WheelPrior&);
template Excerpt<2> excerpt_to_tune(const WheelModel<2>&, const WheelPrior&);
template TunedNoise tune_noise(WheelModel<1>, const Excerpt<1>&, bool);
template TunedNoise tune_noise(WheelModel<2>, const Excerpt<2>&, bool);

}  // namespace proofmass::estimate
