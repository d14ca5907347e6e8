#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "proofmass/core/units.hpp"
#include "proofmass/report/simulate_report.hpp"
#include "proofmass/report/wording.hpp"

namespace proofmass::report {
namespace {

using simulate::TruePose;
using simulate::TrueStroke;

// Revolutions and maximum speed, from the true trajectory.
struct Motion {
  double turns = 0.0, peak_rpm = 0.0;
};

Motion motion(const Recording& truth) {
  Motion found;
  const Channel* angle = truth.find("angle");
  const Channel* speed = truth.find("speed");
  if (angle != nullptr && !angle->values.empty())
    found.turns = (angle->values.back() - angle->values.front()) / rad_per_turn;
  if (speed != nullptr)
    for (const double radps : speed->values)
      found.peak_rpm = std::max(found.peak_rpm, std::abs(radps) / radps_per_rpm);
  return found;
}

// Entries common to the rig and the procedures; `Report` is either report type.
template <class Report>
Fields file_fields(const Report& report) {
  return {field::text("file", report.output, {.meaning = "the recording; - is standard output"}),
          field::text("truth_file", report.truth,
                      {.meaning = "empty if the recording went to standard output"})};
}

template <class Report>
Fields recording_fields(const Report& report) {
  const Recording& recording = report.result.recording;
  return {field::count("samples", recording.samples()),
          field::number("rate_hz", report.options.rate_hz),
          field::number("duration_s", recording.duration_s()),
          field::number("gravity_mps2", report.options.gravity_mps2),
          field::records("channels", recording.channels, [](const Channel& channel) {
            return Fields{field::text("name", channel.name),
                          field::text("unit", channel.unit.symbol)};
          })};
}

template <class Report>
Document document_of(const Report& report, std::string conclusion, Fields fields) {
  return {.page = {.verb = "simulate",
                   .title = file_name(report.output),
                   .inputs = report.inputs,
                   .conclusion = std::move(conclusion),
                   .notes = report.result.recording.notes},
          .fields = std::move(fields)};
}

// The files and their content.
template <class Report>
Table files_table(const Report& report, const std::string& truth) {
  const Recording& recording = report.result.recording;
  Table table{"Files written",
              {},
              {{"recording", report.output,
                fmt::format("{} of {}", count_words(recording.channels.size(), "channel"),
                            count_words(recording.samples(), "sample"))}}};
  if (!report.truth.empty()) table.rows.push_back({"truth", report.truth, truth});
  return table;
}

Fields rig_fields(const SimulateReport& report) {
  const Motion wheel = motion(report.result.truth);
  Fields fields = file_fields(report);
  fields.push_back(field::count("seed", report.options.seed));
  append(fields, recording_fields(report));
  fields.push_back(field::object("truth", {field::number("turns", wheel.turns),
                                           field::magnitude("peak_speed_rpm", wheel.peak_rpm)}));
  return fields;
}

Fields pose_fields(const TruePose& pose) {
  Fields fields{field::count("number", pose.number), field::number("start_s", pose.start_s),
                field::number("end_s", pose.end_s), field::numbers("force_mps2", pose.force_mps2)};
  if (pose.plane > 0)
    append(fields, {field::count("plane", static_cast<std::size_t>(pose.plane)),
                    field::number("mount_rad", pose.mount_rad),
                    field::number("commanded_rad", pose.commanded_rad),
                    field::number("angle_rad", pose.angle_rad)});
  return fields;
}

Fields stroke_fields(const TrueStroke& stroke) {
  return {field::count("number", stroke.number),    field::count("set", stroke.set),
          field::number("start_s", stroke.start_s), field::number("end_s", stroke.end_s),
          field::number("from_m", stroke.from_m),   field::number("to_m", stroke.to_m)};
}

Field axes(const ProcedureReport& report) {
  Fields items;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const Channel& channel = report.result.recording.channels[axis];
    Fields one{field::text("name", channel.name), field::text("unit", channel.unit.symbol)};
    for (const sensor::CoefficientInfo& info : sensor::coefficients())
      one.push_back(
          field::number(std::string(info.name), report.result.truth.equations[axis].*info.member));
    items.push_back(field::object({}, std::move(one)));
  }
  return field::list("axes", std::move(items),
                     {.meaning = "coefficients of the model equation: K1 in unit per m/s^2, all "
                                 "others in SI"});
}

// The three values of a calibration figure, in a display unit of their own.
Field true_figures(const char* key, const sensor::AxisFigures& figures, About about) {
  Fields items;
  for (const auto& figure : figures)
    items.push_back(field::number({}, figure ? std::optional(figure->si()) : std::nullopt));
  return field::list(key, std::move(items), std::move(about));
}

Fields truth_fields(const ProcedureReport& report) {
  const simulate::ProcedureTruth& truth = report.result.truth;
  const sensor::Calibration& calibration = truth.sensor.calibration;
  Fields fields{
      field::records("positions", truth.poses, pose_fields,
                     {.meaning = "static intervals; plane, mount and angles of a table only"}),
      axes(report),
      true_figures("bias", calibration.bias, {.meaning = "m/s^2, as in the sensor file"}),
      true_figures("scale", calibration.scale, {}),
      true_figures("misalignment_rad", calibration.misalignment, {}),
      field::numbers("mean_drift_mps2", truth.mean_drift_mps2,
                     {.meaning = "of the drift over the static intervals, which a calibration "
                                 "includes in the bias"})};
  if (!truth.strokes.empty())
    append(fields,
           {field::records("strokes", truth.strokes, stroke_fields, {.meaning = "of a slide"}),
            field::numbers("line", truth.line,
                           {.meaning = "of a slide: its direction in the sensor's axes at "
                                       "the first static interval"})});
  return fields;
}

Fields procedure_fields(const ProcedureReport& report) {
  const auto name = std::string(simulate::name_of(report.options.procedure));
  Fields fields{field::choice(
      "procedure", name, {"tumble", "four-position", "six-position", "multi-position", "slide"})};
  append(fields, file_fields(report));
  append(fields,
         {field::text("sensor_file", report.sensor), field::count("seed", report.options.seed),
          field::count("session", report.options.session)});
  append(fields, recording_fields(report));
  fields.push_back(field::object("truth", truth_fields(report)));
  return fields;
}

// At the shaft of the load; inertia and dry friction are the sums of motor and load.
Fields motor_truth(const simulate::GearMotorParameters& p) {
  return {
      field::number("resistance", p.resistance_ohm, {.meaning = "ohm"}),
      field::number("torque_constant", p.torque_constant_nmpa, {.meaning = "N*m/A"}),
      field::number("inertia", p.motor_inertia_kgm2 + p.load_inertia_kgm2, {.meaning = "kg*m^2"}),
      field::number("viscous_friction", p.viscous_nmspr, {.meaning = "N*m*s/rad"}),
      field::number("coulomb_friction", p.coulomb_nm + p.load_coulomb_nm, {.meaning = "N*m"}),
      field::number("breakaway_friction", p.breakaway_nm + p.load_coulomb_nm, {.meaning = "N*m"}),
      field::number("stribeck_speed", p.stribeck_speed_radps, {.meaning = "rad/s"}),
      field::number("unbalance", p.unbalance_nm, {.meaning = "N*m"}),
      field::number("backlash", p.backlash_rad, {.meaning = "rad"})};
}

Fields motor_fields(const MotorRigReport& report) {
  Fields fields{field::choice("procedure", "motor", {"motor"})};
  append(fields, file_fields(report));
  fields.push_back(field::count("seed", report.options.seed));
  append(fields, recording_fields(report));
  fields.push_back(field::object("truth", motor_truth(report.options.drive)));
  return fields;
}

// "0.22589, −0.06487, 0.14264": more digits than for estimates, since the values are exact.
std::string three(const sensor::AxisFigures& values, double to_shown, int decimals) {
  std::string text;
  for (const auto& figure : values)
    if (figure) text += (text.empty() ? "" : ", ") + fixed(figure->si() * to_shown, decimals);
  return text;
}

Table true_sensor_table(const sensor::Calibration& calibration) {
  return {"The true sensor, as a perfect calibration would find it",
          {},
          {{"bias", three(calibration.bias, 1.0, 5) + " m/s²"},
           {"scale", three(calibration.scale, 1.0, 6)},
           {"misalignment", three(calibration.misalignment, 1e3, 3) + " mrad"}}};
}

}  // namespace

