#include "proofmass/estimate/live_track.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "proofmass/core/units.hpp"
#include "proofmass/estimate/live_columns.hpp"
#include "proofmass/estimate/track/live_axis.hpp"
#include "proofmass/estimate/track/live_filter.hpp"
#include "proofmass/estimate/track/live_rests.hpp"
#include "proofmass/estimate/track/motion.hpp"
#include "proofmass/estimate/wheel/live_epochs.hpp"

namespace proofmass::estimate {
namespace {

constexpr double patience_s = 10.0;          ///< for a first rest, before a note asks for one
constexpr double longest_gathered_s = 60.0;  ///< of the motion that the axis is distinguished from
constexpr double longest_gap_s = 60.0;       ///< over which a position is carried
constexpr double longest_cruise_s = 10.0;
constexpr double gap_steps = 2.5;
constexpr double significant_turn_rad = 0.5 * rad_per_deg;
/// Drift of a level at rest without a sensor file, m/s²/√s.
constexpr double usual_rest_walk = 3e-4;

std::vector<Channel> track_columns() {
  return {live_column("position", Quantity::length, "m"),
          live_column("position_std", Quantity::length, "m"),
          live_column("velocity", Quantity::speed, "m/s"),
          live_column("velocity_std", Quantity::speed, "m/s"),
          time_column("smoothed_time"),
          live_column("smoothed_position", Quantity::length, "m"),
          live_column("smoothed_position_std", Quantity::length, "m"),
          number_column("resting")};
}

Status check(const LiveTrackOptions& options) {
  if (options.sensor.axes() == 0)
    return Error{Errc::invalid_argument,
                 options.sensor.name + ": a displacement needs the channel of one axis at least"};
  const bool sensible = options.rate_hz >= 0.0 && std::isfinite(options.rate_hz) &&
                        options.rest_speed_std_mps > 0.0 && options.rest_speed_std_mps <= 1.0 &&
                        options.scale_std >= 0.0 && options.scale_std <= 1.0 &&
                        options.lag_s >= 0.0 && options.lag_s <= 10.0 &&
                        options.most_rate_hz >= 20.0 && options.most_rate_hz <= 1e4;
  if (!sensible)
    return Error{Errc::invalid_argument,
                 "live track: a speed at rest of up to 1 m/s, a relative scale error of 0 to 1, a "
                 "lag of 0 s to 10 s and 20 Hz to 10 kHz of epochs are expected"};
  return options.axis ? check_live_axis(options.sensor, *options.axis) : Status(Done{});
}

/// Tilt that changes the level by this amount.
double turned_rad(double moved_m2ps4) {
  return std::sqrt(moved_m2ps4) / standard_gravity_mps2;
}

class LiveTrack final : public LiveAnalysis {
 public:
  explicit LiveTrack(const LiveTrackOptions& options)
      : options_(options),
        epochs_({{options.sensor}}, {options.rate_hz, options.most_rate_hz}),
        rests_(options.sensor) {
    if (options.axis) axis_ = unit_vector(*options.axis);
  }

  [[nodiscard]] const std::vector<Channel>& columns() const override { return columns_; }

  [[nodiscard]] Status add(const Block& samples, Rows& out) override {
    out.channels.resize(columns_.size());
    return epochs_.add(samples, [&](const LiveEpoch& epoch) { take(epoch, out); });
  }

  [[nodiscard]] Status finish(Rows& out) override {
    out.channels.resize(columns_.size());
    epochs_.finish([&](const LiveEpoch& epoch) { take(epoch, out); });
    rests_.finish([&](const LiveReading& reading) { follow(reading, out); });
    if (!gathered_.empty()) run_gathered(false, out);
    return Done{};
  }

  [[nodiscard]] std::vector<Note> take_notes() override {
    for (Note& note : epochs_.take_notes()) notes_.push_back(std::move(note));
    for (Note& note : rests_.take_notes()) notes_.push_back(std::move(note));
    return std::exchange(notes_, {});
  }

 private:
  void take(const LiveEpoch& epoch, Rows& out) {
    if (epoch.anew) start_anew();
    if (!began_s_) began_s_ = epoch.time_s;
    rests_.add(epoch, [&](const LiveReading& reading) { follow(reading, out); });
  }

  /// The clock was set back, as reported by the epochs.
  void start_anew() {
    for (Note& note : rests_.take_notes()) notes_.push_back(std::move(note));
    rests_ = LiveTrackRests(options_.sensor);
    began_s_.reset();
    lose();
  }

  void lose() {
    filter_.reset();
    level_.reset();
    gathered_.clear();
    doubted_since_s_.reset();
  }

