#include "proofmass/report/track_wording.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>

#include "proofmass/core/statistics.hpp"
#include "proofmass/report/document.hpp"
#include "proofmass/report/track_report.hpp"
#include "proofmass/report/wording.hpp"

namespace proofmass::report {

using estimate::Closure;
using estimate::GravityContent;
using estimate::Stroke;
using estimate::TrackBudget;
using estimate::TrackMethod;
using estimate::TrackSolution;

namespace {

std::string plural(std::size_t count, std::string_view one, std::string_view many) {
  return grouped(count) + " " + std::string(count == 1 ? one : many);
}

}  // namespace

std::string length_with_std(const Uncertain& length_m) {
  constexpr double in_mm_below = 0.1;
  if (std::max(std::abs(length_m.value), length_m.std) >= in_mm_below)
    return with_std(length_m, "m");
  return with_std(*scaled(length_m, 1e3), "mm");
}

std::string interval_words(double lower_m, double upper_m) {
  constexpr double in_mm_below = 0.1;
  const bool in_mm = std::max(std::abs(lower_m), std::abs(upper_m)) < in_mm_below;
  const double factor = in_mm ? 1e3 : 1.0;
  const double width = std::max(factor * (upper_m - lower_m), 1e-6);
  const int decimals = std::min(1 - static_cast<int>(std::floor(std::log10(width))), 6);
  return fmt::format("{} to {} {}", fixed(factor * lower_m, decimals),
                     fixed(factor * upper_m, decimals), in_mm ? "mm" : "m");
}

std::string interval_words(const TrackMethod& method) {
  const double end = method.displacement_m.value;
  return interval_words(end - method.half_width_95_m, end + method.half_width_95_m);
}

std::string_view name_of(GravityContent gravity) {
  switch (gravity) {
    case GravityContent::removed:
      return "removed";
    case GravityContent::present:
      return "present";
    case GravityContent::unknown:
      break;
  }
  return "unknown";
}

std::string_view gravity_words(GravityContent gravity) {
  switch (gravity) {
    case GravityContent::removed:
      return "not in the readings";
    case GravityContent::present:
      return "in the readings";
    case GravityContent::unknown:
      break;
  }
  return "in the readings or not: not known";
}

std::string_view kind_of(const Stroke& stroke) {
  return stroke.back_m ? "there_and_back" : "one_way";
}

std::string axis_words(const TrackSolution& solution) {
  const auto& axis = solution.axis;
  const std::string of = solution.axis_in_world ? " of the world, z up" : " of the sensor";
  constexpr std::array letters{"x", "y", "z"};
  for (std::size_t a = 0; a < 3; ++a) {
    if (std::abs(std::abs(axis[a]) - 1.0) < 5e-5)
      return std::string(axis[a] < 0.0 ? "−" : "") + letters[a] + of;
  }
  return fmt::format("({}, {}, {}){}", fixed(axis[0], 3), fixed(axis[1], 3), fixed(axis[2], 3), of);
}

std::optional<StrokeSummary> summary_of(const std::vector<Stroke>& strokes) {
  if (strokes.empty()) return std::nullopt;
  StrokeSummary summary;
  summary.count = strokes.size();
  std::vector<double> lengths, stds;
  Moments scatter;
  for (const Stroke& stroke : strokes) {
    if (stroke.back_m) ++summary.there_and_back;
    lengths.push_back(stroke.length_m.value);
    stds.push_back(stroke.length_m.std);
    scatter.add(stroke.length_m.value);
  }
  summary.median_length_m = {median(lengths).value_or(0.0), median(stds).value_or(0.0)};
  if (strokes.size() > 1) summary.spread_m = scatter.std();
  return summary;
}

std::string strokes_words(const StrokeSummary& summary) {
  const std::size_t one_way = summary.count - summary.there_and_back;
  std::string text;
  if (summary.there_and_back > 0)
    text = plural(summary.there_and_back, "stroke there and back", "strokes there and back");
  if (one_way > 0) {
    text += (text.empty() ? "" : " and ") +
            (text.empty() ? plural(one_way, "stroke one way", "strokes one way")
                          : grouped(one_way) + " one way");
  }
  if (summary.count == 1) return text + ", " + length_with_std(summary.median_length_m) + " long";
  return fmt::format("{}, median length {}, scattering by {}", text,
                     length_with_std(summary.median_length_m),
                     length_words(summary.spread_m.value_or(0.0)));
}

std::vector<std::string> budget_words(const TrackSolution& solution) {
  const TrackBudget& budget = solution.budget;
  std::vector<std::string> sentences;
  const std::string walk =
      budget.walk_mps2_rts > 0.0
          ? fmt::format(", a bias that walks by {} m/s²/√s", significant(budget.walk_mps2_rts, 2))
          : "";
  sentences.push_back(
      fmt::format("Noise along the axis {} m/s²/√Hz{}; {} of motion, at most {} from stop to stop.",
                  significant(budget.white_mps2_rthz, 2), walk, duration_words(budget.motion_s),
                  duration_words(budget.longest_motion_s)));
  std::string allowed;
  if (budget.free_m)
    allowed = "Plain double integration is off by " + length_words(*budget.free_m) + " at the end";
  if (budget.worst_m && budget.end_m) {
    allowed += fmt::format("{} all stops and fixes it is {} at worst, {} at the end",
                           allowed.empty() ? "With" : "; with", length_words(*budget.worst_m),
                           length_words(*budget.end_m));
  }
  if (!allowed.empty()) sentences.push_back(allowed + " (one standard deviation).");
  constexpr double much_wider = 2.0;
  if (solution.smoother && budget.end_m &&
      solution.smoother->displacement_m.std > much_wider * *budget.end_m)
    sentences.emplace_back(
        "That is from its noise at rest; what it errs by in motion, as the stops show it, makes "
        "the intervals below wider.");
  return sentences;
}

std::string refusal(const TrackSolution& solution) {
  if (solution.smoother) return {};
  if (!solution.alternatives.empty() || solution.too_many_in_doubt)
    return "which of the quiet stretches are rests cannot be told";
  return solution.suspected_jerk
             ? "the readings behave like the rate of change of an acceleration (jerk)"
             : "this recording does not determine it";
}

std::string closures_words(const std::vector<Closure>& closures) {
  double squares = 0.0, normalised = 0.0;
  for (const Closure& closure : closures) {
    squares += closure.velocity_mps * closure.velocity_mps;
    const double ratio = closure.velocity_mps / closure.expected_std_mps;
    if (std::isfinite(ratio)) normalised += ratio * ratio;
  }
  const auto n = static_cast<double>(std::max<std::size_t>(closures.size(), 1));
  return fmt::format(
      "on arrival at {} the velocity was off by {} m/s rms, {} of its standard "
      "deviation",
      count_words(closures.size(), "stop"), significant(std::sqrt(squares / n), 2),
      significant(std::sqrt(normalised / n), 2));
}

std::string_view name_of(estimate::TrackModel model) {
  switch (model) {
    case estimate::TrackModel::pva:
      return "pva";
    case estimate::TrackModel::fused:
      return "fused";
    default:
      return "inertial";
  }
}

std::string model_words(const TrackSolution& solution) {
  if (solution.model == estimate::TrackModel::inertial) return "";
  std::string text = solution.fused ? fmt::format("Model fused: {} accelerometers, one motion",
                                                  solution.fused->sensors.size())
                                    : std::string("Model pva: the acceleration is estimated");
  if (!solution.jerk_psd_m2ps5) return text + "; the readings do not tell how hard it jerks.";
  const Uncertain& jerk = *solution.jerk_psd_m2ps5;
  return text + fmt::format("; white jerk of {} m²/s⁵{}.", significant(jerk.value, 3),
                            jerk.std > 0.0 ? " by maximum likelihood" : ", as given");
}

std::vector<std::vector<std::string>> fused_rows(const TrackSolution& solution) {
  std::vector<std::vector<std::string>> rows{{"sensor", "displacement", "reads at rest"}};
  if (!solution.fused || !solution.smoother) return rows;
  for (const estimate::FusedSensor& sensor : solution.fused->sensors)
    rows.push_back({sensor.name + " alone", length_with_std(sensor.displacement_m),
                    fixed(sensor.bias_mps2.value, 4) + " m/s²"});
  rows.push_back({fmt::format("fused: variance {} times smaller",
                              significant(solution.fused->variance_gain, 2)),
                  length_with_std(solution.smoother->displacement_m), ""});
  return rows;
}

std::string track_conclusion(const TrackSolution& solution) {
  const std::vector<double>& time_s = solution.series.time_s;
  const std::string when = time_s.empty() ? "" : duration_words(time_s.back() - time_s.front());
  if (!solution.smoother) {
    return fmt::format("How far it moved in {} cannot be told: {}.", when, refusal(solution));
  }
  const Uncertain& end = solution.smoother->displacement_m;
  std::string text =
      fmt::format("After {} it stood at {} along {}, 95 % interval {}", when, length_with_std(end),
                  axis_words(solution), interval_words(*solution.smoother));
  const auto strokes = summary_of(solution.strokes);
  if (strokes) text += "; " + strokes_words(*strokes);
  return text + ".";
}

}  // namespace proofmass::report
