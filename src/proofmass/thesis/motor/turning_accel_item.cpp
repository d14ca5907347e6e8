#include <fmt/format.h>
#include <optional>
#include <utility>
#include <vector>

#include "proofmass/thesis/motor/turning_parts.hpp"
#include "proofmass/thesis/wheel_words.hpp"

namespace proofmass::thesis {
namespace {

using report::Figure;
using report::Ink;
using report::Mark;

Figure accel_figure(const FirstTurn& turn, const std::optional<AngularRun>& run) {
  Figure figure = over_time("Angular acceleration",
                            "(f_t1 − f_t2)/(2R) as it is read, by the four-state filter and "
                            "smoother and by the wheel model.",
                            "Angular acceleration (rad/s²)");
  if (run) {
    figure.curves = {curve(turn, "readings", run->raw_radps2, Ink::grey, Mark::thin),
                     curve(turn, "four-state filter", run->filtered_accel, Ink::orange)};
  }
  figure.curves.push_back(
      curve(turn, "wheel model, smoothed", turn.smoothed_accel_radps2, Ink::blue));
  if (turn.simulated)
    figure.curves.push_back(curve(turn, "truth", turn.accel_radps2, Ink::green, Mark::dashes));
  return figure;
}

}  // namespace

Item turning_accel_item(const WheelStudy& study, const std::optional<AngularRun>& run) {
  const FirstTurn& turn = study.at_11rpm().turn;
  Item item{.id = "figure 5.18",
            .title = "Angular acceleration, raw and filtered",
            .thesis =
                "A noisy raw angular acceleration at 11 rpm and 200 Hz, and a Kalman estimate "
                "through it; no figures.",
            .ours = {},
            .note = {}};
  Findings findings;
  findings.why(why_absent(turn));
  const auto off = [&](std::vector<double> AngularRun::* which) -> std::optional<Uncertain> {
    if (!run) return std::nullopt;
    return rms_off((*run).*which, turn.accel_radps2);
  };
  const auto raw = off(&AngularRun::raw_radps2), filtered = off(&AngularRun::filtered_accel),
             smoothed = off(&AngularRun::smoothed_accel);
  std::optional<Uncertain> wheel;
  if (turn.simulated) wheel = rms_off(turn.smoothed_accel_radps2, turn.accel_radps2);
  findings.add("raw", "Readings (f_t1 − f_t2)/(2R): error, rms", kind::angular_accel, {}, raw);
  findings.add("filtered", "Four-state filter: error, rms", kind::angular_accel, {}, filtered);
  findings.add("smoothed", "Four-state smoother: error, rms", kind::angular_accel, {}, smoothed);
  findings.why("The smoothed wheel model is what the others are counted from.");
  findings.add("wheel", "Wheel model, smoothed: error, rms", kind::angular_accel, {}, wheel);
  item.findings = std::move(findings).all();
  item.figures = {accel_figure(turn, run)};
  item.ours = fmt::format(
      "Error over the turn, rms against the {}: readings {}, four-state filter "
      "{}, its smoother {}, wheel model {}.",
      reference_name(turn), said(raw, kind::angular_accel), said(filtered, kind::angular_accel),
      said(smoothed, kind::angular_accel), said(wheel, kind::angular_accel));
  if (!run) item.ours = why_absent(turn);
  item.note =
      "α = (f_t1 − f_t2)/(2R), not \"radius × linear acceleration\": 1 mg of bias is 0.1 rad/s². "
      "From "
      "α alone the bias is not seen, only the sum; the wheel model determines it "
      "from the rotation of gravity. "
      "Its error is largest at the two ends of the ramp, where α leaps." +
      caveats(study);
  return item;
}

}  // namespace proofmass::thesis
