#include "proofmass/estimate/tilt/motion.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "proofmass/core/statistics.hpp"
#include "proofmass/estimate/filter/iteration.hpp"
#include "proofmass/estimate/tilt/rest.hpp"
#include "proofmass/estimate/tilt/still.hpp"

namespace proofmass::estimate {
namespace {

// Consecutive smoothers, each linearised about the previous path.
constexpr int gyroscope_passes = 3, free_passes = 4;
// Mean squared distance of a smoothed path from the filter's, in the filter's standard deviations,
// beyond which the iteration may have gone astray: less than 1 is expected.
constexpr double plausible_distance2 = 1.0;

void set(TiltSolution& solution, std::size_t k, const TiltAngles& angles, bool smoothed) {
  TiltSeries& s = solution.series;
  const auto put = [k](std::vector<double>& value, std::vector<double>& std,
                       const std::optional<Uncertain>& angle) {
    value[k] = angle ? angle->value : no_value;
    std[k] = angle ? angle->std : no_value;
  };
  if (smoothed) {
    put(s.roll_rad, s.roll_std_rad, angles.roll_rad);
    put(s.pitch_rad, s.pitch_std_rad, angles.pitch_rad);
  } else {
    put(s.filtered_roll_rad, s.filtered_roll_std_rad, angles.roll_rad);
    put(s.filtered_pitch_rad, s.filtered_pitch_std_rad, angles.pitch_rad);
  }
}

/// Lower limit of the white angular acceleration, rad/s²/√Hz, of a base whose force departs from
/// its mean by more than the norm explains by acceleration. One-step predictions hardly differ
/// between rotation and a correlated acceleration, so that the likelihood chooses either: without
/// this limit the angles of half the recordings were those of no rotation, at a quarter of their
/// error. An angle σ with the correlation time τ has the angular acceleration σ/τ², of density 2
/// σ²/τ³; three times its root includes slower and faster parts.
double least_drive(const BaseAccel& accel, double gravity_mps2) {
  const double angle_rad = accel.perhaps_rotation_mps2 / gravity_mps2;
  return 3.0 * std::numbers::sqrt2 * angle_rad / std::pow(accel.time_s, 1.5);
}

}  // namespace

double tilt_log_likelihood(const StepOf<TiltModel>& step, int readings) {
  double sum = 0.0;
  for (int i = 0; i < readings; ++i) {
    const Update<9>& u = step.updates[static_cast<std::size_t>(i)];
    const double off = std::sqrt(u.nis()), huber = tilt_gate.huber;
    const double loss = off <= huber ? 0.5 * off * off : huber * (off - 0.5 * huber);
    sum -= loss + 0.5 * std::log(2.0 * std::numbers::pi * u.expected);
  }
  return sum;
}

double tilt_log_likelihood(const TiltEpochs& epochs,
                           const TiltKnown& known,
                           const TiltMotion& motion) {
  const TiltModel model(epochs, known, motion);
  FilterState<9> state = model.start();
  double sum = 0.0;
  filter(model, {0, model.size()}, tilt_gate, state,
         [&](std::size_t k, const StepOf<TiltModel>& step) {
           if (epochs.resting[k] != 0) return;
           sum += tilt_log_likelihood(step, model.accel_readings(k));
         });
  return sum;
}

TiltMotion fit_tilt_motion(const TiltEpochs& epochs,
                           const TiltKnown& known,
                           const BaseAccel& accel,
                           bool gyroscope) {
  std::vector<double> moving;
  for (std::size_t k = 0; k < accel.cov_m2ps4.size(); ++k)
    if (epochs.resting[k] == 0) moving.push_back(std::sqrt(accel.cov_m2ps4[k].trace() / 3.0));
  TiltMotion motion{.gyroscope = gyroscope,
                    .drive = known.rate_noise_radps_rthz.value_or(usual_rate_noise_radps_rthz),
                    .accel_std_mps2 = median(moving).value_or(0.0),
                    .accel_time_s = accel.time_s,
                    .reading_std_mps2 = accel.reading_std_mps2,
                    .rest_std_mps2 = known.rest_std_mps2.mean(),
                    .gravity_mps2 = known.gravity_mps2};
  if (gyroscope) return motion;
  double best = -std::numeric_limits<double>::infinity();
  double found = 1.0;
  const auto look = [&](double log_drive) {
    TiltMotion trial = motion;
    trial.drive = std::exp(log_drive);
    const double value = tilt_log_likelihood(epochs, known, trial);
    if (value > best) {
      best = value;
      found = trial.drive;
    }
  };
  for (int i = -3; i <= 3; ++i) look(1.5 * i);  // 0.011 … 90 rad/s²/√Hz
  for (const double width : {0.75, 0.375, 0.19}) {
    const double middle = std::log(found);
    look(middle - width);
    look(middle + width);
  }
  motion.drive = std::max(found, least_drive(accel, known.gravity_mps2));
  return motion;
}

RateBias rate_bias_of(const TiltEpochs& epochs, const TiltKnown& known, const TiltMotion& motion) {
  const TiltModel model(epochs, known, motion);
  RateBias bias;
  Mat<3, 3> cov = Mat<3, 3>::Zero();  // of the filter at the end: the bias hardly changes
  double across = 0.0;                // of gravity, mean over the recording
  smooth(
      model, model.start(), tilt_gate,
      [&](std::size_t, const auto& step) {
        cov = step.filtered.cov.template bottomRightCorner<3, 3>();
      },
      [&](std::size_t k, const auto& step, const BackwardInformation<9>& later) {
        const Mat<9> x = later.mean(step.filtered);
        const Mat<3> up = x.template head<3>().normalized();
        across += 0.5 * (cov.trace() - up.dot(cov * up)) / static_cast<double>(model.size());
        if (k == model.size() / 2) bias.mean_radps = x.template tail<3>();
      });
  bias.tilting_std_radps = std::sqrt(std::max(0.0, across));
  return bias;
}

namespace {

// Gravity given all measurements.
struct SmoothedUp {
  Mat<3> mean;
  Mat<3, 3> cov;
};

// The filter's results, epoch by epoch.
class FilterNotes {
 public:
  FilterNotes(const TiltEpochs& epochs,
              const TiltModel& model,
              const ForceSpread& spread,
              TiltSolution& solution)
      : epochs_(epochs),
        model_(model),
        spread_(spread),
        solution_(solution),
        check_({.channels = {"x", "y", "z"}, .rate_hz = rate_hz(epochs)}),
        filtered_(epochs.step_s.size()) {}

