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

// Has a sensor changed between two of its files?
namespace proofmass::sensor {

enum class Verdict {
  changed,      ///< by more than the uncertainty of the two figures explains
  same,         ///< within it
  unchanged,    ///< the same entry in both files
  cannot_tell,  ///< see reason
  only_old,
  only_new,
  condition,  ///< under what the figures hold: compared, not tested
};

/// One figure of the two files.
struct FigureComparison {
  FigureSlot before, after;
  std::string unit;              ///< SI, of what follows
  std::optional<double> change;  ///< new − old
  std::optional<double> change_std;
  std::optional<double> p;           ///< of a change so large or larger by chance
  std::optional<double> p_adjusted;  ///< the same for all tests of the comparison together
  Verdict verdict = Verdict::cannot_tell;
  std::string reason;  ///< where it cannot be told

  /// The change in units of its standard deviation, where that is not 0.
  [[nodiscard]] std::optional<double> in_stds() const;
};

/// All figures of the calibration at once, with their correlations.
struct JointTest {
  double statistic = 0.0;     ///< Δᵀ (C_old + C_new)⁻¹ Δ
  std::size_t figures = 0;    ///< its degrees of freedom
  std::optional<double> dof;  ///< of the covariances, for Fisher's F; absent: χ²
  double p = 1.0;             ///< of so much or more by chance
  double p_adjusted = 1.0;
};

struct SensorComparison {
  std::vector<FigureComparison> figures;  ///< what at least one file has, in the file's order
  std::optional<JointTest> joint;
  std::string no_joint;  ///< why there is none
  std::optional<CalibrationEffect> effect;
  std::string no_effect;                       ///< why there is none
  std::size_t tests = 0;                       ///< that were made: the joint one counts as one
  double level = 0.0;                          ///< probability of any false alarm among them
  Verdict calibration = Verdict::cannot_tell;  ///< changed, same, unchanged or cannot_tell
  Verdict all = Verdict::cannot_tell;          ///< the same of the whole files
  std::vector<Note> notes;
};

struct ComparisonOptions {
  double level = 0.05;      ///< probability of any false alarm
  bool with_effect = true;  ///< what takes most of the time
};

/// Biases count as uncertain as they are from one session to another: by calibration.stability
/// beside the repeatability within the recording. Compares each figure in SI: Δ = new − old with u²
/// = u_old² + u_new², two-sided, normal, or of Student's t where a calibration says its degrees of
/// freedom; and the calibration as a whole by Δᵀ (C_old + C_new)⁻¹ Δ where both files have a
/// covariance. The probability of any false alarm is `level` at most: Holm's method over all
/// figures, the calibration counting as one where it was tested as a whole; its own figures are
/// then looked into only if it has changed. Figures carried over from one file to the other are not
/// tested. Source: S. Holm, Scand. J. Statist. 6 (1979) 65; for the order, R. Marcus, E. Peritz, K.
/// R. Gabriel, Biometrika 63 (1976) 655 (closed testing); for degrees of freedom of sums, B. L.
/// Welch, Biometrika 34 (1947) 28.
[[nodiscard]] SensorComparison compare(const SensorModel& before,
                                       const SensorModel& after,
                                       const ComparisonOptions& options = {});

/// "changed by more than their uncertainty", …: of two figures, for people.
[[nodiscard]] std::string_view words_of(Verdict verdict);

}  // namespace proofmass::sensor
