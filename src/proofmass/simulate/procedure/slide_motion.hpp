#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "proofmass/simulate/procedure.hpp"
#include "proofmass/simulate/procedure/pose_motion.hpp"
#include "proofmass/simulate/procedure/pose_plan.hpp"
#include "proofmass/simulate/procedure/sensor_error_model.hpp"

namespace proofmass::simulate {

/// State of the carriage at one time.
struct SlideState {
  double along_m = 0.0, velocity_mps = 0.0, accel_mps2 = 0.0;
  std::size_t stroke = 0;  ///< number of the current stroke; 0: none
  std::size_t rest = 0;    ///< number of the rest; 0: none
  double turn_rad = 0.0;   ///< rotation from the attitude at the first rest
  /// In the sensor's axes: its motion, and the gravity part of the force.
  SensorMotion motion;
  Eigen::Vector3d gravity_mps2 = Eigen::Vector3d::Zero();
};

/// Motion of a sensor on a slide at any time: exact rest between the strokes, and strokes of the
/// selected profile, with rotation, wobble and vibration as configured.
class SlideMotion {
 public:
  explicit SlideMotion(const ProcedureOptions& options);

  [[nodiscard]] SlideState at(double t_s) const;
  [[nodiscard]] const std::vector<PlannedPose>& rests() const { return rests_; }
  [[nodiscard]] const std::vector<TrueStroke>& strokes() const { return strokes_; }
  /// Direction of the line in the sensor's axes at the first rest.
  [[nodiscard]] Eigen::Vector3d line() const;

 private:
  void plan(const ProcedureOptions& options);
  [[nodiscard]] std::size_t last_rest(double t_s) const;
  [[nodiscard]] Eigen::Vector3d turn_at(std::size_t rest, double t_s) const;
  void move_along(double t_s, SlideState& state) const;
  /// The attitude, with the rates set in `state`.
  [[nodiscard]] Eigen::Matrix3d rotate(std::size_t rest, double t_s, SlideState& state) const;

  ProcedureSlide slide_;
  double gravity_mps2_;
  std::vector<PlannedPose> rests_;
  std::vector<Eigen::Vector3d> turns_rad_;  ///< rotation of each rest from the mounting
  std::vector<TrueStroke> strokes_;
  Eigen::Vector3d direction_;  ///< direction of the line; z upwards
  Eigen::Matrix3d mounting_;   ///< from the sensor's axes
  bool turns_ = false;
  TripleNoise wobble_, vibration_;
};

}  // namespace proofmass::simulate
