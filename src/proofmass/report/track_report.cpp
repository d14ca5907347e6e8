#include "proofmass/report/track_report.hpp"

#include <cmath>
#include <fmt/format.h>

#include "proofmass/core/units.hpp"
#include "proofmass/report/consistency_report.hpp"
#include "proofmass/report/document.hpp"
#include "proofmass/report/track_wording.hpp"
#include "proofmass/report/wording.hpp"

namespace proofmass::report {
namespace {

using estimate::Stroke;
using estimate::TrackMethod;
using estimate::TrackSolution;
using Rows = std::vector<std::vector<std::string>>;

Rows method_rows(const TrackSolution& solution) {
  Rows rows{{"method", "displacement", "95 % interval", "farthest", "path"}};
  const auto add = [&](const char* name, const std::optional<TrackMethod>& method) {
    if (!method) return;
    rows.push_back({name, length_with_std(method->displacement_m), interval_words(*method),
                    length_with_std(method->peak_m),
                    method->path_std_m ? length_with_std({method->path_m, *method->path_std_m})
                                       : length_words(method->path_m)});
  };
  add("smoother", solution.smoother);
  add("filter (Kalman)", solution.kalman);
  add("double integration", solution.double_integration);
  return rows;
}

constexpr std::size_t most_strokes = 20;

Rows stroke_rows(const std::vector<Stroke>& strokes) {
  Rows rows{{"stroke", "from", "turns", "to", "out", "back", "length"}};
  for (const Stroke& stroke : strokes) {
    if (rows.size() > most_strokes) break;
    rows.push_back({std::to_string(rows.size()), fixed(stroke.start_s, 2) + " s",
                    stroke.back_m ? fixed(stroke.turn_s, 2) + " s" : "",
                    fixed(stroke.end_s, 2) + " s", fixed(stroke.out_m.value, 3) + " m",
                    stroke.back_m ? fixed(stroke.back_m->value, 3) + " m" : "",
                    length_with_std(stroke.length_m)});
  }
  return rows;
}

Channel channel(const char* name, const char* unit, const std::vector<double>& values) {
  return {name, *parse_unit(unit), values};
}

}  // namespace

std::string track_text(const TrackReport& report) {
  const TrackSolution& solution = report.solution;
  std::string text = "What this sensor, this duration and these stops allow:\n";
  for (const std::string& sentence : budget_words(solution)) text += "  " + sentence + '\n';
  text += '\n' + track_conclusion(solution) + '\n';
  if (solution.smoother) text += '\n' + aligned(method_rows(solution));
  if (solution.fused && solution.smoother) text += '\n' + aligned(fused_rows(solution));
  if (!solution.strokes.empty()) {
    text += '\n' + aligned(stroke_rows(solution.strokes));
    if (solution.strokes.size() > most_strokes)
      text += fmt::format("  … and {} more: --json and --report have all\n",
                          solution.strokes.size() - most_strokes);
  }
  text += fmt::format("\n  {}, gravity {}", count_words(solution.rests.size(), "rest"),
                      gravity_words(solution.gravity));
  if (!solution.closures.empty()) text += "; " + closures_words(solution.closures);
  text += ".\n";
  if (const std::string model = model_words(solution); !model.empty()) text += "  " + model + '\n';
  if (solution.consistency.innovations > 0)
    text += "  " + consistency_conclusion(solution.consistency) + '\n';
  return text;
}

Recording track_series(const TrackReport& report) {
  const estimate::TrackSeries& series = report.solution.series;
  Recording out;
  out.source = "proofmass track";
  out.format = "series";
  out.time.source = TimeSource::stamps;
  out.time.stamps_s = series.time_s;
  if (report.solution.smoother) {
    out.channels = {channel("position", "m", series.position_m),
                    channel("position_std", "m", series.position_std_m),
                    channel("velocity", "m/s", series.velocity_mps),
                    channel("velocity_std", "m/s", series.velocity_std_mps),
                    channel("filtered_position", "m", series.filtered_position_m),
                    channel("filtered_position_std", "m", series.filtered_position_std_m),
                    channel("filtered_velocity", "m/s", series.filtered_velocity_mps),
                    channel("double_integral_position", "m", series.double_integral_m)};
  }
  out.channels.push_back(channel("accel", "m/s^2", series.accel_mps2));
  out.channels.push_back(
      {"resting", {}, std::vector<double>(series.resting.begin(), series.resting.end())});
  // A method that had nothing to say has no column.
  std::erase_if(out.channels,
                [&](const Channel& c) { return c.values.size() != series.time_s.size(); });
  return out;
}

}  // namespace proofmass::report
