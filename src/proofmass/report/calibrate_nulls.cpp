#include "proofmass/report/calibrate_nulls.hpp"

#include <algorithm>

#include "proofmass/report/calibrate_wording.hpp"

namespace proofmass::report {
namespace {

using calibrate::Pose;
using calibrate::PoseModel;
using calibrate::PoseResidual;

class Reasons {
 public:
  explicit Reasons(const CalibrateReport& report) : report_(report) {}

  // The fit and the program may have said why already.
  void add(const std::string& key, const std::string& why) {
    const std::string start = key + ": null";
    const auto says = [&](const std::string& text) { return text.starts_with(start); };
    if (std::any_of(report_.fit.notes.begin(), report_.fit.notes.end(), says)) return;
    for (const Note& note : report_.notes)
      if (says(note.text)) return;
    all.push_back(start + ": " + why);
  }

  std::vector<std::string> all;

 private:
  const CalibrateReport& report_;
};

bool free_directions(const CalibrateReport& report) {
  return report.fit.model == PoseModel::norm_9 || report.fit.model == PoseModel::norm_6;
}

bool noise_known(const CalibrateReport& report) {
  const auto& poses = report.fit.poses;
  return std::any_of(poses.begin(), poses.end(),
                     [](const PoseResidual& pose) { return pose.predicted_std_mps2 > 0.0; });
}

constexpr const char* no_spare =
    "no position is to spare: the others alone do not carry the parameters";

void add_fit_reasons(const CalibrateReport& report, Reasons& reasons) {
  const calibrate::MultiPosition& fit = report.fit;
  if (!fit.bias[0]) reasons.add("bias, scale", "the positions do not carry them");
  if (!fit.misalignment_rad[0])
    reasons.add("misalignment_rad", "the model takes the axes for orthogonal");
  if (!stds_known(report))
    reasons.add("std, interval_95 of bias, scale and misalignment_rad, rest_accuracy",
                "the noise of the means is not known and no position is to spare");
  if (!report.certificate.gravity_mps2) reasons.add("gravity.std", "it was not stated");
  if (!fit.lack_of_fit)
    reasons.add("lack_of_fit",
                noise_known(report) ? no_spare : "the noise of the means is not known");
  if (!fit.leave_one_out_rms_mps2)
    reasons.add("leave_one_out_rms",
                free_directions(report) ? no_spare : "this model does not compute it");
  if (!fit.next_pose) reasons.add("next_pose", "the model has its directions given");
  if (fit.model == PoseModel::six_position)
    reasons.add("condition", "six directions taken for exact have a closed form");
}

void add_pose_reasons(const CalibrateReport& report, Reasons& reasons) {
  const auto& rows = report.fit.poses;
  const auto any = [&](auto missing) { return std::any_of(rows.begin(), rows.end(), missing); };
  bool timeless = false;
  for (std::size_t k = 0; k < report.poses.size(); ++k) {
    const Pose& pose = report.poses[k];
    timeless |= !pose.start_s || !pose.end_s || !report.files[report.pose_file[k]].times_known;
  }
  if (timeless)
    reasons.add("positions[].start_s, end_s", "the file tells no times, or no rate is known");
  if (any([](const PoseResidual& pose) { return pose.predicted_std_mps2 == 0.0; }))
    reasons.add("positions[].predicted_std", "the noise of the means is not known");
  if (any([](const PoseResidual& pose) {
        return !pose.leave_one_out_mps2 || !pose.studentised || !pose.detectable_mps2;
      })) {
    reasons.add("positions[].leave_one_out, studentised, detectable",
                free_directions(report) ? "the other positions alone do not carry the parameters"
                                        : "this model does not compute it");
  }
}

void add_other_reasons(const CalibrateReport& report, Reasons& reasons) {
  for (const double std : report.sample_std) {
    if (std > 0.0) continue;
    reasons.add("sample_std", "the noise of one sample is not known");
    break;
  }
  constexpr const char* axes[] = {"x", "y", "z"};
  bool without = false;
  for (std::size_t k = 0; k < 3; ++k) {
    if (report.cross_axis[k] && !report.cross_axis[k]->value)
      reasons.add(std::string("cross_axis ") + axes[k] + ", value, std",
                  report.cross_axis[k]->reason);
    without |= k < 2 && !report.cross_axis[k];
  }
  reasons.add("cross_axis", without ? "misalignment was not fitted"
                                    : "of z: its axis is the frame that the others are told in");
  if (!report.stability)
    reasons.add("stability", "neither the recording nor a sensor file shows how the bias wanders");
  if (!report.check)
    reasons.add("monte_carlo", "not asked for");
  else if (!stds_known(report))
    reasons.add("monte_carlo", "the noise of the means is not known: there is no budget to check");
  if (report.validation && !report.validation->p)
    reasons.add("validation.p", "the noise of the new positions' means is not known");
  if (!report.supply) return;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto& axis = report.supply->axes[k];
    if (!axis) {
      reasons.add(std::string("supply.axes ") + axes[k], "not calibrated at two supplies");
    } else if (!axis->scale_p || !axis->zero_p || !axis->ratiometric) {
      reasons.add(std::string("supply.axes ") + axes[k] + ", scale_p, zero_p, ratiometric",
                  "no uncertainty is known to judge by");
    }
  }
}

}  // namespace

std::vector<std::string> calibrate_null_reasons(const CalibrateReport& report) {
  Reasons reasons(report);
  add_fit_reasons(report, reasons);
  add_pose_reasons(report, reasons);
  add_other_reasons(report, reasons);
  return reasons.all;
}

}  // namespace proofmass::report
