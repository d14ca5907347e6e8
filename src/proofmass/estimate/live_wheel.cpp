#include "proofmass/estimate/live_wheel.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <future>
#include <limits>
#include <optional>
#include <utility>

#include "proofmass/estimate/live_columns.hpp"
#include "proofmass/estimate/wheel/joint_fit.hpp"
#include "proofmass/estimate/wheel/live_epochs.hpp"
#include "proofmass/estimate/wheel/live_filter.hpp"
#include "proofmass/estimate/wheel/live_start.hpp"

namespace proofmass::estimate {
namespace {

/// The longest interval used for the initialisation.
constexpr double longest_start_s = 20.0;
/// A speed change by this share determines the lever arms, if observed for this long.
constexpr double significant_change = 0.25, watch_change_s = 2.0;
/// Repeated at once if the lever arms leave more than this uncertainty of the angle.
constexpr double open_angle_rad = 0.1, least_pause_s = 0.5;
/// Time from the beginning of a search to the use of its result.
constexpr double search_s = 1.0;
/// A filter whose angle was always known better than this has not slipped.
constexpr double certain_rad = 0.5;
/// Maximum pause after a failed search.
constexpr double longest_pause_s = 60.0;

std::vector<Channel> wheel_columns() {
  return {angle_column("angle"),
          angle_column("angle_std"),
          rate_column("speed"),
          rate_column("speed_std"),
          time_column("smoothed_time"),
          angle_column("smoothed_angle"),
          angle_column("smoothed_angle_std"),
          rate_column("smoothed_speed"),
          rate_column("smoothed_speed_std"),
          number_column("nis")};
}

std::vector<LiveVector> vectors_of(const LiveWheelOptions& options) {
  std::vector<LiveVector> vectors;
  for (const Triad& sensor : options.sensors) vectors.push_back({sensor});
  for (const Triad& gyroscope : options.gyroscopes)
    if (gyroscope.x) vectors.push_back({gyroscope, true});
  return vectors;
}

Status check(const LiveWheelOptions& options) {
  if (auto status = check_wheel(options.sensors.size(), options.wheel); !status) return status;
  for (const Triad& sensor : options.sensors)
    if (!sensor.x || !sensor.y)
      return Error{Errc::invalid_argument,
                   sensor.name + ": a wheel needs the channels of x and y at least"};
  if (!options.gyroscopes.empty() && options.gyroscopes.size() != options.sensors.size())
    return Error{Errc::invalid_argument, "as many gyroscopes as accelerometers are expected"};
  for (const Triad& gyroscope : options.gyroscopes)
    if (gyroscope.x && gyroscope.axes() < 3)
      return Error{Errc::invalid_argument, gyroscope.name + ": a gyroscope needs three channels"};
  return check_live_times({options.rate_hz, options.start_s, options.lag_s, options.most_rate_hz});
}

/// The last row output, from which the turns are counted.
struct LastRow {
  double time_s = 0.0;
  std::optional<double> angle_rad{};
  double speed_radps = 0.0;
};

template <int S>
class LiveWheel final : public LiveAnalysis {
 public:
  explicit LiveWheel(const LiveWheelOptions& options)
      : options_(options),
        epochs_(vectors_of(options), {options.rate_hz, options.most_rate_hz}),
        pause_s_(options.start_s) {}

  [[nodiscard]] const std::vector<Channel>& columns() const override { return columns_; }

  [[nodiscard]] Status add(const Block& samples, Rows& out) override {
    out.channels.resize(columns_.size());
    return epochs_.add(samples, [&](const LiveEpoch& epoch) { take(epoch, out); });
  }

  [[nodiscard]] Status finish(Rows& out) override {
    out.channels.resize(columns_.size());
    epochs_.finish([&](const LiveEpoch& epoch) { take(epoch, out); });
    if (!search_.valid() && !filter_ && !gathered_.empty()) look();
    if (search_.valid()) adopt(out);
    return Done{};
  }

  [[nodiscard]] std::vector<Note> take_notes() override {
    for (Note& note : epochs_.take_notes()) notes_.push_back(std::move(note));
    return std::exchange(notes_, {});
  }

 private:
  void take(const LiveEpoch& epoch, Rows& out) {
    if (epoch.anew) {
      last_ = {};
      resume_s_ = -std::numeric_limits<double>::infinity();
      forget();
    }
    if (filter_) follow(epoch, out);
    if (gathering_ && epoch.time_s >= resume_s_) gather(epoch);
    if (search_.valid()) {
      if (epoch.time_s >= adopt_s_) adopt(out);
    } else if (gathering_ && !gathered_.empty() && is_due()) {
      look();
    }
  }

  void forget() {
    search_ = {};
    filter_.reset();
    gathered_.clear();
    given_rad_.clear();
    gathering_ = true;
    saw_turn_ = false;
  }

  void follow(const LiveEpoch& epoch, Rows& out) {
    filter_->step(epoch);
    if (!filter_->is_lost()) return give(epoch.time_s, out);
    notes_.push_back({Severity::warning, "the wheel was lost at " + at_second(epoch.time_s) +
                                             " s and is searched again: turns may be lost"});
    turns_std_rad_ += std::max(rad_per_turn, filter_->std_before_rad());
    unseen_jerk_psd_ = filter_->unseen_jerk_psd();
    forget();
  }

