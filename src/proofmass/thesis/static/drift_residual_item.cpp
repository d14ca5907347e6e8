#include <fmt/format.h>
#include <utility>

#include "proofmass/report/drift/figures.hpp"
#include "proofmass/report/drift/tables.hpp"
#include "proofmass/report/drift/wording.hpp"
#include "proofmass/report/wording.hpp"
#include "proofmass/thesis/static/item_parts.hpp"

namespace proofmass::thesis {
namespace {

using report::duration_words;
using report::fixed;
using signal::WhitenessTest;

struct NamedTest {
  std::string name;
  WhitenessTest test;
};

std::string sample_words(const StaticTest& test, double scale_s) {
  return test.record.decimation > 1 ? fmt::format("one sample every {}", duration_words(scale_s))
                                    : fmt::format("samples at {}", duration_words(scale_s));
}

/// The thesis's fit on the samples as it has them.
std::vector<NamedTest> plain_tests(const StaticTest& test, const AxisTest& axis) {
  std::vector<NamedTest> tests;
  if (!axis.plain) return tests;
  for (const auto& one : {axis.plain->residuals, axis.plain->few_residuals})
    if (one) tests.push_back({sample_words(test, one->scale_s), *one});
  return tests;
}

report::Table whiteness_rows(const StaticTest& test, const AxisTest& axis) {
  report::Table table = report::whiteness_table(*axis.drift);
  table.caption += ". The first rows are of the thesis's fit on single samples";
  std::vector<std::vector<std::string>> rows;
  for (const NamedTest& one : plain_tests(test, axis))
    rows.push_back(report::whiteness_row(one.name, one.test));
  table.rows.insert(table.rows.begin(), rows.begin(), rows.end());
  return table;
}

std::vector<report::Figure> residual_autocorrelations(const StaticTest& test, std::size_t at) {
  const report::ChannelDrift channel = channel_of(test, at);
  const std::string label = channel.name + ", single samples";
  std::vector<report::Figure> figures;
  for (const NamedTest& one : plain_tests(test, test.axes[at]))
    figures.push_back(report::autocorrelation_figure(one.test, label));
  if (channel.analysis->whitened) {
    figures.push_back(report::autocorrelation_figure(*channel.analysis->whitened, label));
    figures.back().title = channel.name + ": the same of our curve, the noise model divided out";
  }
  return figures;
}

void add_scales(const AxisTest& axis, std::vector<Finding>& findings) {
  for (const WhitenessTest& test : axis.drift->whiteness) {
    if (test.scale_s < 1.0) continue;
    const std::string scale = report::compact(test.scale_s, 4);
    Finding& share = findings.emplace_back(
        percent("inside_bounds_" + scale + "s", "Inside the bounds, means over " + scale + " s"));
    share.ours = Uncertain{test.inside_bounds, 0.0};
  }
}

std::vector<Finding> shares_of(const AxisTest& axis) {
  const char* const too_few = "There are too few samples, or no exponential, to test.";
  Finding all = percent("inside_bounds", "Inside the bounds, every sample that was kept");
  all.thesis = 0.97;
  Finding few = percent("inside_bounds_2000", "The same of 2000 of them");
  const auto take = [&](const std::optional<WhitenessTest>& test, Finding& finding) {
    if (test) finding.ours = Uncertain{test->inside_bounds, 0.0};
    if (!test) finding.reason = too_few;
  };
  take(axis.plain ? axis.plain->residuals : std::nullopt, all);
  take(axis.plain ? axis.plain->few_residuals : std::nullopt, few);
  std::vector<Finding> findings{all, few};
  add_scales(axis, findings);
  if (axis.drift->whitened) {
    Finding& divided = findings.emplace_back(
        percent("inside_bounds_whitened", "Inside the bounds, our noise model divided out"));
    divided.ours = Uncertain{axis.drift->whitened->inside_bounds, 0.0};
  }
  Finding& variance = findings.emplace_back(Finding{.key = "innovation_variance",
                                                    .label = "Mean squared innovation over its "
                                                             "expectation, our filter",
                                                    .si_unit = "",
                                                    .shown = {}});
  variance.thesis = 1.0;
  variance.ours = Uncertain{axis.tracks->filtered.mean_nis, 0.0};
  return findings;
}

std::string few_words(const AxisTest& axis) {
  if (!axis.plain || !axis.plain->few_residuals) return "";
  const WhitenessTest& few = *axis.plain->few_residuals;
  return fmt::format(" Of {} samples out of the same record {} % are inside, and three tests {}.",
                     report::grouped(few.values), fixed(100.0 * few.inside_bounds, 0),
                     few.white ? "find nothing wrong" : "say that they are not white");
}

std::string found_residuals(const StaticTest& test, const AxisTest& axis) {
  std::string text;
  if (axis.plain && axis.plain->residuals) {
    const WhitenessTest& all = *axis.plain->residuals;
    text = fmt::format("{} % of {} lags inside the bounds where {} is taken (Ljung–Box p {}).",
                       fixed(100.0 * all.inside_bounds, 0), report::grouped(all.lags),
                       picked_words(test.record), report::p_words(all.ljung_box_p));
  }
  if (text.empty()) text = "The thesis's method finds no curve whose residuals could be tested.";
  text += few_words(axis);
  if (axis.drift->whitened)
    text += fmt::format(" With the noise model divided out {} %, {}.",
                        fixed(100.0 * axis.drift->whitened->inside_bounds, 0),
                        axis.drift->whitened->white ? "white" : "not white");
  return text;
}

}  // namespace

Item residuals_item(const StaticTest& test) {
  const std::size_t at = fitted_axis(test);
  const AxisTest& axis = test.axes[at];
  Item item{.id = "figure 4.6",
            .title = "Autocorrelation of the residuals",
            .thesis =
                "97 % of the autocorrelation lies within its bounds, with an average variance "
                "near one: the fit passes a whiteness test.",
            .ours = found_residuals(test, axis),
            .note = ""};
  item.note =
      "The bounds are ±1.96/√n, so what they see depends on n, which the thesis does not give: the "
      "same slow noise is outside with every sample and inside with a few of them. White residuals "
      "have "
      "95 % inside, so 97 % of some lags is no proof, and a curve that passes may have a T that is "
      "off by many times its standard deviation (table 4.1). A variance of one says nothing either "
      "where the residuals were divided by their own scatter; that of a filter's innovations does. "
      "Take the test at 1, 10 and 100 s, and intervals that allow for what it finds.";
  item.findings = shares_of(axis);
  item.tables.push_back(whiteness_rows(test, axis));
  item.figures = residual_autocorrelations(test, at);
  return item;
}

}  // namespace proofmass::thesis
