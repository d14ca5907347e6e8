#include "proofmass/calibrate/rest_accuracy.hpp"
#include "proofmass/report/calibrate_json_parts.hpp"
#include "proofmass/report/calibrate_nulls.hpp"
#include "proofmass/report/calibrate_wording.hpp"

namespace proofmass::report {
namespace {

using calibrate::MultiPosition;
using calibrate::PoseModel;

std::string_view model_code(PoseModel model) {
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
  switch (model) {
    case PoseModel::norm_9:
      return 9;
    case PoseModel::given_12:
      return 12;
    case PoseModel::norm_6:
    case PoseModel::six_position:
      break;
  }
  return 6;
}

std::string_view origin_code(PoseOrigin origin) {
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

Array vector_json(const Eigen::Vector3d& v) {
  return {v.x(), v.y(), v.z()};
}

// The std of a figure whose noise nobody knows is null, not what little of it is known.
Value figure_json(const CalibrationFigure& one, bool std_known) {
  if (!one.figure) return nullptr;
  return Object{{"value", one.figure->value},
                {"std", std_known ? Value(one.figure->std) : Value()},
                {"unit", one.unit}};
}

Value interval_json(const CalibrationFigure& one) {
  if (!one.figure || !one.half_width_95) return nullptr;
  return Array{one.figure->value - *one.half_width_95, one.figure->value + *one.half_width_95};
}

// The nine figures, in three groups of x, y and z.
template <class Function>
Object in_groups(const std::vector<CalibrationFigure>& figures, Function json) {
  constexpr const char* keys[] = {"bias", "scale", "misalignment_rad"};
  Object out;
  for (std::size_t group = 0; group < 3; ++group) {
    Array values;
    for (std::size_t k = 0; k < 3; ++k) values.push_back(json(figures[3 * group + k]));
    out.push_back({keys[group], std::move(values)});
  }
  return out;
}

Array covariance_json(const MultiPosition& fit) {
  Array rows;
  for (Eigen::Index i = 0; i < 9; ++i) {
    Array row;
    for (Eigen::Index j = 0; j < 9; ++j) row.push_back(fit.covariance(i, j));
    rows.push_back(std::move(row));
  }
  return rows;
}

Value gravity_json(const CalibrateReport& report) {
  if (report.certificate.gravity_mps2) return quantity(report.certificate.gravity_mps2, "m/s^2");
  return Object{{"value", report.fit.gravity_mps2}, {"std", nullptr}, {"unit", "m/s^2"}};
}

Value rest_accuracy_json(const MultiPosition& fit) {
  const std::optional<calibrate::RestAccuracy> found = calibrate::rest_accuracy(fit);
  if (!found) return nullptr;
  return Object{{"overall", found->overall_mps2},
                {"by_noise", found->by_noise_mps2},
                {"scatter", found->scatter_mps2},
                {"worst", found->worst_mps2},
                {"worst_direction", vector_json(found->worst_up)}};
}

Value lack_of_fit_json(const MultiPosition& fit) {
  if (!fit.lack_of_fit) return nullptr;
  return Object{{"statistic", fit.lack_of_fit->statistic},
                {"p", fit.lack_of_fit->p},
                {"dof", fit.lack_of_fit->dof}};
}

Value next_pose_json(const MultiPosition& fit) {
  if (!fit.next_pose) return nullptr;
  return Object{{"direction", vector_json(fit.next_pose->up)},
                {"words", fit.next_pose->words},
                {"gain", fit.next_pose->gain}};
}

Array cross_axis_json(const CalibrateReport& report) {
  Array out;
  for (const auto& one : report.cross_axis) {
    if (!one) {
      out.push_back(nullptr);
      continue;
    }
    out.push_back(Object{{"value", one->value ? Value(one->value->value) : Value()},
                         {"std", one->value ? Value(one->value->std) : Value()},
                         {"unit", "1"},
                         {"upper_95", one->upper_95},
                         {"p", one->p}});
  }
  return out;
}

Array sample_std_json(const CalibrateReport& report) {
  Array out;
  for (const double std : report.sample_std) out.push_back(std > 0.0 ? Value(std) : Value());
  return out;
}

Array files_json(const CalibrateReport& report) {
  Array out;
  for (const PoseFile& file : report.files) {
    Object one{{"file", file.file},
               {"origin", origin_code(file.origin)},
               {"positions", file.poses},
               {"rejected", file.rejected}};
    if (file.samples > 0) one.push_back({"samples", file.samples});
    if (file.duration_s > 0.0) one.push_back({"duration_s", file.duration_s});
    out.push_back(std::move(one));
  }
  return out;
}

Object validation_json(const CalibrateReport& report) {
  const calibrate::Validation& found = *report.validation;
  return {{"files", array_of(report.validation_files)},
          {"positions", found.residuals_mps2.size()},
          {"rms", found.rms_mps2},
          {"expected_rms", found.expected_rms_mps2},
          {"p", or_null(found.p)},
          {"residuals", array_of(found.residuals_mps2)}};
}

Value stability_json(const CalibrateReport& report) {
  if (!report.stability) return {};
  Array stds;
  for (const double std : report.stability->std) stds.emplace_back(std);
  return Object{{"bias", std::move(stds)},
                {"unit", report.unit.symbol},
                {"source", report.stability->source}};
}

// What only some models have.
void add_directions(const MultiPosition& fit, Object& out) {
  if (fit.mounting_rad && fit.mounting_std_rad) {
    out.push_back({"mounting", Object{{"rotation_rad", vector_json(*fit.mounting_rad)},
                                      {"std_rad", vector_json(*fit.mounting_std_rad)}}});
  }
  if (fit.placement_std_rad) out.push_back({"placement_std_rad", *fit.placement_std_rad});
  if (!fit.axes_in_fixture) return;
  Array rows;
  for (Eigen::Index k = 0; k < 3; ++k)
    rows.push_back(vector_json(fit.axes_in_fixture->row(k).transpose()));
  out.push_back({"axes_in_fixture", std::move(rows)});
}

Object body(const CalibrateReport& report) {
  const MultiPosition& fit = report.fit;
  const std::vector<CalibrationFigure> figures = calibration_figures(report);
  const bool known = stds_known(report);
  Object out =
      in_groups(figures, [&](const CalibrationFigure& one) { return figure_json(one, known); });
  const auto add = [&](const char* key, Value value) { out.push_back({key, std::move(value)}); };
  add("covariance", covariance_json(fit));
  add("gravity", gravity_json(report));
  add("residual_rms", fit.residual_rms_mps2);
  add("leave_one_out_rms", or_null(fit.leave_one_out_rms_mps2));
  add("rest_accuracy", rest_accuracy_json(fit));
  add("lack_of_fit", lack_of_fit_json(fit));
  add("next_pose", next_pose_json(fit));
  add("sensor", report.sensor);
  add("unit", report.unit.symbol);
  add("model", model_code(fit.model));
  add("parameters", parameter_count(fit.model));
  add("dof", fit.dof);
  add("condition", fit.condition > 0.0 ? Value(fit.condition) : Value());
  add("converged", fit.converged);
  add("interval_95", in_groups(figures, interval_json));
  add("cross_axis", cross_axis_json(report));
  add_directions(fit, out);
  add("sample_std", sample_std_json(report));
  add("files", files_json(report));
  Array doubtful;
  for (const std::size_t k : fit.doubtful) doubtful.push_back(k + 1);
  add("doubtful", std::move(doubtful));
  add("positions", positions_json(report));
  add("budgets", budgets_json(report));
  add("stability", stability_json(report));
  add("monte_carlo", monte_carlo_json(report));
  if (report.validation) add("validation", validation_json(report));
  if (report.supply) add("supply", supply_json(report));
  return out;
}

}  // namespace

std::string calibrate_json(const CalibrateReport& report) {
  std::vector<std::string> warnings = texts(calibrate_notes(report), Severity::warning);
  for (std::string& reason : calibrate_null_reasons(report)) warnings.push_back(std::move(reason));
  Object out = body(report);
  out.push_back({"conclusion", calibrate_conclusion(report)});
  out.push_back({"notes", array_of(texts(calibrate_notes(report), Severity::info))});
  return to_json({"calibrate", report.inputs, std::move(warnings)}, out);
}

}  // namespace proofmass::report
