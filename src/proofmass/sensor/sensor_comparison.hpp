#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "proofmass/core/recording.hpp"
#include "proofmass/sensor/calibration_effect.hpp"
#include "proofmass/sensor/figure_list.hpp"
#include "proofmass/sensor/sensor_model.hpp"

// Tests whether a sensor has changed between two of its files.
namespace proofmass::sensor {

enum class Verdict {
  changed,      ///< by more than the uncertainty of the two figures
  same,         ///< within it
  unchanged,    ///< the same entry in both files
  cannot_tell,  ///< not decidable, see reason
  only_old,
  only_new,
  condition,  ///< conditions of the figures: compared, not tested
};

/// One figure in both files.
struct FigureComparison {
  FigureSlot before, after;
  std::string unit;              ///< SI unit of the members below
  std::optional<double> change;  ///< new − old
  std::optional<double> change_std;
  std::optional<double> p;           ///< probability of a change at least this large by chance
  std::optional<double> p_adjusted;  ///< adjusted for all tests of the comparison
  Verdict verdict = Verdict::cannot_tell;
  std::string reason;  ///< if it cannot be decided

  /// The change in units of its standard deviation, if that is not 0.
  [[nodiscard]] std::optional<double> in_stds() const;
};

/// All figures of the calibration jointly, with their correlations.
struct JointTest {
  double statistic = 0.0;     ///< Δᵀ (C_old + C_new)⁻¹ Δ
  std::size_t figures = 0;    ///< its degrees of freedom
  std::optional<double> dof;  ///< degrees of freedom of the covariances, for Fisher's F; absent: χ²
  double p = 1.0;             ///< probability of a statistic at least this large by chance
  double p_adjusted = 1.0;
};

struct SensorComparison {
  std::vector<FigureComparison> figures;  ///< all figures of at least one file, in the file's order
  std::optional<JointTest> joint;
  std::string no_joint;  ///< the reason if there is none
  std::optional<CalibrationEffect> effect;
  std::string no_effect;                       ///< the reason if there is none
  std::size_t tests = 0;                       ///< made; the joint one counts as one
  double level = 0.0;                          ///< familywise false-alarm probability
  Verdict calibration = Verdict::cannot_tell;  ///< changed, same, unchanged or cannot_tell
  Verdict all = Verdict::cannot_tell;          ///< the same for the whole files
  std::vector<Note> notes;
};

struct ComparisonOptions {
  double level = 0.05;      ///< familywise false-alarm probability
  bool with_effect = true;  ///< takes most of the time
};

/// Compares each figure of two sensor files in SI.
///
/// - Test of one figure: Δ = new − old with u² = u_old² + u_new², two-sided, normal, or Student's t
///   if a calibration states its degrees of freedom.
/// - Test of the calibration as a whole: Δᵀ (C_old + C_new)⁻¹ Δ, if both files have a covariance.
/// - Biases have their session-to-session uncertainty: calibration.stability in addition to the
///   repeatability within the recording.
/// - The familywise false-alarm probability is at most `level`: Holm's method over all figures,
///   with the calibration as one if it was tested as a whole. Its own figures are then tested only
///   if it has changed.
/// - Figures carried over from one file to the other are not tested.
///
/// Source: S. Holm, Scand. J. Statist. 6 (1979) 65; for the order, R. Marcus, E. Peritz, K. R.
/// Gabriel, Biometrika 63 (1976) 655 (closed testing); for degrees of freedom of sums, B. L. Welch,
/// Biometrika 34 (1947) 28.
[[nodiscard]] SensorComparison compare(const SensorModel& before,
                                       const SensorModel& after,
                                       const ComparisonOptions& options = {});

/// "changed by more than their uncertainty", …: the verdict on two figures, in words.
[[nodiscard]] std::string_view words_of(Verdict verdict);

}  // namespace proofmass::sensor
