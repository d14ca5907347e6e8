#include "proofmass/servo/loop/feedback.hpp"

#include <array>
#include <cmath>

#include "proofmass/servo/loop/observer.hpp"

namespace proofmass::servo {
namespace {

// Columns of the rig with an encoder and two sensors.
enum Column : std::size_t { voltage, current, encoder, x1, y1, x2, y2 };

// Opposite sensors with parallel axes: centripetal and tangential acceleration cancel.
std::array<double, 2> mean_of(const std::vector<double>& row) {
  return {0.5 * (row[x1] + row[x2]), 0.5 * (row[y1] + row[y2])};
}

// Speed by differences of the angle through a low-pass, as controllers do.
class Differences {
 public:
  explicit Differences(double step_s) : step_s_(step_s) {}
  double next(double angle_rad) {
    constexpr double filter_s = 0.02;
    if (!started_) last_ = angle_rad;
    started_ = true;
    const double share = step_s_ / (filter_s + step_s_);
    speed_ += share * ((angle_rad - last_) / step_s_ - speed_);
    last_ = angle_rad;
    return speed_;
  }

 private:
  double step_s_, last_ = 0.0, speed_ = 0.0;
  bool started_ = false;
};

class FromEncoder : public Source {
 public:
  explicit FromEncoder(const simulate::MotorOptions& rig)
      : start_rad_(rig.start_angle_rad), speed_(1.0 / rig.rate_hz) {}
  FedBack take(const std::vector<double>& row, double) override {
    const double angle = start_rad_ + row[encoder];
    return {angle, speed_.next(angle), row[current]};
  }

 private:
  double start_rad_;
  Differences speed_;
};

class FromAtan2 : public Source {
 public:
  explicit FromAtan2(const simulate::MotorOptions& rig) : speed_(1.0 / rig.rate_hz) {}
  FedBack take(const std::vector<double>& row, double) override {
    const auto [x, y] = mean_of(row);
    angle_rad_ += std::remainder(std::atan2(x, y) - angle_rad_, rad_per_turn);
    return {angle_rad_, speed_.next(angle_rad_), row[current]};
  }

 private:
  double angle_rad_ = 0.0;
  Differences speed_;
};

// The tangential difference, its bias as the mean over the first two seconds, at rest.
class FromIntegration : public Source {
 public:
  explicit FromIntegration(const simulate::MotorOptions& rig)
      : step_s_(1.0 / rig.rate_hz),
        radius_m_(rig.sensors.front().radius_m),
        angle_rad_(rig.start_angle_rad) {}
  FedBack take(const std::vector<double>& row, double) override {
    constexpr double rest_s = 2.0;
    const double accel = 0.5 * (row[y1] - row[y2]) / radius_m_;
    if (time_s_ < rest_s - 0.5 * step_s_) {
      sum_ += accel;
      ++count_;
    } else {
      const double next = speed_ + step_s_ * (accel - sum_ / count_);
      angle_rad_ += 0.5 * step_s_ * (speed_ + next);
      speed_ = next;
    }
    time_s_ += step_s_;
    return {angle_rad_, speed_, row[current]};
  }

 private:
  double step_s_, radius_m_, angle_rad_, speed_ = 0.0, time_s_ = 0.0, sum_ = 0.0;
  int count_ = 0;
};

class FromObserver : public Source {
 public:
  FromObserver(const MotorModel& model, const simulate::MotorOptions& rig)
      : observer_({.model = model,
                   .step_s = 1.0 / rig.rate_hz,
                   .gravity_mps2 = rig.gravity_mps2,
                   .accel_std_mps2 = 0.0184 / std::sqrt(2.0),
                   .bias_std_mps2 = rig.bias_spread_mps2 / std::sqrt(6.0),
                   .current_std_a = rig.current_noise_a},
                  0.0) {}
  FedBack take(const std::vector<double>& row, double voltage_v) override {
    const auto mean = mean_of(row);
    if (!started_) {
      // The first angle is that of gravity.
      shift_rad_ = std::atan2(mean[0], mean[1]);
      started_ = true;
    } else {
      observer_.predict(voltage_v);
    }
    // In coordinates turned to the start, so that the observer starts at zero.
    const double c = std::cos(shift_rad_), s = std::sin(shift_rad_);
    observer_.update({.current_a = row[current],
                      .accel_mps2 = {c * mean[0] - s * mean[1], s * mean[0] + c * mean[1]}});
    return {shift_rad_ + observer_.load_rad().value, observer_.speed_radps().value,
            observer_.current_a()};
  }

 private:
  MotorObserver observer_;
  double shift_rad_ = 0.0;
  bool started_ = false;
};

}  // namespace

std::unique_ptr<Source> source_of(Feedback feedback,
                                  const MotorModel& model,
                                  const simulate::MotorOptions& rig) {
  switch (feedback) {
    case Feedback::live_estimate:
      return std::make_unique<FromObserver>(model, rig);
    case Feedback::double_integration:
      return std::make_unique<FromIntegration>(rig);
    case Feedback::atan2:
      return std::make_unique<FromAtan2>(rig);
    case Feedback::encoder:
      return std::make_unique<FromEncoder>(rig);
  }
  return nullptr;
}

}  // namespace proofmass::servo
