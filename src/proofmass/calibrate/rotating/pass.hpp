#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "proofmass/calibrate/rotating/encoder_zero.hpp"
#include "proofmass/calibrate/rotating/harmonics.hpp"
#include "proofmass/calibrate/rotating/phase_spline.hpp"
#include "proofmass/calibrate/rotating/turns.hpp"

// Passes over the samples of a rotating wheel: normal equations and the scatter of their gradient.
namespace proofmass::calibrate {

/// Input of the passes, and the current state of the fit.
struct RotationState {
  View<RotationRecording> recordings;
  std::vector<SteadyTurns> sections;
  bool angle_given = false;
  EncoderZero zero = EncoderZero::sensor;
  bool phase_defined = false;     ///< by the first axis, whose C1 is zero then
  bool speed_determined = false;  ///< ω² varies enough for its column
  bool delay_determined = false;  ///< with an encoder: ω varies enough for the delay's column
  std::size_t axes = 1;

  std::vector<PhaseSpline> splines;  ///< of each section, counted in radians
  std::vector<Ripple> ripples;       ///< of each section; empty where an encoder gives the angle
  std::vector<double> sense;         ///< of each section: sign of the encoder's speed
  double mean_square_speed = 0.0;    ///< ω̄²
  double direction = 1.0;            ///< φ = offset + direction · θ
  std::array<double, 2> offset{};    ///< of each axis
  std::array<Harmonics, 2> harmonics{Harmonics::Zero(), Harmonics::Zero()};
  std::array<double, 2> variance{1.0, 1.0};  ///< of each axis's residuals

  [[nodiscard]] Eigen::Index size() const {
    return harmonic_count * static_cast<Eigen::Index>(axes);
  }
  /// Whether a harmonic is fitted: not the first axis's C1 if it defines the phase.
  [[nodiscard]] bool fitted(Eigen::Index column) const {
    const Eigen::Index k = column % harmonic_count;
    if (k == square_speed_column) return speed_determined;
    if (k == delay_column) return delay_determined;
    if (k > square_speed_column) return !angle_given;
    return !phase_defined || column != 2;
  }
};

/// One sample of a section.
struct RotationSample {
  std::size_t section = 0, k = 0;
  PhaseSpline::Local local;
  double theta = 0.0;  ///< rad
  double speed_squared = 0.0;
  double relative_acceleration = 0.0;  ///< φ̈/ω̄² by the ripple
  double relative_speed = 0.0;         ///< φ̇/√ω̄², with its sign; with an encoder only
};

/// Sets angle and speed, including the ripple.
void place(const RotationState& state, const RotationRecording& recording, RotationSample& sample);

/// Calls f(recording, sample) for each sample of the steady sections.
template <class F>
void for_each_sample(const RotationState& state, F&& f) {
  for (std::size_t s = 0; s < state.sections.size(); ++s) {
    const SteadyTurns& section = state.sections[s];
    const RotationRecording& recording = state.recordings[section.recording];
    for (std::size_t k = section.first; k <= section.last; ++k) {
      RotationSample sample{
          .section = s, .k = k, .local = state.splines[s].at(recording.time_s[k])};
      place(state, recording, sample);
      if (std::isfinite(sample.theta)) f(recording, sample);
    }
  }
}

/// Distance from the axle on which r φ̈ acts along an axis, in the unit of its term in ω²: along the
/// first axis that of the second, with its sign reversed. 0 if it is not determined.
[[nodiscard]] double tangential_distance(const RotationState& state, std::size_t axis);

/// An axis's columns, its residual and ∂E/∂θ at a sample; the residual is NaN without a
/// measurement.
struct AxisAt {
  Harmonics columns;
  double residual = 0.0, slope = 0.0;
};
[[nodiscard]] AxisAt axis_at(const RotationState& state,
                             std::size_t axis,
                             const RotationSample& sample,
                             double reading);

/// JᵀWJ and JᵀWr, the spline's part by sections.
struct RotationNormal {
  Eigen::MatrixXd H;
  Eigen::VectorXd g;
  struct Section {
    Eigen::MatrixXd cross;  ///< harmonics × spline
    Eigen::MatrixXd H;
    Eigen::VectorXd g;
  };
  std::vector<Section> sections;  ///< empty where the angle is given
  std::array<double, 2> squares{};
  std::array<std::size_t, 2> count{};
};
[[nodiscard]] RotationNormal normal_equations(const RotationState& state);

/// Elimination of the spline: δ = S⁻¹ (g − Σ cross H⁻¹ g_s).
struct RotationSolver {
  Eigen::MatrixXd inverse;                   ///< S⁻¹; zero where a harmonic is not fitted
  std::vector<Eigen::MatrixXd> elimination;  ///< cross H⁻¹ of each section
  std::vector<Eigen::MatrixXd> spline_inverse;
};
[[nodiscard]] RotationSolver make_solver(const RotationState& state, const RotationNormal& normal);

/// One Gauss–Newton step; without `move_phase` the harmonics alone. Returns the largest change: of
/// the phase in radians, of harmonics relative to S1.
double step(RotationState& state, bool move_phase);

/// The gradient of each block of turns with the spline eliminated, times S⁻¹: one column a block.
struct BlockScores {
  Eigen::MatrixXd scores;            ///< harmonics × blocks
  Eigen::MatrixXd gradients;         ///< the same before S⁻¹
  std::vector<std::size_t> section;  ///< of each block
  double turns_per_block = 0.0;
};
[[nodiscard]] BlockScores block_scores(const RotationState& state, const RotationSolver& solver);

}  // namespace proofmass::calibrate
