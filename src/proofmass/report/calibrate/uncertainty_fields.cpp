#include "proofmass/report/calibrate/fields.hpp"
#include "proofmass/report/calibrate/wording.hpp"

namespace proofmass::report {
namespace {

using calibrate::BudgetSize;
using calibrate::SupplyAxis;
using calibrate::UncertaintyBudget;

std::string_view name_of(BudgetSize size) {
  switch (size) {
    case BudgetSize::too_small:
      return "too_small";
    case BudgetSize::too_large:
      return "too_large";
    case BudgetSize::right:
      break;
  }
  return "right";
}

Fields budget_fields(const UncertaintyBudget& budget) {
  const About infinite{.meaning = "degrees of freedom; omitted where infinite"};
  Fields lines;
  for (std::size_t k = 0; k < budget.lines.size(); ++k) {
    const calibrate::BudgetLine& line = budget.lines[k];
    Fields fields{field::text("source", line.source),
                  field::choice("type", line.type_a ? "A" : "B", {"A", "B"}),
                  field::choice("distribution", calibrate::name_of(line.distribution),
                                {"normal", "uniform", "triangular", "arcsine", "Student t"}),
                  field::magnitude("std", line.std),
                  field::text("unit", line.unit),
                  field::number("sensitivity", line.sensitivity),
                  field::number("contribution", line.contribution()),
                  field::number("share", budget.shares[k], {.meaning = "of the variance"})};
    if (line.dof > 0.0) fields.push_back(field::magnitude("dof", line.dof, infinite));
    lines.push_back(field::object({}, std::move(fields)));
  }
  Fields out{field::text("quantity", budget.measurand.quantity),
             field::text("unit", budget.measurand.unit),
             field::number("value", budget.measurand.value),
             field::magnitude("combined_std", budget.combined_std),
             field::magnitude("coverage_factor_95", budget.coverage_factor_95),
             field::magnitude("expanded_95", budget.expanded_95)};
  if (budget.effective_dof > 0.0)
    out.push_back(field::magnitude("effective_dof", budget.effective_dof, infinite));
  out.push_back(field::list("lines", std::move(lines)));
  return out;
}

Fields check_fields(const calibrate::ParameterCheck& check) {
  return {field::text("quantity", check.quantity),
          field::text("unit", check.unit),
          field::magnitude("budget_std", check.budget_std),
          field::magnitude("drawn_std", check.drawn_std),
          field::number("drawn_shift", check.drawn_shift, {.meaning = "in units of budget_std"}),
          field::interval("drawn_95", std::array{check.drawn_95.lower, check.drawn_95.upper}),
          field::probability("inside", check.inside,
                             {.meaning = "share of the draws in the budget's 95 % interval"}),
          field::choice("agreement", name_of(check.agreement), {"right", "too_small", "too_large"},
                        {.meaning = "size of the budget against the draws"})};
}

std::string scale_unit(const std::string& unit) {
  return unit == "m/s^2" ? "1" : unit + "/(m/s^2)";
}

Field three(const char* key,
            const std::array<std::optional<Uncertain>, 3>& figures,
            const std::string& unit) {
  Fields items;
  for (const auto& figure : figures)
    items.push_back(
        field::measured({}, figure, unit, {.why_null = "the positions do not determine it"}));
  return field::fixed_list(key, std::move(items));
}

Field supply_axis(const std::optional<SupplyAxis>& axis, const std::string& unit) {
  std::optional<Fields> fields;
  const std::string no_uncertainty = "there is no uncertainty to test against";
  if (axis) {
    fields = Fields{
        field::measured("scale_ref", axis->scale_ref, unit + "/(m/s^2)"),
        field::measured("exponent", axis->exponent, "1"),
        field::measured("zero_ref", axis->zero_ref, unit),
        field::measured("fraction", axis->fraction, unit == "V" ? "1" : unit + "/V"),
        field::measured("constant", axis->constant, unit),
        field::number("expected_fraction", axis->expected_fraction),
        field::probability(
            "scale_p", axis->scale_p,
            {.meaning = "p-value of the exponent against 1", .why_null = no_uncertainty}),
        field::probability(
            "zero_p", axis->zero_p,
            {.meaning = "p-value of the constant against 0", .why_null = no_uncertainty}),
        field::flag(
            "ratiometric", axis->ratiometric,
            {.meaning = "exponent 1 and constant 0, both at 5 %", .why_null = no_uncertainty}),
        field::text("words", axis->words)};
  }
  return field::object_or_null({}, std::move(fields),
                               {.why_null = "not calibrated at two supplies"});
}

}  // namespace

Field budgets_field(const std::vector<UncertaintyBudget>& budgets) {
  return field::records("budgets", budgets, budget_fields);
}

Field stability_field(const CalibrateReport& report) {
  std::optional<Fields> fields;
  if (report.stability)
    fields = Fields{
        field::numbers("bias", report.stability->std,
                       {.meaning = "standard deviation between sessions, beside that of bias"}),
        field::text("unit", report.unit.symbol), field::text("source", report.stability->source)};
  return field::object_or_null(
      "stability", std::move(fields),
      {.meaning = "part of the certificate and of sensor diff, not of interval_95",
       .why_null = "neither the recording nor a sensor file shows the drift of the bias"});
}

Field monte_carlo_field(const CalibrateReport& report) {
  std::optional<Fields> fields;
  if (report.check && stds_known(report)) {
    fields = Fields{
        field::count("draws", report.check->draws), field::count("failed", report.check->failed),
        field::flag("agrees", report.check->agrees), field::text("verdict", report.check->verdict),
        field::records("parameters", report.check->parameters, check_fields)};
    if (report.check->stable)
      fields->push_back(field::flag(
          "stable", *report.check->stable,
          {.meaning = "two digits of each uncertainty, with JCGM 101's adaptive procedure"}));
  }
  const std::string why = !report.why_no_check.empty() ? report.why_no_check
                          : report.check ? "the noise of the means is not known: no budget to check"
                                         : "not requested";
  return field::object_or_null("monte_carlo", std::move(fields),
                               {.meaning = "check of the budgets by Monte Carlo", .why_null = why});
}

Field validation_field(const CalibrateReport& report) {
  const calibrate::Validation& found = *report.validation;
  return field::object(
      "validation",
      {field::texts("files", report.validation_files),
       field::count("positions", found.residuals_mps2.size()),
       field::magnitude("rms", found.rms_mps2, {.meaning = "m/s^2"}),
       field::magnitude("expected_rms", found.expected_rms_mps2, {.meaning = "m/s^2"}),
       field::probability("p", found.p,
                          {.meaning = "probability of this mean square or more by chance",
                           .why_null = "the noise of the means of the new positions is not known"}),
       field::numbers("residuals", found.residuals_mps2, {.meaning = "|f| - g, m/s^2"})},
      {.meaning = "with --validate"});
}

Field supply_field(const CalibrateReport& report) {
  const std::string& unit = report.unit.symbol;
  Fields axes;
  for (const auto& axis : report.supply->axes) axes.push_back(supply_axis(axis, unit));
  return field::object(
      "supply",
      {field::magnitude("reference_v", report.supply->reference_v),
       field::magnitude("lowest_v", report.supply->lowest_v),
       field::magnitude("highest_v", report.supply->highest_v),
       field::records("points", report.supplies,
                      [&](const SuppliedFit& one) -> Fields {
                        return {field::magnitude("supply_v", one.supply_v),
                                field::text("file", one.file),
                                field::count("positions", one.fit.poses.size()),
                                three("bias", one.fit.bias, unit),
                                three("scale", one.fit.scale, scale_unit(unit)),
                                field::magnitude("residual_rms", one.fit.residual_rms_mps2)};
                      }),
       field::fixed_list("axes", std::move(axes),
                         {.meaning = "scale = scale_ref (V/V_ref)^exponent, bias = fraction V + "
                                     "constant"})},
      {.meaning = "with --supplies"});
}

}  // namespace proofmass::report
