#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "proofmass/core/recording.hpp"
#include "proofmass/estimate/filter/gaussian.hpp"
#include "proofmass/estimate/wheel/live_epochs.hpp"
#include "proofmass/signal/running_rests.hpp"

// Whether the sensor was at rest at an epoch, as soon as it is determined.
namespace proofmass::estimate {

/// A measurement of all axes, and whether the sensor was at rest.
struct LiveReading {
  double time_s = 0.0;
  Mat<3> accel_mps2 = Mat<3>::Zero();
  bool resting = false;
};

/// The newest rest.
struct LiveRest {
  double since_s = 0.0, until_s = -1.0;
  Mat<3> level_mps2 = Mat<3>::Zero();
  Mat<3> white_m2ps3 = Mat<3>::Zero();  ///< N², of each axis
  double behind_level_s = 0.0;          ///< averaging time of the level
};

/// Holds epochs back until that is determined.
class LiveTrackRests {
 public:
  explicit LiveTrackRests(const Triad& sensor);

  /// Calls visit(const LiveReading&) for those determined by now, in their order.
  template <class Visit>
  void add(const LiveEpoch& epoch, Visit&& visit) {
    if (!take(epoch)) return;
    release(known_until_s(), visit);
  }
  /// Visits the epochs still held; after the last known rest they count as motion.
  template <class Visit>
  void finish(Visit&& visit) {
    release(last_s_, visit);
  }

  [[nodiscard]] const LiveRest& rest() const { return rest_; }
  /// Recent step of the measurements; 0 before the second.
  [[nodiscard]] double step_s() const { return step_s_; }
  [[nodiscard]] std::vector<Note> take_notes();

 private:
  [[nodiscard]] bool take(const LiveEpoch& epoch);
  [[nodiscard]] double known_until_s();
  [[nodiscard]] bool look_at_rest(const signal::RestState& state);
  [[nodiscard]] Mat<3> white_of_rest(const signal::RestState& state) const;

  template <class Visit>
  void release(double until_s, Visit& visit) {
    std::size_t given = 0;
    for (; given < held_.size() && held_[given].time_s <= until_s; ++given) {
      LiveReading& reading = held_[given];
      reading.resting = reading.time_s >= rest_.since_s && reading.time_s <= rest_.until_s;
      visit(static_cast<const LiveReading&>(reading));
    }
    held_.erase(held_.begin(), held_.begin() + static_cast<std::ptrdiff_t>(given));
  }

  std::string name_;
  std::vector<Eigen::Index> axes_;  ///< axes present
  signal::RunningRests rests_;
  std::vector<LiveReading> held_;
  LiveRest rest_;
  double quietest_m2ps3_ = 0.0;  ///< N² of the quietest rest, over its axes
  std::size_t refused_ = 0;      ///< blocks too loud for a rest
  double last_s_ = 0.0, step_s_ = 0.0, steps_ = 0.0;
  bool any_ = false, stuck_ = false;
  std::vector<Note> notes_;
};

}  // namespace proofmass::estimate
