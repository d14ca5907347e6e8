#include "proofmass/calibrate/direction_words.hpp"
#include "proofmass/report/calibrate/fields.hpp"
#include "proofmass/report/calibrate/wording.hpp"

namespace proofmass::report {
namespace {

using calibrate::PoseResidual;

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

Fields pose_file_fields(const PoseFile& file) {
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
                            .why_null = noise_of_means_unknown}),
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

}  // namespace

Field pose_files_field(const CalibrateReport& report) {
  return field::records("files", report.files, pose_file_fields);
}

Field positions_field(const CalibrateReport& report) {
  Fields items;
  for (std::size_t k = 0; k < report.poses.size(); ++k)
    items.push_back(field::object({}, position_fields(report, k)));
  return field::list("positions", std::move(items));
}

}  // namespace proofmass::report