  void operator()(std::size_t k, const StepOf<TiltModel>& step) {
    filtered_[k] = {step.filtered.mean.head<3>(), step.filtered.cov.topLeftCorner<3, 3>().trace()};
    set(solution_, k,
        spread_.angles(step.filtered.mean.head<3>(), step.filtered.cov.topLeftCorner<3, 3>()),
        false);
    double weight = model_.accel_readings(k) == 0 ? 0.0 : 1.0;
    std::size_t row = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const bool read = std::isfinite(epochs_.force_mps2[k](static_cast<Eigen::Index>(axis)));
      if (!read || epochs_.resting[k] != 0) check_.miss(axis);
      if (!read) continue;
      const Update<9>& u = step.updates[row++];
      weight = std::min(weight, u.expected / u.variance);
      if (epochs_.resting[k] == 0) check_.add(axis, u.innovation, u.expected, u.used);
    }
    solution_.series.weight[k] = static_cast<float>(weight);
    if (row > 0 && weight < 0.5) ++solution_.down_weighted;
  }
  [[nodiscard]] Consistency judge() const { return check_.judge(); }
  /// Mean squared distance of a path from the filter's, in its standard deviations.
  [[nodiscard]] double distance2(const std::vector<SmoothedUp>& path) const {
    constexpr double most = 25.0;
    double sum = 0.0;
    for (std::size_t k = 0; k < path.size(); ++k)
      sum +=
          std::min(most, (path[k].mean - filtered_[k].mean).squaredNorm() / filtered_[k].variance);
    return sum / static_cast<double>(path.size());
  }

 private:
  struct Filtered {
    Mat<3> mean;
    double variance = 0.0;  // all axes
  };

