#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <utility>

#include "proofmass/report/drift/figures.hpp"
#include "proofmass/report/drift/wording.hpp"
#include "proofmass/report/wording.hpp"
#include "proofmass/thesis/static/item_parts.hpp"

namespace proofmass::thesis {
namespace {

using characterise::DriftFit;
using characterise::Interval95;
using report::fixed;

Uncertain figure_of(const Interval95& interval) {
  return {interval.value, interval.std};
}

// The curve at its start, where it bends.
report::Figure beginning_of(report::Figure figure, double until_s) {
  figure.title += ": the first " + report::duration_words(until_s);
  figure.x.max = until_s;
  return figure;
}

/// a1 + a2, with the correlation of the two.
Uncertain settled_mps2(const DriftFit& fit) {
  const Eigen::MatrixXd& C = fit.curve.covariance;  // of a2, a1, ln T
  return {fit.curve.a1 + fit.curve.a2, std::sqrt(std::max(0.0, C(0, 0) + 2.0 * C(0, 1) + C(1, 1)))};
}

void take(const std::optional<Interval95>& interval, const std::string& verdict, Finding& finding) {
  if (interval) {
    finding.ours = figure_of(*interval);
  } else {
    finding.reason = verdict;
  }
}

void add_plain(const std::optional<PlainFit>& plain, std::vector<Finding>& findings) {
  const char* const who = ", by the thesis's method";
  Finding a1 = milli_g("a1_plain", std::string("Warm-up a1") + who);
  Finding a2 = milli_g("a2_plain", std::string("Bias at switching on a2") + who);
  Finding T = seconds("time_constant_plain", std::string("Time constant T") + who);
  if (plain) {
    a1.ours = plain->a1_mps2;
    a2.ours = plain->a2_mps2;
    T.ours = plain->time_constant_s;
  } else {
    a1.reason = a2.reason = T.reason = "Plain least squares find no exponential in this record.";
  }
  findings.insert(findings.end(), {a1, a2, T});
}

std::vector<Finding> parameters_of(const StaticTest& test, std::size_t at) {
  const AxisTest& axis = test.axes[at];
  const std::string verdict = verdict_sentence(test, at);
  const DriftFit& fit = axis.drift->fit;
  std::vector<Finding> findings{milli_g("a1", "Warm-up a1"),
                                milli_g("a2", "Bias at switching on a2"),
                                seconds("time_constant", "Time constant T")};
  findings[0].thesis = 0.25;
  findings[1].thesis = -0.21;
  findings[2].thesis = 70.0;
  take(fit.a1, verdict, findings[0]);
  take(fit.a2, verdict, findings[1]);
  take(fit.time_constant_s, verdict, findings[2]);
  add_plain(axis.plain, findings);
  Finding& settled = findings.emplace_back(milli_g("settled", "Bias once warm, a1 + a2"));
  if (fit.curve.shape == characterise::DriftShape::exponential) settled.ours = settled_mps2(fit);
  if (!settled.ours)
    settled.reason = fit.identified ? "The curve is no single exponential." : verdict;
  return findings;
}

bool holds(const std::optional<Interval95>& interval, double truth) {
  return interval && truth >= interval->lower_95.value_or(-HUGE_VAL) &&
         truth <= interval->upper_95.value_or(HUGE_VAL);
}

/// How many of the intervals of a1, a2 and T contain the simulated value.
int held(const DriftFit& fit, const sensor::WarmUp& truth) {
  return int{holds(fit.a1, truth.a1_mps2)} + int{holds(fit.a2, truth.a2_mps2)} +
         int{holds(fit.time_constant_s, truth.time_constant_s)};
}

std::string truth_words(const StaticTest& test) {
  int all = 0, in = 0;
  for (std::size_t k = 0; k < test.axes.size(); ++k) {
    const auto& truth = test.record.axes[k].true_warm_up;
    if (!truth || !test.axes[k].drift) continue;
    all += 3;
    in += held(test.axes[k].drift->fit, *truth);
  }
  return all == 0 ? "" : fmt::format(" {} of the {} intervals hold what was simulated.", in, all);
}

report::Table axes_table(const StaticTest& test) {
  const Unit unit = parse_unit("m/s^2").value_or(Unit{});
  report::Table table{
      "The warm-up of each axis, with 95 % intervals", {"Axis", "a2", "a1", "T"}, {}};
  for (std::size_t k = 0; k < test.axes.size(); ++k) {
    const AxisTest& axis = test.axes[k];
    const std::string& name = test.record.axes[k].name;
    if (!axis.drift) {
      table.rows.push_back({name, "not analysed: " + axis.refused->message, "", ""});
      continue;
    }
    const DriftFit& fit = axis.drift->fit;
    const bool known = fit.a1 && fit.time_constant_s;
    table.rows.push_back(
        {name, report::bias_interval_words(fit.a2, unit),
         known ? report::bias_interval_words(*fit.a1, unit) : "not identified",
         known ? report::time_interval_words(*fit.time_constant_s) : verdict_sentence(test, k)});
  }
  return table;
}

// Largest error of the plain fits in their own standard deviations, over all axes.
std::string plain_error_words(const StaticTest& test) {
  double worst = 0.0;
  for (std::size_t k = 0; k < test.axes.size(); ++k) {
    const auto& truth = test.record.axes[k].true_warm_up;
    const auto& plain = test.axes[k].plain;
    if (!truth || !plain) continue;
    const auto errors = [&](const Uncertain& x, double of) {
      return std::abs(x.value - of) / x.std;
    };
    worst = std::max({worst, errors(plain->a1_mps2, truth->a1_mps2),
                      errors(plain->a2_mps2, truth->a2_mps2),
                      errors(plain->time_constant_s, truth->time_constant_s)});
  }
  if (worst == 0.0) return "";
  return fmt::format(
      " On the four axes plain least squares are off by up to {} of the standard deviations that "
      "they state.",
      fixed(worst, 1));
}

// What the thesis's method makes of a record without a warm-up, and of one with gravity.
std::string without_warm_up_words(const StaticTest& test, std::size_t at) {
  const AxisTest& axis = test.axes[at];
  std::string text;
  if (!axis.drift->fit.identified && axis.plain)
    text = fmt::format(
        " Nothing in this recording speaks for an exponential; least squares give T = {} all the "
        "same.",
        report::with_std(axis.plain->time_constant_s, "s"));
  if (report::holds_gravity(axis.drift->fit.a2)) text += " This a2 holds gravity.";
  return text;
}

}  // namespace

Item bias_data_item(const StaticTest& test) {
  const std::size_t at = fitted_axis(test);
  const report::ChannelDrift channel = channel_of(test, at);
  const DriftFit& fit = channel.analysis->fit;
  Item item{.id = "figure 4.5",
            .title = "Bias data of one axis with the fitted curve",
            .thesis =
                "Two hours of a y axis with a1 (1 − e^(−t/T)) + a2 fitted by Levenberg and "
                "Marquardt. A bias of 0.1 m/s² is said to cost 500 m in 100 s (4.51).",
            .ours = fmt::format("{} ({}), {}: {}.", channel.name, source_words(test),
                                report::duration_words(channel.analysis->duration_s),
                                report::drift_verdict(channel)),
            .note =
                "The curve is the thesis's, and its example is right. What is new is the "
                "verdict whether a recording shows such a curve at all: most real ones move by "
                "steps or slow noise, and least squares give an a1 and a T for those too. Take the "
                "curve where it is identified, and the band beside it, not the readings' "
                "scatter."};
  Finding duration = seconds("duration", "Length of the record");
  duration.thesis = 7200.0;
  duration.ours = Uncertain{channel.analysis->duration_s, 0.0};
  Finding cost{.key = "position_error_100s",
               .label = "Position error of 0.1 m/s² after 100 s",
               .si_unit = "m",
               .shown = {"m", 1.0},
               .thesis = 500.0,
               .ours = Uncertain{0.5 * 0.1 * 100.0 * 100.0, 0.0}};
  Finding rms = milli_g("residual_rms", "Readings about the curve, rms");
  rms.ours = Uncertain{channel.analysis->residual_rms, 0.0};
  item.findings = {duration, cost, rms};
  item.figures.push_back(report::drift_figure(channel, channel.name));
  if (fit.identified && 20.0 * fit.curve.time_constant_s < channel.analysis->duration_s)
    item.figures.push_back(beginning_of(item.figures.front(), 8.0 * fit.curve.time_constant_s));
  return item;
}

Item fit_item(const StaticTest& test) {
  const std::size_t at = fitted_axis(test);
  const report::ChannelDrift channel = channel_of(test, at);
  const bool simulated = test.record.simulated;
  Item item{.id = "table 4.1",
            .title = "Fitted parameters of the warm-up",
            .thesis =
                "a1 = 0.25, a2 = −0.21, T = 70, of one y axis; neither units nor "
                "uncertainties.",
            .ours = fmt::format("{} ({}): {}.{}", channel.name, source_words(test),
                                report::drift_verdict(channel), truth_words(test)),
            .note = ""};
  item.note =
      simulated
          ? "The simulated sensor was given these three figures, so the agreement says that "
            "they can be found again in such a record, to the intervals shown, and nothing of "
            "the thesis's sensor. "
          : "Another sensor has another warm-up; the thesis's figures are shown beside. ";
  item.note +=
      "Units: we take m/s², in which −0.21 is 21.4 mg, the size of table 5.1's 19.8 and 22.4 mg. "
      "Once warm a1 + a2 = 0.04 m/s² (4.1 mg) would be left, so those are figures of a cold sensor "
      "or of another axis. T is not identifiable: 70 s means that 95 % is reached after 3.5 min, "
      "while "
      "section 5.1.1 has the bias stable after a few seconds; 70 samples down-sampled to 40 Hz, "
      "1.75 s, would fit that.";
  item.note += plain_error_words(test) + without_warm_up_words(test, at);
  item.note +=
      " Use the intervals, which allow for slow noise of the bias: 93 to 98 % of them "
      "hold the truth in hundreds of simulated records (methods/drift.md).";
  item.findings = parameters_of(test, at);
  item.tables.push_back(axes_table(test));
  item.figures.push_back(report::profile_figure(channel, channel.name));
  return item;
}

}  // namespace proofmass::thesis
