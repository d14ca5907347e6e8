#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <set>

#include "proofmass/fleet/summary.hpp"
#include "proofmass/fleet/summary_parts.hpp"
#include "proofmass/report/wording.hpp"

namespace proofmass::fleet {
namespace {

namespace field = report::field;
using report::Field;
using report::Fields;
using report::Section;

Field bounds_field(const char* key, const Bounds& bounds) {
  return field::interval(key, std::array{bounds.lower, bounds.upper});
}

Field quantiles_field(const Quantiles& q) {
  return field::object(
      "quantiles",
      {field::number("min", q.min), field::number("p05", q.p05), field::number("p25", q.p25),
       field::number("median", q.median), field::number("p75", q.p75), field::number("p95", q.p95),
       field::number("max", q.max)},
      {.meaning = "over all recordings"});
}

Fields scatter_fields(double std, const std::string& unit, const Bounds& bounds) {
  return {field::magnitude("value", std), field::text("unit", unit),
          bounds_field("interval_95", bounds)};
}

Field type_field(const FigureSummary& figure) {
  std::optional<Fields> fields;
  if (const auto& type = figure.type) {
    fields = {field::count("sensors", type->sensors), field::count("values", type->values),
              field::object("mean", {field::number("value", type->mean.value),
                                     field::magnitude("std", type->mean.std),
                                     field::text("unit", figure.unit),
                                     bounds_field("interval_95", type->mean_95)}),
              field::object("between_std",
                            scatter_fields(type->between_std, figure.unit, type->between_95),
                            {.meaning = "standard deviation between sensors"})};
    std::optional<Fields> within;
    if (type->within_std) within = scatter_fields(*type->within_std, figure.unit, type->within_95);
    fields->push_back(field::object_or_null(
        "within_std", within,
        {.meaning = "standard deviation within a sensor, from one recording to the next",
         .why_null = "no sensor has two recordings"}));
  }
  return field::object_or_null("type", fields,
                               {.meaning = "random-effects model of the sensors in the family",
                                .why_null = "fewer than three sensors"});
}

Field trend_field(const char* key,
                  const std::optional<Trend>& trend,
                  double adjusted_p,
                  const std::string& unit,
                  const char* why_null) {
  std::optional<Fields> fields;
  if (trend)
    fields = {field::number("value", trend->slope.value),
              field::magnitude("std", trend->slope.std),
              field::text("unit", unit),
              bounds_field("interval_95", trend->slope_95),
              field::magnitude("p", trend->p, {.meaning = "of no dependence"}),
              field::magnitude("adjusted_p", adjusted_p,
                               {.meaning = "over all trends, by Benjamini and Hochberg"}),
              field::flag("within_sensors", trend->within_sensors,
                          {.meaning = "false: no sensor was measured at two values, so that "
                                      "differences between sensors may look like a trend"})};
  return field::object_or_null(key, fields, {.why_null = why_null});
}

std::vector<std::string> names_of(const Summary& summary, const std::vector<std::size_t>& sensors) {
  std::vector<std::string> names;
  for (const std::size_t sensor : sensors) names.push_back(summary.sensors[sensor]);
  return names;
}

Fields figure_fields(const Summary& summary, const FigureSummary& figure) {
  return {field::text("name", figure.name, {.meaning = "column of results.parquet"}),
          field::text("channel", figure.channel),
          field::text("unit", figure.unit),
          field::count("values", figure.values.size(), {.meaning = "recordings that have it"}),
          field::count("not_identified", figure.not_identified,
                       {.meaning = "recordings that did not determine it"}),
          quantiles_field(figure.quantiles),
          field::flag("tested", figure.is_tested, {.meaning = "for sensors out of family"}),
          type_field(figure),
          trend_field("per_day", figure.per_day, figure.per_day_adjusted_p, figure.unit + "/day",
                      "too few dates in the column date"),
          trend_field("per_kelvin", figure.per_kelvin, figure.per_kelvin_adjusted_p,
                      figure.unit + "/K", "too few temperatures in the column temperature"),
          field::records("yield", figure.yields, [&](const Yield& yield) {
            return Fields{field::text("limit", yield.limit.text),
                          field::count("within", yield.within, {.meaning = "sensors, by the mean"}),
                          field::count("sensors", yield.sensors),
                          bounds_field("share_95", yield.share_95),
                          field::texts("failing", names_of(summary, yield.failing))};
          })};
}

Fields outlier_fields(const Summary& summary, const FigureSummary& figure, const Outlier& one) {
  std::vector<const FigureValue*> values;
  for (const FigureValue& value : figure.values)
    if (value.sensor == one.sensor) values.push_back(&value);
  return {field::text("sensor", summary.sensors[one.sensor]),
          field::text("channel", figure.channel),
          field::text("figure", figure.name),
          field::number("mean", one.mean),
          field::text("unit", figure.unit),
          field::number("z", one.z, {.meaning = "distance, robust standard deviations"}),
          field::magnitude("p", one.p),
          field::magnitude("adjusted_p", one.adjusted_p,
                           {.meaning = "over all tests, by Benjamini and Hochberg"}),
          field::records("recordings", values, [](const FigureValue* value) {
            return Fields{field::text("file", value->file),
                          field::text("page", value->page,
                                      {.meaning = "its report or document, in the results"})};
          })};
}

Field outliers_field(const Summary& summary) {
  Fields outliers;
  for (const FigureSummary& figure : summary.figures)
    for (const Outlier& one : figure.outliers)
      outliers.push_back(field::object({}, outlier_fields(summary, figure, one)));
  return field::list("out_of_family", std::move(outliers));
}

Fields summary_fields(const Summary& summary) {
  return {
      field::text("analysis", "summary"),
      field::count("recordings", summary.recordings),
      field::count("failures", summary.failures, {.meaning = "recordings that failed"}),
      field::texts("sensors", summary.sensors,
                   {.meaning = "by the column sensor or serial, or the recordings' own names"}),
      field::magnitude("false_share", summary.false_share,
                       {.meaning = "expected share of false alarms among those listed"}),
      field::count("family_tests", summary.family_tests),
      field::count("trend_tests", summary.trend_tests),
      outliers_field(summary),
      field::records("figures", summary.figures,
                     [&](const FigureSummary& figure) { return figure_fields(summary, figure); }),
      field::text("results", summary.folder, {.meaning = "the folder"})};
}

// "1 000 recordings of 20 sensors; 5 failed. Out of family: S03, S11."
std::string summary_conclusion(const Summary& summary) {
  constexpr std::size_t most_listed = 8;
  std::set<std::string> out;
  for (const FigureSummary& figure : summary.figures)
    for (const Outlier& one : figure.outliers) out.insert(summary.sensors[one.sensor]);
  std::string text =
      fmt::format("{} of {}; {} failed. ", report::count_words(summary.recordings, "recording"),
                  report::count_words(summary.sensors.size(), "sensor"), summary.failures);
  if (summary.family_tests == 0)
    return text + "No figure was measured on enough sensors to test which are out of family.";
  if (out.empty()) return text + "No sensor is out of family.";
  const std::vector<std::string> listed(
      out.begin(),
      std::next(out.begin(), static_cast<std::ptrdiff_t>(std::min(out.size(), most_listed))));
  const std::string more =
      out.size() > listed.size() ? fmt::format(" and {} more", out.size() - listed.size()) : "";
  return text + fmt::format("Out of family: {}{}.", fmt::join(listed, ", "), more);
}

Section outliers_section(const Summary& summary, const std::string& links) {
  Section section{.heading = "Out of family", .id = "out-of-family", .on_terminal = true};
  section.tables = {outlier_table(summary), outlier_recordings_table(summary, links)};
  if (section.tables.front().rows.empty()) section.tables.clear();
  section.paragraphs.push_back(fmt::format(
      "Means of sensors that lie farther from the others than chance accounts for: of {} tests, "
      "those with an expected share of false alarms of {} at most (Benjamini and Hochberg).",
      report::grouped(summary.family_tests), report::compact(summary.false_share, 3)));
  return section;
}

void add_table(std::vector<Section>& sections,
               const char* heading,
               const char* id,
               report::Table table) {
  if (table.rows.empty()) return;
  Section section{.heading = heading, .id = id, .on_terminal = true};
  section.tables.push_back(std::move(table));
  sections.push_back(std::move(section));
}

// The numbers by which the plots know the sensors.
Section sensors_section(const Summary& summary) {
  constexpr std::size_t most_listed = 400;
  const std::size_t listed = std::min(summary.sensors.size(), most_listed);
  std::string names;
  for (std::size_t k = 0; k < listed; ++k)
    names += fmt::format("{}{}: {}", k == 0 ? "" : ", ", k + 1, summary.sensors[k]);
  if (listed < summary.sensors.size())
    names += fmt::format(" and {} more; the JSON document has all",
                         report::grouped(summary.sensors.size() - listed));
  return {
      .heading = "Sensors, by their number in the plots", .id = "sensors", .paragraphs = {names}};
}

Section figures_section(const Summary& summary) {
  Section section{.heading = "Figure by figure", .id = "figures"};
  for (const FigureSummary& figure : summary.figures)
    section.parts.push_back({.heading = figure_title(figure), .figures = figures_of(figure)});
  return section;
}

}  // namespace

bool is_out_of_family(const FigureSummary& figure, std::size_t sensor) {
  return std::ranges::any_of(figure.outliers,
                             [&](const Outlier& one) { return one.sensor == sensor; });
}

std::string figure_title(const FigureSummary& figure) {
  return figure.channel.empty() ? figure.name : figure.channel + ": " + figure.name;
}

report::Document describe(const Summary& summary, const std::string& links) {
  report::Document document{.page = {.verb = "fleet",
                                     .title = "Summary of " + summary.folder,
                                     .inputs = {summary.folder},
                                     .conclusion = summary_conclusion(summary),
                                     .contents = true},
                            .fields = summary_fields(summary)};
  std::vector<Section>& sections = document.page.sections;
  if (summary.family_tests > 0) sections.push_back(outliers_section(summary, links));
  add_table(sections, "The type", "type", type_table(summary));
  add_table(sections, "Dependence on date and temperature", "trends", trend_table(summary));
  add_table(sections, "Yield", "yield", yield_table(summary));
  add_table(sections, "Distributions", "distributions", quantiles_table(summary));
  if (summary.figures.empty()) return document;
  sections.push_back(sensors_section(summary));
  sections.push_back(figures_section(summary));
  return document;
}

}  // namespace proofmass::fleet