  static double rate_hz(const TiltEpochs& epochs) {
    const double step_s = median(View<double>(epochs.step_s).subspan(1)).value_or(1.0);
    return step_s > 0.0 ? 1.0 / step_s : 1.0;
  }

  const TiltEpochs& epochs_;
  const TiltModel& model_;
  const ForceSpread& spread_;
  TiltSolution& solution_;
  ConsistencyCheck check_;
  std::vector<Filtered> filtered_;
};

// Final results, at the last sample.
void set_final(const Mat<9>& mean,
               const Mat<9, 9>& cov,
               const ForceSpread& spread,
               TiltSolution& solution) {
  const Mat<3> g = mean.head<3>();
  const Mat<3, 3> cov_g = cov.topLeftCorner<3, 3>();
  solution.final = spread.angles(g, cov_g);
  solution.shares = {.noise = direction_std_rad(g, cov_g),
                     .calibration = direction_std_rad(g, spread.calibration(g)),
                     .alignment = direction_std_rad(g, spread.alignment(g))};
  if (!solution.motion->gyroscope) return;
  solution.rate_bias_radps.emplace();
  for (std::size_t i = 0; i < 3; ++i) {
    const auto row = static_cast<Eigen::Index>(6 + i);
    (*solution.rate_bias_radps)[i] = {mean(row), std::sqrt(cov(row, row))};
  }
}

}  // namespace

void run_tilt(const TiltEpochs& epochs,
              const TiltKnown& known,
              const TiltOptions& options,
              TiltSolution& solution) {
  TiltMotion& motion = *solution.motion;
  TiltModel model(epochs, known, motion);
  Mat<3> rounding = Mat<3>::Zero();
  for (const TiltRest& rest : solution.rests) rounding = rounding.cwiseMax(rest.rounding_m2ps4);
  const ForceSpread spread(options, rounding);
  motion.log_likelihood = tilt_log_likelihood(epochs, known, motion);
  FilterNotes notes(epochs, model, spread, solution);
  std::vector<Mat<9>> path(model.size()), next(model.size());
  std::vector<SmoothedUp> found(model.size()), best;
  Gaussian<9> last;
  double nearest = std::numeric_limits<double>::infinity();
  const int passes = motion.gyroscope ? gyroscope_passes : free_passes;
  const auto keep = [&](int pass) {
    if (options.progress) options.progress("smoothing", static_cast<double>(pass) / passes);
    return [&, pass](std::size_t k, const auto& step, const BackwardInformation<9>& later) {
      next[k] = later.mean(step.filtered);
      found[k] = {next[k].template head<3>(), later.template cov<3>(step.filtered)};
      if (pass > 0) {  // what a pass still changes is uncertain
        const Mat<3> change = (next[k] - path[k]).template head<3>();
        found[k].cov += change * change.transpose();
      }
      if (k + 1 == next.size()) last.cov = step.filtered.cov;
    };
  };
  // The last pass; without gyroscope the iteration may go astray: then the pass nearest to the
  // filter's path.
  const auto choose = [&] {
    const double distance = notes.distance2(found);
    if (!motion.gyroscope && distance > std::max(nearest, plausible_distance2)) return;
    nearest = distance;
    best.swap(found);
    found.resize(best.size());
    last.mean = next.back();
  };
  smooth(model, model.start(), tilt_gate, notes, keep(0));
  choose();
  model.linearise_about_smoothed();
  for (int pass = 1; pass < passes; ++pass) {
    path.swap(next);
    for (Mat<9>& x : path) x.head<3>() *= known.gravity_mps2 / x.head<3>().norm();
    smooth(
        detail::LinearAbout<TiltModel>{model, path.data()},
        model.start_about(path.front().head<3>()), tilt_gate, [](std::size_t, const auto&) {},
        keep(pass));
    choose();
  }
  for (std::size_t k = 0; k < best.size(); ++k) {
    set(solution, k, spread.angles(best[k].mean, best[k].cov), true);
    set_up(solution.series, k, best[k].mean);
  }
  last.cov.topLeftCorner<3, 3>() = best.back().cov;
  set_final(last.mean, last.cov, spread, solution);
  solution.consistency = notes.judge();
}

}  // namespace proofmass::estimate
