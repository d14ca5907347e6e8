#include <fmt/format.h>

#include "proofmass/core/units.hpp"
#include "proofmass/report/consistency_report.hpp"
#include "proofmass/report/document.hpp"
#include "proofmass/report/page.hpp"
#include "proofmass/report/tilt_figures.hpp"
#include "proofmass/report/tilt_report.hpp"
#include "proofmass/report/wording.hpp"

namespace proofmass::report {
namespace {

using estimate::TiltSolution;

constexpr std::size_t most_rests_shown = 40;

std::string degrees(double angle_rad) {
  return significant(angle_rad * deg_per_rad, 2) + "°";
}

Table rests_table(const TiltSolution& solution) {
  Table table{"Rests", {"From", "To", "Roll", "Pitch", "Norm of the force"}, {}};
  const std::vector<double>& time_s = solution.series.time_s;
  for (const estimate::TiltRest& rest : solution.rests) {
    if (table.rows.size() == most_rests_shown) break;
    const auto at = [&](std::size_t k) {
      return time_s.empty() ? "sample " + std::to_string(k) : fixed(time_s[k], 2) + " s";
    };
    table.rows.push_back({at(rest.first), at(rest.last), degree_words(rest.angles.roll_rad),
                          degree_words(rest.angles.pitch_rad),
                          with_std(rest.norm_mps2, "m/s²", absent)});
  }
  if (solution.rests.size() > most_rests_shown)
    table.caption += fmt::format(": the first {} of {}; the JSON document has all",
                                 most_rests_shown, solution.rests.size());
  return table;
}

Table budget_table(const TiltSolution& solution) {
  return {"Where the standard deviation of the last direction comes from",
          {"Source", "Standard deviation"},
          {{"Noise and motion", degrees(solution.shares.noise)},
           {"Calibration", degrees(solution.shares.calibration)},
           {"Sensor against its case", degrees(solution.shares.alignment)}}};
}

Table motion_table(const TiltSolution& solution) {
  const estimate::TiltMotion& motion = *solution.motion;
  Table table{"What the motion was taken for", {"Figure", "Value"}, {}};
  table.rows = {
      {motion.gyroscope ? "White noise of the gyroscope" : "Angular acceleration, white",
       significant(motion.drive * deg_per_rad, 2) + (motion.gyroscope ? " °/s/√Hz" : " °/s²/√Hz")},
      {"Acceleration of the base, each axis, median",
       significant(motion.accel_std_mps2, 2) + " m/s²"},
      {"Its time constant", significant(motion.accel_time_s, 2) + " s"},
      {"White noise of a reading in motion", significant(motion.reading_std_mps2, 2) + " m/s²"},
      {"Norm of gravity", fixed(motion.gravity_mps2, 4) + " m/s²"},
      {"Readings that lost half of their weight", count_words(solution.told_less, "reading")}};
  if (!solution.rate_bias_radps) return table;
  constexpr std::array names{"x", "y", "z"};
  for (std::size_t i = 0; i < 3; ++i)
    table.rows.push_back(
        {fmt::format("Bias of the gyroscope, {}", names[i]),
         with_std(scaled((*solution.rate_bias_radps)[i], deg_per_rad), "°/s", absent)});
  return table;
}

Section signs_section(const TiltReport& report) {
  Section section{
      .heading = "Signs, and how it was computed",
      .paragraphs = {"Axes are right-handed with z upwards where roll and pitch are 0. At rest an "
                     "axis that points up reads +g. Roll = atan2(f_y, f_z) is positive where y "
                     "goes up, pitch = atan2(−f_x, √(f_y² + f_z²)) where x goes down. Heading "
                     "cannot be told from gravity."}};
  if (report.reads_minus_g)
    section.paragraphs.emplace_back(
        "This sensor reads −g upwards; its readings were turned round.");
  if (report.solution->moving)
    section.paragraphs.emplace_back(
        "On a moving base a Kalman filter follows the direction of gravity in the sensor, which "
        "turns as the gyroscope says or, without one, by white angular acceleration, and beside "
        "it the acceleration of the base. Its strength is read off the scatter of the force, so "
        "that the accelerometer is told less while the base is shaken. A fixed-interval smoother "
        "then judges every instant by all readings.");
  else
    section.paragraphs.emplace_back(
        "At rest the mean force over each rest gives the angles. The standard deviation of the "
        "mean comes from batch means, which count correlated noise; to it come what the sensor "
        "file says of slow noise, of the calibration and of the case.");
  section.paragraphs.push_back(
      fmt::format("Gravity was taken as {}.", with_std(report.gravity_mps2, "m/s²")));
  return section;
}

Page axis_page(const TiltReport& report, Page page) {
  const estimate::AxisTiltSolution& axis = *report.axis;
  const estimate::AxisTiltNoise& noise = axis.noise;
  page.key_figures = {
      {"Angle at the end", degree_words(axis.angle_rad)},
      {"Bias of the gyroscope", with_std(scaled(axis.rate_bias_radps, deg_per_rad), "°/s", absent)},
      {"Motion adds to the angle", degrees(noise.motion_std_rad)},
      {"Mean NIS (1 expected)", fixed(axis.consistency.nis, 3)}};
  page.sections.push_back({.heading = "Angle", .figures = axis_tilt_figures(axis)});
  page.sections.push_back(
      {.heading = "Noise, as the recording tells it",
       .paragraphs =
           {"Figures of largest likelihood. What motion does to the angle of the "
            "accelerometer is exponentially correlated; of a gyroscope that is late or off "
            "scale 5 % of every turn is in doubt."},
       .tables = {{"Noise",
                   {"Figure", "Value"},
                   {{"White noise of the gyroscope",
                     significant(noise.rate_noise_radps_rthz * deg_per_rad, 2) + " °/s/√Hz"},
                    {"Walk of its bias",
                     significant(noise.rate_bias_walk_radps_rts * deg_per_rad, 2) + " °/s/√s"},
                    {"What motion adds to the angle", degrees(noise.motion_std_rad)},
                    {"Its time constant", significant(noise.motion_time_s, 2) + " s"},
                    {"White noise of the angle", degrees(noise.reading_std_rad)}}}}});
  page.sections.push_back(consistency_section(axis.consistency));
  return page;
}

}  // namespace

std::string tilt_html(const TiltReport& report) {
  Page page{.verb = "tilt",
            .title = file_name(report.inputs.front()),
            .inputs = report.inputs,
            .conclusion = tilt_conclusion(report),
            .notes = tilt_notes(report)};
  if (report.axis) return html(axis_page(report, std::move(page)));
  const TiltSolution& solution = *report.solution;
  page.key_figures = {{"Roll", degree_words(solution.final.roll_rad)},
                      {"Pitch", degree_words(solution.final.pitch_rad)},
                      {"From the vertical", inclination_words(solution.final)},
                      {"Rests", std::to_string(solution.rests.size())}};
  if (solution.consistency)
    page.key_figures.push_back({"Mean NIS (1 expected)", fixed(solution.consistency->nis, 3)});
  Section angles{.heading = "Roll and pitch", .figures = tilt_figures(solution)};
  if (solution.axes == 3) angles.figures.push_back(gravity_figure(solution));
  angles.figures.push_back(tilt_std_figure(solution));
  for (const auto& [name, why] : {std::pair{"roll", solution.final.why_no_roll},
                                  std::pair{"pitch", solution.final.why_no_pitch}})
    if (!why.empty()) angles.paragraphs.push_back(fmt::format("No {} at the end: {}.", name, why));
  if (!solution.rests.empty()) angles.tables.push_back(rests_table(solution));
  if (solution.axes == 3) angles.tables.push_back(budget_table(solution));
  page.sections.push_back(std::move(angles));
  if (solution.motion)
    page.sections.push_back({.heading = "The motion", .tables = {motion_table(solution)}});
  if (solution.consistency) page.sections.push_back(consistency_section(*solution.consistency));
  page.sections.push_back(signs_section(report));
  return html(page);
}

}  // namespace proofmass::report
