#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "proofmass/calibrate/phase_spline.hpp"
#include "proofmass/calibrate/rotation_turns.hpp"

// Passes over the samples of a wheel that turns: normal equations and the scatter of their
// gradient.
namespace proofmass::calibrate {

/// B0, S1, C1, S2, C2, S3, C3 and that of −(ω²/ω̄² − 1).
using Harmonics = Eigen::Matrix<double, 8, 1>;
inline constexpr Eigen::Index harmonic_count = 8;

/// What the passes go over, and where the fit stands.
struct RotationState {
  View<RotationRecording> recordings;
  std::vector<SteadyTurns> sections;
  bool angle_given = false;
  bool phase_defined = false;  ///< by the first axis, whose C1 is zero then
  bool speed_told = false;     ///< ω² varies enough for its column
  std::size_t axes = 1;

  std::vector<PhaseSpline> splines;  ///< of each section, counted in radians
  double mean_square_speed = 0.0;    ///< ω̄²
  double direction = 1.0;            ///< φ = offset + direction · θ
  std::array<double, 2> offset{};    ///< of each axis
  std::array<Harmonics, 2> harmonics{Harmonics::Zero(), Harmonics::Zero()};
  std::array<double, 2> variance{1.0, 1.0};  ///< of each axis's residuals

  [[nodiscard]] Eigen::Index size() const {
    return harmonic_count * static_cast<Eigen::Index>(axes);
  }
  /// Whether a harmonic is fitted: not the first axis's C1 where it defines the phase.
  [[nodiscard]] bool fitted(Eigen::Index column) const {
    return (!phase_defined || column != 2) && (speed_told || column % harmonic_count != 7);
  }
};

/// One sample of a section.
struct RotationSample {
  std::size_t section = 0, k = 0;
  PhaseSpline::Local local;
  double theta = 0.0;  ///< rad
  double speed_squared = 0.0;
};

/// Calls f(recording, sample) for each sample of the steady sections.
template <class F>
void for_each_sample(const RotationState& state, F&& f) {
  for (std::size_t s = 0; s < state.sections.size(); ++s) {
    const SteadyTurns& section = state.sections[s];
    const RotationRecording& recording = state.recordings[section.recording];
    for (std::size_t k = section.first; k <= section.last; ++k) {
      RotationSample sample{s, k, state.splines[s].at(recording.time_s[k]), 0.0, 0.0};
      const double speed = state.splines[s].slope_per_s(sample.local);
      sample.speed_squared = speed * speed;
      sample.theta =
          state.angle_given ? recording.angle_rad[k] : state.splines[s].value(sample.local);
      if (std::isfinite(sample.theta)) f(recording, sample);
    }
  }
}

/// The columns of one axis at phase φ.
[[nodiscard]] Harmonics columns_at(double phase, double relative_square_speed);

/// ∂E/∂φ.
[[nodiscard]] double slope_at(const Harmonics& columns, const Harmonics& harmonics);

/// An axis's columns, its residual and ∂E/∂θ at a sample; no number in the residual where the
/// reading is none.
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

/// What eliminates the spline: δ = S⁻¹ (g − Σ cross H⁻¹ g_s).
struct RotationSolver {
  Eigen::MatrixXd inverse;                   ///< S⁻¹; zero where a harmonic is not fitted
  std::vector<Eigen::MatrixXd> elimination;  ///< cross H⁻¹ of each section
  std::vector<Eigen::MatrixXd> spline_inverse;
};
[[nodiscard]] RotationSolver make_solver(const RotationState& state, const RotationNormal& normal);

/// One step of Gauss and Newton; without `move_phase` the harmonics alone. Returns the largest
/// change: of the phase in radians, of harmonics relative to S1.
double step(RotationState& state, bool move_phase);

/// The gradient of each block of turns with the spline eliminated, times S⁻¹: one column a block.
struct BlockScores {
  Eigen::MatrixXd scores;            ///< harmonics × blocks
  std::vector<std::size_t> section;  ///< of each block
  double turns_per_block = 0.0;
};
[[nodiscard]] BlockScores block_scores(const RotationState& state, const RotationSolver& solver);

}  // namespace proofmass::calibrate