  /// Begins with a measurement, at which the search gives angle and speed.
  void gather(const LiveEpoch& epoch) {
    bool is_measured = false;
    for (int s = 0; s < S; ++s) is_measured |= epoch.has(static_cast<std::size_t>(s));
    if (gathered_.empty() && !is_measured) return;
    gathered_.push_back(epoch);
    given_rad_.push_back(filter_ ? *last_.angle_rad : std::numeric_limits<double>::quiet_NaN());
    const bool is_long = epoch.time_s - gathered_.front().time_s >= longest_start_s;
    if (!filter_ || search_.valid() || !is_long) return;
    const auto half = static_cast<std::ptrdiff_t>(gathered_.size() / 2);
    gathered_.erase(gathered_.begin(), gathered_.begin() + half);
    given_rad_.erase(given_rad_.begin(), given_rad_.begin() + half);
    gathered_from_rad_ = filter_->angle_rad();
  }

  /// Without a filter: enough samples are collected. With one: the wheel has made a full turn, or
  /// its speed has changed before the sensors' lever arms were known.
  [[nodiscard]] bool is_due() {
    const double now_s = gathered_.back().time_s;
    if (!filter_) return now_s - gathered_.front().time_s >= options_.start_s;
    if (filter_->places_std_rad() > open_angle_rad && now_s - looked_s_ > look_pause_s_)
      return true;
    if (!saw_turn_) return std::abs(filter_->angle_rad() - gathered_from_rad_) > 1.1 * rad_per_turn;
    const double speed = filter_->speed_radps();
    slowest_radps_ = std::min(slowest_radps_, speed);
    fastest_radps_ = std::max(fastest_radps_, speed);
    const double most = std::max(std::abs(slowest_radps_), std::abs(fastest_radps_));
    if (fastest_radps_ - slowest_radps_ < std::max(significant_change * most, 0.2))
      changed_s_ = now_s;
    return now_s - changed_s_ >= watch_change_s;
  }

  /// The search takes about a second of a processor, and samples do not wait for it. Its result is
  /// used from a fixed time on, however long it took, so that the rows are reproducible.
  void look() {
    looked_s_ = gathered_.back().time_s;
    look_pause_s_ = filter_ ? std::min(2.0 * look_pause_s_, longest_pause_s) : least_pause_s;
    adopt_s_ = looked_s_ + search_s;
    search_ = std::async(std::launch::async, [gathered = gathered_, options = options_] {
      return find_wheel(gathered, options);
    });
  }

  void adopt(Rows& out) {
    const bool settling = filter_.has_value();
    const auto start = search_.get();
    if (start) run_from(*start, out);
    if (!settling && (!start || filter_->is_lost())) return wait(start ? nullptr : &start.error());
    saw_turn_ = saw_turn_ || (start && start->whole_turn) ||
                std::abs(filter_->angle_rad() - gathered_from_rad_) > rad_per_turn;
    changed_s_ = gathered_.back().time_s;
    slowest_radps_ = fastest_radps_ = filter_->speed_radps();
    if (start) say(start->notes);
    gathering_ = !saw_turn_ || !filter_->knows_places();
    if (gathering_) return;
    gathered_ = {};
    given_rad_ = {};
  }

  void say(const std::vector<Note>& notes) {
    for (const Note& note : notes) say_once(note);
    if (saw_turn_ && !filter_->knows_places())
      say_once({Severity::warning,
                "where the sensors are on the wheel is not known: until its speed has changed the "
                "angle is less certain",
                options_.wheel.radius_m ? std::vector<Advice>{} : std::vector{Advice{"radius"}}});
  }

  void say_once(const Note& note) {
    if (std::ranges::find(said_, note.text) != said_.end()) return;
    said_.push_back(note.text);
    notes_.push_back(note);
  }

  /// A failed search costs as much as a successful one: the pause before the next doubles.
  void wait(const Error* why) {
    notes_.push_back(
        {Severity::warning, "no wheel found up to " + at_second(gathered_.back().time_s) + " s" +
                                (why != nullptr ? ": " + why->message : std::string())});
    resume_s_ = gathered_.back().time_s + pause_s_ - options_.start_s;
    pause_s_ = std::min(2.0 * pause_s_, longest_pause_s);
    forget();
  }

