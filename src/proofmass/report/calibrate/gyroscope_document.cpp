#include <array>
#include <cctype>
#include <cmath>
#include <fmt/format.h>

#include "proofmass/calibrate/gyroscope_budget.hpp"
#include "proofmass/report/calibrate/fields.hpp"
#include "proofmass/report/calibrate/gyroscope_report.hpp"
#include "proofmass/report/wording.hpp"

namespace proofmass::report {
namespace {

using calibrate::GyroscopeCalibration;
using calibrate::MotionResidual;
using calibrate::UncertaintyBudget;

constexpr double gyroscope_some_p = 0.05;  // p-values below it are reported
constexpr std::size_t parameters = calibrate::gyroscope_parameters;

// The parameters, three by three.
struct ParameterGroup {
  const char* key;
  const char* meaning;
};
constexpr std::array<ParameterGroup, 4> parameter_groups{
    {{"bias", "reading of x, y and z at rest and 0 g"},
     {"scale", "reading per angular rate of x, y and z"},
     {"misalignment_rad",
      "alpha_yz, alpha_zy, alpha_zx in omega = R T diag(1/scale) (reading - "
      "bias - G f), T = [1 -a_yz a_zy; 0 1 -a_zx; 0 0 1]"},
     {"alignment_rad", "rotation vector from the gyroscope's frame to the accelerometer's: R"}}};

const UncertaintyBudget* budget_of(const GyroscopeReport& report, std::size_t k) {
  for (const UncertaintyBudget& budget : report.budgets)
    if (budget.measurand.quantity == calibrate::gyroscope_parameter_names()[k]) return &budget;
  return nullptr;
}

Field parameter(const GyroscopeReport& report, std::size_t k) {
  return field::measured({}, report.fit.parameter(k),
                         calibrate::gyroscope_unit(k, report.unit.symbol),
                         {.why_null = report.fit.why_absent[k]});
}

Field parameter_interval(const GyroscopeReport& report, std::size_t k) {
  std::optional<std::array<double, 2>> ends;
  if (const UncertaintyBudget* budget = budget_of(report, k))
    ends = {budget->measurand.value - budget->expanded_95,
            budget->measurand.value + budget->expanded_95};
  return field::interval({}, ends, {.why_null = report.fit.why_absent[k]});
}

template <class FieldOf>
Fields grouped_parameters(const GyroscopeReport& report, bool described, FieldOf field_of) {
  const auto three = [&](std::size_t first) {
    Fields items;
    for (std::size_t k = first; k < first + 3; ++k) items.push_back(field_of(report, k));
    return items;
  };
  Fields out;
  for (std::size_t group = 0; group < parameter_groups.size(); ++group)
    out.push_back(field::fixed_list(parameter_groups[group].key, three(3 * group),
                                    {.meaning = described ? parameter_groups[group].meaning : ""}));
  Fields rows;
  for (std::size_t row = 0; row < 3; ++row)
    rows.push_back(field::fixed_list({}, three(12 + 3 * row)));
  out.push_back(field::fixed_list(
      "g_sensitivity", std::move(rows),
      {.meaning =
           described ? "G: reading of x, y and z per specific force along x, y and z" : ""}));
  return out;
}

Field covariance_field(const GyroscopeCalibration& fit) {
  Fields rows;
  for (Eigen::Index i = 0; i < fit.covariance.rows(); ++i) {
    const calibrate::GyroscopeVector row = fit.covariance.row(i);
    rows.push_back(field::numbers({}, row));
  }
  return field::fixed_list("covariance", std::move(rows),
                           {.meaning = "of bias, scale, misalignment, alignment and G row by row"});
}

Field test_field(const char* key,
                 const std::optional<calibrate::LackOfFit>& test,
                 const char* meaning) {
  std::optional<Fields> fields;
  if (test)
    fields = Fields{
        field::magnitude("statistic", test->statistic,
                         {.meaning = "F: mean square of the residuals over that of the "
                                     "noise"}),
        field::probability("p", test->p, {.meaning = "probability of this or more by chance"}),
        field::magnitude("dof", test->dof)};
  return field::object_or_null(
      key, std::move(fields),
      {.meaning = meaning, .why_null = "the noise is not known, or there is no redundancy"});
}

Fields motion_fields(const MotionResidual& motion) {
  const std::string why = motion.why_unused.empty()
                              ? "the others alone do not determine the parameters"
                              : "not in the fit: " + motion.why_unused;
  const auto in_fit = [&](double value) {
    return motion.used ? std::optional(value) : std::nullopt;
  };
  return {field::count("recording", motion.session, {.meaning = "index into input"}),
          field::number("start_s", motion.start_s),
          field::number("end_s", motion.end_s),
          field::magnitude("turned_rad", in_fit(motion.turned_rad),
                           {.meaning = "integral of the magnitude of the rate", .why_null = why}),
          field::magnitude(
              "residual_rad", in_fit(motion.residual_rad),
              {.meaning = "angle from the predicted to the measured gravity", .why_null = why}),
          field::magnitude("predicted_std_rad", in_fit(motion.predicted_std_rad),
                           {.meaning = "of each of its two components, by noise", .why_null = why}),
          field::magnitude("leave_one_out_rad", motion.leave_one_out_rad,
                           {.meaning = "by a fit to the other motions", .why_null = why}),
          field::magnitude("studentised", motion.studentised, {.why_null = why}),
          field::flag("used", motion.used),
          field::text("why_unused", motion.why_unused, {.meaning = "empty if it is used"})};
}

// How the figures of a group are shown.
struct Shown {
  double factor = 1.0;
  std::string unit;
};

Shown shown_of(const GyroscopeReport& report, std::size_t k) {
  const bool rate = report.unit.quantity == Quantity::angular_rate;
  if (k < 3) return rate ? Shown{deg_per_rad, "°/s"} : Shown{1.0, report.unit.symbol};
  if (k < 6) return rate ? Shown{1.0, ""} : Shown{1.0, print_unit(report.unit.symbol + "/(rad/s)")};
  if (k < 12) return {1e3, "mrad"};
  return rate ? Shown{deg_per_rad * standard_gravity_mps2, "°/s/g"}
              : Shown{standard_gravity_mps2, report.unit.symbol + "/g"};
}

std::vector<std::string> parameter_row(const GyroscopeReport& report, std::size_t k) {
  const Shown shown = shown_of(report, k);
  const std::optional<Uncertain> figure = report.fit.parameter(k);
  std::string name = calibrate::gyroscope_parameter_names()[k];
  name.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(name.front())));
  if (!figure) return {name, std::string(absent), "", report.fit.why_absent[k]};
  const UncertaintyBudget* budget = budget_of(report, k);
  const double half = budget != nullptr ? budget->expanded_95 * std::abs(shown.factor) : 0.0;
  return {name, with_std(*scaled(figure, shown.factor), shown.unit),
          fmt::format("± {}", significant(half, 2)), ""};
}