  void follow(const LiveReading& reading, Rows& out) {
    if (level_ && reading.time_s - last_s_ > rests_.step_s() * gap_steps) cross_gap(reading.time_s);
    last_s_ = reading.time_s;
    if (filter_) return filter(reading, out);
    if (reading.resting) {
      if (!gathered_.empty()) return end_gathered(reading, out);
      if (!level_) say_what_was_left_out(reading.time_s);
      level_ = reading;
      look_at_level();
      return give_still(reading.time_s, out);
    }
    if (!level_) {
      if (!unplaced_from_s_) unplaced_from_s_ = reading.time_s;
      return ask_for_rest(reading.time_s);
    }
    if (axis_) {
      begin();
      return filter(reading, out);
    }
    gather(reading);
  }

  void cross_gap(double time_s) {
    const double missing_s = time_s - last_s_;
    const bool too_long = missing_s > longest_gap_s;
    say(at_second(missing_s) + " s without a measurement before " + at_second(time_s) + " s: " +
        (too_long ? "the position is lost and counts from 0 again at the next rest"
                  : "position and velocity are less sure from there on"));
    if (too_long) lose();
  }

  void ask_for_rest(double time_s) {
    if (asked_ || time_s - *began_s_ < patience_s) return;
    asked_ = true;
    say(options_.sensor.name +
        ": no rest yet, and no displacement without one: keep it still for three seconds before "
        "the motion");
  }

  /// A rest too short to be recognised leaves the following motion without a reference position.
  void say_what_was_left_out(double time_s) {
    constexpr double worth_saying_s = 4.0;  // a rest is recognised after three
    if (unplaced_from_s_ && time_s - *unplaced_from_s_ > worth_saying_s)
      say("the position counts from 0 at the rest at " + at_second(time_s) +
          " s: before it the sensor was not still for three seconds, and what it did since " +
          at_second(*unplaced_from_s_) + " s is left out");
    unplaced_from_s_.reset();
  }

  void look_at_level() {
    const LiveRest& rest = rests_.rest();
    level_->accel_mps2 = rest.level_mps2;
    level_white_m2ps3_ = rest.white_m2ps3;
    level_variance_ = rest.white_m2ps3 / rest.behind_level_s;
  }

  // Before the axis is known.

  void gather(const LiveReading& reading) {
    gathered_.push_back(reading);
    if (reading.time_s - gathered_.front().time_s < longest_gathered_s &&
        static_cast<double>(gathered_.size()) < longest_gathered_s * most_rate_hz())
      return;
    say("the first motion did not end within a minute, and no axis is given: its displacement is "
        "left out, and the position counts from 0 again at the next rest");
    lose();
  }

  void end_gathered(const LiveReading& reading, Rows& out) {
    run_gathered(true, out);
    filter(reading, out);
  }

  void run_gathered(bool stopped, Rows& out) {
    const FoundAxis found = axis_of_motion(gathered_, *level_, options_.sensor, stopped);
    axis_ = unit_vector(found.direction);
    constexpr double clear_share = 0.8;
    if (found.share < clear_share)
      say("only " + std::to_string(std::lround(100.0 * found.share)) +
              " % of the first motion is along one direction: state the axis",
          {Advice{"axis"}});
    begin();
    for (const LiveReading& reading : std::exchange(gathered_, {})) filter(reading, out);
  }

  /// From the rest that just ended or, if the motion was collected, the one before it.
  void begin() {
    const Mat<3> squares = axis_->cwiseAbs2();
    const double given_white = density(options_.figures.white_mps2_rthz, 0.0);
    const double rest_walk = density(options_.figures.walk_mps2_rts, usual_rest_walk);
    const double step_s = rests_.step_s(), rate_hz = std::min(1.0 / step_s, most_rate_hz());
    const LiveTrackSetup setup{
        .white_m2ps3 = std::max(squares.dot(level_white_m2ps3_), given_white * given_white),
        .rest_walk_m2ps5 = rest_walk * rest_walk,
        .rest_speed_std_mps = options_.rest_speed_std_mps,
        .scale_std = options_.scale_std,
        .longest_step_s = gap_steps * step_s,
        .lag = static_cast<std::size_t>(std::lround(options_.lag_s * rate_hz))};
    const double level = axis_->dot(level_->accel_mps2);
    filter_.emplace(setup, LiveTrackSample{level_->time_s, level, true},
                    LiveLevel{level, squares.dot(level_variance_)});
  }

  /// Highest rate of the epochs; the stamps themselves may be arbitrary.
  [[nodiscard]] double most_rate_hz() const { return 1.5 * options_.most_rate_hz; }

  [[nodiscard]] double density(const std::array<std::optional<double>, 3>& figures,
                               double otherwise) const {
    return density_along(figures, {(*axis_)(0), (*axis_)(1), (*axis_)(2)}).value_or(otherwise);
  }