  /// Filters the collected samples, and outputs the rows not yet output.
  void run_from(const LiveWheelStart& start, Rows& out) {
    const double span_s = gathered_.back().time_s - gathered_.front().time_s;
    const double rate_hz = static_cast<double>(gathered_.size() - 1) / span_s;
    filter_.emplace(options_, start,
                    static_cast<std::size_t>(std::lround(options_.lag_s * rate_hz)));
    double apart_rad = 0.0;   // between the new filter and the output, at the last row
    double widest_rad = 0.0;  // standard deviation of the new filter's angle
    for (std::size_t k = 0; k < gathered_.size(); ++k) {
      const double time_s = gathered_[k].time_s;
      filter_->step(gathered_[k]);
      widest_rad = std::max(widest_rad, filter_->row().angle_rad.std);
      if (k == 0) {
        gathered_from_rad_ = filter_->angle_rad();
        count_on(time_s);
      }
      if (std::isnan(given_rad_[k])) {
        given_rad_[k] = filter_->angle_rad() + turned_rad_;
        give(time_s, out);
      } else {
        apart_rad = filter_->angle_rad() + turned_rad_ - given_rad_[k];
      }
    }
    // Where the output was less certain than that, it has stated so.
    const bool was_open = std::abs(apart_rad) < 3.0 * widest_std_rad_ && widest_rad < certain_rad;
    if (std::abs(apart_rad) > 0.5 * rad_per_turn && !was_open) say_slipped(apart_rad);
    widest_std_rad_ = widest_rad;
    if (options_.wheel.radius_m) filter_->use_radius(*options_.wheel.radius_m);
  }

  /// One of two filters of the same samples has slipped; which one is not observable.
  void say_slipped(double apart_rad) {
    const double turns = std::max(std::round(std::abs(apart_rad) / rad_per_turn), 1.0);
    turns_std_rad_ += turns * rad_per_turn;
    notes_.push_back({Severity::warning,
                      "at " + at_second(gathered_.back().time_s) + " s the count changes by " +
                          std::to_string(static_cast<int>(turns)) +
                          (turns > 1.0 ? " turns" : " turn") + ": readings since " +
                          at_second(gathered_.front().time_s) +
                          " s fit both counts, and turns may be lost"});
  }

  /// Accelerometers do not determine whole turns: continues from the output at the first epoch, or
  /// the nearest to the last known angle.
  void count_on(double time_s) {
    turned_rad_ = 0.0;
    if (!last_.angle_rad) return;
    double here = given_rad_.front();
    if (std::isnan(here)) {
      const double since_s = time_s - last_.time_s;
      here = *last_.angle_rad + last_.speed_radps * since_s;
      turns_std_rad_ =
          std::hypot(turns_std_rad_, std::sqrt(unseen_jerk_psd_ * std::pow(since_s, 5) / 20.0));
    }
    turned_rad_ = rad_per_turn * std::round((here - filter_->angle_rad()) / rad_per_turn);
  }

  void give(double time_s, Rows& out) {
    const LiveWheelRow row = filter_->row();
    last_ = {time_s, row.angle_rad.value + turned_rad_, row.speed_radps.value};
    widest_std_rad_ = std::max(widest_std_rad_, row.angle_rad.std);
    out.stamps_s.push_back(time_s);
    const std::array values{*last_.angle_rad,
                            std::hypot(row.angle_rad.std, turns_std_rad_),
                            row.speed_radps.value,
                            row.speed_radps.std,
                            row.smoothed_time_s,
                            row.smoothed_angle_rad.value + turned_rad_,
                            std::hypot(row.smoothed_angle_rad.std, turns_std_rad_),
                            row.smoothed_speed_radps.value,
                            row.smoothed_speed_radps.std,
                            row.nis};
    for (std::size_t i = 0; i < values.size(); ++i) out.channels[i].push_back(values[i]);
  }

  LiveWheelOptions options_;
  LiveEpochs epochs_;
  std::vector<Channel> columns_ = wheel_columns();
  std::optional<LiveWheelFilter<S>> filter_;
  std::vector<LiveEpoch> gathered_;  ///< for the search
  std::future<Result<LiveWheelStart>> search_;
  double adopt_s_ = 0.0;           ///< when the search result is used
  std::vector<double> given_rad_;  ///< the angle given for each of them; NaN: none yet
  bool gathering_ = true, saw_turn_ = false;
  double slowest_radps_ = 0.0, fastest_radps_ = 0.0;  ///< since initialisation
  double looked_s_ = 0.0, look_pause_s_ = least_pause_s;
  double changed_s_ = 0.0;          ///< time until which the speed was constant
  double gathered_from_rad_ = 0.0;  ///< the filter's angle at the first of them, or a later one
  double pause_s_, resume_s_ = -std::numeric_limits<double>::infinity();
  LastRow last_;
  double turned_rad_ = 0.0;       ///< whole turns between what is given and the filter's angle
  double widest_std_rad_ = 0.0;   ///< given since the filter started, without that of whole turns
  double turns_std_rad_ = 0.0;    ///< of the whole turns given, since the wheel was lost
  double unseen_jerk_psd_ = 0.0;  ///< of the filter that lost it
  std::vector<Note> notes_;
  std::vector<std::string> said_;
};

}  // namespace

Result<std::unique_ptr<LiveAnalysis>> live_wheel(const LiveWheelOptions& options) {
  if (auto status = check(options); !status) return status.error();
  std::unique_ptr<LiveAnalysis> analysis;
  if (options.sensors.size() == 1)
    analysis = std::make_unique<LiveWheel<1>>(options);
  else
    analysis = std::make_unique<LiveWheel<2>>(options);
  return analysis;
}

}  // namespace proofmass::estimate
