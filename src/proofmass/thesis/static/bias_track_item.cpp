#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <utility>

#include "proofmass/report/wording.hpp"
#include "proofmass/thesis/static/item_parts.hpp"

namespace proofmass::thesis {
namespace {

using report::Ink;
using report::Mark;
using report::significant;

constexpr double ug = 1e-3 * mg_mps2;

report::Curve curve_of(const BiasTrack& track, std::string label, Ink ink) {
  report::Curve curve{.label = std::move(label), .x = track.t_s, .y = {}, .ink = ink};
  for (const double value : track.value_mps2) curve.y.push_back(value / mg_mps2);
  return curve;
}

report::Band band_of(const BiasTrack& track, std::string label, Ink ink) {
  report::Band band{
      .label = std::move(label), .x = track.t_s, .lower = {}, .upper = {}, .ink = ink};
  for (std::size_t k = 0; k < track.t_s.size(); ++k) {
    const double reach = 1.96 * track.std_mps2[k];
    band.lower.push_back((track.value_mps2[k] - reach) / mg_mps2);
    band.upper.push_back((track.value_mps2[k] + reach) / mg_mps2);
  }
  return band;
}

/// All axes, each minus its value at the end, for comparison.
report::Figure all_axes(const StaticTest& test) {
  constexpr std::array inks{Ink::blue, Ink::orange, Ink::green, Ink::purple, Ink::red, Ink::grey};
  report::Figure figure{
      .title = "Bias of each axis since switching on",
      .description = "Smoothed, less the level that each axis ends at.",
      .x = {.label = "Time since switching on (s)", .scale = report::AxisScale::log},
      .y = {.label = "Bias less its last value (mg)"}};
  for (std::size_t k = 0; k < test.axes.size(); ++k) {
    if (!test.axes[k].tracks) continue;
    const BiasTrack& track = test.axes[k].tracks->smoothed;
    report::Curve curve = curve_of(track, test.record.axes[k].name, inks.at(k % inks.size()));
    for (double& value : curve.y) value -= track.last_mps2.value / mg_mps2;
    figure.curves.push_back(std::move(curve));
  }
  return figure;
}

/// One axis without its warm-up, where the two filters differ most.
report::Figure filters_of(const StaticTest& test, std::size_t at) {
  const BiasTracks& tracks = *test.axes[at].tracks;
  const auto& drift = *test.axes[at].drift;
  report::Figure figure{
      .title = test.record.axes[at].name + ": the thesis's filter and ours",
      .description =
          "The thesis's filter follows the readings' noise, because its Q is the square "
          "of their scatter; ours uses the estimated random walk of the bias.",
      .x = {.label = "Time since switching on (s)"},
      .y = {.label = "Bias (mg)"}};
  if (!tracks.thesis.t_s.empty()) {
    figure.curves.push_back(curve_of(tracks.thesis, "the thesis's filter, corrected", Ink::grey));
    figure.curves.back().mark = Mark::thin;
  }
  figure.bands.push_back(band_of(tracks.filtered, "95 % band of our filter", Ink::blue));
  figure.curves.push_back(curve_of(tracks.filtered, "our filter", Ink::blue));
  figure.curves.push_back(curve_of(tracks.smoothed, "our smoother", Ink::orange));
  const double warm_s = drift.fit.time_constant_s ? 5.0 * drift.fit.curve.time_constant_s : 0.0;
  if (warm_s > 0.0 && 2.0 * warm_s < drift.duration_s) {
    figure.title += ", once warm";
    figure.x.min = drift.start_s + warm_s;
    const auto warm = std::ranges::lower_bound(tracks.filtered.t_s, *figure.x.min);
    const auto first = warm - tracks.filtered.t_s.begin();
    const auto [least, most] = std::minmax_element(tracks.filtered.value_mps2.begin() + first,
                                                   tracks.filtered.value_mps2.end());
    const double room =
        tracks.thesis.t_s.empty() ? 0.2 : 3.0 * tracks.thesis.last_mps2.std / mg_mps2;
    figure.y.min = *least / mg_mps2 - room;
    figure.y.max = *most / mg_mps2 + room;
  }
  return figure;
}

/// Errors in µg of one estimate, or its uncertainty without a truth.
std::string error_words(const BiasTrack& track) {
  if (track.rms_error_mps2) return significant(*track.rms_error_mps2 / ug, 3);
  return track.t_s.empty() ? "none" : "± " + significant(track.last_mps2.std / ug, 3);
}

report::Table errors_table(const StaticTest& test) {
  const bool truth = test.record.simulated;
  report::Table table{
      truth ? "Error of the bias in µg, root mean square over the record"
            : "Standard deviation of the bias in µg at the end, as stated by each filter: there "
              "is no truth to compare with",
      {"Axis", "Readings", "The thesis's filter", "Our filter", "Our smoother",
       "Truth in its 95 %"},
      {}};
  for (std::size_t k = 0; k < test.axes.size(); ++k) {
    const std::string& name = test.record.axes[k].name;
    if (!test.axes[k].tracks) {
      table.rows.push_back({name, "not analysed", "", "", "", ""});
      continue;
    }
    const BiasTracks& tracks = *test.axes[k].tracks;
    const auto& inside = tracks.smoothed.inside_95;
    table.rows.push_back({name, truth ? error_words(tracks.raw) : "", error_words(tracks.thesis),
                          error_words(tracks.filtered), error_words(tracks.smoothed),
                          inside ? report::fixed(100.0 * *inside, 1) + " %" : ""});
  }
  return table;
}

Finding micro_g(std::string key, std::string label) {
  return {
      .key = std::move(key), .label = std::move(label), .si_unit = "m/s^2", .shown = {"µg", ug}};
}

void take_error(const BiasTrack& track, Finding& finding) {
  if (track.rms_error_mps2) {
    finding.ours = Uncertain{*track.rms_error_mps2, 0.0};
  } else {
    finding.reason = track.t_s.empty() ? "The thesis's method finds no curve for its filter."
                                       : "The true bias of a recorded sensor is not known.";
  }
}

std::vector<Finding> findings_of(const StaticTest& test) {
  std::vector<Finding> findings;
  for (std::size_t k = 0; k < test.axes.size(); ++k) {
    if (!test.axes[k].tracks) continue;
    const BiasTracks& tracks = *test.axes[k].tracks;
    const std::string key = fmt::format("axis{}_", k + 1), &name = test.record.axes[k].name;
    Finding& end = findings.emplace_back(milli_g(key + "bias_end", name + ": bias at the end"));
    end.ours = tracks.smoothed.last_mps2;
    Finding thesis = micro_g(key + "error_thesis", name + ": rms error, the thesis's filter");
    Finding filter = micro_g(key + "error_filter", name + ": rms error, our filter");
    Finding smoother = micro_g(key + "error_smoother", name + ": rms error, our smoother");
    take_error(tracks.thesis, thesis);
    take_error(tracks.filtered, filter);
    take_error(tracks.smoothed, smoother);
    findings.insert(findings.end(), {thesis, filter, smoother});
  }
  return findings;
}

std::string found_words(const StaticTest& test, std::size_t at) {
  const BiasTracks& tracks = *test.axes[at].tracks;
  const std::string& name = test.record.axes[at].name;
  const auto& thesis = tracks.thesis.rms_error_mps2;
  const auto& filtered = tracks.filtered.rms_error_mps2;
  if (thesis && filtered)
    return fmt::format(
        "{} ({}): the thesis's filter, with its errors corrected, is off by {} µg rms where single "
        "means "
        "are by {}; ours by {}, its smoother by {}, with the truth inside the 95 % band in {} % of "
        "the record.",
        name, source_words(test), significant(*thesis / ug, 3),
        significant(*tracks.raw.rms_error_mps2 / ug, 3), significant(*filtered / ug, 2),
        significant(*tracks.smoothed.rms_error_mps2 / ug, 2),
        report::fixed(100.0 * *tracks.smoothed.inside_95, 0));
  return fmt::format("{} ({}): {} at the end by our filter.", name, source_words(test),
                     report::with_std({tracks.filtered.last_mps2.value / mg_mps2,
                                       tracks.filtered.last_mps2.std / mg_mps2},
                                      "mg"));
}

}  // namespace

Item bias_track_item(const StaticTest& test) {
  const std::size_t at = first_axis(test);
  Item item{
      .id = "figure 5.3",
      .title = "Bias of all axes by a Kalman filter",
      .thesis =
          "The bias of x1, y1, x2 and y2 over two hours, estimated with the fitted "
          "curve as a known input; \"fairly good noise reduction\", without figures.",
      .ours = found_words(test, at),
      .note =
          "With W = 1 the thesis's Q is the variance of the readings themselves (4.62), as "
          "is its R. The gain then is 0.62 whatever the sensor, and two thirds of the "
          "noise pass. Ours uses for Q the estimated random walk of the bias, K² Δt, and for R the "
          "white noise: two figures of the same recording. As printed the filter would "
          "not read the bias at all (4.56). To know the bias of a sensor at rest, take "
          "our smoother; live, our filter."};
  item.findings = findings_of(test);
  item.tables.push_back(errors_table(test));
  item.figures = {all_axes(test), filters_of(test, at)};
  return item;
}

}  // namespace proofmass::thesis
