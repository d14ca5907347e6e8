#include <algorithm>
#include <fmt/format.h>

#include "proofmass/fleet/summary.hpp"
#include "proofmass/report/document.hpp"

namespace proofmass::fleet {
namespace {

using report::Array;
using report::Object;
using report::Value;

Value pair_of(const Bounds& bounds) {
  return Array{bounds.lower, bounds.upper};
}

Object quantiles_json(const Quantiles& q) {
  return {{"min", q.min}, {"p05", q.p05}, {"p25", q.p25}, {"median", q.median},
          {"p75", q.p75}, {"p95", q.p95}, {"max", q.max}};
}

Value type_json(const std::optional<RandomEffects>& type, const std::string& unit) {
  if (!type) return nullptr;
  Object mean{{"value", type->mean.value}, {"std", type->mean.std}, {"unit", unit}};
  mean.push_back({"interval_95", pair_of(type->mean_95)});
  Object item{{"sensors", std::uint64_t{type->sensors}},
              {"values", std::uint64_t{type->values}},
              {"mean", std::move(mean)},
              {"between_std", Object{{"value", type->between_std},
                                     {"unit", unit},
                                     {"interval_95", pair_of(type->between_95)}}}};
  if (type->within_std)
    item.push_back({"within_std", Object{{"value", *type->within_std},
                                         {"unit", unit},
                                         {"interval_95", pair_of(type->within_95)}}});
  return item;
}

Value trend_json(const std::optional<Trend>& trend, double adjusted_p, const std::string& unit) {
  if (!trend) return nullptr;
  return Object{{"value", trend->slope.value},
                {"std", trend->slope.std},
                {"unit", unit},
                {"interval_95", pair_of(trend->slope_95)},
                {"p", trend->p},
                {"adjusted_p", adjusted_p},
                {"within_sensors", trend->within_sensors}};
}

Array yields_json(const Summary& summary, const FigureSummary& figure) {
  Array items;
  for (const Yield& yield : figure.yields) {
    Array failing;
    for (const std::size_t sensor : yield.failing) failing.emplace_back(summary.sensors[sensor]);
    items.push_back(Object{{"limit", yield.limit.text},
                           {"within", std::uint64_t{yield.within}},
                           {"sensors", std::uint64_t{yield.sensors}},
                           {"share_95", pair_of(yield.share_95)},
                           {"failing", std::move(failing)}});
  }
  return items;
}

std::string place_of(const FigureSummary& figure) {
  return figure.channel.empty() ? figure.name : figure.channel + ": " + figure.name;
}

// Why a figure has no type, no trend.
void add_reasons(const FigureSummary& figure, std::vector<std::string>& warnings) {
  const auto add = [&](const char* key, const char* why) {
    warnings.push_back(fmt::format("{}: {}: {}", place_of(figure), key, why));
  };
  if (!figure.type) add("type", "fewer than three sensors");
  if (!figure.per_day) add("per_day", "too few dates in the manifest's column date");
  if (!figure.per_kelvin) add("per_kelvin", "too few temperatures in the column temperature");
}

Value figure_json(const Summary& summary, const FigureSummary& figure) {
  return Object{
      {"name", figure.name},
      {"channel", figure.channel},
      {"unit", figure.unit},
      {"values", std::uint64_t{figure.values.size()}},
      {"not_identified", std::uint64_t{figure.not_identified}},
      {"quantiles", quantiles_json(figure.quantiles)},
      {"tested", figure.is_tested},
      {"type", type_json(figure.type, figure.unit)},
      {"per_day", trend_json(figure.per_day, figure.per_day_adjusted_p, figure.unit + "/day")},
      {"per_kelvin",
       trend_json(figure.per_kelvin, figure.per_kelvin_adjusted_p, figure.unit + "/K")},
      {"yield", yields_json(summary, figure)}};
}

Array recordings_of(const FigureSummary& figure, std::size_t sensor) {
  Array pages;
  for (const FigureValue& value : figure.values)
    if (value.sensor == sensor) pages.push_back(Object{{"file", value.file}, {"page", value.page}});
  return pages;
}

}  // namespace

std::string summary_json(const Summary& summary) {
  std::vector<std::string> warnings;
  Array figures, outliers;
  for (const FigureSummary& figure : summary.figures) {
    figures.push_back(figure_json(summary, figure));
    add_reasons(figure, warnings);
    for (const Outlier& one : figure.outliers)
      outliers.push_back(Object{{"sensor", summary.sensors[one.sensor]},
                                {"channel", figure.channel},
                                {"figure", figure.name},
                                {"mean", one.mean},
                                {"unit", figure.unit},
                                {"z", one.z},
                                {"p", one.p},
                                {"adjusted_p", one.adjusted_p},
                                {"recordings", recordings_of(figure, one.sensor)}});
  }
  return report::to_json({"fleet", {summary.folder}, warnings},
                         {{"analysis", "summary"},
                          {"recordings", std::uint64_t{summary.recordings}},
                          {"failures", std::uint64_t{summary.failures}},
                          {"sensors", report::array_of(summary.sensors)},
                          {"false_share", summary.false_share},
                          {"family_tests", std::uint64_t{summary.family_tests}},
                          {"trend_tests", std::uint64_t{summary.trend_tests}},
                          {"out_of_family", std::move(outliers)},
                          {"figures", std::move(figures)},
                          {"results", summary.folder}});
}

}  // namespace proofmass::fleet
