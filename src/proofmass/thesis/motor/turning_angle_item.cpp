#include <cmath>
#include <cstddef>
#include <fmt/format.h>
#include <numbers>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "proofmass/core/units.hpp"
#include "proofmass/thesis/motor/turning_parts.hpp"
#include "proofmass/thesis/wheel_words.hpp"

namespace proofmass::thesis {
namespace {

using report::Figure;
using report::Ink;
using report::Mark;

std::vector<double> moved(const std::vector<double>& angle_rad) {
  std::vector<double> out(angle_rad);
  for (double& angle : out) angle -= angle_rad.front();
  return out;
}

/// θ = ω (t − t₁), t₁ the time of the first sensor's largest outward reading, when it stands at the
/// top; as the way since the start.
std::vector<double> by_set_speed(const FirstTurn& turn) {
  const std::vector<double>& outward = turn.force_mps2[0][0];
  std::size_t top = 0;
  for (std::size_t k = 1; k < outward.size(); ++k)
    if (outward[k] > outward[top]) top = k;
  const double w = turn.set_speed_radps > 0.0 ? turn.set_speed_radps : turn.mean_speed_radps.value;
  // The top is a quarter turn above the horizontal, in whichever turn.
  const double at_top = turn.angle_rad[top] +
                        std::remainder(std::numbers::pi / 2.0 - turn.angle_rad[top], rad_per_turn);
  std::vector<double> angle;
  angle.reserve(turn.size());
  for (const double t_s : turn.time_s)
    angle.push_back(at_top + w * (t_s - turn.time_s[top]) - turn.angle_rad.front());
  return angle;
}

Figure angle_figure(const FirstTurn& turn,
                    const std::optional<AngularRun>& run,
                    const std::vector<double>& way) {
  Figure figure = over_time(
      "Error of the angle",
      std::string("Way since the start by each method, less the ") + reference_name(turn) + ".",
      "Error (°)");
  const auto add = [&](const char* label, const std::vector<double>& angle, Ink ink, Mark mark) {
    figure.curves.push_back(
        curve(turn, label, times(less(angle, way), 1.0 / rad_per_deg), ink, mark));
  };
  if (run) add("four-state filter from α", run->filtered_rad, Ink::orange, Mark::line);
  add("ω (t − t₁)", by_set_speed(turn), Ink::red, Mark::dashes);
  if (turn.simulated)
    add("wheel model, smoothed", moved(turn.smoothed.angle_rad), Ink::blue, Mark::line);
  return figure;
}

Figure wheel_figure(const FirstTurn& turn) {
  Figure figure =
      over_time("Error of the wheel model's angle",
                "The wheel model alone, with its 95 % bands, on its own scale.", "Error (°)");
  figure.y.min = -0.3;
  figure.y.max = 0.3;
  const auto error = [&](const AngleEstimate& angle) {
    return times(less(angle.angle_rad, turn.angle_rad), 1.0 / rad_per_deg);
  };
  const std::vector<double> filtered = error(turn.filtered);
  figure.bands = {band95(turn, "95 % of the filter", filtered,
                         times(turn.filtered.std_rad, 1.0 / rad_per_deg), Ink::green)};
  figure.curves = {curve(turn, "filter", filtered, Ink::green)};
  if (turn.simulated)
    figure.curves.push_back(curve(turn, "smoother", error(turn.smoothed), Ink::blue));
  return figure;
}

/// rms over the runs, of a path as an angle.
std::optional<Uncertain> angle_end(const SpeedStudy& speed, const Pick& end) {
  const auto path = rms_over(speed.runs, end);
  if (!path || !speed.turn.radius_m) return std::nullopt;
  return Uncertain{path->value / *speed.turn.radius_m, path->std / *speed.turn.radius_m};
}

/// How far each method is off after the turn; in the run shown, or rms over the runs.
struct AngleEnds {
  std::optional<Uncertain> filtered, smoothed, claimed;  ///< four states from α, in the run shown
  Uncertain even;                                        ///< ω (t − t₁), in the run shown
  std::optional<Uncertain> fused, wheel_filtered, wheel_smoothed;  ///< over the runs
  Uncertain wheel_claimed;
};

AngleEnds angle_ends(const SpeedStudy& at, const std::optional<AngularRun>& run) {
  const std::vector<double> way = moved(at.turn.angle_rad);
  const auto end = [&](const std::vector<double>& angle) {
    return Uncertain{angle.back() - way.back(), 0.0};
  };
  AngleEnds ends{
      .filtered = {},
      .smoothed = {},
      .claimed = {},
      .even = end(by_set_speed(at.turn)),
      .fused = angle_end(at, picked(&RunErrors::roll, &ThesisErrors::filtered, &PathError::end)),
      .wheel_filtered = angle_end(at, picked(&RunErrors::wheel_filtered, &PathError::end)),
      .wheel_smoothed = angle_end(at, picked(&RunErrors::wheel_smoothed, &PathError::end)),
      .wheel_claimed = {at.turn.smoothed.std_rad.back(), 0.0}};
  if (run) {
    ends.filtered = end(run->filtered_rad);
    ends.smoothed = end(run->smoothed_rad);
    ends.claimed = Uncertain{run->filtered_std_rad.back(), 0.0};
  }
  return ends;
}

std::string runs_words(const WheelStudy& study) {
  return study.simulated ? how_counted(study) : "one recording";
}

/// Bias of the forward pair that makes 10° in this turn.
std::optional<Uncertain> bias_for_10_degrees(const FirstTurn& turn) {
  if (!turn.radius_m) return std::nullopt;
  const double t_s = turn.time_s.back();
  return Uncertain{2.0 * 10.0 * rad_per_deg * *turn.radius_m / (t_s * t_s), 0.0};
}

Findings angle_findings(const WheelStudy& study, const AngleEnds& ends) {
  const FirstTurn& turn = study.at_11rpm().turn;
  Findings findings;
  findings.why(why_absent(turn));
  findings.add("smoothed", "Four-state smoother from α: error after the turn", kind::degrees, -10.0,
               ends.smoothed);
  findings.add("filtered", "Four-state filter from α: error after the turn", kind::degrees, {},
               ends.filtered);
  findings.add("claimed", "What that filter claims, one standard deviation", kind::degrees, {},
               ends.claimed);
  findings.add("integrated_over_runs",
               "The fused pair's filter: error after the turn, " + runs_words(study), kind::degrees,
               {}, ends.fused);
  findings.add("even_end", "ω (t − t₁): error after the turn", kind::degrees, {}, ends.even);
  findings.add("even_rms", "ω (t − t₁): error over the turn, rms", kind::degrees, {},
               rms_off(by_set_speed(turn), moved(turn.angle_rad)));
  findings.add("bias_for_10_degrees", "Bias of the forward pair that makes 10° in this turn",
               kind::milli_g, {}, bias_for_10_degrees(turn));
  findings.add("wheel_filtered", "Wheel model, filter: error after the turn", kind::degrees, {},
               ends.wheel_filtered);
  if (!study.simulated)
    findings.why("The smoothed wheel model is what the others are counted from.");
  findings.add("wheel_smoothed", "Wheel model, smoother: error after the turn", kind::degrees, {},
               ends.wheel_smoothed);
  findings.add("wheel_claimed", "What the smoother claims there, one standard deviation",
               kind::degrees, {}, ends.wheel_claimed);
  return findings;
}

std::string angle_words(const WheelStudy& study, const AngleEnds& ends) {
  std::string text = fmt::format("In the run shown ω (t − t₁) is off by {} after the turn",
                                 said(ends.even, kind::degrees));
  text += ends.smoothed
              ? fmt::format(", the four-state smoother by {}. ", said(ends.smoothed, kind::degrees))
              : ". " + why_absent(study.at_11rpm().turn) + " ";
  if (study.simulated)
    return text + fmt::format(
                      "As {}: the fused pair's filter {}, the wheel model {} filtered and {} "
                      "smoothed.",
                      runs_words(study), said(ends.fused, kind::degrees),
                      said(ends.wheel_filtered, kind::degrees),
                      said(ends.wheel_smoothed, kind::degrees));
  return text + fmt::format("The wheel model's filter ends {} from its smoother, which claims {}.",
                            said(ends.wheel_filtered, kind::degrees),
                            said(ends.wheel_claimed, kind::degrees));
}

}  // namespace

Item turning_angle_item(const WheelStudy& study, const std::optional<AngularRun>& run) {
  const FirstTurn& turn = study.at_11rpm().turn;
  const AngleEnds ends = angle_ends(study.at_11rpm(), run);
  Item item{.id = "figure 5.19",
            .title = "Angle",
            .thesis =
                "θ = ω (t_i − t_1), t_1 the time of the first +g; the smoothed estimate is "
                "−10° off.",
            .ours = angle_words(study, ends),
            .note = {}};
  item.findings = angle_findings(study, ends).all();
  item.figures = {angle_figure(turn, run, moved(turn.angle_rad)), wheel_figure(turn)};
  item.note =
      "An angle integrated from α goes with the bias: −10° takes a pair's bias known to a tenth of "
      "a "
      "mg, which no tumble test of another day gives. ω (t − t₁) needs an even speed and a t₁ read "
      "off the flat top of a sinusoid, where 0.4 % of g is 5°. Gravity's turning is the angle "
      "itself: "
      "its error has a bound and no integration is in it. Use the wheel model." +
      caveats(study);
  return item;
}

}  // namespace proofmass::thesis
