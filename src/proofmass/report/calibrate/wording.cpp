#include "proofmass/report/calibrate/wording.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <fmt/format.h>

#include "proofmass/calibrate/direction_words.hpp"
#include "proofmass/calibrate/multi_position_budget.hpp"
#include "proofmass/report/wording.hpp"

namespace proofmass::report {
namespace {

using calibrate::MultiPosition;
using calibrate::PoseModel;
using calibrate::PoseResidual;

constexpr double g = standard_gravity_mps2;

const std::optional<Uncertain>& figure_of(const MultiPosition& fit, std::size_t k) {
  return k < 3 ? fit.bias[k] : k < 6 ? fit.scale[k - 3] : fit.misalignment_rad[k - 6];
}

std::string meaning_of(std::size_t k, bool acceleration) {
  constexpr std::array<const char*, 3> angles{"non-orthogonality of x and y",
                                              "non-orthogonality of x and z",
                                              "non-orthogonality of y and z"};
  if (k >= 6) return angles[k - 6];
  if (k >= 3) return acceleration ? "output over acceleration" : "output per g";
  return "output at 0 g";
}

void set_units(std::size_t k, const Unit& unit, CalibrationFigure& out) {
  if (k >= 6) {
    out.unit = "rad";
    out.factor = 1e3;
    out.printed_unit = "mrad";
    return;
  }
  const bool acceleration = unit.quantity == Quantity::acceleration;
  const bool voltage = unit.quantity == Quantity::voltage;
  const std::string printed = acceleration ? "mg" : voltage ? "mV" : unit.symbol;
  const double factor = acceleration ? 1.0 / mg : voltage ? 1e3 : 1.0;
  if (k < 3) {
    out.unit = unit.symbol;
    out.factor = factor;
    out.printed_unit = printed;
    return;
  }
  out.unit = acceleration ? "1" : unit.symbol + "/(m/s^2)";
  out.factor = acceleration ? 1.0 : factor * g;
  out.printed_unit = acceleration ? "" : printed + "/g";
}

// From the budget, which combines the degrees of freedom of all its contributions.
double half_width(const CalibrateReport& report, const std::string& key, double std) {
  for (const calibrate::UncertaintyBudget& budget : report.budgets)
    if (budget.measurand.quantity == key) return budget.expanded_95;
  return calibrate::coverage_factor(0.95, report.fit.dof) * std;
}

std::string with_unit(const std::string& number, const std::string& unit) {
  return unit.empty() ? number : number + " " + unit;
}

// Two significant digits without an exponent, to match a scale of 1.01002.
std::string two_digits(double value) {
  constexpr int most = 9;
  if (!(value > 0.0)) return "0";
  const int decimals = std::min(1 - static_cast<int>(std::floor(std::log10(value))), most);
  return fixed(value, decimals);
}

// Decimals that give the typical residual two significant digits; smaller residuals are rounding.
int residual_decimals(const CalibrateReport& report) {
  const double rms = report.fit.residual_rms_mps2 / mg;
  constexpr double rounding = 1e-6;
  if (!(rms > rounding)) return 3;
  return std::clamp(1 - static_cast<int>(std::floor(std::log10(rms))), 0, 6);
}

// The first row is the head, and does not count.
void without_empty_columns(std::vector<std::vector<std::string>>& rows) {
  for (std::size_t column = rows.front().size(); column-- > 0;) {
    const auto blank = [&](const std::vector<std::string>& row) { return row[column].empty(); };
    if (!std::all_of(rows.begin() + 1, rows.end(), blank)) continue;
    for (std::vector<std::string>& row : rows)
      row.erase(row.begin() + static_cast<std::ptrdiff_t>(column));
  }
}

std::string verdict_of(const CalibrateReport& report, std::size_t k) {
  const PoseResidual& pose = report.fit.poses[k];
  if (pose.suspect)
    return pose.used ? "contradicts the others; kept" : "contradicts the others; excluded";
  const std::vector<std::size_t>& doubtful = report.fit.doubtful;
  if (std::find(doubtful.begin(), doubtful.end(), k) != doubtful.end()) return "doubtful";
  return "";
}

// "12.3–15.1 s", "samples 120–450"; "" if the times are unknown.
std::string time_words(const CalibrateReport& report, std::size_t k) {
  const calibrate::Pose& pose = report.poses[k];
  if (!pose.start_s || !pose.end_s) return "";
  const PoseFile& file = report.files[report.pose_file[k]];
  if (!file.times_known)
    return fmt::format("samples {}–{}", compact(*pose.start_s, 9), compact(*pose.end_s, 9));
  const int decimals = *pose.end_s < 1e4 ? 1 : 0;
  return fmt::format("{}–{} s", fixed(*pose.start_s, decimals), fixed(*pose.end_s, decimals));
}

constexpr std::string_view no_misalignment = "misalignment_rad: null: ";

}  // namespace

bool is_reason_of_null(const std::string& note) {
  return note.find(": null: ") != std::string::npos;
}

std::string why_no_misalignment(const MultiPosition& fit) {
  for (const std::string& note : fit.notes)
    if (note.starts_with(no_misalignment)) return note.substr(no_misalignment.size());
  return "the positions do not determine it";
}

std::vector<CalibrationFigure> calibration_figures(const CalibrateReport& report) {
  std::vector<CalibrationFigure> out;
  const bool known = stds_known(report);
  const bool acceleration = report.unit.quantity == Quantity::acceleration;
  for (std::size_t k = 0; k < 9; ++k) {
    CalibrationFigure& one = out.emplace_back();
    one.key = calibrate::parameter_names()[k];
    one.label = one.key;
    one.label[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(one.label[0])));
    one.meaning = meaning_of(k, acceleration);
    one.figure = figure_of(report.fit, k);
    if (one.figure && known) one.half_width_95 = half_width(report, one.key, one.figure->std);
    set_units(k, report.unit, one);
  }
  return out;
}

