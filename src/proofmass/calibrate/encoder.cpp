#include "proofmass/calibrate/encoder.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <optional>

#include "proofmass/calibrate/encoder/fit.hpp"
#include "proofmass/calibrate/encoder/results.hpp"
#include "proofmass/core/statistics.hpp"

namespace proofmass::calibrate {
namespace {

constexpr double fewest_turns = 5.0, fewest_fixes_a_turn = 48.0;
constexpr std::size_t most_blocks = 24;
/// Largest |α|/ω² of a row that is used: beyond, the speed changes too much within a sixth of a
/// turn.
constexpr double steepest = 0.5;
/// Half the angle over which EncoderRows::smooth is smoothed.
constexpr double smooth_half_rad = 3.0 * signal::twelfth_of_turn_rad;

Status check_recording(const EncoderRecording& recording) {
  if (recording.axes.empty())
    return Error{Errc::invalid_argument, recording.name + ": no accelerometer"};
  for (const auto& axis : recording.axes)
    if (axis.size() != recording.time_s.size())
      return Error{Errc::invalid_argument, recording.name + ": channels of different lengths"};
  if (recording.axis_names.size() != recording.axes.size() ||
      recording.sensor_of.size() != recording.axes.size())
    return Error{Errc::invalid_argument, recording.name + ": axes without a name or sensor"};
  return Done{};
}

/// Below a tenth of the usual speed the wheel is taken to stand: one angle, and its quantisation.
double slowest_of(const std::vector<double>& speeds) {
  std::vector<double> sizes;
  for (const double speed : speeds)
    if (!std::isnan(speed)) sizes.push_back(std::abs(speed));
  return 0.1 * quantile(sizes, 0.9).value_or(0.0);
}

/// Assigns blocks of whole turns; the last one contains the rest.
void divide(const std::vector<double>& turned, EncoderRows& rows) {
  const double turns = turned.empty() ? 0.0 : turned.back();
  const double each = std::max(1.0, std::ceil(turns / static_cast<double>(most_blocks)));
  rows.blocks = static_cast<std::size_t>(std::max(1.0, std::floor(turns / each)));
  for (const double turn : turned)
    rows.block.push_back(std::min(static_cast<std::size_t>(turn / each), rows.blocks - 1));
}

/// From the acceleration about a fiftieth of a turn before and after.
void add_jerk(const EncoderRows& rows, EncoderMotion& motion) {
  constexpr double apart_rad = rad_per_turn / 48.0;
  const std::size_t size = rows.row.size();
  const auto &angle = motion.at.angle_rad, &accel_radps2 = motion.at.accel_radps2;
  motion.jerk_radps3.assign(size, 0.0);
  std::size_t first = 0, last = 0;
  for (std::size_t k = 0; k < size; ++k) {
    while (first < k && std::abs(angle[k] - angle[first]) > apart_rad) ++first;
    last = std::max(last, k);
    while (last + 1 < size && std::abs(angle[last] - angle[k]) < apart_rad) ++last;
    const double span_s = rows.time_s[last] - rows.time_s[first];
    if (span_s > 0.0) motion.jerk_radps3[k] = (accel_radps2[last] - accel_radps2[first]) / span_s;
  }
}

void append(const signal::AngleMotion& from, std::size_t k, signal::AngleMotion& to) {
  to.angle_rad.push_back(from.angle_rad[k]);
  to.speed_radps.push_back(from.speed_radps[k]);
  to.accel_radps2.push_back(from.accel_radps2[k]);
}

bool known_at(const signal::AngleMotion& motion, std::size_t k) {
  return std::isfinite(motion.angle_rad[k] + motion.speed_radps[k] + motion.accel_radps2[k]);
}

/// Turns up to each row used.
std::vector<double> select_rows(const EncoderRecording& recording,
                                const signal::AngleFixes& fixes,
                                double half_rad,
                                EncoderRows& rows) {
  const signal::AngleMotion shown = signal::motion_at(fixes, recording.time_s, half_rad);
  const signal::AngleMotion smooth = signal::motion_at(fixes, recording.time_s, smooth_half_rad);
  const double slowest = slowest_of(smooth.speed_radps);
  const double span_s = recording.time_s.back() - recording.time_s.front();
  std::vector<double> turned;
  double turns = 0.0;
  std::optional<std::size_t> previous;
  for (std::size_t k = 0; k < recording.time_s.size(); ++k) {
    const double speed = smooth.speed_radps[k];
    if (!known_at(shown, k) || !known_at(smooth, k) || std::abs(speed) <= slowest ||
        std::abs(smooth.accel_radps2[k]) > steepest * speed * speed) {
      previous.reset();
      continue;
    }
    if (previous) turns += std::abs(shown.angle_rad[k] - shown.angle_rad[*previous]) / rad_per_turn;
    previous = k;
    turned.push_back(turns);
    rows.row.push_back(k);
    rows.time_s.push_back(recording.time_s[k]);
    rows.phase.push_back(2.0 * (recording.time_s[k] - recording.time_s.front()) / span_s - 1.0);
    append(shown, k, rows.shown.at);
    append(smooth, k, rows.smooth.at);
  }
  for (EncoderMotion* motion : {&rows.shown, &rows.smooth}) add_jerk(rows, *motion);
  divide(turned, rows);
  return turned;
}

Status check_rows(const EncoderRecording& recording, double turns) {
  if (!(turns >= fewest_turns))
    return Error{Errc::too_few_samples,
                 fmt::format("{}: the wheel turns {:.1f} times by the encoder; expected {:g} or "
                             "more: check the counts per turn, or record longer",
                             recording.name, turns, fewest_turns),
                 {Advice{"counts-per-turn"}}};
  const double each = static_cast<double>(recording.encoder.time_s.size()) / turns;
  if (each < fewest_fixes_a_turn)
    return Error{Errc::too_few_samples,
                 fmt::format("{}: {:.0f} angles a turn from the encoder; expected {:g} or more: "
                             "use a finer encoder, or record at a higher rate",
                             recording.name, each, fewest_fixes_a_turn)};
  return Done{};
}

/// Whether some axis follows gravity.
bool follows_gravity(const EncoderFit& fit, const encoder::Layout& layout) {
  for (std::size_t axis = 0; axis < layout.axes; ++axis) {
    const double response =
        fit.parameters.segment<2>(layout.axis(axis) + encoder::sin).squaredNorm();
    if (response > fit.variance[axis]) return true;
  }
  return false;
}

/// The largest nonlinearity of an axis in the plane, as a multiple of its prior.
double nonlinearity_shown(const EncoderFit& fit, const encoder::Layout& layout) {
  double most = 0.0;
  for (std::size_t axis = 0; axis < layout.axes; ++axis) {
    const Eigen::Index first = layout.axis(axis);
    if (fit.parameters.segment<2>(first + encoder::sin).norm() < 3.0) continue;
    for (Eigen::Index i = first + encoder::nonlinear; i < first + encoder::drift; ++i)
      most = std::max(most, std::abs(fit.parameters(i)) / fit.prior_std(i));
  }
  return most;
}

struct EncoderRound {
  EncoderRows rows;
  EncoderFit fit;
  EncoderOffsets offsets;
  double turns = 0.0;
};

/// Half the angle over which the encoder's motion is smoothed, and a fit to start from.
struct EncoderStart {
  double half_rad = signal::twelfth_of_turn_rad;
  std::optional<EncoderFit> fit;
};

Result<EncoderRound> one_round(const EncoderRecording& recording,
                               const signal::AngleFixes& fixes,
                               const EncoderStart& start,
                               const EncoderOptions& options) {
  EncoderRound round;
  const std::vector<double> turned = select_rows(recording, fixes, start.half_rad, round.rows);
  round.turns = turned.empty() ? 0.0 : turned.back();
  if (const Status enough = check_rows(recording, round.turns); !enough) return enough.error();
  round.fit = fit_encoder(recording, round.rows, options, start.fit);
  if (!follows_gravity(round.fit, encoder::layout_of(recording)))
    return Error{Errc::not_observable,
                 recording.name +
                     ": the accelerometers do not follow gravity at the encoder's angle: check the "
                     "counts per turn and the unit; the axle must be level",
                 {Advice{"counts-per-turn"}, Advice{"unit"}}};
  round.offsets = offsets_of(recording, round.rows, round.fit, options.gravity_mps2);
  return round;
}

void add_notes(const EncoderRecording& recording,
               const EncoderOptions& given,
               EncoderCalibration& out) {
  if (!recording.has_index)
    out.notes.push_back(
        {Severity::warning,
         "without an index pulse the phases count from where this recording's count is zero; they "
         "hold elsewhere only if the encoder is absolute or keeps its count",
         {Advice{"index"}}});
  if (out.nonlinearity > given.nonlinearity)
    out.notes.push_back(
        {Severity::warning,
         fmt::format(
             "the accelerometers' output has harmonics that neither gravity nor the encoder "
             "explains: their nonlinearity is taken as {:.2g} % at 1 g instead of {:.2g} %",
             100.0 * out.nonlinearity, 100.0 * given.nonlinearity)});
  if (out.blocks < 10)
    out.notes.push_back({Severity::warning,
                         fmt::format("{} turns only: the intervals are wide by Student's t with {} "
                                     "degrees of freedom",
                                     static_cast<int>(out.turns), static_cast<int>(out.dof))});
}

/// The smoothing at which the accelerometers leave the least residuals: wider, it loses ripple of
/// the speed; narrower, the noise of the acceleration times the lever arm exceeds their own.
EncoderStart best_start(const EncoderRecording& recording, const EncoderOptions& options) {
  constexpr std::array shares{1.0, 0.7, 0.5, 1.4};
  EncoderStart next, best;
  for (const double share : shares) {
    next.half_rad = share * signal::twelfth_of_turn_rad;
    auto round = one_round(recording, recording.encoder, next, options);
    if (!round) continue;
    next.fit = std::move(round->fit);
    if (!best.fit || log_variance(*next.fit) < log_variance(*best.fit)) best = next;
  }
  return best;
}

/// The offsets without those at which the speed changes so much within a turn that an error of 5 %
/// in the acceleration of the nearest sensor moves them by a quarter of a count.
std::vector<double> steady_offsets(const EncoderRecording& recording,
                                   const EncoderRound& round,
                                   double gravity_mps2) {
  constexpr double accel_error = 0.05, count_share = 0.25;
  constexpr std::size_t half_turn = 8;  // bins
  const encoder::Layout layout = encoder::layout_of(recording);
  double lever_m = std::numeric_limits<double>::infinity();
  for (std::size_t sensor = 0; sensor < layout.sensors; ++sensor)
    lever_m = std::min(lever_m, round.fit.parameters.segment<2>(layout.lever(sensor)).norm());
  const double most_radps2 =
      count_share * recording.step_rad * gravity_mps2 / (accel_error * lever_m);
  const EncoderOffsets& bins = round.offsets;
  std::vector<double> out = bins.offset_rad;
  for (std::size_t i = 0; i < out.size(); ++i) {
    const std::size_t first = i - std::min(i, half_turn);
    const std::size_t last = std::min(i + half_turn, out.size() - 1);
    const double change = std::abs(bins.speed_radps[last] - bins.speed_radps[first]);
    if (change > most_radps2 * (bins.time_s[last] - bins.time_s[first]))
      out[i] = std::numeric_limits<double>::quiet_NaN();
  }
  return out;
}

/// Mean of the residuals of four turns, those of bins [first, first + 64) as far as they exist.
double mean_residual(const EncoderOffsets& bins, std::ptrdiff_t first) {
  constexpr std::ptrdiff_t four_turns = 64;
  const auto size = static_cast<std::ptrdiff_t>(bins.offset_rad.size());
  Moments residuals;
  for (std::ptrdiff_t i = std::max<std::ptrdiff_t>(first, 0);
       i < std::min(first + four_turns, size); ++i)
    residuals.add(bins.offset_rad[static_cast<std::size_t>(i)] -
                  bins.fitted_rad[static_cast<std::size_t>(i)]);
  return residuals.mean;
}

/// `removed` and `found` together. Those within two turns of each other are one, in the middle of
/// their times, with the counts by which the residuals after all of them differ from those before,
/// at most those of the largest. A step that reverses within two turns is no missed count, but an
/// error of the motion shown, as at a kink of the speed.
std::vector<signal::CountSlip> lasting(const std::vector<signal::CountSlip>& removed,
                                       const std::vector<signal::CountSlip>& found,
                                       const EncoderOffsets& bins,
                                       double step_rad) {
  constexpr std::ptrdiff_t two_turns = 32, four_turns = 64;
  const auto bin_at = [&](double time_s) {
    return std::ranges::lower_bound(bins.time_s, time_s) - bins.time_s.begin();
  };
  std::vector<signal::CountSlip> all = removed;
  all.insert(all.end(), found.begin(), found.end());
  std::ranges::sort(all, {}, &signal::CountSlip::time_s);
  std::vector<signal::CountSlip> out;
  for (std::size_t i = 0, after = 0; i < all.size(); i = after) {
    after = i + 1;
    while (after < all.size() &&
           bin_at(all[after].time_s) - bin_at(all[after - 1].time_s) < two_turns)
      ++after;
    signal::CountSlip one = all[i];
    if (after - i > 1) {
      const double first_s = all[i].time_s, last_s = all[after - 1].time_s;
      const double change =
          mean_residual(bins, bin_at(last_s)) - mean_residual(bins, bin_at(first_s) - four_turns);
      int most = 0;
      for (std::size_t k = i; k < after; ++k) most = std::max(most, std::abs(all[k].counts));
      one.counts = std::clamp(static_cast<int>(std::lround(change / step_rad)), -most, most);
      for (const signal::CountSlip& slip : removed)
        if (slip.time_s >= first_s && slip.time_s <= last_s) one.counts += slip.counts;
      one.end_s = all[after - 1].end_s;
      one.time_s = 0.5 * (first_s + last_s);
    }
    if (one.counts != 0) out.push_back(one);
  }
  return out;
}

bool same_counts(const std::vector<signal::CountSlip>& a, const std::vector<signal::CountSlip>& b) {
  return std::ranges::equal(a, b, {}, &signal::CountSlip::counts, &signal::CountSlip::counts);
}

/// Fits, finds the missed counts, removes them from `fixes` and fits again, until there are none;
/// then moves them to where the fit without them has them.
Result<EncoderRound> without_slips(const EncoderRecording& recording,
                                   const EncoderStart& start,
                                   const EncoderOptions& options,
                                   signal::AngleFixes& fixes,
                                   EncoderCalibration& out) {
  // The first fit is bent by the slips; few rounds find them all.
  constexpr int most_rounds = 6;
  auto round = one_round(recording, fixes, start, options);
  for (int n = 0; n < most_rounds && round; ++n) {
    const auto found = signal::find_count_slips(
        round->offsets.time_s, steady_offsets(recording, *round, options.gravity_mps2),
        recording.step_rad);
    if (found.empty()) break;
    if (static_cast<double>(out.missed.size() + found.size()) > round->turns) {
      out.notes.push_back(
          {Severity::warning,
           "the encoder departs from gravity more often than once a turn: these are not missed "
           "counts, or the wheel does not turn as its accelerometers do; none is removed"});
      out.missed.clear();
      fixes = recording.encoder;
      return one_round(recording, fixes, start, options);
    }
    std::vector<signal::CountSlip> all =
        lasting(out.missed, found, round->offsets, recording.step_rad);
    if (same_counts(all, out.missed)) break;
    const bool reversed = all.size() < out.missed.size();
    out.missed = std::move(all);
    fixes = recording.encoder;
    signal::remove_slips(out.missed, recording.step_rad, fixes);
    round = one_round(recording, fixes, start, options);
    if (reversed) break;
  }
  for (int n = 0; n < most_rounds && round && !out.missed.empty(); ++n) {
    std::vector<double> residual_rad = round->offsets.offset_rad;
    for (std::size_t i = 0; i < residual_rad.size(); ++i)
      residual_rad[i] -= round->offsets.fitted_rad[i];
    if (!signal::relocate_slips(round->offsets.time_s, residual_rad, recording.step_rad,
                                out.missed))
      break;
    fixes = recording.encoder;
    signal::remove_slips(out.missed, recording.step_rad, fixes);
    round = one_round(recording, fixes, start, options);
  }
  std::ranges::sort(out.missed, {}, &signal::CountSlip::time_s);
  return round;
}

void conclude(const EncoderRecording& recording, EncoderRound round, EncoderCalibration& out) {
  out.turns = round.turns;
  out.samples = round.rows.row.size();
  out.blocks = round.rows.blocks;
  out.dof = static_cast<double>(out.blocks) - 1.0;
  out.iterations = round.fit.iterations;
  out.converged = round.fit.converged;
  std::vector<double> speeds = round.rows.shown.at.speed_radps;
  for (double& speed : speeds) speed = std::abs(speed);
  out.speed_min_radps = *quantile(speeds, 0.01);
  out.speed_max_radps = *quantile(speeds, 0.99);
  add_encoder_results(recording, round.fit, out.dof, out);
  out.detectable_counts = signal::detectable_counts(round.offsets.offset_rad, recording.step_rad);
  out.offset_time_s = std::move(round.offsets.time_s);
  out.offset_angle_rad = std::move(round.offsets.angle_rad);
  out.offset_rad = std::move(round.offsets.offset_rad);
  out.fitted_rad = std::move(round.offsets.fitted_rad);
}

}  // namespace

Result<EncoderCalibration> calibrate_encoder(const EncoderRecording& recording,
                                             const EncoderOptions& given) {
  if (const Status fits = check_recording(recording); !fits) return fits.error();
  EncoderCalibration out;
  out.step_rad = recording.step_rad;
  EncoderOptions options = given;
  signal::AngleFixes fixes = recording.encoder;
  const EncoderStart start = best_start(recording, options);
  auto round = without_slips(recording, start, options, fixes, out);
  if (!round) return round.error();
  constexpr double beyond_prior = 3.0;
  if (const double shown = nonlinearity_shown(round->fit, encoder::layout_of(recording));
      shown > beyond_prior) {
    options.nonlinearity *= shown;
    round = one_round(recording, fixes, start, options);
    if (!round) return round.error();
  }
  out.nonlinearity = options.nonlinearity;
  conclude(recording, std::move(round).value(), out);
  add_notes(recording, given, out);
  return out;
}

}  // namespace proofmass::calibrate
