#include "proofmass/estimate/wheel_fit.hpp"

#include "proofmass/core/contract.hpp"
#include "proofmass/core/linalg.hpp"
#include "proofmass/estimate/wheel_passes.hpp"

namespace proofmass::estimate {
namespace {

template <int S>
struct Settled {
  WheelNoise noise;
  WheelPrior prior;
  Eigen::MatrixXd places_cov;
  double log_likelihood = 0.0;
};

/// The model of the settled passes: linear about a path, the places held.
template <int S>
WheelModel<S> held_model(const WheelReadings& readings,
                         const WheelNoise& noise,
                         const WheelPath& about) {
  auto model = wheel_model<S>(readings, noise);
  model.about = &about;
  model.places_held = true;
  return model;
}

/// What may be believed of the constants, by how far the wheel turns.
ConstantsPrior prior_for(const WheelPath& path) {
  const auto angle = [](const Mat<wheel::moving>& at) { return at(wheel::angle); };
  const auto [lowest, highest] = std::ranges::minmax_element(path.moving, {}, angle);
  return angle(*highest) - angle(*lowest) < rad_per_turn ? short_way_prior : ConstantsPrior{};
}

/// One round: the readings' variance, the motion's noise and the sensors' places, all about the
/// path found so far.
template <int S>
Settled<S> settle(WheelReadings& readings,
                  const WheelTrack& track,
                  const PlacesPrior& belief,
                  double tuning_factor) {
  auto model = held_model<S>(readings, track.noise, track.path);
  const Places places = track.path.standing.tail<2 * S>();
  WheelPrior prior{track.beginning, prior_for(track.path), places};
  settle_variance(model, prior, readings);
  const Excerpt<S> excerpt = liveliest(model, prior);
  model.noise = tune_noise(model, excerpt, tuning_factor).noise;
  const FoundPlaces found = find_places(model, excerpt, prior, belief);
  prior.places = found.mean;
  return {model.noise, prior, found.cov, found.log_likelihood};
}

/// Moves the track to the smoother's under the settled figures.
template <int S>
void improve(const WheelReadings& readings, const Settled<S>& settled, WheelTrack& track) {
  const auto model = held_model<S>(readings, settled.noise, track.path);
  WheelPath path = track.path;
  const auto end = trace_path(model, prior_state<S>(settled.prior), path);
  track.path = std::move(path);
  track.noise = settled.noise;
  track.beginning.angle_rad = end.mean(wheel::start);
  track.beginning.speed_radps = track.path.moving.front()(wheel::speed);
}

void resize(WheelSeries& series, std::size_t size) {
  for (std::vector<double>* column :
       {&series.angle_rad, &series.angle_std_rad, &series.speed_radps, &series.speed_std_radps,
        &series.accel_radps2, &series.accel_std_radps2, &series.filtered_angle_rad,
        &series.filtered_angle_std_rad})
    column->resize(size);
  series.nis.resize(size);
  series.channels_used.resize(size);
  series.channels_gated.resize(size);
}

template <int S>
void note_forward(const WheelModel<S>& model,
                  std::size_t k,
                  const StepOf<WheelModel<S>>& step,
                  ConsistencyCheck& check,
                  WheelFit& fit) {
  double nis = 0.0;
  unsigned char used = 0, gated = 0;
  std::size_t next = 0;
  for (std::size_t s = 0; s < static_cast<std::size_t>(S); ++s) {
    if (!model.has_readings(s, k)) continue;
    for (std::size_t channel = 2 * s; channel < 2 * s + 2; ++channel) {
      const auto& u = step.updates[next++];
      check.add(channel, u.innovation, u.expected, u.used);
      nis += u.used ? u.nis() : 0.0;
      ++(u.used ? used : gated);
    }
  }
  fit.series.nis[k] = static_cast<float>(nis);
  fit.series.channels_used[k] = used;
  fit.series.channels_gated[k] = gated;
}

template <int S>
void note_backward(std::size_t k,
                   const StepOf<WheelModel<S>>& step,
                   const Hindsight<wheel::states(S)>& later,
                   WheelFit& fit) {
  WheelSeries& series = fit.series;
  const Mat<wheel::moving> mean = later.mean(step.filtered).template head<wheel::moving>();
  const auto cov = later.template cov<wheel::jerk>(step.filtered);
  const auto std_of = [&](int i) { return std::sqrt(std::max(cov(i, i), 0.0)); };
  series.angle_rad[k] = mean(wheel::angle);
  series.angle_std_rad[k] = std_of(wheel::angle);
  series.speed_radps[k] = mean(wheel::speed);
  series.speed_std_radps[k] = std_of(wheel::speed);
  series.accel_radps2[k] = mean(wheel::accel);
  series.accel_std_radps2[k] = std_of(wheel::accel);
  fit.track.path.moving[k] = mean;
}

/// The extended filter as it would run on calibrated sensors: the motion unknown at the start, the
/// constants as the whole recording tells them for its first instant, as well as it does at its
/// last.
template <int S>
void filter_calibrated(const WheelModel<S>& model,
                       const WheelPrior& prior,
                       const Gaussian<wheel::states(S)>& known,
                       WheelSeries& series) {
  constexpr int count = wheel::standing(S);
  auto state = prior_state<S>(prior);
  state.x.mean.template tail<count>() = known.mean.template tail<count>();
  state.x.cov.template bottomRightCorner<count, count>() =
      known.cov.template bottomRightCorner<count, count>();
  filter(model, 0, model.size(), wheel_gate, state, [&](std::size_t k, const auto& step) {
    series.filtered_angle_rad[k] = step.filtered.mean(wheel::angle);
    series.filtered_angle_std_rad[k] = std::sqrt(step.filtered.cov(wheel::angle, wheel::angle));
  });
}

/// What filter and smoother say with the places held where they were found.
template <int S>
WheelFit smooth_at_places(const WheelReadings& readings,
                          const Settled<S>& settled,
                          const WheelPath& about,
                          const Progress& progress) {
  const auto model = held_model<S>(readings, settled.noise, about);
  const std::size_t size = model.size();
  WheelFit fit;
  resize(fit.series, size);
  fit.series.time_s = readings.time_s;
  fit.track = {settled.prior.beginning, settled.noise, about, 0.0};
  const auto prior = prior_state<S>(settled.prior);
  Gaussian<wheel::states(S)> end = prior.x;
  Mat<wheel::states(S)> first_mean = end.mean;
  ConsistencyCheck check({.channels = std::vector<std::string>(static_cast<std::size_t>(2 * S)),
                          .rate_hz = readings.rate_hz(),
                          .gate = wheel_gate.limit});
  const auto tell = [&](std::string_view stage, std::size_t done) {
    if (progress && done % 65536 == 0)
      progress(stage, static_cast<double>(done) / static_cast<double>(size));
  };
  smooth(
      model, prior, wheel_gate,
      [&](std::size_t k, const auto& step) {
        if (k > 0 && readings.time_s[k] > readings.time_s.front() + 1.0) {
          const Mat<wheel::moving> from_angle =
              model.transition(end.mean, k).F.row(wheel::angle).transpose();
          const double variance = from_angle.dot(
              end.cov.template topLeftCorner<wheel::moving, wheel::moving>() * from_angle);
          fit.widest_prediction_rad = std::max(fit.widest_prediction_rad, std::sqrt(variance));
        }
        end = step.filtered;
        note_forward(model, k, step, check, fit);
        tell("filter", k);
      },
      [&](std::size_t k, const auto& step, const auto& later) {
        note_backward<S>(k, step, later, fit);
        if (k == 0) first_mean = later.mean(step.filtered);
        tell("smoother", size - k);
      });
  filter_calibrated(model, settled.prior, {first_mean, end.cov}, fit.series);
  fit.consistency = check.judge();
  constexpr int count = wheel::standing(S);
  fit.constants = end.mean.template tail<count>();
  fit.constants_cov = end.cov.template bottomRightCorner<count, count>();
  const double variance = end.cov(wheel::angle, wheel::angle) +
                          end.cov(wheel::start, wheel::start) -
                          2.0 * end.cov(wheel::angle, wheel::start);
  fit.turns = {(end.mean(wheel::angle) - end.mean(wheel::start)) / rad_per_turn,
               std::sqrt(std::max(variance, 0.0)) / rad_per_turn};
  fit.ekf_turns =
      (fit.series.filtered_angle_rad.back() - fit.series.filtered_angle_rad.front()) / rad_per_turn;
  return fit;
}

void add_in_square(double& std, double more) {
  std = std::hypot(std, more);
}

/// Adds what the places' uncertainty makes of everything else: the whole smoothed again a little
/// way along each principal direction of their covariance, and the differences drawn out to one
/// standard deviation. Not that far at once: where the recording hardly tells the places, that is
/// no small step.
template <int S>
void add_places_uncertainty(const WheelReadings& readings,
                            const Settled<S>& settled,
                            const WheelPath& about,
                            WheelFit& fit) {
  constexpr double longest_step_m = 2e-3;
  const SymmetricEigen axes = symmetric_eigen(settled.places_cov);
  for (Eigen::Index i = 0; i < axes.values.size(); ++i) {
    const double std_m = std::sqrt(std::max(axes.values(i), 1e-16));
    const double step_m = std::min(std_m, longest_step_m), reach = std_m / step_m;
    Settled<S> moved = settled;
    *moved.prior.places += step_m * axes.vectors.col(i);
    const auto model = held_model<S>(readings, moved.noise, about);
    WheelPath path = about;
    const auto end = trace_path(model, prior_state<S>(moved.prior), path);
    const Eigen::VectorXd change = reach * (end.mean.tail(fit.constants.size()) - fit.constants);
    fit.constants_cov += change * change.transpose();
    const double turns = (end.mean(wheel::angle) - end.mean(wheel::start)) / rad_per_turn;
    add_in_square(fit.turns.std, reach * (turns - fit.turns.value));
    for (std::size_t k = 0; k < path.moving.size(); ++k) {
      const Mat<wheel::moving> difference = reach * (path.moving[k] - fit.track.path.moving[k]);
      add_in_square(fit.series.angle_std_rad[k], difference(wheel::angle));
      add_in_square(fit.series.filtered_angle_std_rad[k], difference(wheel::angle));
      add_in_square(fit.series.speed_std_radps[k], difference(wheel::speed));
      add_in_square(fit.series.accel_std_radps2[k], difference(wheel::accel));
    }
  }
}

/// Gravity is what scales and places are measured with: were it larger by a part, the scales would
/// be smaller and the places larger by that part, the angle the same. `believed` is the share of
/// the places' information that came from their prior, which no gravity moves.
template <int S>
void add_gravity_uncertainty(const WheelReadings& readings,
                             const Eigen::MatrixXd& believed,
                             WheelFit& fit) {
  const double part = readings.gravity_std_mps2 / readings.gravity_mps2;
  Eigen::VectorXd change = Eigen::VectorXd::Zero(fit.constants.size());
  for (int s = 0; s < S; ++s) {
    const int at = wheel::first_of(s) - wheel::first_of(0) + wheel::scale;
    change.segment<2>(at) = -part * (fit.constants.segment<2>(at).array() + 1.0);
  }
  const Places places = fit.constants.tail<2 * S>();
  change.tail<2 * S>() = part * (places - believed * places);
  fit.constants_cov += change * change.transpose();
}

/// Rounds until the likelihood has settled, at most `most`.
template <int S>
Settled<S> settle_rounds(WheelReadings& readings,
                         WheelTrack& track,
                         const PlacesPrior& belief,
                         int most,
                         const Progress& progress) {
  double tuning_factor = 10.0;
  Settled<S> settled = settle<S>(readings, track, belief, tuning_factor);
  for (int round = 1; round < most; ++round) {
    if (progress) progress("noise and constants", static_cast<double>(round) / most);
    const double before = settled.log_likelihood;
    improve(readings, settled, track);
    tuning_factor = std::sqrt(10.0);
    settled = settle<S>(readings, track, belief, tuning_factor);
    if (round > 1 && std::abs(settled.log_likelihood - before) < 1.0) break;
  }
  return settled;
}

/// How many readings may be averaged before the wheel turns a twentieth of a radian meanwhile.
std::size_t readings_to_average(const WheelReadings& readings, const WheelTrack& track) {
  double fastest = 0.0;
  for (const Mat<wheel::moving>& at : track.path.moving)
    fastest = std::max(fastest, std::abs(at(wheel::speed)));
  return static_cast<std::size_t>(std::clamp(0.05 * readings.rate_hz() / fastest, 1.0, 64.0));
}

/// A track of the averaged readings, on the time line of all of them.
WheelTrack spread_track(const WheelTrack& track,
                        const WheelReadings& averaged,
                        const WheelReadings& readings) {
  WheelTrack out = track;
  out.path.moving.clear();
  std::size_t at = 0;
  for (const double t : readings.time_s) {
    while (at + 1 < averaged.time_s.size() && averaged.time_s[at + 1] <= t) ++at;
    Mat<wheel::moving> moving = track.path.moving[at];
    moving(wheel::angle) += (t - averaged.time_s[at]) * moving(wheel::speed);
    out.path.moving.push_back(moving);
  }
  return out;
}

/// Gives each reading the variance that its average was found to have, times what averaging took
/// off.
void spread_variance(const WheelReadings& averaged, std::size_t each, WheelReadings& readings) {
  for (std::size_t s = 0; s < readings.sensors.size(); ++s)
    for (std::size_t k = 0; k < readings.instants.size(); ++k) {
      const std::int64_t row = readings.instants[k].row[s];
      const std::int64_t block = averaged.instants[k / each].row[s];
      if (row == WheelInstant::no_row || block == WheelInstant::no_row) continue;
      readings.sensors[s].variance_m2ps4[static_cast<std::size_t>(row)] =
          static_cast<double>(each) *
          averaged.sensors[s].variance_m2ps4[static_cast<std::size_t>(block)];
    }
}

template <int S>
WheelFit fit_sensors(WheelReadings& readings,
                     WheelTrack track,
                     const PlacesPrior& belief,
                     const Progress& progress) {
  const std::size_t each = readings_to_average(readings, track);
  WheelReadings coarse = averaged(readings, each);
  WheelTrack coarse_track = spread_track(track, readings, coarse);
  Settled<S> settled = settle_rounds<S>(coarse, coarse_track, belief, S == 1 ? 4 : 2, progress);
  track = spread_track(coarse_track, coarse, readings);
  // A warm-up is no random walk: it drifts fastest at the start, where the turns begin to be
  // counted.
  settled.noise.bias_walk_psd *= 3.0;
  track.noise = settled.noise;
  const auto model = held_model<S>(readings, settled.noise, track.path);
  spread_variance(coarse, each, readings);
  settle_variance(model, settled.prior, readings);
  improve(readings, settled, track);
  settled.prior.beginning = track.beginning;
  settle_variance(model, settled.prior, readings);
  WheelFit fit = smooth_at_places(readings, settled, track.path, progress);
  constexpr int count = wheel::standing(S);
  fit.constants_prior_cov =
      prior_state<S>(settled.prior).x.cov.template bottomRightCorner<count, count>();
  fit.constants_prior_cov.template bottomRightCorner<2 * S, 2 * S>() =
      positive_inverse(belief.information);
  add_places_uncertainty(readings, settled, track.path, fit);
  add_gravity_uncertainty<S>(readings, settled.places_cov * belief.information, fit);
  return fit;
}

}  // namespace

WheelFit fit_wheel(WheelReadings& readings,
                   WheelTrack track,
                   const PlacesPrior& places_prior,
                   const Progress& progress) {
  PM_EXPECTS(!readings.sensors.empty() && readings.sensors.size() <= 2);
  PM_EXPECTS(readings.instants.size() >= 2 && track.path.moving.size() == readings.instants.size());
  if (readings.sensors.size() == 1)
    return fit_sensors<1>(readings, std::move(track), places_prior, progress);
  return fit_sensors<2>(readings, std::move(track), places_prior, progress);
}

}  // namespace proofmass::estimate