Section figures_section_of(const GyroscopeReport& report) {
  Table table{"± is one standard deviation; the gyroscope in the accelerometer's frame",
              {"Figure", "Value", "95 %", "Why absent"},
              {}};
  bool any_absent = false;
  for (std::size_t k = 0; k < parameters; ++k) {
    table.rows.push_back(parameter_row(report, k));
    any_absent |= !report.fit.why_absent[k].empty();
  }
  if (!any_absent) {
    table.head.pop_back();
    for (auto& row : table.rows) row.pop_back();
  }
  const GyroscopeCalibration& fit = report.fit;
  std::size_t used = 0;
  for (const MotionResidual& motion : fit.motions) used += motion.used ? 1 : 0;
  std::vector<std::string> points{
      fmt::format("{} of {} motions; gravity after a motion is predicted to {} mrad rms", used,
                  fit.motions.size(), significant(1e3 * fit.residual_rms_rad, 2))};
  if (fit.lack_of_fit)
    points.back() +=
        fmt::format(", {} times the noise", significant(std::sqrt(fit.lack_of_fit->statistic), 2));
  points.back() += ".";
  if (fit.angle_random_walk[0] > 0.0)
    points.push_back(fmt::format("Angle random walk at rest: {}, {}, {} °/√h.",
                                 significant(60.0 * deg_per_rad * fit.angle_random_walk[0], 2),
                                 significant(60.0 * deg_per_rad * fit.angle_random_walk[1], 2),
                                 significant(60.0 * deg_per_rad * fit.angle_random_walk[2], 2)));
  return {.heading = "Gyroscope",
          .points = std::move(points),
          .tables = {std::move(table)},
          .on_terminal = true};
}

