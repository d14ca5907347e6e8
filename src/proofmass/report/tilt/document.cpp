#include <array>
#include <cctype>
#include <fmt/format.h>

#include "proofmass/core/units.hpp"
#include "proofmass/report/consistency_report.hpp"
#include "proofmass/report/tilt/figures.hpp"
#include "proofmass/report/tilt/report.hpp"
#include "proofmass/report/wording.hpp"

namespace proofmass::report {
namespace {

using estimate::AxisTiltSolution;
using estimate::TiltAngles;
using estimate::TiltSolution;

constexpr std::array axis_names{"x", "y", "z"};
constexpr Display degrees{"°", deg_per_rad}, degrees_per_second{"°/s", deg_per_rad};

std::string degree_text(double angle_rad) {
  return significant(angle_rad * deg_per_rad, 2) + "°";
}

// Roll is ill-conditioned if x is nearly vertical: its standard deviation is ten times that of the
// tilt.
bool is_nearly_vertical(const TiltAngles& angles) {
  constexpr double near_rad = 10.0 * rad_per_deg;
  return angles.inclination && angles.inclination->axis == 0 &&
         angles.inclination->angle_rad.value < near_rad;
}

std::string inclination_words(const TiltAngles& angles) {
  if (!angles.inclination) return std::string(absent);
  const estimate::Inclination& one = *angles.inclination;
  std::string words = fmt::format("{} points {}, {} from the vertical", axis_names[one.axis],
                                  one.up ? "up" : "down", degree_words(one.angle_rad));
  if (one.azimuth_rad)
    words += fmt::format(", azimuth {} from {} to {}", degree_words(one.azimuth_rad),
                         axis_names[(one.axis + 1) % 3], axis_names[(one.axis + 2) % 3]);
  return words;
}

std::string conclusion(const TiltReport& report) {
  if (report.axis)
    return fmt::format("The angle is {} at the end.", degree_words(report.axis->angle_rad));
  const TiltSolution& solution = *report.solution;
  const TiltAngles& last = solution.final;
  std::string words =
      is_nearly_vertical(last)
          ? fmt::format("{}; pitch {}", inclination_words(last), degree_words(last.pitch_rad))
          : fmt::format("roll {}, pitch {}", degree_words(last.roll_rad),
                        degree_words(last.pitch_rad));
  words.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(words.front())));
  if (solution.moving) return words + ", at the end of the recording.";
  if (solution.rests.size() == 1) return words + ", over one rest.";
  return fmt::format("{}, over the last of {} rests.", words, solution.rests.size());
}

// Labelled if it is the result, unlabelled for a single rest.
Field roll(const TiltAngles& angles, const char* label = "") {
  return field::measured(
      "roll_rad", angles.roll_rad, "rad",
      {.meaning = "atan2(f_y, f_z), positive where y goes up, 0 where z points up; null where x is "
                  "vertical",
       .label = label,
       .why_null = angles.why_no_roll,
       .display = degrees});
}

Field pitch(const TiltAngles& angles, const char* label = "") {
  return field::measured(
      "pitch_rad", angles.pitch_rad, "rad",
      {.meaning = "positive where x goes down; null where the recorded axes do not determine it",
       .label = label,
       .why_null = angles.why_no_pitch,
       .display = degrees});
}

Field elevations(const TiltAngles& angles) {
  Fields fields;
  for (std::size_t i = 0; i < 3; ++i)
    fields.push_back(
        field::measured(axis_names[i], angles.elevation_rad[i], "rad",
                        {.why_null = "the axis was not recorded, or is nearly vertical"}));
  return field::object("elevation_rad", std::move(fields),
                       {.meaning = "elevation of each axis above the horizontal"});
}

Field inclination(const TiltAngles& angles) {
  std::optional<Fields> fields;
  if (angles.inclination) {
    const estimate::Inclination& one = *angles.inclination;
    fields = Fields{
        field::choice("axis", axis_names[one.axis], {"x", "y", "z"}),
        field::flag("up", one.up, {.meaning = "it points up rather than down"}),
        field::measured("angle_rad", one.angle_rad, "rad",
                        {.meaning = "between the axis and the vertical"}),
        field::measured("azimuth_rad", one.azimuth_rad, "rad",
                        {.meaning = "of the upward vertical in the plane of the other two axes, "
                                    "from y to z, z to x or x to y",
                         .why_null = "the axis is vertical within its uncertainty"})};
  }
  return field::object_or_null(
      "inclination", std::move(fields),
      {.meaning = "of the axis nearest to the vertical: defined where roll is not",
       .why_null = "needs three axes and a known direction of gravity"});
}

