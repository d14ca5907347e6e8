#include "proofmass/report/tilt_report.hpp"

#include <array>
#include <cctype>
#include <fmt/format.h>

#include "proofmass/core/units.hpp"
#include "proofmass/report/consistency_report.hpp"
#include "proofmass/report/document.hpp"
#include "proofmass/report/wording.hpp"

namespace proofmass::report {
namespace {

using estimate::TiltAngles;
using estimate::TiltSolution;

constexpr std::size_t most_rests = 20;

std::string angles_words(const TiltAngles& angles) {
  return fmt::format("roll {}, pitch {}", degree_words(angles.roll_rad),
                     degree_words(angles.pitch_rad));
}

// Roll means little where x is nearly vertical: one in ten of its standard deviation is the tilt's.
bool is_nearly_vertical(const TiltAngles& angles) {
  constexpr double near_rad = 10.0 * rad_per_deg;
  return angles.inclination && angles.inclination->axis == 0 &&
         angles.inclination->angle_rad.value < near_rad;
}

Channel channel(const char* name, const char* unit, const std::vector<double>& values) {
  return {name, *parse_unit(unit), values};
}

std::string rests_text(const TiltSolution& solution) {
  std::vector<std::vector<std::string>> rows{{"rest", "roll", "pitch", "|force|"}};
  for (const estimate::TiltRest& rest : solution.rests) {
    if (rows.size() > most_rests) break;
    const bool timed = !solution.series.time_s.empty();
    rows.push_back({timed ? fmt::format("{} … {} s", fixed(solution.series.time_s[rest.first], 2),
                                        fixed(solution.series.time_s[rest.last], 2))
                          : fmt::format("samples {} … {}", rest.first, rest.last),
                    degree_words(rest.angles.roll_rad), degree_words(rest.angles.pitch_rad),
                    with_std(rest.norm_mps2, "m/s²", "")});
  }
  std::string text = aligned(rows);
  if (solution.rests.size() > most_rests)
    text += fmt::format("  and {} more\n", solution.rests.size() - most_rests);
  return text;
}

std::string motion_text(const TiltSolution& solution) {
  const estimate::TiltMotion& motion = *solution.motion;
  return aligned(
      {{"by", motion.gyroscope ? "accelerometer and gyroscope" : "accelerometer alone"},
       {motion.gyroscope ? "gyroscope's noise" : "angular acceleration",
        significant(motion.drive * deg_per_rad, 2) + (motion.gyroscope ? " °/s/√Hz" : " °/s²/√Hz")},
       {"acceleration of the base",
        fmt::format("{} m/s² for {} s at a time", significant(motion.accel_std_mps2, 2),
                    significant(motion.accel_time_s, 2))},
       {"readings told less", count_words(solution.told_less, "reading")}});
}

std::string axis_text(const TiltReport& report) {
  const estimate::AxisTiltSolution& axis = *report.axis;
  const estimate::AxisTiltNoise& noise = axis.noise;
  std::string text = aligned(
      {{"angle at the end", degree_words(axis.angle_rad)},
       {"gyroscope's bias", with_std(scaled(axis.rate_bias_radps, deg_per_rad), "°/s", absent)},
       {"gyroscope's noise",
        significant(noise.rate_noise_radps_rthz * deg_per_rad, 2) + " °/s/√Hz"},
       {"what motion does to the angle",
        fmt::format("{}° for {} s at a time", significant(noise.motion_std_rad * deg_per_rad, 2),
                    significant(noise.motion_time_s, 2))},
       {"noise of the angle", significant(noise.reading_std_rad * deg_per_rad, 2) + "°"},
       {"readings told less", count_words(axis.told_less, "reading")}});
  text += "\n  Consistency: " + nis_words(axis.consistency) + ".\n";
  return text + "  " + consistency_conclusion(axis.consistency) + '\n';
}

}  // namespace

std::string inclination_words(const TiltAngles& angles) {
  if (!angles.inclination) return std::string(absent);
  const estimate::Inclination& one = *angles.inclination;
  constexpr std::array names{"x", "y", "z"};
  std::string text = fmt::format("{} points {}, {} from the vertical", names[one.axis],
                                 one.up ? "up" : "down", degree_words(one.angle_rad));
  if (one.azimuth_rad)
    text += fmt::format(", azimuth {} from {} to {}", degree_words(one.azimuth_rad),
                        names[(one.axis + 1) % 3], names[(one.axis + 2) % 3]);
  return text;
}

std::vector<Note> tilt_notes(const TiltReport& report) {
  std::vector<Note> notes = report.notes;
  const std::vector<Note>& own = report.solution ? report.solution->notes : report.axis->notes;
  notes.insert(notes.end(), own.begin(), own.end());
  return notes;
}

std::string tilt_conclusion(const TiltReport& report) {
  if (report.axis)
    return fmt::format("The angle is {} at the end.", degree_words(report.axis->angle_rad));
  const TiltSolution& solution = *report.solution;
  std::string text = angles_words(solution.final);
  if (is_nearly_vertical(solution.final))
    text = fmt::format("{}; pitch {}", inclination_words(solution.final),
                       degree_words(solution.final.pitch_rad));
  text.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(text.front())));
  if (solution.moving) return text + ", at the end of the recording.";
  if (solution.rests.size() == 1) return text + ", over one rest.";
  return fmt::format("{}, over the last of {} rests.", text, solution.rests.size());
}

