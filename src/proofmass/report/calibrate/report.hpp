#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "proofmass/calibrate/bias_stability.hpp"
#include "proofmass/calibrate/cross_axis.hpp"
#include "proofmass/calibrate/multi_position.hpp"
#include "proofmass/calibrate/multi_position_check.hpp"
#include "proofmass/calibrate/supply.hpp"
#include "proofmass/calibrate/uncertainty_budget.hpp"
#include "proofmass/calibrate/validation.hpp"
#include "proofmass/core/recording.hpp"
#include "proofmass/core/units.hpp"
#include "proofmass/report/calibrate/certificate.hpp"
#include "proofmass/report/calibrate/gyroscope_report.hpp"
#include "proofmass/report/document.hpp"

namespace proofmass::report {

/// Origin of the poses.
enum class PoseOrigin {
  found,     ///< rests found in the recording
  labelled,  ///< labels in the recording
  listed,    ///< a list of intervals
  table,     ///< a table of means
};

/// One input file and the poses taken from it.
struct PoseFile {
  std::string file;
  PoseOrigin origin = PoseOrigin::found;
  std::size_t poses = 0;
  std::size_t samples = 0;   ///< samples in the recording; 0 for a table
  double duration_s = 0.0;   ///< of the recording; 0 if its rate is unknown
  bool times_known = true;   ///< false: the times of its poses are sample numbers
  std::size_t rejected = 0;  ///< samples at rest that are not finite or outliers
};

/// One of several calibrations at different supplies.
struct SuppliedFit {
  double supply_v = 0.0;
  std::string file;
  calibrate::MultiPosition fit;
};

/// A multi-position calibration and its input.
struct CalibrateReport {
  std::vector<std::string> inputs;  ///< files, as the user named them
  std::vector<PoseFile> files;
  std::string sensor;                  ///< common part of the three channels' names
  Unit unit;                           ///< of the output: m/s^2, V or counts
  std::vector<calibrate::Pose> poses;  ///< one for each of fit.poses; times in s
  std::vector<std::size_t> pose_file;  ///< index into files
  std::array<double, 3> sample_std{};  ///< standard deviation of one sample at rest; 0 if unknown
  calibrate::MultiPosition fit;        ///< type B contributions included
  std::vector<calibrate::UncertaintyBudget> budgets;
  std::optional<calibrate::MonteCarloCheck> check;
  std::string why_no_check;  ///< reason if the Monte Carlo check was requested and failed
  /// Scatter between sessions, beyond the uncertainties of the figures; enters the certificate's
  /// budgets.
  std::optional<calibrate::BiasStability> stability;
  std::array<std::optional<calibrate::CrossAxis>, 3> cross_axis;  ///< absent for z: the reference
  std::optional<calibrate::Validation> validation;
  std::vector<std::string> validation_files;
  std::vector<SuppliedFit> supplies;  ///< one for each file if they differ in supply
  std::optional<calibrate::SupplyDependence> supply;
  std::optional<GyroscopeReport> gyroscope;  ///< with --gyro
  CertificateData certificate;  ///< names, conditions and limits; budgets are those above
  std::vector<Note> notes;      ///< notes of reading and preparation; those of the fit are added
};

/// The nine figures with their uncertainties, the positions with their residuals, budgets, next
/// pose, supplies, and the certificate. Holds a reference to the report, which must outlive it.
[[nodiscard]] Document describe(const CalibrateReport& report);

/// The report's notes, then the fit's: suspects as Severity::bad, lack of fit and doubtful poses as
/// warnings.
[[nodiscard]] std::vector<Note> calibrate_notes(const CalibrateReport& report);

/// One row per pose: start, end, means, force, residual, leave-one-out residual; the content of
/// `--output`.
[[nodiscard]] Recording calibrate_series(const CalibrateReport& report);

}  // namespace proofmass::report