Fields rest_fields(const TiltSolution& solution, const estimate::TiltRest& rest) {
  Fields fields{field::count("first_sample", rest.first), field::count("last_sample", rest.last)};
  if (!solution.series.time_s.empty()) {
    fields.push_back(field::number("start_s", solution.series.time_s[rest.first]));
    fields.push_back(field::number("end_s", solution.series.time_s[rest.last]));
  }
  fields.push_back(roll(rest.angles));
  fields.push_back(pitch(rest.angles));
  if (rest.norm_mps2)
    fields.push_back(field::measured("norm_mps2", rest.norm_mps2, "m/s^2",
                                     {.meaning = "of the mean force, with three axes"}));
  return fields;
}

Fields motion_fields(const estimate::TiltMotion& motion) {
  return {field::flag("gyroscope", motion.gyroscope),
          field::magnitude(motion.gyroscope ? "rate_noise_radps_rthz" : "angular_accel_radps2_rthz",
                           motion.drive),
          field::magnitude("accel_std_mps2", motion.accel_std_mps2,
                           {.meaning = "acceleration of the base, each axis, median"}),
          field::magnitude("accel_time_s", motion.accel_time_s,
                           {.meaning = "correlation time of that acceleration"}),
          field::magnitude("reading_std_mps2", motion.reading_std_mps2,
                           {.meaning = "white noise of a measurement in motion"}),
          field::magnitude("gravity_mps2", motion.gravity_mps2),
          field::number("log_likelihood", motion.log_likelihood)};
}

Field down_weighted_count(std::size_t measurements) {
  return field::count("told_less", measurements,
                      {.meaning = "measurements down-weighted by half or more"});
}

Field unusable(std::size_t samples) {
  return field::count("unusable", samples,
                      {.meaning = "samples without a measurement on every channel"});
}

Field mode(std::string_view name) {
  Field field = field::choice(
      "mode", name, {"still", "moving", "angle"},
      {.meaning = "still: from rests; moving: filter and smoother; angle: one angle and its rate"});
  field.shape.decides = true;
  return field;
}

Field axes(std::size_t recorded) {
  Field field = field::count("axes", recorded, {.meaning = "recorded"});
  field.shape.maximum = 3.0;
  return field;
}

Fields axis_fields(const TiltReport& report) {
  const AxisTiltSolution& axis = *report.axis;
  const estimate::AxisTiltNoise& noise = axis.noise;
  const About none{.why_null = "the recording has a single angle, see angle_rad"};
  return {
      mode("angle"),
      field::count("samples", axis.samples),
      unusable(axis.unusable),
      down_weighted_count(axis.down_weighted),
      field::measured("roll_rad", std::nullopt, "rad", none),
      field::measured("pitch_rad", std::nullopt, "rad", none),
      field::measured("angle_rad", axis.angle_rad, "rad",
                      {.meaning = "at the last sample, unwrapped",
                       .label = "Angle at the end",
                       .display = degrees}),
      field::list(
          "rate_bias_radps",
          {field::measured({}, axis.rate_bias_radps, "rad/s", {.display = degrees_per_second})},
          {.meaning = "of the gyroscope at the last sample: x, y and z, or the one of "
                      "mode angle"}),
      field::object("noise",
                    {field::magnitude("rate_noise_radps_rthz", noise.rate_noise_radps_rthz),
                     field::magnitude("rate_bias_walk_radps_rts", noise.rate_bias_walk_radps_rts),
                     field::magnitude("motion_std_rad", noise.motion_std_rad),
                     field::magnitude("motion_time_s", noise.motion_time_s),
                     field::magnitude("reading_std_rad", noise.reading_std_rad),
                     field::number("log_likelihood", noise.log_likelihood),
                     field::flag("converged", noise.converged)},
                    {.meaning = "maximum-likelihood noise model; mode angle"}),
      consistency_field(axis.consistency),
      field::notes(tilt_notes(report))};
}

Field std_from(const estimate::TiltShares& shares) {
  return field::object("std_from",
                       {field::magnitude("noise_rad", shares.noise),
                        field::magnitude("calibration_rad", shares.calibration),
                        field::magnitude("alignment_rad", shares.alignment)},
                       {.meaning = "contributions to the standard deviation of the last direction, "
                                   "rms of the two directions across it"});
}

Field rate_bias(const std::array<Uncertain, 3>& biases_radps) {
  Fields items;
  for (const Uncertain& bias : biases_radps)
    items.push_back(field::measured({}, bias, "rad/s", {.display = degrees_per_second}));
  return field::list("rate_bias_radps", std::move(items));
}

