#include "proofmass/thesis/wheel_words.hpp"

#include <cmath>
#include <cstddef>
#include <fmt/format.h>
#include <string_view>
#include <utility>

#include "proofmass/report/wording.hpp"

namespace proofmass::thesis {

void Findings::add(std::string key,
                   std::string label,
                   const Kind& kind,
                   std::optional<double> printed,
                   std::optional<Uncertain> ours) {
  if (printed) *printed *= kind.to_si;
  findings_.push_back({.key = std::move(key),
                       .label = std::move(label),
                       .si_unit = kind.si_unit,
                       .shown = {kind.symbol, kind.to_si},
                       .thesis = printed,
                       .ours = ours,
                       .reason = ours ? std::string() : reason_});
}

std::string said(const std::optional<Uncertain>& figure, const Kind& kind) {
  if (!figure) return "not known";
  const Uncertain shown{figure->value / kind.to_si, figure->std / kind.to_si};
  if (shown.std > 0.0) return report::with_std(shown, kind.symbol);
  const std::string number = std::abs(shown.value) >= 1000.0 ? report::fixed(shown.value, 0)
                                                             : report::significant(shown.value, 3);
  const std::string_view symbol = kind.symbol;
  return number + (symbol.empty() || symbol == "°" ? "" : " ") + kind.symbol;
}

std::string rpm_words(const SpeedStudy& speed) {
  return report::compact(speed.speed_radps / radps_per_rpm, 3);
}

std::string how_counted(const WheelStudy& study) {
  if (study.simulated)
    return fmt::format("rms over {}", report::count_words(study.seeds, "simulated run"));
  return "of this recording, counted from the smoothed wheel model";
}

std::string why_absent(const FirstTurn& turn) {
  if (!turn.radius_m)
    return "The sensors' distance from the axle is not known, so there is no path to compare with.";
  if (!turn.opposite)
    return turn.force_mps2.size() < 2
               ? "This takes two opposite sensors, and the recording has one."
               : "The second sensor does not sit opposite the first, so gravity does not cancel.";
  return {};
}

std::string caveats(const WheelStudy& study) {
  const FirstTurn& turn = study.at_11rpm().turn;
  std::string text;
  for (const std::string& note : turn.notes) text += " " + note + ".";
  if (!turn.whole)
    text += " The recording is shorter than a revolution: its last sample stands for the end.";
  if (!turn.from_rest)
    text += " The recording does not begin at rest: the start speed is the wheel model's.";
  return text;
}

const char* reference_name(const FirstTurn& turn) {
  return turn.simulated ? "truth" : "smoothed wheel model";
}

report::Figure over_time(std::string title, std::string description, std::string y) {
  return {.title = std::move(title),
          .description = std::move(description),
          .x = {.label = "Time (s)"},
          .y = {.label = std::move(y)}};
}

report::Curve curve(const FirstTurn& turn,
                    std::string label,
                    std::vector<double> y,
                    report::Ink ink,
                    report::Mark mark) {
  return {.label = std::move(label), .x = turn.time_s, .y = std::move(y), .ink = ink, .mark = mark};
}

report::Band band95(const FirstTurn& turn,
                    std::string label,
                    const std::vector<double>& y,
                    const std::vector<double>& std,
                    report::Ink ink) {
  constexpr double two_sided_95 = 1.959964;
  report::Band band{
      .label = std::move(label), .x = turn.time_s, .lower = y, .upper = y, .ink = ink};
  for (std::size_t k = 0; k < y.size(); ++k) {
    band.lower[k] -= two_sided_95 * std[k];
    band.upper[k] += two_sided_95 * std[k];
  }
  return band;
}

std::vector<double> times(std::vector<double> values, double factor) {
  for (double& value : values) value *= factor;
  return values;
}

std::vector<double> less(std::vector<double> a, const std::vector<double>& b) {
  for (std::size_t k = 0; k < a.size(); ++k) a[k] -= b[k];
  return a;
}

double rms(const std::vector<double>& values) {
  double sum = 0.0;
  std::size_t count = 0;
  for (const double value : values)
    if (std::isfinite(value)) sum += value * value, ++count;
  return std::sqrt(sum / static_cast<double>(count));
}

Uncertain rms_off(const std::vector<double>& estimate, const std::vector<double>& truth) {
  return {rms(less(estimate, truth)), 0.0};
}

}  // namespace proofmass::thesis
