#include <fmt/format.h>
#include <optional>
#include <string>
#include <utility>

#include "proofmass/core/units.hpp"
#include "proofmass/thesis/motor/pair_parts.hpp"
#include "proofmass/thesis/wheel_words.hpp"

namespace proofmass::thesis {
namespace {

using report::Figure;
using report::Ink;
using report::Mark;

/// rms over the runs.
template <typename... Members>
std::optional<Uncertain> over(const SpeedStudy& speed, Members... members) {
  return rms_over(speed.runs, picked(members...));
}

Figure path_figure(const FirstTurn& turn,
                   const Pair& pair,
                   const ThesisPaths& paths,
                   bool gravity) {
  Figure figure = over_time(
      fmt::format("Path from {}, gravity {}", pair.axes, gravity ? "left in" : "cancelled"),
      "Way of the sensors along their circle through the first revolution, by each "
      "estimator; one run.",
      "Path (m)");
  figure.bands = {band95(turn, "what the filter claims (95 %)", paths.filtered_m,
                         paths.filtered_std_m, Ink::orange)};
  figure.curves = {curve(turn, "double integration", paths.integrated_m, Ink::red, Mark::dashes),
                   curve(turn, "thesis's filter", paths.filtered_m, Ink::orange),
                   curve(turn, "thesis's smoother", paths.smoothed_m, Ink::purple, Mark::dashes)};
  if (!turn.radius_m) return figure;
  figure.curves.push_back(
      curve(turn, "wheel model, smoothed", turn.path_m(turn.smoothed.angle_rad), Ink::blue));
  if (turn.simulated)
    figure.curves.push_back(
        curve(turn, "truth", turn.path_m(turn.angle_rad), Ink::green, Mark::dashes));
  return figure;
}

void add_path_findings(const WheelStudy& study, const Pair& pair, Findings& findings) {
  const SpeedStudy& speed = study.at_11rpm();
  using E = ThesisErrors;
  using P = PathError;
  const bool forward = pair.axis == WheelAxis::forward;
  const auto at = forward ? &P::at_2s : &P::half;
  const std::string when = forward ? "at 2 s" : "at half time";
  findings.add("true_path", "Way of the sensors in one revolution", kind::metres, 0.62,
               speed.turn.radius_m
                   ? std::optional(Uncertain{rad_per_turn * *speed.turn.radius_m, 0.0})
                   : std::nullopt);
  findings.add("integrated", "Double integration, gravity cancelled: error " + when, kind::metres,
               forward ? 6.88 : 9.0, over(speed, pair.cancelled, &E::integrated, at));
  findings.add("filtered", "Thesis's filter, gravity cancelled: error " + when, kind::metres,
               forward ? 3.58 : 6.0, over(speed, pair.cancelled, &E::filtered, at));
  findings.add("smoothed", "Thesis's smoother, gravity cancelled: error " + when, kind::metres,
               forward ? 6.0 : 2.0, over(speed, pair.cancelled, &E::smoothed, at));
  findings.add("integrated_end", "Double integration, gravity cancelled: error after the turn",
               kind::metres, {}, over(speed, pair.cancelled, &E::integrated, &P::end));
  findings.add("filtered_end", "Thesis's filter, gravity cancelled: error after the turn",
               kind::metres, {}, over(speed, pair.cancelled, &E::filtered, &P::end));
  findings.add("claimed_end", "What the thesis's filter claims there, one standard deviation",
               kind::metres, {}, over(speed, pair.gravity, &E::filtered, &P::end_std));
  findings.add("gravity_integrated", "Double integration, gravity left in: error " + when,
               kind::metres, {}, over(speed, pair.gravity, &E::integrated, at));
  findings.add("gravity_filtered", "Thesis's filter, gravity left in: error " + when, kind::metres,
               {}, over(speed, pair.gravity, &E::filtered, at));
  findings.add("gravity_filtered_end", "Thesis's filter, gravity left in: error after the turn",
               kind::metres, {}, over(speed, pair.gravity, &E::filtered, &P::end));
  // In a recording that is not even it goes with the first revolution.
  const double w = study.simulated ? speed.turn.mean_speed_radps.value
                                   : (speed.turn.angle_rad.back() - speed.turn.angle_rad.front()) /
                                         speed.turn.time_s.back();
  findings.add("gravity_scale", "g/ω², what gravity turns into when integrated twice", kind::metres,
               {}, Uncertain{speed.turn.gravity_mps2 / (w * w), 0.0});
  findings.add("wheel_filtered", "Wheel model, filter: error " + when, kind::millimetres, {},
               over(speed, &RunErrors::wheel_filtered, at));
  if (!study.simulated)
    findings.why("The smoothed wheel model is what the others are counted from.");
  findings.add("wheel_smoothed", "Wheel model, smoother: error " + when, kind::millimetres, {},
               over(speed, &RunErrors::wheel_smoothed, at));
}

std::string path_words(const WheelStudy& study, const Pair& pair) {
  const SpeedStudy& speed = study.at_11rpm();
  using E = ThesisErrors;
  const bool forward = pair.axis == WheelAxis::forward;
  const auto at = forward ? &PathError::at_2s : &PathError::half;
  const auto metres = [&](auto which, auto method) {
    return said(over(speed, which, method, at), kind::metres);
  };
  const std::string cancelled =
      why_absent(speed.turn).empty()
          ? fmt::format(
                "with gravity cancelled {} by double integration, {} by the thesis's filter, "
                "{} by its smoother; ",
                metres(pair.cancelled, &E::integrated), metres(pair.cancelled, &E::filtered),
                metres(pair.cancelled, &E::smoothed))
          : "";
  std::string text = fmt::format(
      "Error {}, {}: {}with gravity left in {} by double integration and {} by the thesis's "
      "filter. "
      "The wheel model: {} filtered",
      forward ? "at 2 s" : "at half time", how_counted(study), cancelled,
      metres(pair.gravity, &E::integrated), metres(pair.gravity, &E::filtered),
      said(over(speed, &RunErrors::wheel_filtered, at), kind::millimetres));
  if (study.simulated)
    text += fmt::format(", {} smoothed",
                        said(over(speed, &RunErrors::wheel_smoothed, at), kind::millimetres));
  text += ".";
  return cancelled.empty() ? text + " " + why_absent(speed.turn) : text;
}

std::string why_metres(const WheelStudy& study) {
  return std::string(
             "Errors of metres cannot come from a bias of 20 mg, which makes ½ b t² = 0.4 m in 2 "
             "s; "
             "they are of the size of gravity left in the readings: integrated twice from rest it "
             "is "
             "(g/ω²)(cos φ − cos(ωt + φ) − ωt sin φ), metres for any start angle φ but a few, on a "
             "way of 0.63 m. The filter takes gravity for motion, and its P, which knows of noise "
             "and bias only, claims far less than its error. ") +
         (study.simulated
              ? "With gravity cancelled, and a bias known to 2 mg as a tumble test of another day "
                "tells it, what is left is the bias: the filter does no better than that "
                "knowledge, "
                "and says so. "
              : "With gravity cancelled what is left is the bias, of which nothing was known "
                "here. ") +
         "The smoother changes nothing: where acceleration alone is read, later readings say "
         "nothing "
         "of the position. Both start with the true position and speed.";
}

}  // namespace

Item pair_path_item(const WheelStudy& study, const Pair& pair, const PairPaths& paths) {
  const FirstTurn& turn = study.at_11rpm().turn;
  const bool forward = pair.axis == WheelAxis::forward;
  Item item{
      .id = pair.path_id,
      .title = fmt::format("Position from {}", pair.axes),
      .thesis = forward ? "On a true path of 0.62 m the error at 2 s is 6.88 m by double "
                          "integration and 3.58 m by the Kalman filter; with the smoother \"error "
                          "was reduced to six meter\"."
                        : "On a true path of 0.62 m the error at half time is nine metres by "
                          "double integration, six by the Kalman filter, and the smoother takes "
                          "almost four off.",
      .ours = path_words(study, pair),
      .note = {}};
  Findings findings;
  findings.why(why_absent(turn));
  add_path_findings(study, pair, findings);
  item.findings = std::move(findings).all();
  if (paths.cancelled_paths)
    item.figures.push_back(path_figure(turn, pair, *paths.cancelled_paths, false));
  if (paths.gravity_paths)
    item.figures.push_back(path_figure(turn, pair, *paths.gravity_paths, true));
  item.note =
      std::string(forward ? ""
                          : "The outward axis shows no path: with gravity cancelled "
                            "what is integrated is −Rω², half of ω² t² radii. ") +
      why_metres(study) +
      " Use the wheel model, whose filter learns its sensors as it turns and whose smoother "
      "knows them from the start." +
      caveats(study);
  return item;
}

}  // namespace proofmass::thesis
