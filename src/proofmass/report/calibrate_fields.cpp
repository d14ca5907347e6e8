#include <fmt/format.h>

#include "proofmass/calibrate/direction_words.hpp"
#include "proofmass/calibrate/rest_accuracy.hpp"
#include "proofmass/report/calibrate_wording.hpp"
#include "proofmass/report/fields.hpp"

namespace proofmass::report {
namespace {

using calibrate::BudgetSize;
using calibrate::MultiPosition;
using calibrate::PoseModel;
using calibrate::PoseResidual;
using calibrate::SupplyAxis;
using calibrate::UncertaintyBudget;

std::string_view name_of(PoseModel model) {
  switch (model) {
    case PoseModel::norm_9:
      return "norm_9";
    case PoseModel::norm_6:
      return "norm_6";
    case PoseModel::given_12:
      return "given_12";
    case PoseModel::six_position:
      break;
  }
  return "six_position";
}

std::size_t parameter_count(PoseModel model) {
  return model == PoseModel::norm_9 ? 9 : model == PoseModel::given_12 ? 12 : 6;
}

std::string_view name_of(PoseOrigin origin) {
  switch (origin) {
    case PoseOrigin::found:
      return "found";
    case PoseOrigin::labelled:
      return "labelled";
    case PoseOrigin::listed:
      return "listed";
    case PoseOrigin::table:
      break;
  }
  return "table";
}

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

// Reasons that several entries share.
constexpr const char* noise_unknown = "the noise of the means is not known";
constexpr const char* no_std =
    "the noise of the means is not known and there is no redundant position";
constexpr const char* no_redundancy =
    "there is no redundant position: the others alone do not determine the parameters";

std::string scale_unit(const std::string& unit) {
  return unit == "m/s^2" ? "1" : unit + "/(m/s^2)";
}

std::string why_absent(const CalibrateReport& report, const CalibrationFigure& one) {
  return one.key.starts_with("misalignment") ? why_no_misalignment(report.fit)
                                             : "the positions do not determine it";
}

Field figure(const CalibrateReport& report, const CalibrationFigure& one) {
  std::optional<double> value, std;
  if (one.figure) value = one.figure->value;
  if (one.figure && stds_known(report)) std = one.figure->std;
  return field::measured({}, value, std, one.unit,
                         {.why_null = why_absent(report, one), .why_no_std = no_std});
}

Field interval(const CalibrateReport& report, const CalibrationFigure& one) {
  std::optional<std::array<double, 2>> ends;
  if (one.figure && one.half_width_95)
    ends = {one.figure->value - *one.half_width_95, one.figure->value + *one.half_width_95};
  return field::interval({}, ends, {.why_null = one.figure ? no_std : why_absent(report, one)});
}

// The nine figures, in three groups of x, y and z.
template <class FieldOf>
Fields in_groups(const CalibrateReport& report, bool described, FieldOf field_of) {
  struct Group {
    const char* key;
    const char* meaning;
  };
  constexpr std::array groups{Group{"bias", "output at 0 g of x, y and z"},
                              Group{"scale", "output per acceleration of x, y and z"},
                              Group{"misalignment_rad",
                                    "alpha_yz, alpha_zy, alpha_zx in f = T diag(1/scale) (output - "
                                    "bias), T = [1 -a_yz a_zy; 0 1 -a_zx; 0 0 1]"}};
  const std::vector<CalibrationFigure> figures = calibration_figures(report);
  Fields out;
  for (std::size_t group = 0; group < 3; ++group) {
    Fields items;
    for (std::size_t k = 0; k < 3; ++k) items.push_back(field_of(report, figures[3 * group + k]));
    out.push_back(field::fixed_list(groups[group].key, std::move(items),
                                    {.meaning = described ? groups[group].meaning : ""}));
  }
  return out;
}

Field covariance(const MultiPosition& fit) {
  Fields rows;
  for (Eigen::Index i = 0; i < 9; ++i) {
    const Eigen::Matrix<double, 9, 1> row = fit.covariance.row(i);
    rows.push_back(field::numbers({}, row));
  }
  return field::fixed_list("covariance", std::move(rows),
                           {.meaning = "of bias, scale and misalignment, in this order"});
}

Field gravity(const CalibrateReport& report) {
  const std::optional<Uncertain>& stated = report.certificate.gravity_mps2;
  const About about{.why_no_std = "the uncertainty of gravity is not stated"};
  if (stated) return field::measured("gravity", stated->value, stated->std, "m/s^2", about);
  return field::measured("gravity", report.fit.gravity_mps2, std::nullopt, "m/s^2", about);
}

Field accuracy_at_rest(const MultiPosition& fit) {
  std::optional<Fields> fields;
  if (const auto found = calibrate::rest_accuracy(fit))
    fields = Fields{field::magnitude("overall", found->overall_mps2),
                    field::magnitude("by_noise", found->by_noise_mps2,
                                     {.meaning = "from the noise of the means alone"}),
                    field::magnitude("scatter", found->scatter_mps2),
                    field::magnitude("worst", found->worst_mps2),
                    field::numbers("worst_direction", found->worst_up,
                                   {.meaning = "upward vertical in the sensor's axes"})};
  return field::object_or_null("rest_accuracy", std::move(fields),
                               {.meaning = "standard deviation of the calibrated force at rest, "
                                           "over all directions, m/s^2",
                                .why_null = no_std});
}

Field lack_of_fit(const MultiPosition& fit) {
  const bool noise_known = std::ranges::any_of(
      fit.poses, [](const PoseResidual& pose) { return pose.predicted_std_mps2 > 0.0; });
  std::optional<Fields> fields;
  if (fit.lack_of_fit)
    fields = Fields{field::magnitude("statistic", fit.lack_of_fit->statistic,
                                     {.meaning = "F: mean square of the residuals over that of the "
                                                 "noise"}),
                    field::probability("p", fit.lack_of_fit->p,
                                       {.meaning = "probability of this or more by chance"}),
                    field::magnitude("dof", fit.lack_of_fit->dof)};
  return field::object_or_null("lack_of_fit", std::move(fields),
                               {.why_null = fit.model == PoseModel::six_position
                                                ? "six positions assumed exact leave no redundancy"
                                            : noise_known ? no_redundancy
                                                          : noise_unknown});
}

Field next_pose(const MultiPosition& fit) {
  std::optional<Fields> fields;
  if (fit.next_pose)
    fields =
        Fields{field::numbers("direction", fit.next_pose->up,
                              {.meaning = "upward vertical in the sensor's axes"}),
               field::text("words", fit.next_pose->words),
               field::number("gain", fit.next_pose->gain,
                             {.meaning = "relative reduction of the largest standard deviation"})};
  return field::object_or_null("next_pose", std::move(fields),
                               {.meaning = "most informative additional position",
                                .why_null = "the model has given directions"});
}

Field cross_axis(const CalibrateReport& report) {
  Fields items;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::optional<calibrate::CrossAxis>& one = report.cross_axis[k];
    const std::optional<Uncertain> value = one ? one->value : std::nullopt;
    const std::string why = one ? one->reason : "";
    std::optional<Fields> fields;
    if (one)
      fields = Fields{
          field::magnitude("value", value ? std::optional(value->value) : std::nullopt,
                           {.meaning = "relative to the sensitivity of the axis", .why_null = why}),
          field::magnitude("std", value ? std::optional(value->std) : std::nullopt,
                           {.why_null = why}),
          field::choice("unit", "1", {"1"}), field::magnitude("upper_95", one->upper_95),
          field::probability("p", one->p,
                             {.meaning = "probability of this or more if it were zero"})};
    items.push_back(field::object_or_null(
        {}, std::move(fields),
        {.why_null = k == 2 ? "the z axis defines the frame" : "misalignment was not fitted"}));
  }
  return field::fixed_list(
      "cross_axis", std::move(items),
      {.meaning = "cross-axis sensitivity of x, y and z in the sensor's own frame, "
                  "whose z is its z axis"});
}

// What only some models have.
void add_directions(const MultiPosition& fit, Fields& out) {
  if (fit.mounting_rad && fit.mounting_std_rad)
    out.push_back(field::object(
        "mounting",
        {field::numbers("rotation_rad", *fit.mounting_rad,
                        {.meaning = "rotation vector from the fixture's frame to the sensor's"}),
         field::numbers("std_rad", *fit.mounting_std_rad)},
        {.meaning = "with given directions"}));
  if (fit.placement_std_rad)
    out.push_back(field::magnitude(
        "placement_std_rad", *fit.placement_std_rad,
        {.meaning = "standard deviation of the set directions about either axis; with given "
                    "directions"}));
  if (!fit.axes_in_fixture) return;
  Fields rows;
  for (Eigen::Index k = 0; k < 3; ++k) {
    const Eigen::Vector3d row = fit.axes_in_fixture->row(k);
    rows.push_back(field::numbers({}, row));
  }
  out.push_back(field::fixed_list(
      "axes_in_fixture", std::move(rows),
      {.meaning = "row k: direction of the sensor's axis k in the fixture's frame"}));
}

Field sample_std(const CalibrateReport& report) {
  Fields items;
  for (const double std : report.sample_std)
    items.push_back(
        field::magnitude({}, std > 0.0 ? std::optional(std) : std::nullopt,
                         {.meaning = "standard deviation of one sample at rest, in the unit of "
                                     "the output",
                          .why_null = "the noise of one sample is not known"}));
  return field::fixed_list("sample_std", std::move(items));
}

Fields file_fields(const PoseFile& file) {
  Fields out{field::text("file", file.file),
             field::choice("origin", name_of(file.origin), {"found", "labelled", "listed", "table"},
                           {.meaning = "how its positions were given"}),
             field::count("positions", file.poses),
             field::count("rejected", file.rejected,
                          {.meaning = "samples at rest that are not finite or outliers"})};
  if (file.samples > 0) out.push_back(field::count("samples", file.samples));
  if (file.duration_s > 0.0) out.push_back(field::magnitude("duration_s", file.duration_s));
  return out;
}

void add_times(const calibrate::Pose& pose, const PoseFile& file, Fields& out) {
  const bool known = file.times_known;
  const std::string why = "the file has no times, or its rate is not known";
  out.push_back(field::number("start_s", known ? pose.start_s : std::nullopt,
                              {.meaning = "within the recording", .why_null = why}));
  out.push_back(field::number("end_s", known ? pose.end_s : std::nullopt,
                              {.meaning = "within the recording", .why_null = why}));
  if (known || !pose.start_s || !pose.end_s) return;
  out.push_back(field::count("start_sample", static_cast<std::size_t>(*pose.start_s)));
  out.push_back(field::count("end_sample", static_cast<std::size_t>(*pose.end_s)));
}

Fields position_fields(const CalibrateReport& report, std::size_t k) {
  const calibrate::Pose& pose = report.poses[k];
  const PoseResidual& residual = report.fit.poses[k];
  const PoseFile& file = report.files[report.pose_file[k]];
  Fields out{field::count("position", k + 1, {.meaning = "number from 1"})};
  if (!pose.label.empty()) out.push_back(field::text("label", pose.label));
  out.push_back(field::text("file", file.file));
  add_times(pose, file, out);
  if (pose.samples > 0)
    out.push_back(field::count("samples", pose.samples, {.meaning = "in the mean, where known"}));
  const double std = residual.predicted_std_mps2;
  const std::string why = has_free_directions(report.fit.model)
                              ? "the other positions alone do not determine the parameters"
                              : "this model does not compute it";
  append(out,
         {field::numbers("mean", pose.mean, {.meaning = "in the unit of the output"}),
          field::numbers("force", residual.force_mps2,
                         {.meaning = "calibrated, m/s^2, in the sensor's axes"}),
          field::text("direction", calibrate::direction_words(residual.force_mps2),
                      {.meaning = "the axis that points up, in words"}),
          field::number("residual", residual.residual_mps2, {.meaning = "|f| - g, m/s^2"}),
          field::magnitude("predicted_std", std > 0.0 ? std::optional(std) : std::nullopt,
                           {.meaning = "of the residual by the noise of the mean, m/s^2",
                            .why_null = noise_unknown}),
          field::number("leave_one_out", residual.leave_one_out_mps2,
                        {.meaning = "|f| - g by a fit to the others, m/s^2", .why_null = why}),
          field::number("studentised", residual.studentised,
                        {.meaning = "leave_one_out over its standard deviation", .why_null = why}),
          field::magnitude("detectable", residual.detectable_mps2,
                           {.meaning = "smallest error of |f| in this position that would be "
                                       "detected, m/s^2",
                            .why_null = why}),
          field::flag("suspect", residual.suspect, {.meaning = "it contradicts the others"}),
          field::flag("used", residual.used, {.meaning = "it is in the fit"})});
  return out;
}

Field positions(const CalibrateReport& report) {
  Fields items;
  for (std::size_t k = 0; k < report.poses.size(); ++k)
    items.push_back(field::object({}, position_fields(report, k)));
  return field::list("positions", std::move(items));
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

Field stability(const CalibrateReport& report) {
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

Field monte_carlo(const CalibrateReport& report) {
  std::optional<Fields> fields;
  if (report.check && stds_known(report))
    fields = Fields{
        field::count("draws", report.check->draws), field::count("failed", report.check->failed),
        field::flag("agrees", report.check->agrees), field::text("verdict", report.check->verdict),
        field::records("parameters", report.check->parameters, check_fields)};
  const std::string why = !report.why_no_check.empty() ? report.why_no_check
                          : report.check ? "the noise of the means is not known: no budget to check"
                                         : "not requested";
  return field::object_or_null("monte_carlo", std::move(fields),
                               {.meaning = "check of the budgets by Monte Carlo", .why_null = why});
}

Field validation(const CalibrateReport& report) {
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

Field supply(const CalibrateReport& report) {
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

void add_fit_fields(const CalibrateReport& report, Fields& out) {
  const MultiPosition& fit = report.fit;
  const bool closed_form = fit.model == PoseModel::six_position;
  append(
      out,
      {covariance(fit), gravity(report),
       field::magnitude("residual_rms", fit.residual_rms_mps2, {.meaning = "m/s^2"}),
       field::magnitude(
           "leave_one_out_rms", fit.leave_one_out_rms_mps2,
           {.meaning = "m/s^2",
            .why_null =
                has_free_directions(fit.model) ? no_redundancy : "this model does not compute it"}),
       accuracy_at_rest(fit), lack_of_fit(fit), next_pose(fit),
       field::text("sensor", report.sensor,
                   {.meaning = "common part of the channels' names; may be empty"}),
       field::text("unit", report.unit.symbol, {.meaning = "of the output: m/s^2, V or counts"}),
       field::choice("model", name_of(fit.model), {"norm_9", "norm_6", "given_12", "six_position"}),
       field::count("parameters", parameter_count(fit.model)),
       field::magnitude("dof", fit.dof,
                        {.meaning = "of the noise, for Student's t; 0: the noise is not "
                                    "known"}),
       field::magnitude(
           "condition", fit.condition > 0.0 ? std::optional(fit.condition) : std::nullopt,
           {.meaning = "condition number of the weighted Jacobian, columns of "
                       "unit length",
            .why_null = closed_form ? "six positions have a closed form" : "not computed"}),
       field::flag("converged", fit.converged)});
}

}  // namespace

Fields calibrate_fields(const CalibrateReport& report) {
  Fields out = in_groups(report, true, figure);
  add_fit_fields(report, out);
  out.push_back(field::object(
      "interval_95", in_groups(report, false, interval),
      {.meaning = "by Student's t with the effective degrees of freedom of each budget"}));
  out.push_back(cross_axis(report));
  add_directions(report.fit, out);
  out.push_back(sample_std(report));
  out.push_back(field::records("files", report.files, file_fields));
  Fields doubtful;
  for (const std::size_t k : report.fit.doubtful) doubtful.push_back(field::count({}, k + 1));
  out.push_back(field::list("doubtful", std::move(doubtful),
                            {.meaning = "numbers of the positions of which one is bad, where the "
                                        "others do not show which"}));
  out.push_back(positions(report));
  out.push_back(field::records("budgets", report.budgets, budget_fields));
  out.push_back(stability(report));
  out.push_back(monte_carlo(report));
  if (report.validation) out.push_back(validation(report));
  if (report.supply) out.push_back(supply(report));
  out.push_back(field::text("conclusion", calibrate_conclusion(report)));
  out.push_back(field::notes(calibrate_notes(report)));
  return out;
}

}  // namespace proofmass::report