Fields tilt_fields(const TiltReport& report) {
  const TiltSolution& solution = *report.solution;
  Fields fields{
      mode(solution.moving ? "moving" : "still"),
      field::count("samples", solution.samples, {.meaning = "in the recording"}),
      unusable(solution.unusable),
      down_weighted_count(solution.down_weighted),
      axes(solution.axes),
      roll(solution.final, "Roll"),
      pitch(solution.final, "Pitch"),
      elevations(solution.final),
      inclination(solution.final),
      field::magnitude("bias_std_mps2", solution.bias_std_mps2,
                       {.meaning = "standard deviation assumed for the bias of each axis: "
                                   "as given, or from the norm of the force at rest"})};
  if (solution.axes == 3) fields.push_back(std_from(solution.shares));
  fields.push_back(field::records("rests", solution.rests, [&](const estimate::TiltRest& rest) {
    return rest_fields(solution, rest);
  }));
  if (solution.motion)
    fields.push_back(field::object("motion", motion_fields(*solution.motion),
                                   {.meaning = "motion model of the moving base, as identified"}));
  if (solution.rate_bias_radps) fields.push_back(rate_bias(*solution.rate_bias_radps));
  if (solution.consistency) fields.push_back(consistency_field(*solution.consistency));
  fields.push_back(
      field::measured("gravity_mps2", report.gravity_mps2, "m/s^2", {.meaning = "as assumed"}));
  fields.push_back(field::choice("reads", report.reads_minus_g ? "-g" : "+g", {"+g", "-g"},
                                 {.meaning = "output at rest of an axis that points up"}));
  fields.push_back(field::notes(tilt_notes(report)));
  return fields;
}

Table rests_table(const TiltSolution& solution) {
  Table table{"Rests", {"From", "To", "Roll", "Pitch", "Norm of the force"}, {}};
  const std::vector<double>& time_s = solution.series.time_s;
  const auto at = [&](std::size_t k) {
    return time_s.empty() ? "sample " + std::to_string(k) : fixed(time_s[k], 2) + " s";
  };
  for (const estimate::TiltRest& rest : solution.rests)
    table.rows.push_back({at(rest.first), at(rest.last), degree_words(rest.angles.roll_rad),
                          degree_words(rest.angles.pitch_rad),
                          with_std(rest.norm_mps2, "m/s²", absent)});
  return table;
}

Table shares_table(const estimate::TiltShares& shares) {
  return {"Standard deviation of the last direction, by source",
          {"Source", "Standard deviation"},
          {{"Noise and motion", degree_text(shares.noise)},
           {"Calibration", degree_text(shares.calibration)},
           {"Sensor against its case", degree_text(shares.alignment)}}};
}

Table motion_table(const TiltSolution& solution) {
  const estimate::TiltMotion& motion = *solution.motion;
  Table table{"Motion model, as identified", {"Parameter", "Value"}, {}};
  table.rows = {
      {motion.gyroscope ? "White noise of the gyroscope" : "Angular acceleration, white",
       significant(motion.drive * deg_per_rad, 2) + (motion.gyroscope ? " °/s/√Hz" : " °/s²/√Hz")},
      {"Acceleration of the base, each axis, median",
       significant(motion.accel_std_mps2, 2) + " m/s²"},
      {"Its correlation time", significant(motion.accel_time_s, 2) + " s"},
      {"White noise of a measurement in motion", significant(motion.reading_std_mps2, 2) + " m/s²"},
      {"Norm of gravity", fixed(motion.gravity_mps2, 4) + " m/s²"},
      {"Down-weighted measurements", grouped(solution.down_weighted)}};
  if (!solution.rate_bias_radps) return table;
  for (std::size_t i = 0; i < 3; ++i)
    table.rows.push_back(
        {fmt::format("Bias of the gyroscope, {}", axis_names[i]),
         with_std(scaled((*solution.rate_bias_radps)[i], deg_per_rad), "°/s", absent)});
  return table;
}

Table noise_table(const AxisTiltSolution& axis) {
  const estimate::AxisTiltNoise& noise = axis.noise;
  return {"Noise model",
          {"Parameter", "Value"},
          {{"Bias of the gyroscope",
            with_std(scaled(axis.rate_bias_radps, deg_per_rad), "°/s", absent)},
           {"White noise of the gyroscope",
            significant(noise.rate_noise_radps_rthz * deg_per_rad, 2) + " °/s/√Hz"},
           {"Random walk of its bias",
            significant(noise.rate_bias_walk_radps_rts * deg_per_rad, 2) + " °/s/√s"},
           {"Motion disturbance of the angle", degree_text(noise.motion_std_rad) + " rms"},
           {"Its correlation time", significant(noise.motion_time_s, 2) + " s"},
           {"White noise of the angle", degree_text(noise.reading_std_rad)},
           {"Down-weighted measurements", grouped(axis.down_weighted)}}};
}

