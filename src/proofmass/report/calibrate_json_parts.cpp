#include "proofmass/report/calibrate_json_parts.hpp"

#include "proofmass/calibrate/direction_words.hpp"
#include "proofmass/report/calibrate_wording.hpp"

namespace proofmass::report {
namespace {

using calibrate::BudgetLine;
using calibrate::ParameterCheck;
using calibrate::Pose;
using calibrate::PoseResidual;
using calibrate::SupplyAxis;
using calibrate::UncertaintyBudget;

Array array_of_vector(const Eigen::Vector3d& v) {
  return {v.x(), v.y(), v.z()};
}

// Degrees of freedom that are infinitely many are left away.
void add_dof(Object& object, const char* key, double dof) {
  if (dof > 0.0) object.push_back({key, dof});
}

void add_times(const Pose& pose, const PoseFile& file, Object& out) {
  const bool known = file.times_known;
  out.push_back({"start_s", known ? or_null(pose.start_s) : Value()});
  out.push_back({"end_s", known ? or_null(pose.end_s) : Value()});
  if (known || !pose.start_s || !pose.end_s) return;
  out.push_back({"start_sample", static_cast<std::uint64_t>(*pose.start_s)});
  out.push_back({"end_sample", static_cast<std::uint64_t>(*pose.end_s)});
}

Object position_json(const CalibrateReport& report, std::size_t k) {
  const Pose& pose = report.poses[k];
  const PoseResidual& residual = report.fit.poses[k];
  const PoseFile& file = report.files[report.pose_file[k]];
  Object out{{"position", k + 1}};
  if (!pose.label.empty()) out.push_back({"label", pose.label});
  out.push_back({"file", file.file});
  add_times(pose, file, out);
  if (pose.samples > 0) out.push_back({"samples", pose.samples});
  const double std = residual.predicted_std_mps2;
  for (Member& member : Object{{"mean", array_of_vector(pose.mean)},
                               {"force", array_of_vector(residual.force_mps2)},
                               {"direction", calibrate::direction_words(residual.force_mps2)},
                               {"residual", residual.residual_mps2},
                               {"predicted_std", std > 0.0 ? Value(std) : Value()},
                               {"leave_one_out", or_null(residual.leave_one_out_mps2)},
                               {"studentised", or_null(residual.studentised)},
                               {"detectable", or_null(residual.detectable_mps2)},
                               {"suspect", residual.suspect},
                               {"used", residual.used}})
    out.push_back(std::move(member));
  return out;
}

Object line_json(const BudgetLine& line, double share) {
  Object out{{"source", line.source},
             {"type", line.type_a ? "A" : "B"},
             {"distribution", calibrate::name_of(line.distribution)},
             {"std", line.std},
             {"unit", line.unit},
             {"sensitivity", line.sensitivity},
             {"contribution", line.contribution()},
             {"share", share}};
  add_dof(out, "dof", line.dof);
  return out;
}

std::string_view size_word(calibrate::BudgetSize size) {
  switch (size) {
    case calibrate::BudgetSize::too_small:
      return "too_small";
    case calibrate::BudgetSize::too_large:
      return "too_large";
    case calibrate::BudgetSize::right:
      break;
  }
  return "right";
}

Object parameter_json(const ParameterCheck& check) {
  return {{"quantity", check.quantity},
          {"unit", check.unit},
          {"budget_std", check.budget_std},
          {"drawn_std", check.drawn_std},
          {"drawn_shift", check.drawn_shift},
          {"drawn_95", Array{check.drawn_95.lower, check.drawn_95.upper}},
          {"inside", check.inside},
          {"agreement", size_word(check.agreement)}};
}

Array figures_json(const std::array<std::optional<Uncertain>, 3>& figures,
                   const std::string& unit) {
  Array out;
  for (const auto& figure : figures) out.push_back(quantity(figure, unit));
  return out;
}

Value axis_json(const std::optional<SupplyAxis>& axis, const std::string& unit) {
  if (!axis) return nullptr;
  return Object{{"scale_ref", quantity(axis->scale_ref, unit + "/(m/s^2)")},
                {"exponent", quantity(axis->exponent, "1")},
                {"zero_ref", quantity(axis->zero_ref, unit)},
                {"fraction", quantity(axis->fraction, unit == "V" ? "1" : unit + "/V")},
                {"constant", quantity(axis->constant, unit)},
                {"expected_fraction", axis->expected_fraction},
                {"scale_p", or_null(axis->scale_p)},
                {"zero_p", or_null(axis->zero_p)},
                {"ratiometric", or_null(axis->ratiometric)},
                {"words", axis->words}};
}

}  // namespace

Array positions_json(const CalibrateReport& report) {
  Array out;
  for (std::size_t k = 0; k < report.poses.size(); ++k) out.push_back(position_json(report, k));
  return out;
}

Array budgets_json(const CalibrateReport& report) {
  Array out;
  for (const UncertaintyBudget& budget : report.budgets) {
    Object one{{"quantity", budget.measurand.quantity},
               {"unit", budget.measurand.unit},
               {"value", budget.measurand.value},
               {"combined_std", budget.combined_std},
               {"coverage_factor_95", budget.coverage_factor_95},
               {"expanded_95", budget.expanded_95}};
    add_dof(one, "effective_dof", budget.effective_dof);
    Array lines;
    for (std::size_t k = 0; k < budget.lines.size(); ++k)
      lines.push_back(line_json(budget.lines[k], budget.shares[k]));
    one.push_back({"lines", std::move(lines)});
    out.push_back(std::move(one));
  }
  return out;
}

Value monte_carlo_json(const CalibrateReport& report) {
  if (!report.check || !stds_known(report)) return nullptr;
  Array parameters;
  for (const ParameterCheck& check : report.check->parameters)
    parameters.push_back(parameter_json(check));
  return Object{{"draws", report.check->draws},
                {"failed", report.check->failed},
                {"agrees", report.check->agrees},
                {"verdict", report.check->verdict},
                {"parameters", std::move(parameters)}};
}

Object supply_json(const CalibrateReport& report) {
  const std::string& unit = report.unit.symbol;
  const std::string scale_unit = unit == "m/s^2" ? "1" : unit + "/(m/s^2)";
  Array points, axes;
  for (const SuppliedFit& one : report.supplies) {
    points.push_back(Object{{"supply_v", one.supply_v},
                            {"file", one.file},
                            {"positions", one.fit.poses.size()},
                            {"bias", figures_json(one.fit.bias, unit)},
                            {"scale", figures_json(one.fit.scale, scale_unit)},
                            {"residual_rms", one.fit.residual_rms_mps2}});
  }
  for (const auto& axis : report.supply->axes) axes.push_back(axis_json(axis, unit));
  return {{"reference_v", report.supply->reference_v},
          {"lowest_v", report.supply->lowest_v},
          {"highest_v", report.supply->highest_v},
          {"points", std::move(points)},
          {"axes", std::move(axes)}};
}

}  // namespace proofmass::report
