#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "proofmass/core/quantity.hpp"
#include "proofmass/estimate/filter/fixed_lag.hpp"
#include "proofmass/estimate/wheel/gyro_jerk.hpp"
#include "proofmass/estimate/wheel/live_start.hpp"

// The parallel filters of an online wheel.
namespace proofmass::estimate {

/// Output for one epoch.
struct LiveWheelRow {
  Uncertain angle_rad{}, speed_radps{};
  double smoothed_time_s = std::numeric_limits<double>::quiet_NaN();
  Uncertain smoothed_angle_rad{}, smoothed_speed_radps{};
  double nis = 0.0;
};

template <int S>
class LiveWheelFilter {
 public:
  static constexpr int states = wheel::states(S), first_place = wheel::places(S);

  LiveWheelFilter(const LiveWheelOptions& options,
                  const LiveWheelStart& start,
                  std::size_t lag_epochs);
  LiveWheelFilter(const LiveWheelFilter&) = delete;
  LiveWheelFilter& operator=(const LiveWheelFilter&) = delete;

  /// Processes one epoch. Does not allocate.
  void step(const LiveEpoch& epoch);
  /// Sets the sensors' distance from the axle, once the initial samples have been filtered.
  void use_radius(double radius_m);
  /// Whether the lever arms are known well enough for the speed to change.
  [[nodiscard]] bool knows_places() const;
  /// Angle uncertainty due to the lever arms.
  [[nodiscard]] double places_std_rad() const { return std::sqrt(places_variance()(0)); }

  [[nodiscard]] LiveWheelRow row() const;
  /// Diverged beyond covariance inflation: the wheel must be reinitialised.
  [[nodiscard]] bool is_lost() const { return lost_; }
  /// Uncertainty of the angle before the last epoch's measurements.
  [[nodiscard]] double std_before_rad() const { return std_before_rad_; }
  /// Density of the white jerk, rad²/s⁵, where nothing is measured.
  [[nodiscard]] double unseen_jerk_psd() const;
  [[nodiscard]] double angle_rad() const { return main_.x.mean(wheel::angle); }
  [[nodiscard]] double speed_radps() const { return main_.x.mean(wheel::speed); }

 private:
  using Model = WheelModel<S>;
  static constexpr int places = 2 * S;
  /// Channels: u, v and the gyroscope of each sensor.
  using PerChannel = std::array<double, static_cast<std::size_t>(3 * S)>;
  /// Perturbation of a lever arm. The measurement is linear in it.
  static constexpr double place_step_m = 1e-3;
  /// The filter with one coordinate of the lever arms perturbed, and its fit to the measurements.
  struct Moved {
    FilterState<states> state;
    PerChannel innovations{};
  };
  /// Alternative noise parameters, and their gain in predicting the measurements of this interval.
  struct Rival {
    double factor = 1.0;
    FilterState<states> state{};
    double log_likelihood = 0.0;
  };
  /// Noise statistics of one sensor's measurements, or its gyroscope's, in an interval, as in
  /// settle_variance().
  struct Noise {
    double innovation2 = 0.0, explained = 0.0, readings = 0.0;

    void add(double nis, double expected, double variance);
    /// The variance moves half way (in logarithm) to this interval's estimate.
    void adapt(double& variance) const;
  };
  /// Smoothed squared innovations, for loosen().
  struct Recent {
    double sum = 0.0, channels = 0.0;  ///< of this epoch
    double mean = 0.0;

    void add(double innovation, double most2);
    void end_epoch();
  };
  /// Whether the corrections of the speed are white, as those of a filter whose model is right.
  /// Ripple, slips and the vibration of a vehicle give them the same sign for many epochs.
  struct Colour {
    double mean = 0.0;    ///< of the last corrections, each in its standard deviations
    double factor = 1.0;  ///< square of that mean, smoothed, against that of white corrections

    void add(double correction, double variance);
  };

  void narrow_constants(const Eigen::MatrixXd& found_cov);
  void hold_rolling_radius();
  void release_rolling_radius();
  [[nodiscard]] double significant_accel() const;
  void seat(int place);
  [[nodiscard]] bool is_unseen(const LiveEpoch& epoch) const;
  void learn_accel();
  void read(const LiveEpoch& epoch);
  void set_variance();
  void advance_all();
  void judge();
  void notice_surprise(double mean_nis);
  void loosen();
  void end_stretch();
  void forget_stretch();
  [[nodiscard]] double predicted_std_rad() const;
  [[nodiscard]] std::pair<Uncertain, Uncertain> motion_of(const Gaussian<3>& x,
                                                          const Mat<2>& by_places) const;
  // wheel/live_places.cpp, with what is public of the places:
  void expect();
  [[nodiscard]] bool shows_place(int sensor) const;
  void learn_place(const Mat<places>& slope, double residual, double variance);
  [[nodiscard]] Mat<2> places_variance() const;

  std::vector<WheelPlane> planes_;
  WheelReadings now_;  ///< two epochs: 0 the first, 1 any later; each sensor has one row
  Model model_;
  std::size_t epochs_ = 0;
  double time_s_ = 0.0;
  std::array<double, 2> variance_m2ps4_;                      ///< of each sensor's measurements
  std::array<std::optional<std::size_t>, 2> gyroscope_at_{};  ///< among an epoch's vectors
  std::vector<GyroJerk> jerks_;                               ///< one for each sensor
  /// At epoch 1, significant_accel(): see WheelModel::mean_accel.
  std::shared_ptr<std::vector<double>> hub_accel_ = std::make_shared<std::vector<double>>(2, 0.0);
  double rolling_std_m_ = 0.0;  ///< while it is held
  double alignment_variance_rad2_ = 0.0, delay_std_s_ = 0.0;

  FilterState<states> main_;
  StepOf<Model> step_, other_step_;
  std::array<Moved, static_cast<std::size_t>(2 * S)> moved_;
  Mat<places, places> places_cov_;
  std::array<Rival, 2> rivals_{};
  double main_log_likelihood_ = 0.0;

  /// Angle, speed and acceleration.
  FixedLag<states, 3> window_;
  std::vector<double> window_time_s_;
  std::vector<Mat<2>> window_places_;  ///< places_variance() at those times

  std::array<Noise, 2> noise_{}, speed_noise_{};
  PerChannel expected_{};  ///< squares of the innovations
  double first_time_s_ = 0.0, stretch_start_s_ = 0.0, nis_ = 0.0, since_loosened_s_ = 0.0;
  double std_before_rad_ = 0.0;
  double surprise_ = 1.0;  ///< smoothed NIS per channel
  Recent recent_, recent_speed_;
  Colour colour_;
  double accel2_ = 0.0;  ///< mean square of the acceleration, rad²/s⁴
  int loosened_ = 0;
  bool lost_ = false;
};

extern template class LiveWheelFilter<1>;
extern template class LiveWheelFilter<2>;

}  // namespace proofmass::estimate
