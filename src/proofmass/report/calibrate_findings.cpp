#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "proofmass/report/calibrate_wording.hpp"
#include "proofmass/report/wording.hpp"

namespace proofmass::report {
namespace {

using calibrate::LackOfFit;
using calibrate::PoseModel;
using calibrate::PoseResidual;

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (std::size_t k = 0; k < words.size(); ++k)
    text += (k == 0 ? "" : k + 1 == words.size() ? " and " : ", ") + words[k];
  return text;
}

std::string p_words(double p) {
  constexpr double least = 1e-4;
  return p < least ? "p < 0.0001" : "p = " + significant(p, 2);
}

// How the poses came to be known.
std::string origin_words(PoseOrigin origin) {
  switch (origin) {
    case PoseOrigin::found:
      return "found in";
    case PoseOrigin::labelled:
      return "by the labels of";
    case PoseOrigin::listed:
      return "listed for";
    case PoseOrigin::table:
      break;
  }
  return "of";
}

std::string file_sentence(const CalibrateReport& report, const PoseFile& file) {
  std::string text = report.files.size() > 1 ? file_name(file.file) + ": " : "";
  if (file.origin == PoseOrigin::table)
    return text + count_words(file.poses, "position") + " of a table of means.";
  text += fmt::format("{} {} {}", count_words(file.poses, "rest"), origin_words(file.origin),
                      count_words(file.samples, "sample"));
  if (file.duration_s > 0.0) text += " in " + duration_words(file.duration_s);
  if (file.rejected > 0) {
    text += fmt::format("; {} at rest passed over: no number, or a spike",
                        count_words(file.rejected, "sample"));
  }
  return text + ".";
}

// As many parameters as positions leave no residuals to speak of.
std::string residual_sentence(const calibrate::MultiPosition& fit) {
  const auto used = static_cast<std::size_t>(std::count_if(
      fit.poses.begin(), fit.poses.end(), [](const PoseResidual& pose) { return pose.used; }));
  const bool all_taken = (fit.model == PoseModel::norm_9 && used == 9) ||
                         (fit.model == PoseModel::norm_6 && used == 6);
  if (all_taken)
    return "As many parameters as positions: the residuals are zero whatever was read, and nothing "
           "contradicts a bad position.";
  std::string text = "Residuals " + mg_words(fit.residual_rms_mps2) + " rms";
  if (fit.leave_one_out_rms_mps2)
    text += "; each position judged by the others alone: " + mg_words(*fit.leave_one_out_rms_mps2) +
            " rms";
  return text + ".";
}

std::string validation_sentence(const CalibrateReport& report) {
  const calibrate::Validation& found = *report.validation;
  std::string text = fmt::format(
      "{} that had no part in the calibration read {} rms away from gravity; {} were to be "
      "expected",
      count_words(found.residuals_mps2.size(), "new position"), mg_words(found.rms_mps2),
      mg_words(found.expected_rms_mps2));
  if (!found.p) return text + ".";
  return text +
         (*found.p < some_p
              ? fmt::format(" ({}): the calibration does not hold for them.", p_words(*found.p))
              : fmt::format(" ({}): the calibration holds for them.", p_words(*found.p)));
}

std::string mounting_sentence(const CalibrateReport& report) {
  const calibrate::MultiPosition& fit = report.fit;
  std::string text = fmt::format("The sensor sits turned by {}° in the fixture",
                                 significant(fit.mounting_rad->norm() / rad_per_deg, 3));
  if (fit.placement_std_rad)
    text += fmt::format("; the positions were set to {}° (standard deviation about either axis)",
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
  return words.empty()
             ? ""
             : "Cross-axis sensitivity in the sensor's own frame, whose z is its z axis: " +
                   joined(words) + ".";
}

// What ± means, and what it leaves out.
std::string scope_sentence(const CalibrateReport& report) {
  std::string text = "± is the repeatability within this recording";
  if (!report.stability)
    return text +
           "; how the biases change from one session to another is not known: state it by "
           "--bias-stability.";
  const std::vector<CalibrationFigure> figures = calibration_figures(report);
  std::vector<std::string> stds;
  for (std::size_t axis = 0; axis < 3; ++axis)
    stds.push_back(significant(report.stability->std[axis] * figures[axis].factor, 2));
  return text + fmt::format(
                    "; from one session to another the biases x, y, z scatter by {} {} beside it "
                    "(one standard deviation, by {}).",
                    fmt::join(stds, ", "), figures[0].printed_unit, report.stability->source);
}

}  // namespace

std::string lack_of_fit_sentence(const CalibrateReport& report) {
  if (!report.fit.lack_of_fit) return "";
  const LackOfFit& test = *report.fit.lack_of_fit;
  if (test.p >= some_p) return "Noise explains the residuals.";
  if (!report.fit.doubtful.empty())
    return fmt::format("With all positions the residuals are {} times what the noise explains.",
                       significant(std::sqrt(test.statistic), 2));
  return fmt::format(
      "The residuals are {} times what the noise explains: the positions were not quite at rest, "
      "temperature moved, or the sensor is not linear; the uncertainties hold that.",
      significant(std::sqrt(test.statistic), 2));
}

std::vector<std::string> suspect_sentences(const CalibrateReport& report) {
  std::vector<std::string> out;
  for (std::size_t k = 0; k < report.fit.poses.size(); ++k) {
    const PoseResidual& pose = report.fit.poses[k];
    if (!pose.suspect) continue;
    const double off = std::abs(pose.leave_one_out_mps2.value_or(pose.residual_mps2));
    out.push_back(fmt::format("Position {} contradicts the others by {}: {}; repeat it.",
                              position_words(report, k), mg_words(off),
                              pose.used ? "it stays in the fit, as asked" : "it was left out"));
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
      "the "
      "fits without each, and the intervals hold all of these; repeat them or add others.",
      joined(names));
}

std::string next_pose_sentence(const CalibrateReport& report) {
  if (!report.fit.next_pose) return "";
  const calibrate::NextPose& next = *report.fit.next_pose;
  if (!stds_known(report)) {
    return "Next: record more positions, spread over all directions, for with these alone nothing "
           "can be judged.";
  }
  const std::string percent = fixed(100.0 * next.gain, 0) + " %";
  constexpr double worth_it = 0.1;
  if (next.gain >= worth_it) {
    return fmt::format(
        "Next position: {}; it would lower the least certain figure's standard deviation by {}.",
        next.words, percent);
  }
  constexpr std::size_t many = 18;
  if (report.fit.poses.size() < many) {
    return fmt::format(
        "One more position would change little (best: {}; it would lower the least certain "
        "figure's standard deviation by {}): add several, spread over all directions.",
        next.words, percent);
  }
  return fmt::format(
      "Nothing much is to be gained by one more position: the best ({}) would lower the least "
      "certain figure's standard deviation by {}.",
      next.words, percent);
}

std::vector<std::string> calibrate_findings(const CalibrateReport& report) {
  std::vector<std::string> out;
  const calibrate::MultiPosition& fit = report.fit;
  for (const PoseFile& file : report.files) out.push_back(file_sentence(report, file));
  out.push_back(residual_sentence(fit));
  if (fit.lack_of_fit) {
    out.push_back(fmt::format("Mean square of the residuals over that of the noise: {}, {}.",
                              significant(fit.lack_of_fit->statistic, 3),
                              p_words(fit.lack_of_fit->p)));
  }
  if (stds_known(report)) out.push_back(scope_sentence(report));
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
