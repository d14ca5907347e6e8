#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "proofmass/calibrate/direction_words.hpp"
#include "proofmass/calibrate/rest_accuracy.hpp"
#include "proofmass/report/calibrate/wording.hpp"
#include "proofmass/report/wording.hpp"

namespace proofmass::report {
namespace {

using calibrate::LackOfFit;
using calibrate::PoseModel;
using calibrate::PoseResidual;

std::string p_words(double p) {
  constexpr double least = 1e-4;
  return p < least ? "p < 0.0001" : "p = " + significant(p, 2);
}

std::string origin_words(PoseOrigin origin) {
  switch (origin) {
    case PoseOrigin::found:
      return "detected in";
    case PoseOrigin::labelled:
      return "labelled in";
    case PoseOrigin::listed:
      return "listed for";
    case PoseOrigin::table:
      break;
  }
  return "from";
}

std::string file_sentence(const CalibrateReport& report, const PoseFile& file) {
  std::string text = report.files.size() > 1 ? file_name(file.file) + ": " : "";
  if (file.origin == PoseOrigin::table)
    return text + count_words(file.poses, "position") + " from a table of means.";
  text += fmt::format("{} {} {}", count_words(file.poses, "rest"), origin_words(file.origin),
                      count_words(file.samples, "sample"));
  if (file.duration_s > 0.0) text += " in " + duration_words(file.duration_s);
  if (file.rejected > 0) {
    text += fmt::format("; {} at rest excluded: not finite, or outliers",
                        count_words(file.rejected, "sample"));
  }
  return text + ".";
}

// If all positions are consumed by the parameters, the residuals are identically zero.
std::string residual_sentence(const calibrate::MultiPosition& fit) {
  const auto used = static_cast<std::size_t>(std::count_if(
      fit.poses.begin(), fit.poses.end(), [](const PoseResidual& pose) { return pose.used; }));
  const bool all_taken = (fit.model == PoseModel::norm_9 && used == 9) ||
                         (fit.model == PoseModel::norm_6 && used == 6);
  if (all_taken)
    return "As many parameters as positions: the residuals are zero by construction, and a bad "
           "position is not detectable.";
  std::string text = "Residuals " + mg_words(fit.residual_rms_mps2) + " rms";
  if (fit.leave_one_out_rms_mps2)
    text += ", leave-one-out " + mg_words(*fit.leave_one_out_rms_mps2) + " rms";
  return text + ".";
}

std::string validation_sentence(const CalibrateReport& report) {
  const calibrate::Validation& found = *report.validation;
  std::string text = fmt::format("Validation with {}: residuals {} rms, {} expected",
                                 count_words(found.residuals_mps2.size(), "new position"),
                                 mg_words(found.rms_mps2), mg_words(found.expected_rms_mps2));
  if (!found.p) return text + ".";
  return text +
         (*found.p < some_p
              ? fmt::format(" ({}): the calibration does not hold for them.", p_words(*found.p))
              : fmt::format(" ({}): the calibration holds for them.", p_words(*found.p)));
}

std::string mounting_sentence(const CalibrateReport& report) {
  const calibrate::MultiPosition& fit = report.fit;
  std::string text = fmt::format("The sensor is rotated by {}° in the fixture",
                                 significant(fit.mounting_rad->norm() / rad_per_deg, 3));
  if (fit.placement_std_rad)
    text +=
        fmt::format("; the positions were set with a standard deviation of {}° about either axis",
                    significant(*fit.placement_std_rad / rad_per_deg, 2));
  return text + ".";
}

std::string cross_axis_sentence(const CalibrateReport& report) {
  std::vector<std::string> words;
  constexpr char names[] = {'x', 'y', 'z'};
  for (std::size_t k = 0; k < 3; ++k) {
    const std::optional<calibrate::CrossAxis>& one = report.cross_axis[k];
    if (!one) continue;
    const auto percent = [](double part) { return 100.0 * part; };
    words.push_back(one->value ? fmt::format("{} {} %", names[k],
                                             with_std(Uncertain{percent(one->value->value),
                                                                percent(one->value->std)}))
                               : fmt::format("{} below {} % (95 %)", names[k],
                                             significant(percent(one->upper_95), 2)));
  }
  return words.empty() ? ""
                       : "Cross-axis sensitivity in the frame given by the sensor's z axis: " +
                             joined(words) + ".";
}

// Components of uncertainty that ± includes.
std::string scope_sentence(const CalibrateReport& report) {
  const std::string text = "± is the repeatability within this recording; ";
  if (!report.stability)
    return text + "the stability of the biases between sessions is not known (--bias-stability).";
  const std::vector<CalibrationFigure> figures = calibration_figures(report);
  std::vector<std::string> stds;
  for (std::size_t axis = 0; axis < 3; ++axis)
    stds.push_back(significant(report.stability->std[axis] * figures[axis].factor, 2));
  return text + fmt::format(
                    "between sessions the biases x, y, z scatter by a further {} {} (one standard "
                    "deviation, from {}).",
                    fmt::join(stds, ", "), figures[0].printed_unit, report.stability->source);
}

std::string accuracy_words(const CalibrateReport& report) {
  const std::optional<calibrate::RestAccuracy> found = calibrate::rest_accuracy(report.fit);
  if (!found)
    return "the accuracy is not determined, for want of a redundant position or the noise of the "
           "means";
  std::string text = "accurate to " + mg_words(found->overall_mps2) + " at rest (68 %)";
  constexpr double much = 2.0;
  if (found->overall_mps2 > much * found->by_noise_mps2)
    text += fmt::format(", mostly from {}; noise alone contributes {}", found->main_type_b,
                        mg_words(found->by_noise_mps2));
  if (found->worst_mps2 > much * found->overall_mps2)
    text += fmt::format(", but only to {} with {}, where positions are missing",
                        mg_words(found->worst_mps2), calibrate::direction_words(found->worst_up));
  return text;
}

}  // namespace

std::string lack_of_fit_sentence(const CalibrateReport& report) {
  if (!report.fit.lack_of_fit) return "";
  const LackOfFit& test = *report.fit.lack_of_fit;
  if (test.p >= some_p) return "The noise explains the residuals.";
  if (!report.fit.doubtful.empty())
    return fmt::format("With all positions the residuals are {} times those of the noise.",
                       significant(std::sqrt(test.statistic), 2));
  return fmt::format(
      "The residuals are {} times those of the noise: motion during the rests, a change of "
      "temperature, or a nonlinear sensor; the uncertainties include it.",
      significant(std::sqrt(test.statistic), 2));
}

std::vector<std::string> suspect_sentences(const CalibrateReport& report) {
  std::vector<std::string> out;
  for (std::size_t k = 0; k < report.fit.poses.size(); ++k) {
    const PoseResidual& pose = report.fit.poses[k];
    if (!pose.suspect) continue;
    const double off = std::abs(pose.leave_one_out_mps2.value_or(pose.residual_mps2));
    out.push_back(fmt::format(
        "Position {} contradicts the others by {}: {}; repeat it.", position_words(report, k),
        mg_words(off), pose.used ? "kept in the fit, as requested" : "excluded from the fit"));
  }
  return out;
}

std::string doubtful_sentence(const CalibrateReport& report) {
  const std::vector<std::size_t>& doubtful = report.fit.doubtful;
  if (doubtful.empty()) return "";
  std::vector<std::string> names;
  for (const std::size_t k : doubtful) names.push_back(position_words(report, k));
  if (names.size() == 1) return "Position " + names.front() + " is doubtful: repeat it.";
  return fmt::format(
      "One of positions {} is bad, and the others do not show which: the figures are the mean of "
      "the fits without each of them, and the intervals cover all of these; repeat them or add "
      "others.",
      joined(names));
}

std::string next_pose_sentence(const CalibrateReport& report) {
  if (!report.fit.next_pose) return "";
  const calibrate::NextPose& next = *report.fit.next_pose;
  if (!stds_known(report)) {
    return "Next: record more positions, spread over all directions: these alone leave no "
           "redundancy.";
  }
  const std::string percent = fixed(100.0 * next.gain, 0) + " %";
  constexpr double worth_it = 0.1;
  if (next.gain >= worth_it) {
    return fmt::format("Next position: {}; it would reduce the largest standard deviation by {}.",
                       next.words, percent);
  }
  constexpr std::size_t many = 18;
  if (report.fit.poses.size() < many) {
    return fmt::format(
        "One more position would change little (best: {}; it would reduce the largest standard "
        "deviation by {}): add several, spread over all directions.",
        next.words, percent);
  }
  return fmt::format(
      "One more position would change little: the best ({}) would reduce the largest standard "
      "deviation by {}.",
      next.words, percent);
}

std::string calibrate_conclusion(const CalibrateReport& report) {
  std::string text = fmt::format("{}, {}: {}.", count_words(report.fit.poses.size(), "position"),
                                 model_words(report.fit.model), accuracy_words(report));
  for (const std::string& sentence : {lack_of_fit_sentence(report), doubtful_sentence(report)})
    if (!sentence.empty()) text += " " + sentence;
  const std::vector<std::string> suspects = suspect_sentences(report);
  constexpr std::size_t few = 2;
  for (std::size_t k = 0; k < std::min(suspects.size(), few); ++k) text += " " + suspects[k];
  if (suspects.size() > few)
    text += fmt::format(" {} more contradict the others.",
                        count_words(suspects.size() - few, "position"));
  return text;
}

std::vector<std::string> calibrate_findings(const CalibrateReport& report) {
  std::vector<std::string> out;
  const calibrate::MultiPosition& fit = report.fit;
  for (const PoseFile& file : report.files) out.push_back(file_sentence(report, file));
  out.push_back(residual_sentence(fit));
  if (fit.lack_of_fit) {
    out.push_back(fmt::format("Lack of fit: residuals to noise F = {}, {}.",
                              significant(fit.lack_of_fit->statistic, 3),
                              p_words(fit.lack_of_fit->p)));
  }
  if (stds_known(report)) out.push_back(scope_sentence(report));
  if (!fit.misalignment_rad[0])
    out.push_back("Misalignment is not determined: " + why_no_misalignment(fit) + ".");
  if (fit.mounting_rad) out.push_back(mounting_sentence(report));
  if (std::string words = cross_axis_sentence(report); !words.empty())
    out.push_back(std::move(words));
  if (report.validation) out.push_back(validation_sentence(report));
  if (report.check && stds_known(report)) out.push_back("Monte Carlo: " + report.check->verdict);
  if (report.supply) {
    for (const auto& axis : report.supply->axes)
      if (axis) out.push_back("Supply: " + axis->words);
  }
  if (std::string words = next_pose_sentence(report); !words.empty())
    out.push_back(std::move(words));
  return out;
}

}  // namespace proofmass::report