  // With a filter.

  void filter(const LiveReading& reading, Rows& out) {
    const bool resting = reading.resting && !is_doubtful(reading.time_s);
    LiveLevel level;
    if (resting && !filter_->at_rest()) level = new_level();
    filter_->step({reading.time_s, axis_->dot(reading.accel_mps2), resting}, level);
    if (resting) {
      level_->accel_mps2 = rests_.rest().level_mps2;
      level_variance_ = rests_.rest().white_m2ps3 / rests_.rest().behind_level_s;
    }
    give(reading.time_s, filter_->row(), resting, out);
  }

  /// A rest at which half of the speed would remain, with an unchanged level, counts as motion at
  /// constant speed, but not for ever: an erroneous velocity would persist.
  [[nodiscard]] bool is_doubtful(double time_s) {
    if (filter_->at_rest() || !filter_->is_cruising() ||
        turned_rad(moved_m2ps4()) > significant_turn_rad) {
      doubted_since_s_.reset();
      return false;
    }
    if (!doubted_since_s_) {
      doubted_since_s_ = time_s;
      say("nothing is felt from " + at_second(time_s) +
          " s on, but it should be under way: taken as motion at constant speed");
    }
    return time_s - *doubted_since_s_ < longest_cruise_s;
  }

  /// Squared change of the level since the previous rest, beyond noise.
  [[nodiscard]] double moved_m2ps4() const {
    const LiveRest& rest = rests_.rest();
    const Mat<3> variance = rest.white_m2ps3 / rest.behind_level_s + level_variance_;
    constexpr double beyond_noise = 9.0;
    const double moved = (rest.level_mps2 - level_->accel_mps2).squaredNorm();
    return std::max(moved - beyond_noise * variance.sum(), 0.0);
  }

  [[nodiscard]] LiveLevel new_level() {
    const LiveRest& rest = rests_.rest();
    const Mat<3> variance = rest.white_m2ps3 / rest.behind_level_s;
    const LiveLevel level{axis_->dot(rest.level_mps2), axis_->cwiseAbs2().dot(variance),
                          moved_m2ps4()};
    const double turned = turned_rad(level.moved_m2ps4);
    if (turned > significant_turn_rad && turned > 1.5 * said_turn_rad_) {
      said_turn_rad_ = turned;
      say("the level at rest moved by " + at_second(turned / rad_per_deg) +
          "° of gravity before the rest at " + at_second(rest.since_s) +
          " s: the sensor turned, and positions from there on are less sure");
    }
    return level;
  }

  void give_still(double time_s, Rows& out) {
    constexpr double none = std::numeric_limits<double>::quiet_NaN();
    give(time_s, {{0.0, 0.0}, {0.0, options_.rest_speed_std_mps}, none, {none, none}}, true, out);
  }

  static void give(double time_s, const LiveTrackRow& row, bool resting, Rows& out) {
    out.stamps_s.push_back(time_s);
    const std::array values{row.position_m.value,        row.position_m.std,
                            row.velocity_mps.value,      row.velocity_mps.std,
                            row.smoothed_time_s,         row.smoothed_position_m.value,
                            row.smoothed_position_m.std, resting ? 1.0 : 0.0};
    for (std::size_t i = 0; i < values.size(); ++i) out.channels[i].push_back(values[i]);
  }

  void say(std::string text, std::vector<Advice> advice = {}) {
    notes_.push_back({Severity::warning, std::move(text), std::move(advice)});
  }

  LiveTrackOptions options_;
  LiveEpochs epochs_;
  LiveTrackRests rests_;
  std::vector<Channel> columns_ = track_columns();
  std::optional<double> began_s_;
  bool asked_ = false;
  std::optional<double> unplaced_from_s_;  ///< start of the measurements without a preceding rest
  double last_s_ = 0.0;                    ///< of the measurements processed

  std::optional<Mat<3>> axis_;
  std::optional<LiveReading> level_;  ///< of the last rest, at its last epoch until it moves
  Mat<3> level_white_m2ps3_ = Mat<3>::Zero(), level_variance_ = Mat<3>::Zero();
  std::vector<LiveReading> gathered_;  ///< the motion that determines the axis
  std::optional<LiveTrackFilter> filter_;
  std::optional<double> doubted_since_s_;
  double said_turn_rad_ = 0.0;
  std::vector<Note> notes_;
};

}  // namespace

Result<std::unique_ptr<LiveAnalysis>> live_track(const LiveTrackOptions& options) {
  if (auto status = check(options); !status) return status.error();
  return std::unique_ptr<LiveAnalysis>(std::make_unique<LiveTrack>(options));
}

}  // namespace proofmass::estimate
