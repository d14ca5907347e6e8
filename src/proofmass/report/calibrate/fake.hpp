#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <string>
#include <vector>

#include "proofmass/calibrate/multi_position_budget.hpp"
#include "proofmass/core/units.hpp"
#include "proofmass/report/calibrate/report.hpp"

// Synthetic calibrations with known figures, for the tests of this module.
namespace proofmass::report {

inline constexpr double fake_pose_mg = 1e-3 * standard_gravity_mps2;

/// Rests of 3 s every 5 s, spread over the sphere, with residuals of ± 0.05 mg, leave-one-out 0.06
/// mg.
inline void add_fake_poses(std::size_t count, CalibrateReport& report) {
  for (std::size_t k = 0; k < count; ++k) {
    const auto place = static_cast<double>(k);
    const double z = 1.0 - 2.0 * (place + 0.5) / static_cast<double>(count);
    const double flat = std::sqrt(1.0 - z * z), angle = 2.399963 * place;
    const Eigen::Vector3d up(flat * std::cos(angle), flat * std::sin(angle), z);
    const double sign = k % 2 == 0 ? 1.0 : -1.0;
    calibrate::Pose& pose = report.poses.emplace_back();
    pose.start_s = 5.0 * place;
    pose.end_s = 5.0 * place + 3.0;
    pose.samples = 300;
    pose.mean = standard_gravity_mps2 * up + Eigen::Vector3d(0.1, -0.2, 0.3);
    pose.mean_covariance = std::pow(0.05 * fake_pose_mg, 2) * Eigen::Matrix3d::Identity();
    report.pose_file.push_back(0);
    calibrate::PoseResidual& residual = report.fit.poses.emplace_back();
    residual.residual_mps2 = 0.05 * sign * fake_pose_mg;
    residual.predicted_std_mps2 = 0.05 * fake_pose_mg;
    residual.leave_one_out_mps2 = 0.06 * sign * fake_pose_mg;
    residual.studentised = sign;
    residual.force_mps2 = standard_gravity_mps2 * up;
  }
}

/// Biases 0.1, −0.2, 0.3 m/s², scales 1.01, 0.99, 1.0, angles 1, −2, 3 mrad; each std is 0.0002.
inline void add_fake_figures(CalibrateReport& report) {
  calibrate::MultiPosition& fit = report.fit;
  const std::array<double, 9> values{0.1, -0.2, 0.3, 1.01, 0.99, 1.0, 1e-3, -2e-3, 3e-3};
  constexpr double std = 2e-4;
  fit.estimate = values;
  fit.covariance = std * std * Eigen::Matrix<double, 9, 9>::Identity();
  for (std::size_t k = 0; k < 3; ++k) {
    fit.bias[k] = Uncertain{values[k], std};
    fit.scale[k] = Uncertain{values[3 + k], std};
    fit.misalignment_rad[k] = Uncertain{values[6 + k], std};
  }
  fit.shares = {{"noise of the means", true, fit.covariance, 15.0}};
  fit.dof = 15.0;
  fit.gravity_mps2 = standard_gravity_mps2;
  fit.residual_rms_mps2 = 0.05 * fake_pose_mg;
  fit.leave_one_out_rms_mps2 = 0.06 * fake_pose_mg;
  fit.lack_of_fit = calibrate::LackOfFit{1.1, 0.36, 15.0};
  fit.condition = 4.2;
  fit.next_pose =
      calibrate::NextPose{Eigen::Vector3d(0.0, 0.0, -1.0), "place it with −z straight up", 0.54};
  fit.iterations = 5;
  fit.converged = true;
}

/// 24 consistent positions of one recording, without check and supplies.
inline CalibrateReport fake_calibrate_report() {
  CalibrateReport report;
  report.inputs = {"turned <1>.csv"};
  report.files = {{.file = "turned <1>.csv",
                   .origin = PoseOrigin::found,
                   .poses = 24,
                   .samples = 12'000,
                   .duration_s = 120.0}};
  report.sensor = "acc";
  report.unit = *parse_unit("m/s^2");
  report.sample_std = {0.01, 0.01, 0.02};
  add_fake_poses(24, report);
  add_fake_figures(report);
  report.budgets = calibrate::budget_of(report.fit, {}, "m/s^2").value();
  report.cross_axis[0] = calibrate::CrossAxis{Uncertain{0.0022, 0.0002}, 0.0026, 1e-9, ""};
  report.cross_axis[1] = calibrate::CrossAxis{{}, 0.004, 0.2, "it is not above zero beyond chance"};
  report.certificate.name = "test sensor";
  report.certificate.gravity_mps2 = Uncertain{standard_gravity_mps2, 4e-4};
  report.certificate.files = report.inputs;
  report.certificate.positions = 24;
  report.notes = {{Severity::info, "separator ','"}};
  return report;
}

/// The seventh position is off by 5.1 mg and excluded.
inline CalibrateReport fake_suspect_report() {
  CalibrateReport report = fake_calibrate_report();
  calibrate::PoseResidual& bad = report.fit.poses[6];
  bad.residual_mps2 = bad.leave_one_out_mps2.emplace(5.1 * fake_pose_mg);
  bad.studentised = 80.0;
  bad.suspect = true;
  bad.used = false;
  return report;
}

/// Nine positions of a table without noise or times: no redundancy to test the fit by.
inline CalibrateReport fake_bare_report() {
  CalibrateReport report = fake_calibrate_report();
  report.files.front() = {.file = "means.csv", .origin = PoseOrigin::table, .poses = 9};
  report.sample_std = {};
  report.poses.resize(9);
  report.pose_file.resize(9);
  report.fit.poses.resize(9);
  for (calibrate::Pose& pose : report.poses) {
    pose.start_s = pose.end_s = std::nullopt;
    pose.samples = 0;
    pose.mean_covariance.setZero();
  }
  for (calibrate::PoseResidual& residual : report.fit.poses) {
    residual.residual_mps2 = residual.predicted_std_mps2 = 0.0;
    residual.leave_one_out_mps2 = residual.studentised = std::nullopt;
  }
  calibrate::MultiPosition& fit = report.fit;
  fit.dof = fit.residual_rms_mps2 = 0.0;
  fit.leave_one_out_rms_mps2 = std::nullopt;
  fit.lack_of_fit = std::nullopt;
  fit.shares.clear();
  fit.covariance.setZero();
  for (std::size_t k = 0; k < 3; ++k)
    fit.bias[k]->std = fit.scale[k]->std = fit.misalignment_rad[k]->std = 0.0;
  fit.notes = {"the noise of the means is not known and no position is to spare"};
  report.budgets.clear();
  report.cross_axis = {};
  return report;
}

/// The same sensor in volts at supplies of 3.0 and 3.6 V, ratiometric.
inline CalibrateReport fake_supply_report() {
  CalibrateReport report = fake_calibrate_report();
  report.unit = *parse_unit("V");
  std::vector<calibrate::SupplyPoint> points;
  for (const double supply_v : {3.0, 3.3, 3.6}) {
    SuppliedFit& one = report.supplies.emplace_back();
    one = {supply_v, "supply.csv", report.fit};
    for (std::size_t k = 0; k < 3; ++k) {
      one.fit.bias[k] = Uncertain{0.5 * supply_v, 1e-4};
      one.fit.scale[k] = Uncertain{0.034 * supply_v / 3.3, 1e-5};
    }
    points.push_back({{supply_v, 0.0}, one.fit.bias, one.fit.scale});
  }
  report.supply = calibrate::fit_supply(points).value();
  report.budgets = calibrate::budget_of(report.fit, {}, "V").value();
  return report;
}

}  // namespace proofmass::report
