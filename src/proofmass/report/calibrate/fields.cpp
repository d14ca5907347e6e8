#include "proofmass/report/calibrate/fields.hpp"

#include "proofmass/calibrate/rest_accuracy.hpp"
#include "proofmass/report/calibrate/wording.hpp"

namespace proofmass::report {
namespace {

using calibrate::MultiPosition;
using calibrate::PoseModel;
using calibrate::PoseResidual;

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

// Reasons shared by several entries.
constexpr const char* no_std =
    "the noise of the means is not known and there is no redundant position";
constexpr const char* no_redundancy =
    "there is no redundant position: the others alone do not determine the parameters";

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
                                                          : noise_of_means_unknown});
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

// Entries that only some models have.
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
  out.push_back(pose_files_field(report));
  Fields doubtful;
  for (const std::size_t k : report.fit.doubtful) doubtful.push_back(field::count({}, k + 1));
  out.push_back(field::list("doubtful", std::move(doubtful),
                            {.meaning = "numbers of the positions of which one is bad, where the "
                                        "others do not show which"}));
  out.push_back(positions_field(report));
  out.push_back(budgets_field(report.budgets));
  out.push_back(stability_field(report));
  out.push_back(monte_carlo_field(report));
  if (report.validation) out.push_back(validation_field(report));
  if (report.supply) out.push_back(supply_field(report));
  if (report.gyroscope) out.push_back(gyroscope_field(*report.gyroscope));
  out.push_back(field::text("conclusion", calibrate_conclusion(report)));
  out.push_back(field::notes(calibrate_notes(report)));
  return out;
}

}  // namespace proofmass::report