std::string tilt_text(const TiltReport& report) {
  std::string text = tilt_conclusion(report) + "\n\n";
  if (report.axis) return text + axis_text(report);
  const TiltSolution& solution = *report.solution;
  if (is_nearly_vertical(solution.final))
    text += "  Roll " + degree_words(solution.final.roll_rad) +
            ": with x nearly vertical roll and heading are nearly one rotation; the azimuth says "
            "which way it leans.\n\n";
  else if (!solution.final.why_no_roll.empty())
    text += "  No roll: " + solution.final.why_no_roll + ".\n\n";
  if (!solution.final.why_no_pitch.empty())
    text += "  No pitch: " + solution.final.why_no_pitch + ".\n\n";
  if (!solution.rests.empty()) text += rests_text(solution) + '\n';
  if (solution.motion) text += motion_text(solution) + '\n';
  if (solution.axes == 3)
    text +=
        aligned({{"of the standard deviation:"},
                 {"noise", significant(solution.shares.noise * deg_per_rad, 2) + "°"},
                 {"calibration", significant(solution.shares.calibration * deg_per_rad, 2) + "°"},
                 {"case", significant(solution.shares.alignment * deg_per_rad, 2) + "°"}});
  if (!solution.consistency) return text;
  text += "\n  Consistency: " + nis_words(*solution.consistency) + ".\n";
  return text + "  " + consistency_conclusion(*solution.consistency) + '\n';
}

Recording tilt_series(const TiltReport& report) {
  Recording out;
  out.source = "proofmass tilt";
  out.format = "series";
  if (report.axis) {
    const estimate::AxisTiltSeries& s = report.axis->series;
    out.time.source = TimeSource::stamps;
    out.time.stamps_s = s.time_s;
    out.channels = {channel("angle", "rad", s.angle_rad),
                    channel("angle_std", "rad", s.angle_std_rad),
                    channel("filtered_angle", "rad", s.filtered_angle_rad),
                    channel("filtered_angle_std", "rad", s.filtered_angle_std_rad),
                    channel("rate_bias", "rad/s", s.rate_bias_radps),
                    channel("rate_bias_std", "rad/s", s.rate_bias_std_radps)};
    out.channels.push_back({"weight", {}, std::vector<double>(s.weight.begin(), s.weight.end())});
    return out;
  }
  const estimate::TiltSeries& s = report.solution->series;
  out.time.source = s.time_s.empty() ? TimeSource::none : TimeSource::stamps;
  out.time.stamps_s = s.time_s;
  out.channels = {channel("roll", "rad", s.roll_rad),
                  channel("roll_std", "rad", s.roll_std_rad),
                  channel("pitch", "rad", s.pitch_rad),
                  channel("pitch_std", "rad", s.pitch_std_rad),
                  channel("filtered_roll", "rad", s.filtered_roll_rad),
                  channel("filtered_roll_std", "rad", s.filtered_roll_std_rad),
                  channel("filtered_pitch", "rad", s.filtered_pitch_rad),
                  channel("filtered_pitch_std", "rad", s.filtered_pitch_std_rad)};
  constexpr std::array up{"up_x", "up_y", "up_z"};
  for (std::size_t i = 0; i < 3; ++i) out.channels.push_back({up[i], {}, s.up[i]});
  out.channels.push_back({"weight", {}, std::vector<double>(s.weight.begin(), s.weight.end())});
  out.channels.push_back({"at_rest", {}, std::vector<double>(s.resting.begin(), s.resting.end())});
  return out;
}

}  // namespace proofmass::report
