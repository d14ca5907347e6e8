#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>

#include "proofmass/simulate/procedure.hpp"
#include "proofmass/simulate/rig/bias_noise.hpp"
#include "proofmass/simulate/rig/converter.hpp"

namespace proofmass::simulate {

/// Motion of a sensor, in its own axes.
struct SensorMotion {
  Eigen::Vector3d force_mps2 = Eigen::Vector3d::Zero();
  Eigen::Vector3d omega_radps = Eigen::Vector3d::Zero();
  Eigen::Vector3d omega_dot_radps2 = Eigen::Vector3d::Zero();
};

/// The sensor of a procedure with all values drawn for it from the seed.
class SensorErrorModel {
 public:
  explicit SensorErrorModel(const ProcedureOptions& options);

  /// Reading in m/s² without drift and noise.
  [[nodiscard]] double reading_mps2(std::size_t axis, const SensorMotion& motion) const;
  /// Clipped, scaled by the supply, converted.
  [[nodiscard]] double recorded(std::size_t axis, double reading_mps2, double noise_mps2) const;
  /// The same for means: without the converter.
  [[nodiscard]] double mean_recorded(std::size_t axis,
                                     double reading_mps2,
                                     double noise_mps2) const;
  /// Noise of 1 m/s² in the recording's unit.
  [[nodiscard]] double noise_gain() const;
  /// True if angular rates affect the reading.
  [[nodiscard]] bool feels_rates() const;

  [[nodiscard]] const std::array<sensor::ModelEquation, 3>& equations() const { return reading_; }
  /// See ProcedureTruth::equations.
  [[nodiscard]] std::array<sensor::ModelEquation, 3> recorded_equations() const;
  /// See ProcedureTruth::sensor.
  [[nodiscard]] sensor::SensorModel model() const;

 private:
  [[nodiscard]] double volts(std::size_t axis, double reading_mps2, double noise_mps2) const;
  [[nodiscard]] double unrounded(double v) const;

  ProcedureOptions options_;
  std::array<sensor::ModelEquation, 3> reading_;
  RecordedOutput output_;
};

/// The drift of one axis, per sample or as means over intervals.
class BenchDrift {
 public:
  BenchDrift(const ProcedureOptions& options, std::size_t axis, std::size_t trial);
  /// At t_s, not before the last time requested.
  double at(double t_s);
  /// Mean from start_s to end_s, not before the last time requested.
  double mean_over(double start_s, double end_s);

 private:
  const ProcedureSensor& sensor_;
  std::size_t axis_;
  double now_s_ = 0.0;
  BiasNoise noise_;
};

/// The linear part of three equations: E = M f + b.
[[nodiscard]] Eigen::Matrix3d linear_part(const std::array<sensor::ModelEquation, 3>& equations);

}  // namespace proofmass::simulate
