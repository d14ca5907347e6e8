#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <vector>

#include "proofmass/core/random.hpp"
#include "proofmass/simulate/band_limited_noise.hpp"
#include "proofmass/simulate/procedure/pose_plan.hpp"
#include "proofmass/simulate/procedure/sensor_error_model.hpp"

namespace proofmass::simulate {

/// Noise along three axes as a function of time.
class TripleNoise {
 public:
  TripleNoise(double rms, double bandwidth_hz, const ProcedureOptions& options, const char* name);
  [[nodiscard]] Eigen::Vector3d at(double t_s) const;

 private:
  std::array<BandLimitedNoise, 3> axes_;
};

/// Motion of the sensor at any time of a procedure: exact rest in every position after settling,
/// and smooth rotations in between, by the table or by hand (lifting, sway, tremor, setting down).
/// Force and rates are continuous.
class PoseMotion {
 public:
  PoseMotion(const ProcedureOptions& options, std::vector<PlannedPose> plan, bool with_rates);
  [[nodiscard]] SensorMotion at(double t_s) const;
  /// Number of the position whose rest contains t_s; 0 between rests.
  [[nodiscard]] std::size_t rest_at(double t_s) const;
  /// The current position, or the next one while moving.
  [[nodiscard]] const PlannedPose& aimed_at(double t_s) const;
  /// An angle of the table given per position; in between it follows the table.
  [[nodiscard]] double moving_rad(double PlannedPose::* angle, double t_s) const;

 private:
  /// A half-sine of force that begins and ends at 0.
  struct Shock {
    double start_s, duration_s;
    Eigen::Vector3d peak_mps2;
  };
  /// Random values of the move to a position and of its settling.
  struct Arrival {
    std::vector<Shock> shocks;
    Eigen::Vector3d ringing_mps2;
    double ringing_radps;
  };

  [[nodiscard]] std::size_t last_stood(double t_s) const;
  [[nodiscard]] SensorMotion on_table(std::size_t next, double t_s) const;
  [[nodiscard]] SensorMotion in_hand(std::size_t next, double t_s) const;
  [[nodiscard]] Eigen::Vector3d up_in_hand(std::size_t next, double t_s) const;
  [[nodiscard]] Eigen::Vector3d omega_in_hand(std::size_t next, double t_s) const;
  [[nodiscard]] Eigen::Vector3d ringing(std::size_t pose, double t_s) const;
  void draw_arrivals(const ProcedureOptions& options);

  std::vector<PlannedPose> plan_;
  std::vector<Arrival> arrivals_;
  ProcedureHand hand_;
  double radius_m_, axis_tilt_rad_;
  bool with_rates_;
  TripleNoise sway_, tremor_, wobble_, motor_;
};

}  // namespace proofmass::simulate
