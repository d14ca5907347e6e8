#include <algorithm>
#include <cmath>
#include <cstddef>
#include <fmt/format.h>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "proofmass/core/statistics.hpp"
#include "proofmass/core/units.hpp"
#include "proofmass/report/wording.hpp"
#include "proofmass/thesis/motor/pair_parts.hpp"
#include "proofmass/thesis/wheel_words.hpp"

namespace proofmass::thesis {
namespace {

using report::Figure;
using report::Ink;
using report::Mark;

/// What an ideal sensor at the first one's place would read without gravity: R α, or −R ω².
std::vector<double> true_accel(const FirstTurn& turn, WheelAxis axis) {
  std::vector<double> accel;
  accel.reserve(turn.size());
  for (std::size_t k = 0; k < turn.size(); ++k)
    accel.push_back(axis == WheelAxis::forward ? turn.accel_radps2[k]
                                               : -turn.speed_radps[k] * turn.speed_radps[k]);
  return times(std::move(accel), turn.radius_m.value_or(0.0));
}

std::vector<double> without_mean(std::vector<double> values) {
  const double mean = moments(values).mean;
  for (double& value : values) value -= mean;
  return values;
}

double largest(const std::vector<double>& values) {
  double most = 0.0;
  for (const double value : values) most = std::max(most, std::abs(value));
  return most;
}

std::string speed_words(const FirstTurn& turn) {
  return report::compact(turn.mean_speed_radps.value / radps_per_rpm, 3) + " rpm";
}

Figure cancelled_accel_figure(const FirstTurn& turn, const Pair& pair, const PairPaths& paths) {
  Figure figure = over_time(fmt::format("{} fused, gravity cancelled", pair.axes),
                            "Half the sum of the signals of two opposite sensors, the second "
                            "turned by 180°: the readings, the thesis's filter and the truth.",
                            "Acceleration (m/s²)");
  figure.curves = {
      curve(turn, "fused readings", paths.cancelled->accel_mps2, Ink::grey, Mark::thin),
      curve(turn, "thesis's filter, its bias off", paths.cancelled_paths->filtered_accel_mps2,
            Ink::orange),
      curve(turn, turn.simulated ? "truth" : "wheel model", true_accel(turn, pair.axis),
            Ink::blue)};
  return figure;
}

Figure gravity_accel_figure(const FirstTurn& turn, const Pair& pair, const PairPaths& paths) {
  Figure figure = over_time(fmt::format("{} fused, gravity left in", pair.axes),
                            "Half the sum with parallel axes: gravity turns through the reading "
                            "once a revolution, and the motion is a hair beside it.",
                            "Acceleration (m/s²)");
  figure.curves = {curve(turn, "fused readings", paths.gravity->accel_mps2, Ink::grey),
                   curve(turn, "thesis's filter, its bias off",
                         paths.gravity_paths->filtered_accel_mps2, Ink::orange, Mark::dashes),
                   curve(turn, turn.simulated ? "truth" : "wheel model",
                         true_accel(turn, pair.axis), Ink::blue)};
  return figure;
}

}  // namespace

Item pair_accel_item(const WheelStudy& study, const Pair& pair, const PairPaths& paths) {
  const FirstTurn& turn = study.at_11rpm().turn;
  const bool forward = pair.axis == WheelAxis::forward;
  Item item{.id = pair.accel_id,
            .title = fmt::format("{} fused, raw and filtered", pair.axes),
            .thesis = fmt::format("Raw {} at 11 rpm and 200 Hz, fused; \"evident white noise\", "
                                  "which the filter reduces.",
                                  pair.axes),
            .ours = {},
            .note = {}};
  Findings findings;
  findings.why(why_absent(turn));
  std::optional<Uncertain> raw, filtered, motion;
  if (paths.cancelled && turn.radius_m) {
    const std::vector<double> truth = true_accel(turn, pair.axis);
    raw = Uncertain{rms(without_mean(less(paths.cancelled->accel_mps2, truth))), 0.0};
    filtered =
        Uncertain{rms(without_mean(less(paths.cancelled_paths->filtered_accel_mps2, truth))), 0.0};
    item.figures.push_back(cancelled_accel_figure(turn, pair, paths));
  }
  if (turn.radius_m) motion = Uncertain{largest(true_accel(turn, pair.axis)), 0.0};
  item.figures.push_back(gravity_accel_figure(turn, pair, paths));
  findings.add("speed", "Speed of the wheel", kind::rpm, 11.0, turn.mean_speed_radps);
  findings.add("rate", "Readings a second (Hz)", kind::plain, 200.0,
               Uncertain{static_cast<double>(turn.size() - 1) / turn.time_s.back(), 0.0});
  findings.add("raw_noise", "Noise and drift of the fused readings, rms", kind::milli_g, {}, raw);
  findings.add("filtered_noise", "What the thesis's filter leaves of it, rms", kind::milli_g, {},
               filtered);
  findings.add(
      "motion",
      forward ? "Largest acceleration of the motion, Rα" : "Largest centripetal acceleration, Rω²",
      kind::milli_g, {}, motion);
  findings.add("gravity", "Largest reading with gravity left in", kind::milli_g, {},
               Uncertain{largest(paths.gravity->accel_mps2), 0.0});
  item.findings = std::move(findings).all();
  const std::string why = why_absent(turn);
  item.ours = fmt::format(
      "At {}: {}the motion makes {} at most, gravity where it is left in {}. {}", speed_words(turn),
      why.empty() ? fmt::format("noise of the pair {} rms, {} after the filter; ",
                                said(raw, kind::milli_g), said(filtered, kind::milli_g))
                  : "",
      said(motion, kind::milli_g),
      said(Uncertain{largest(paths.gravity->accel_mps2), 0.0}, kind::milli_g), why);
  item.note =
      std::string(
          "With W = 1 and R of the sensor the filter follows nearly every reading (figure "
          "5.16), so it hardly smooths. ") +
      (forward ? "A sinusoid in the figure is gravity, not motion: at an even speed the forward "
                 "acceleration is zero. Use the pair as in (4.59), in which gravity cancels, or "
                 "better the wheel model, which takes gravity for what it is: the angle."
               : "The outward reading is gravity and −Rω²; neither is the acceleration of a path "
                 "along the circle.") +
      caveats(study);
  return item;
}

}  // namespace proofmass::thesis