Section method_section(const TiltReport& report) {
  Section section{
      .heading = "Signs, and how it was computed",
      .paragraphs = {"Axes are right-handed with z upwards where roll and pitch are 0. At rest an "
                     "axis that points up reads +g. Roll = atan2(f_y, f_z) is positive where y "
                     "goes up, pitch = atan2(−f_x, √(f_y² + f_z²)) where x goes down. Gravity does "
                     "not determine the heading."}};
  if (report.reads_minus_g)
    section.paragraphs.emplace_back("This sensor reads −g upwards; its signs were inverted.");
  if (report.solution->moving)
    section.paragraphs.emplace_back(
        "On a moving base a Kalman filter estimates the direction of gravity in the sensor frame, "
        "which rotates with the measured rate or, without a gyroscope, is driven by white angular "
        "acceleration, and the acceleration of the base. The variance of that acceleration follows "
        "the scatter of the force, so that the accelerometer is down-weighted while the base is "
        "shaken. A fixed-interval smoother then uses all measurements at every sample.");
  else
    section.paragraphs.emplace_back(
        "At rest the mean force over each rest gives the angles. The standard deviation of the "
        "mean is that of batch means, which accounts for correlated noise; the sensor file's slow "
        "noise, calibration and alignment are added.");
  section.paragraphs.push_back(
      fmt::format("Gravity was taken as {}.", with_std(report.gravity_mps2, "m/s²")));
  return section;
}

void add_axis_sections(Page& page, const AxisTiltSolution& axis) {
  page.sections.push_back({.heading = "Angle",
                           .figures = {[&] { return axis_angle_figure(axis); },
                                       [&] { return rate_bias_figure(axis); }}});
  page.sections.push_back(
      {.heading = "Noise",
       .paragraphs =
           {"Maximum-likelihood estimates. The effect of motion on the accelerometer's "
            "angle is modelled as exponentially correlated; scale and delay errors of the "
            "gyroscope as 5 % of every turn."},
       .tables = {noise_table(axis)},
       .on_terminal = true});
}

void add_sections(Page& page, const TiltReport& report) {
  const TiltSolution& solution = *report.solution;
  Section angles{
      .heading = "Roll and pitch",
      .figures = {[&] { return roll_figure(solution); }, [&] { return pitch_figure(solution); }},
      .on_terminal = true};
  if (solution.axes == 3) angles.figures.push_back([&] { return gravity_figure(solution); });
  angles.figures.push_back([&] { return tilt_std_figure(solution); });
  const auto reason = [&](const char* angle, const std::string& why) {
    if (!why.empty()) angles.paragraphs.push_back(fmt::format("No {}: {}.", angle, why));
  };
  reason("roll", solution.final.why_no_roll);
  reason("pitch", solution.final.why_no_pitch);
  if (is_nearly_vertical(solution.final))
    angles.paragraphs.emplace_back(
        "With x nearly vertical, roll and heading are nearly the same rotation; the azimuth gives "
        "the direction of the lean.");
  if (!solution.rests.empty()) angles.tables.push_back(rests_table(solution));
  if (solution.axes == 3) angles.tables.push_back(shares_table(solution.shares));
  page.sections.push_back(std::move(angles));
  if (solution.motion)
    page.sections.push_back(
        {.heading = "The motion", .tables = {motion_table(solution)}, .on_terminal = true});
}

}  // namespace

std::vector<Note> tilt_notes(const TiltReport& report) {
  return all_notes(report.notes, report.solution ? report.solution->notes : report.axis->notes);
}

Document describe(const TiltReport& report) {
  Document document{.page = {.verb = "tilt",
                             .title = file_name(report.inputs.front()),
                             .inputs = report.inputs,
                             .conclusion = conclusion(report),
                             .notes = tilt_notes(report)},
                    .fields = report.axis ? axis_fields(report) : tilt_fields(report)};
  Page& page = document.page;
  page.key_figures = key_figures(document.fields);
  const std::optional<estimate::Consistency> consistency =
      report.axis ? std::optional(report.axis->consistency) : report.solution->consistency;
  if (report.solution)
    page.key_figures.push_back({"From the vertical", inclination_words(report.solution->final)});
  if (consistency)
    page.key_figures.push_back({"Mean NIS (1 expected)", fixed(consistency->nis, 3)});
  if (report.axis)
    add_axis_sections(page, *report.axis);
  else
    add_sections(page, report);
  if (consistency) page.sections.push_back(consistency_section(*consistency));
  if (report.solution) page.sections.push_back(method_section(report));
  return document;
}

}  // namespace proofmass::report
