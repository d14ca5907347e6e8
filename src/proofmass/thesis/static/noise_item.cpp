#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <utility>

#include "proofmass/report/page/thinning.hpp"
#include "proofmass/report/wording.hpp"
#include "proofmass/thesis/static/item_parts.hpp"

namespace proofmass::thesis {
namespace {

using characterise::NoiseAnalysis;
using report::Ink;
using report::Mark;
using report::significant;

constexpr double ug = 1e-3 * mg_mps2;
constexpr double settled_within_mps2 = mg_mps2;

report::Curve samples_curve(const StaticTest& test,
                            View<double> values,
                            std::string label,
                            Ink ink) {
  std::vector<double> t_s(values.size()), shown(values.size());
  for (std::size_t k = 0; k < values.size(); ++k) {
    t_s[k] = test.record.since_switch_on_s + static_cast<double>(k) / test.record.rate_hz;
    shown[k] = values[k] / mg_mps2;
  }
  report::Polyline line = report::thinned(t_s, shown);
  return {.label = std::move(label),
          .x = std::move(line.x),
          .y = std::move(line.y),
          .ink = ink,
          .mark = Mark::thin};
}

report::Figure readings_of(const StaticTest& test, std::size_t at) {
  const StaticAxis& axis = test.record.axes[at];
  const AxisTest& found = test.axes[at];
  report::Figure figure{.title = axis.name + ": static bias test",
                        .description =
                            "Each point of the outer band is one reading, of the inner "
                            "one the mean of all readings since the one before; the line "
                            "is the bias that is left when the noise is taken off.",
                        .x = {.label = "Time since switching on (s)"},
                        .y = {.label = "Reading (mg)"}};
  const std::string by = std::to_string(test.record.decimation);
  if (!axis.picked_mps2.empty())
    figure.curves.push_back(
        samples_curve(test, axis.picked_mps2, picked_words(test.record), Ink::grey));
  figure.curves.push_back(samples_curve(
      test, axis.accel_mps2, axis.picked_mps2.empty() ? "samples" : "means over " + by, Ink::blue));
  report::Curve bias{.label = "bias, smoothed", .x = {}, .y = {}, .ink = Ink::orange};
  bias.x = found.tracks->smoothed.t_s;
  for (const double value : found.tracks->smoothed.value_mps2) bias.y.push_back(value / mg_mps2);
  figure.curves.push_back(std::move(bias));
  return figure;
}

report::Curve deviation_of(const NoiseAnalysis& noise, std::string label, Ink ink) {
  report::Curve curve{.label = std::move(label), .x = {}, .y = {}, .ink = ink};
  for (const auto& point : noise.deviation.points) {
    curve.x.push_back(point.tau_s);
    curve.y.push_back(point.value / ug);
  }
  return curve;
}

report::Figure deviations_of(const DecimationNoise& noise, const std::string& name) {
  report::Figure figure{.title = name + ": what averaging does to the readings",
                        .description =
                            "Allan deviation about the fitted curve: how far two "
                            "neighbouring means of so long differ. Single samples stay "
                            "above means until the bias drifts.",
                        .x = {.label = "Averaging time (s)", .scale = report::AxisScale::log},
                        .y = {.label = "Allan deviation (µg)", .scale = report::AxisScale::log}};
  if (noise.picked)
    figure.curves.push_back(
        deviation_of(*noise.picked, "single samples, the rest thrown away", Ink::grey));
  if (noise.means) figure.curves.push_back(deviation_of(*noise.means, "means of all", Ink::blue));
  return figure;
}

/// rms about the smoothed bias would flatter: about the fitted curve.
double scatter_mps2(View<double> values, const StaticTest& test, std::size_t at) {
  const auto& curve = test.axes[at].drift->fit.curve;
  double squares = 0.0, count = 0.0;
  for (std::size_t k = 0; k < values.size(); ++k) {
    const double t_s = test.record.since_switch_on_s + static_cast<double>(k) / test.record.rate_hz;
    const double residual = values[k] - curve.value(t_s);
    if (!std::isfinite(residual)) continue;
    squares += residual * residual;
    count += 1.0;
  }
  return count > 0.0 ? std::sqrt(squares / count) : std::numeric_limits<double>::quiet_NaN();
}

Finding density(std::string key, std::string label, const std::optional<NoiseAnalysis>& noise) {
  Finding finding{.key = std::move(key),
                  .label = std::move(label),
                  .si_unit = "m/s^2/sqrt(Hz)",
                  .shown = {"µg/√Hz", ug}};
  if (noise && noise->model.ordinates > 0) {
    finding.ours = Uncertain{noise->model.white.value, noise->model.white.std};
  } else {
    finding.reason = noise ? "The record is too short for a spectrum."
                           : "The samples were not decimated, or do not vary.";
  }
  return finding;
}

/// Picked over means.
std::optional<double> aliasing(const DecimationNoise& noise) {
  if (!noise.slow || !noise.picked) return std::nullopt;
  const double means = noise.slow->model.white.value, picked = noise.picked->model.white.value;
  if (!(means > 0.0) || !(picked > 0.0)) return std::nullopt;
  return picked / means;
}

Finding walk_of(const DecimationNoise& noise) {
  Finding finding{.key = "random_walk",
                  .label = "Random walk of the bias K",
                  .si_unit = "m/s^2/sqrt(s)",
                  .shown = {"µg/√s", ug}};
  const bool seen =
      noise.slow && noise.slow->model.random_walk.verdict == characterise::Verdict::identified;
  if (seen) {
    const auto& K = noise.slow->model.random_walk;
    finding.ours = Uncertain{K.value, K.std};
  } else {
    finding.reason = "The record can be explained without one.";
  }
  return finding;
}

Finding settling_of(const StaticTest& test, std::size_t at) {
  const characterise::DriftFit& fit = test.axes[at].drift->fit;
  Finding finding = seconds("settling_time_1mg", "Time until 1 mg of the warm-up is left");
  if (fit.a1 && std::abs(fit.curve.a1) > settled_within_mps2) {
    const double time_constants = std::log(std::abs(fit.curve.a1) / settled_within_mps2);
    finding.ours = Uncertain{fit.curve.time_constant_s * time_constants,
                             std::hypot(fit.time_constant_s->std * time_constants,
                                        fit.curve.time_constant_s * fit.a1->std / fit.a1->value)};
  } else {
    finding.reason = fit.a1 ? "The warm-up is smaller than that." : verdict_sentence(test, at);
  }
  return finding;
}

std::vector<Finding> findings_of(const StaticTest& test, std::size_t at) {
  const StaticAxis& axis = test.record.axes[at];
  Finding rate{.key = "rate", .label = "Sampled at", .si_unit = "Hz", .shown = {"Hz", 1.0}};
  rate.thesis = 1000.0;
  rate.ours = Uncertain{sampled_hz(test.record), 0.0};
  Finding by{.key = "decimation", .label = "Down-sampled by", .si_unit = "", .shown = {}};
  by.thesis = 25.0;
  by.ours = Uncertain{static_cast<double>(test.record.decimation), 0.0};
  Finding means = milli_g("std_means", "Standard deviation of the means about the curve");
  means.ours = Uncertain{scatter_mps2(axis.accel_mps2, test, at), 0.0};
  Finding picked = milli_g("std_picked", "Standard deviation of single samples about it");
  if (axis.picked_mps2.empty()) {
    picked.reason = "The samples were not decimated.";
  } else {
    picked.ours = Uncertain{scatter_mps2(axis.picked_mps2, test, at), 0.0};
  }
  return {rate,
          by,
          picked,
          means,
          density("white_noise_picked", "White noise N of single samples", test.noise.picked),
          density("white_noise", "White noise N of the means", test.noise.slow),
          walk_of(test.noise),
          settling_of(test, at)};
}

std::string found_noise(const StaticTest& test, const std::vector<Finding>& findings) {
  const auto& picked = findings[2].ours;
  std::string text =
      fmt::format("{} ({}): means over {} scatter by {} mg about the curve",
                  test.record.axes[first_axis(test)].name, source_words(test),
                  test.record.decimation, significant(findings[3].ours->value / mg_mps2, 3));
  if (picked)
    text += fmt::format(", single samples by {} mg", significant(picked->value / mg_mps2, 3));
  text += ".";
  if (const auto ratio = aliasing(test.noise))
    text +=
        fmt::format(" White noise N is {} µg/√Hz in the means and {} times that where {} is kept.",
                    significant(test.noise.slow->model.white.value / ug, 3), significant(*ratio, 3),
                    picked_words(test.record));
  return text;
}

}  // namespace

Item static_noise_item(const StaticTest& test) {
  const std::size_t at = first_axis(test);
  Item item{.id = "figure 5.2",
            .title = "Static bias test, down-sampled by 25",
            .thesis =
                "Two hours at 1 kHz at rest, every 25th sample shown. The bias stabilises "
                "after a few seconds; the standard deviation obtained is the bias drift. The "
                "axis is A1-X in one place and x2 in another.",
            .ours = "",
            .note =
                "The standard deviation is mostly white noise and depends on the bandwidth and "
                "the averaging: it is no property of the bias. What the bias does is shown by "
                "its random walk and by the curve. To keep every 25th sample folds all the "
                "noise up to the sensor's 50 Hz into 20 Hz: √(x coth x) with x = π 50/40 makes "
                "the density 1.98 times as large. Means over 25 keep it, and that is what is "
                "taken here."};
  if (test.record.simulated)
    item.note +=
        " Noise, filter and warm-up of the simulated sensors are the datasheet's and the "
        "thesis's; the random walk of 5 µg/√s is assumed, as cheap sensors have it.";
  item.findings = findings_of(test, at);
  item.ours = found_noise(test, item.findings);
  item.figures.push_back(readings_of(test, at));
  if (test.noise.means)
    item.figures.push_back(deviations_of(test.noise, test.record.axes[at].name));
  return item;
}

}  // namespace proofmass::thesis