Document describe(const SimulateReport& report) {
  const Recording& recording = report.result.recording;
  const Motion wheel = motion(report.result.truth);
  Document document = document_of(
      report,
      fmt::format("Simulated {} at {} Hz, seed {}: {} turns, top speed {} rpm.",
                  duration_words(recording.duration_s()), compact(report.options.rate_hz, 6),
                  report.options.seed, fixed(wheel.turns, 4), significant(wheel.peak_rpm, 4)),
      rig_fields(report));
  document.page.sections = {{.heading = "Result",
                             .tables = {files_table(report, "angle, speed, acceleration, biases")},
                             .on_terminal = true}};
  return document;
}

Document describe(const ProcedureReport& report) {
  const Recording& recording = report.result.recording;
  const simulate::ProcedureTruth& truth = report.result.truth;
  const bool slides = !truth.strokes.empty();
  Document document =
      document_of(report,
                  fmt::format("Simulated {}, {} at {} Hz, seed {}: {}.",
                              simulate::name_of(report.options.procedure),
                              duration_words(recording.duration_s()),
                              compact(report.options.rate_hz, 6), report.options.seed,
                              slides ? count_words(truth.strokes.size(), "stroke")
                                     : count_words(truth.poses.size(), "position")),
                  procedure_fields(report));
  Table files = files_table(report, slides ? "force, drift, displacement, static intervals, strokes"
                                           : "force, drift, static intervals");
  if (!report.sensor.empty())
    files.rows.push_back({"sensor", report.sensor, "the true sensor, as a sensor file"});
  document.page.sections = {
      {.heading = "Result",
       .tables = {std::move(files), true_sensor_table(truth.sensor.calibration)},
       .on_terminal = true}};
  return document;
}

Document describe(const MotorRigReport& report) {
  const Recording& recording = report.result.recording;
  const Motion load = motion(report.result.truth);
  Document document = document_of(
      report,
      fmt::format("Simulated motor, {} at {} Hz, seed {}: top speed {} rpm.",
                  duration_words(recording.duration_s()), compact(report.options.rate_hz, 6),
                  report.options.seed, significant(load.peak_rpm, 4)),
      motor_fields(report));
  document.page.sections = {
      {.heading = "Result",
       .tables = {files_table(report, "angles and speeds of load and motor, contact of the gear")},
       .on_terminal = true}};
  return document;
}

}  // namespace proofmass::report
