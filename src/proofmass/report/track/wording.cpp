#include "proofmass/report/track/wording.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>

#include "proofmass/core/statistics.hpp"
#include "proofmass/report/json.hpp"
#include "proofmass/report/track/report.hpp"
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
      return "removed from the data";
    case GravityContent::present:
      return "in the data";
    case GravityContent::unknown:
      break;
  }
  return "in the data or not: unknown";
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
  return fmt::format("{}, median length {}, scatter {}", text,
                     length_with_std(summary.median_length_m),
                     length_words(summary.spread_m.value_or(0.0)));
}

std::vector<std::string> budget_words(const TrackSolution& solution) {
  const TrackBudget& budget = solution.budget;
  std::vector<std::string> sentences;
  const std::string walk =
      budget.walk_mps2_rts > 0.0
          ? fmt::format(", bias random walk {} m/s²/√s", significant(budget.walk_mps2_rts, 2))
          : "";
  sentences.push_back(
      fmt::format("Noise along the axis {} m/s²/√Hz{}; {} of motion, at most {} between stops.",
                  significant(budget.white_mps2_rthz, 2), walk, duration_words(budget.motion_s),
                  duration_words(budget.longest_motion_s)));
  std::string allowed;
  if (budget.free_m)
    allowed = "Error of plain double integration " + length_words(*budget.free_m) + " at the end";
  if (budget.worst_m && budget.end_m) {
    allowed += fmt::format("{} all stops and fixes {} at worst, {} at the end",
                           allowed.empty() ? "With" : "; with", length_words(*budget.worst_m),
                           length_words(*budget.end_m));
  }
  if (!allowed.empty()) sentences.push_back(allowed + " (one standard deviation).");
  constexpr double much_wider = 2.0;
  if (solution.smoother && budget.end_m &&
      solution.smoother->displacement_m.std > much_wider * *budget.end_m)
    sentences.emplace_back(
        "This accounts for the noise at rest; errors in motion, as the stops show, widen the "
        "intervals below.");
  return sentences;
}

std::string refusal(const TrackSolution& solution) {
  if (solution.smoother) return {};
  if (!solution.alternatives.empty() || solution.too_many_in_doubt)
    return "which of the quiet intervals are rests is ambiguous";
  return solution.suspected_jerk ? "the data behave like the derivative of an acceleration (jerk)"
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
  return fmt::format("the residual velocity at {} is {} m/s rms, {} of its standard deviation",
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
  if (!solution.jerk_psd_m2ps5) return text + "; the jerk is not identifiable.";
  const Uncertain& jerk = *solution.jerk_psd_m2ps5;
  return text + fmt::format("; white jerk of {} m²/s⁵{}.", significant(jerk.value, 3),
                            jerk.std > 0.0 ? " by maximum likelihood" : ", as given");
}

}  // namespace proofmass::report
