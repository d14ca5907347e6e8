#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "proofmass/fleet/summary_words.hpp"
#include "proofmass/report/figure.hpp"
#include "proofmass/report/page.hpp"
#include "proofmass/report/wording.hpp"

namespace proofmass::fleet {
namespace {

using report::Axis;
using report::Curve;
using report::Figure;
using report::Ink;
using report::Mark;
using report::Section;
using report::Table;

bool is_out(const FigureSummary& figure, std::size_t sensor) {
  return std::ranges::any_of(figure.outliers,
                             [&](const Outlier& one) { return one.sensor == sensor; });
}

void add_levels(const FigureSummary& figure, Figure& plot) {
  for (const Yield& yield : figure.yields)
    plot.levels.push_back({"limit " + yield.limit.text, yield.limit.bound});
  if (figure.type) plot.levels.push_back({"type", figure.type->mean.value});
}

// Each recording's value over its sensor, or over what it may depend on.
Figure scatter(const FigureSummary& figure,
               const std::string& title,
               const std::string& x_label,
               double (*x_of)(const FigureValue&)) {
  Curve family{.label = "recordings", .x = {}, .y = {}, .ink = Ink::blue, .mark = Mark::points};
  Curve out{
      .label = "of sensors out of family", .x = {}, .y = {}, .ink = Ink::red, .mark = Mark::points};
  for (const FigureValue& value : figure.values) {
    const double x = x_of(value);
    if (!std::isfinite(x)) continue;
    Curve& curve = is_out(figure, value.sensor) ? out : family;
    curve.x.push_back(x);
    curve.y.push_back(value.value);
  }
  Figure plot{.title = title,
              .description = "One point a recording.",
              .x = {.label = x_label},
              .y = {.label = fmt::format("{} ({})", figure.name, figure.unit)}};
  if (!family.x.empty()) plot.curves.push_back(std::move(family));
  if (!out.x.empty()) plot.curves.push_back(std::move(out));
  add_levels(figure, plot);
  return plot;
}

double sensor_number(const FigureValue& value) {
  return static_cast<double>(value.sensor + 1);
}
double day_number(const FigureValue& value) {
  return value.day.value_or(report::gap);
}
double temperature_of(const FigureValue& value) {
  return value.temperature_c.value_or(report::gap);
}

Table quantiles_table(const FigureSummary& figure) {
  constexpr int digits = 4;
  const auto words = [](double value) { return report::compact(value, digits); };
  const Quantiles& q = figure.quantiles;
  return {.caption = fmt::format("Distribution over {}",
                                 report::count_words(figure.values.size(), "recording")),
          .head = {"", "smallest", "5 %", "25 %", "median", "75 %", "95 %", "largest"},
          .rows = {{figure.name, words(q.min), words(q.p05), words(q.p25), words(q.median),
                    words(q.p75), words(q.p95), words(q.max)}}};
}

Section section_of(const FigureSummary& figure) {
  Section section{.heading = figure_title(figure)};
  section.tables.push_back(quantiles_table(figure));
  section.figures.push_back(scatter(figure, figure.name + " of each sensor",
                                    "sensor, in the order of the table above", sensor_number));
  if (figure.per_day)
    section.figures.push_back(
        scatter(figure, figure.name + " over time", "days since 1970", day_number));
  if (figure.per_kelvin)
    section.figures.push_back(
        scatter(figure, figure.name + " against temperature", "temperature (°C)", temperature_of));
  return section;
}

// Each outlier's recordings, a click away.
Table outlier_table(const Summary& summary, const std::string& links) {
  Table table{.caption = "Sensors out of family, and their recordings",
              .head = {"recording", "sensor", "figure", "value"},
              .rows = {}};
  for (const FigureSummary& figure : summary.figures)
    for (const Outlier& one : figure.outliers)
      for (const FigureValue& value : figure.values) {
        if (value.sensor != one.sensor) continue;
        table.rows.push_back({report::file_name(value.file), summary.sensors[one.sensor],
                              figure_title(figure), report::compact(value.value, 4)});
        table.links.push_back(links + value.page);
      }
  return table;
}

Section outliers_section(const Summary& summary, const std::string& links) {
  Section section{.heading = "Out of family"};
  section.paragraphs.push_back(fmt::format(
      "A sensor is called out of family where its mean is farther from the others than chance "
      "accounts for: of {} tests, those whose expected share of false alarms is {} at most "
      "(Benjamini and Hochberg).",
      summary.family_tests, report::compact(summary.false_share, 3)));
  const auto rows = outlier_rows(summary);
  if (rows.empty()) return section;
  section.tables.push_back(
      {.caption = "", .head = {"sensor", "figure", "mean", "", "distance", ""}, .rows = rows});
  section.tables.push_back(outlier_table(summary, links));
  return section;
}

Section sensors_section(const Summary& summary) {
  Section section{.heading = "Sensors"};
  std::string names;
  for (std::size_t k = 0; k < summary.sensors.size(); ++k)
    names += fmt::format("{}{} {}", k == 0 ? "" : ", ", k + 1, summary.sensors[k]);
  section.paragraphs.push_back(names);
  return section;
}

void add_table(std::vector<Section>& sections,
               const char* heading,
               std::vector<std::vector<std::string>> rows,
               std::vector<std::string> head) {
  if (rows.empty()) return;
  Section section{.heading = heading};
  section.tables.push_back({.caption = "", .head = std::move(head), .rows = std::move(rows)});
  sections.push_back(std::move(section));
}

}  // namespace

std::string summary_html(const Summary& summary, const std::string& links) {
  report::Page page{.verb = "fleet summary",
                    .title = summary.folder,
                    .inputs = {},
                    .conclusion = conclusion_of(summary)};
  page.sections.push_back(outliers_section(summary, links));
  add_table(page.sections, "The type", type_rows(summary),
            {"figure", "mean", "scatter between sensors", "scatter within"});
  add_table(page.sections, "Dependence on date and temperature", trend_rows(summary),
            {"figure", "slope", "", ""});
  add_table(page.sections, "Yield", yield_rows(summary), {"figure", "limit", "within", "95 %"});
  page.sections.push_back(sensors_section(summary));
  for (const FigureSummary& figure : summary.figures) page.sections.push_back(section_of(figure));
  return report::html(page);
}

}  // namespace proofmass::fleet