Section motions_section(const GyroscopeReport& report) {
  Table table{"Angle between gravity as predicted by the integrated rate and as measured",
              {"Motion", "From", "To", "Turned", "Residual", "Leave-one-out", "t", ""},
              {}};
  table.long_list = true;
  const auto mrad = [](const std::optional<double>& rad) {
    return rad ? significant(1e3 * *rad, 2) + " mrad" : std::string();
  };
  for (std::size_t k = 0; k < report.fit.motions.size(); ++k) {
    const MotionResidual& motion = report.fit.motions[k];
    table.rows.push_back(
        {fmt::format("{}", k + 1), fixed(motion.start_s, 2) + " s", fixed(motion.end_s, 2) + " s",
         motion.used ? fixed(deg_per_rad * motion.turned_rad, 0) + "°" : "",
         motion.used ? mrad(motion.residual_rad) : "", mrad(motion.leave_one_out_rad),
         motion.studentised ? fixed(*motion.studentised, 1) : "", motion.why_unused});
  }
  return {.heading = "Motions between the positions", .tables = {std::move(table)}};
}

}  // namespace

Field gyroscope_field(const GyroscopeReport& report) {
  const GyroscopeCalibration& fit = report.fit;
  Fields out{
      field::text("unit", report.unit.symbol, {.meaning = "of the readings: rad/s, V or counts"})};
  append(out, grouped_parameters(report, true, parameter));
  append(
      out,
      {field::object("interval_95", grouped_parameters(report, false, parameter_interval),
                     {.meaning = "by Student's t with the effective degrees of freedom of each "
                                 "budget"}),
       covariance_field(fit),
       field::numbers("angle_random_walk", fit.angle_random_walk,
                      {.meaning = "N of x, y and z at rest, rad/sqrt(s); 0: no noise is visible"}),
       field::magnitude("residual_rms_rad", fit.residual_rms_rad),
       field::magnitude("leave_one_out_rms_rad", fit.leave_one_out_rms_rad,
                        {.why_null = "no motion is redundant"}),
       test_field("lack_of_fit", fit.lack_of_fit, "of the motions and turntable rates"),
       test_field("rests_lack_of_fit", fit.rests_lack_of_fit,
                  "of the means at rest: the bias drifts between them"),
       field::records("motions", fit.motions, motion_fields),
       field::records("turntable", fit.rates,
                      [](const calibrate::RateResidual& rate) {
                        return Fields{
                            field::magnitude("rate_radps", rate.rate_radps),
                            field::number("residual_radps", rate.residual_radps),
                            field::magnitude("predicted_std_radps", rate.predicted_std_radps)};
                      },
                      {.meaning = "steady rates, with --table-rates"}),
       budgets_field(report.budgets), field::flag("converged", fit.converged)});
  return field::object("gyroscope", std::move(out), {.meaning = "with --gyro"});
}

std::vector<Section> gyroscope_sections(const GyroscopeReport& report) {
  return {figures_section_of(report), motions_section(report)};
}

std::vector<Note> gyroscope_notes(const GyroscopeReport& report) {
  const GyroscopeCalibration& fit = report.fit;
  std::vector<Note> out;
  for (const MotionResidual& motion : fit.motions)
    if (!motion.used)
      out.push_back({Severity::warning, fmt::format("gyroscope: the motion {}–{} s is not used: {}",
                                                    fixed(motion.start_s, 2),
                                                    fixed(motion.end_s, 2), motion.why_unused)});
  if (fit.lack_of_fit && fit.lack_of_fit->p < gyroscope_some_p)
    out.push_back(
        {Severity::warning,
         fmt::format("gyroscope: the residuals of the motions are {} times the noise: the "
                     "uncertainties are by the residuals",
                     significant(std::sqrt(fit.lack_of_fit->statistic), 2))});
  if (fit.rests_lack_of_fit && fit.rests_lack_of_fit->p < gyroscope_some_p)
    out.push_back({Severity::info,
                   "gyroscope: the bias drifts between the rests by more than its noise; its "
                   "uncertainty is by that scatter"});
  if (!fit.converged)
    out.push_back({Severity::bad, "gyroscope: the fit did not converge: do not use its figures"});
  for (const std::string& text : fit.notes) out.push_back({Severity::warning, text});
  return out;
}

void add_to_certificate(const GyroscopeReport& report, CertificateData& data) {
  data.equations.emplace_back("gyroscope: ω = R T diag(1/scale) (reading − bias − G f)");
  data.method += "; gyroscope against gravity before and after each rotation";
  for (UncertaintyBudget budget : report.budgets) {
    budget.measurand.quantity = "gyroscope " + budget.measurand.quantity;
    data.budgets.push_back(std::move(budget));
  }
  for (std::size_t k = 0; k < parameters; ++k)
    if (!report.fit.why_absent[k].empty())
      data.not_determined.push_back(fmt::format("Gyroscope, {}: {}.",
                                                calibrate::gyroscope_parameter_names()[k],
                                                report.fit.why_absent[k]));
}

}  // namespace proofmass::report