std::string figure_words(const CalibrationFigure& figure, bool std_known) {
  if (!figure.figure) return std::string(absent);
  const double value = figure.figure->value * figure.factor;
  if (!std_known) return with_unit(significant(value, 6), figure.printed_unit);
  return with_std(Uncertain{value, figure.figure->std * figure.factor}, figure.printed_unit);
}

std::vector<std::vector<std::string>> figure_rows(const CalibrateReport& report) {
  const bool known = stds_known(report);
  std::vector<std::vector<std::string>> rows{{"Figure", "Value", "95 %", "Meaning"}};
  const std::string why = why_no_misalignment(report.fit);
  for (const CalibrationFigure& one : calibration_figures(report)) {
    const std::string band =  // keeps the sign on the line of its number
        one.half_width_95 ? "±\u00a0" + two_digits(*one.half_width_95 * one.factor) : "";
    rows.push_back({one.label, figure_words(one, known), band,
                    one.figure ? one.meaning : why.substr(0, why.find(';'))});
  }
  without_empty_columns(rows);
  return rows;
}

bool stds_known(const CalibrateReport& report) {
  return report.fit.dof > 0.0;
}

std::string model_words(PoseModel model) {
  switch (model) {
    case PoseModel::norm_9:
      return "nine parameters";
    case PoseModel::norm_6:
      return "six parameters";
    case PoseModel::given_12:
      return "twelve parameters from given directions";
    case PoseModel::six_position:
      break;
  }
  return "six directions assumed exact";
}

bool has_free_directions(PoseModel model) {
  return model == PoseModel::norm_9 || model == PoseModel::norm_6;
}

std::string mg_words(double accel_mps2) {
  const double value = accel_mps2 / mg;
  constexpr double rounding = 1e-7;
  if (std::abs(value) < rounding) return "0 mg";
  if (std::abs(value) < 1e-3) return significant(value * 1e3, 2) + " µg";
  if (std::abs(value) >= 1e3) return significant(value * 1e-3, 3) + " g";
  return significant(value, std::abs(value) >= 100.0 ? 3 : 2) + " mg";
}

std::string position_words(const CalibrateReport& report, std::size_t k) {
  std::vector<std::string> parts;
  if (report.files.size() > 1) parts.push_back(file_name(report.files[report.pose_file[k]].file));
  if (!report.poses[k].label.empty()) parts.push_back(report.poses[k].label);
  if (std::string time = time_words(report, k); !time.empty()) parts.push_back(std::move(time));
  if (parts.empty()) return std::to_string(k + 1);
  std::string text;
  for (const std::string& part : parts) text += (text.empty() ? "" : ", ") + part;
  return fmt::format("{} ({})", k + 1, text);
}

std::vector<std::vector<std::string>> position_rows(const CalibrateReport& report) {
  const int decimals = residual_decimals(report);
  std::vector<std::vector<std::string>> rows{
      {"Position", "Time", "Up", "Residual, mg", "Leave-one-out, mg", "t", ""}};
  for (std::size_t k = 0; k < report.poses.size(); ++k) {
    const PoseResidual& pose = report.fit.poses[k];
    std::string where = report.poses[k].label;
    if (std::string time = time_words(report, k); !time.empty())
      where += (where.empty() ? "" : ", ") + time;
    if (report.files.size() > 1) {
      const std::string file = file_name(report.files[report.pose_file[k]].file);
      where = where.empty() ? file : file + ", " + where;
    }
    rows.push_back({std::to_string(k + 1), std::move(where),
                    calibrate::direction_words(pose.force_mps2),
                    fixed(pose.residual_mps2 / mg, decimals),
                    pose.leave_one_out_mps2 ? fixed(*pose.leave_one_out_mps2 / mg, decimals) : "",
                    pose.studentised ? fixed(*pose.studentised, 1) : "", verdict_of(report, k)});
  }
  without_empty_columns(rows);
  return rows;
}

}  // namespace proofmass::report
