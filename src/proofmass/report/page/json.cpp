#include "proofmass/report/page/json.hpp"

#include <algorithm>
#include <utility>

#include "proofmass/core/version.hpp"
#include "proofmass/report/json.hpp"
#include "proofmass/report/page/thinning.hpp"
#include "proofmass/report/wording.hpp"

namespace proofmass::report {
namespace {

const char* name_of(AxisScale scale) {
  if (scale == AxisScale::log) return "log";
  return scale == AxisScale::bare ? "bare" : "linear";
}

const char* name_of(Mark mark) {
  switch (mark) {
    case Mark::line:
      return "line";
    case Mark::dashes:
      return "dashes";
    case Mark::thin:
      return "thin";
    case Mark::points:
      return "points";
    case Mark::ticks:
      break;
  }
  return "ticks";
}

const char* name_of(Severity severity) {
  if (severity == Severity::info) return "info";
  return severity == Severity::warning ? "warning" : "bad";
}

Value axis_json(const Axis& axis) {
  return Object{{"label", axis.label},
                {"scale", name_of(axis.scale)},
                {"min", or_null(axis.min)},
                {"max", or_null(axis.max)}};
}

Value curve_json(const Curve& curve) {
  Object json{{"label", curve.label}, {"ink", name_of(curve.ink)}, {"mark", name_of(curve.mark)}};
  if (curve.mark == Mark::ticks) {
    json.push_back({"x", array_of(curve.x)});
    return json;
  }
  const Polyline line = thinned(curve.x, curve.y);
  json.push_back({"x", array_of(line.x)});
  json.push_back({"y", array_of(line.y)});
  return json;
}

Value band_json(const Band& band) {
  const Envelope area = thinned_band(band.x, band.lower, band.upper);
  return Object{{"label", band.label},
                {"ink", name_of(band.ink)},
                {"x", array_of(area.x)},
                {"lower", array_of(area.lower)},
                {"upper", array_of(area.upper)}};
}

Value callout_json(const Callout& callout) {
  return Object{{"text", callout.text},        {"x", callout.x},         {"y", callout.y},
                {"ink", name_of(callout.ink)}, {"below", callout.below}, {"left", callout.left},
                {"bare", callout.bare}};
}

template <class Range, class Json>
Array all(const Range& items, Json json) {
  Array out;
  for (const auto& item : items) out.push_back(json(item));
  return out;
}

Value figure_json(const Figure& figure) {
  const auto level = [](const Level& one) {
    return Value(Object{{"label", one.label}, {"y", one.y}});
  };
  return Object{{"title", figure.title},
                {"description", figure.description},
                {"x", axis_json(figure.x)},
                {"y", axis_json(figure.y)},
                {"height", figure.height},
                {"bands", all(figure.bands, band_json)},
                {"curves", all(figure.curves, curve_json)},
                {"levels", all(figure.levels, level)},
                {"callouts", all(figure.callouts, callout_json)}};
}

Value table_json(const Table& table) {
  constexpr std::size_t most_rows = 100;  // rows of a table that may be cut
  const std::size_t shown =
      table.long_list ? std::min(table.rows.size(), most_rows) : table.rows.size();
  Array rows;
  for (std::size_t k = 0; k < shown; ++k) rows.push_back(array_of(table.rows[k]));
  return Object{{"caption", table.caption},
                {"head", array_of(table.head)},
                {"rows", std::move(rows)},
                {"rows_in_all", std::uint64_t{table.rows.size()}},
                {"stacks", table.stacks}};
}

Value section_json(const Section& section) {
  const auto side = [](const Side& one) {
    return Value(Object{{"label", one.label}, {"text", one.text}});
  };
  return Object{
      {"heading", section.heading},
      {"id", section.id},
      {"paragraphs", array_of(section.paragraphs)},
      {"points", array_of(section.points)},
      {"sides", all(section.sides, side)},
      {"tables", all(section.tables, table_json)},
      {"figures", all(section.figures, [](const Plot& plot) { return figure_json(plot.draw()); })},
      {"parts", all(section.parts, section_json)}};
}

}  // namespace

std::string page_json(const Page& page) {
  const auto key = [](const KeyFigure& one) {
    return Value(Object{{"label", one.label}, {"value", one.value}});
  };
  const auto note = [](const Note& one) {
    return Value(Object{{"severity", name_of(one.severity)}, {"text", with_flags(one)}});
  };
  return json_text(Object{{"proofmass", version()},
                          {"verb", page.verb},
                          {"title", page.title},
                          {"inputs", array_of(page.inputs)},
                          {"conclusion", page.conclusion},
                          {"key_figures", all(page.key_figures, key)},
                          {"notes", all(page.notes, note)},
                          {"sections", all(page.sections, section_json)}}) +
         "\n";
}

}  // namespace proofmass::report
