#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <optional>
#include <string_view>

#include "proofmass/report/json.hpp"
#include "proofmass/report/page.hpp"
#include "proofmass/report/sensor_report.hpp"
#include "proofmass/report/wording.hpp"
#include "proofmass/sensor/figure_list.hpp"

namespace proofmass::report {
namespace {

using sensor::Figure;
using sensor::FigureSlot;

constexpr std::array<std::string_view, 4> figure_sections{"calibration", "noise", "drift",
                                                          "electrical"};

std::string section_words(std::string_view section) {
  if (section == "calibration") return "Calibration";
  if (section == "noise") return "Noise";
  if (section == "drift") return "Warm-up";
  return "Electrical";
}

// As its author wrote it; the unit stands in a column of its own.
std::string value_words(const Figure& figure) {
  if (figure.std && *figure.std > 0.0) return with_std({figure.value, *figure.std});
  return compact(figure.value, 9);
}

std::vector<std::string> cells(const FigureSlot& slot) {
  const Figure& figure = *slot.figure;
  const std::string name = slot.axis ? slot.key + " " + slot.axis_name() : slot.key;
  const std::string unit = figure.unit.symbol == "1" ? "" : print_unit(figure.unit.symbol);
  return {name, value_words(figure), unit, figure.std ? "" : "not said", figure.origin};
}

std::vector<std::vector<std::string>> rows_of(const SensorShow& report, std::string_view section) {
  std::vector<std::vector<std::string>> rows;
  for (const FigureSlot& slot : sensor::figure_slots(report.model))
    if (slot.section == section && slot.figure) rows.push_back(cells(slot));
  // A column that says nothing is left away.
  const bool all_known = std::ranges::all_of(rows, [](const auto& row) { return row[3].empty(); });
  for (auto& row : rows)
    if (all_known) row.erase(row.begin() + 3);
  if (!rows.empty())
    rows.insert(rows.begin(),
                all_known ? std::vector<std::string>{"figure", "value", "unit", "origin"}
                          : std::vector<std::string>{"figure", "value", "unit", "std", "origin"});
  return rows;
}

/// The two figures of the calibration that are most alike in their errors.
std::string correlation_words(const sensor::Calibration& calibration) {
  constexpr std::array<std::string_view, 9> names{
      "bias x",  "bias y",          "bias z",          "scale x",        "scale y",
      "scale z", "misalignment yz", "misalignment zy", "misalignment zx"};
  if (!calibration.covariance) return {};
  const auto& C = *calibration.covariance;
  double largest = 0.0;
  std::size_t a = 0, b = 0;
  for (std::size_t i = 0; i < 9; ++i)
    for (std::size_t j = 0; j < i; ++j) {
      const double size = std::sqrt(C[i][i] * C[j][j]);
      const double r = size > 0.0 ? C[i][j] / size : 0.0;
      if (std::abs(r) <= std::abs(largest)) continue;
      largest = r;
      a = j;
      b = i;
    }
  if (largest == 0.0) return "The covariance of the nine figures has no correlations.";
  return fmt::format(
      "The covariance of the nine figures is there; most correlated are {} and {}, {}.", names[a],
      names[b], fixed(largest, 2));
}

std::string title(const SensorShow& report) {
  const sensor::SensorModel& model = report.model;
  std::string out = model.name.empty() ? file_name(report.file) : model.name;
  if (!model.serial.empty()) out += ", serial number " + model.serial;
  if (!model.date.empty()) out += ", " + model.date;
  return out;
}

// "calibration (9 figures), noise (6 figures)": what the file knows.
std::string contents(const SensorShow& report) {
  std::string known, unknown;
  for (const std::string_view section : figure_sections) {
    const auto slots = sensor::figure_slots(report.model);
    const auto count = static_cast<std::size_t>(std::ranges::count_if(
        slots, [&](const FigureSlot& s) { return s.section == section && s.figure; }));
    if (count > 0)
      known += fmt::format("{}{} ({})", known.empty() ? "" : ", ", section,
                           count_words(count, "figure"));
    else
      unknown += fmt::format("{}{}", unknown.empty() ? "" : ", ", section);
  }
  if (known.empty()) return "The file has no figures.";
  return fmt::format("The file has {}{}.", known,
                     unknown.empty() ? "" : fmt::format("; nothing on {}", unknown));
}

Value json_of(const FigureSlot& slot) {
  const Figure& figure = *slot.figure;
  const auto std_si = figure.std_si();
  Object out{{"section", slot.section}, {"key", slot.key}};
  if (slot.axis) out.push_back({"axis", slot.axis_name()});
  out.push_back({"value", figure.si()});
  out.push_back({"std", std_si ? Value(*std_si) : Value()});
  out.push_back({"unit", figure.unit.si_symbol});
  out.push_back({"written_value", figure.value});
  out.push_back({"written_unit", figure.unit.symbol});
  out.push_back({"origin", figure.origin});
  return out;
}

}  // namespace

std::string sensor_show_json(const SensorShow& report) {
  const sensor::SensorModel& model = report.model;
  std::vector<std::string> warnings = texts(report.notes, Severity::warning);
  Array figures;
  bool std_missing = false;
  for (const FigureSlot& slot : sensor::figure_slots(model)) {
    if (!slot.figure) continue;
    std_missing = std_missing || !slot.figure->std;
    figures.push_back(json_of(slot));
  }
  if (std_missing) warnings.emplace_back("std: null where the file gives no standard deviation");
  Value covariance;
  if (model.calibration.covariance) {
    Array rows;
    for (const auto& row : *model.calibration.covariance) rows.push_back(array_of(row));
    covariance = std::move(rows);
  } else {
    warnings.emplace_back("covariance: null: the file has none");
  }
  return to_json({"sensor", {report.file}, std::move(warnings)},
                 {{"action", "show"},
                  {"name", model.name},
                  {"serial", model.serial},
                  {"date", model.date},
                  {"supply_channel", model.electrical.supply_channel},
                  {"figures", std::move(figures)},
                  {"covariance", std::move(covariance)}});
}

std::string sensor_show_text(const SensorShow& report) {
  std::string out = title(report) + "\n" + contents(report) + "\n";
  for (const std::string_view section : figure_sections) {
    const auto rows = rows_of(report, section);
    if (!rows.empty()) out += fmt::format("\n{}\n{}", section_words(section), aligned(rows));
    if (section == "calibration" && report.model.calibration.covariance)
      out += "  " + correlation_words(report.model.calibration) + "\n";
  }
  return out;
}

std::string sensor_show_html(const SensorShow& report) {
  Page page{.verb = "sensor show",
            .title = title(report),
            .inputs = {report.file},
            .conclusion = contents(report),
            .notes = report.notes};
  for (const std::string_view section : figure_sections) {
    auto rows = rows_of(report, section);
    if (rows.empty()) continue;
    Table table{"", rows.front(), {rows.begin() + 1, rows.end()}};
    Section part{.heading = section_words(section), .tables = {std::move(table)}};
    if (section == "calibration" && report.model.calibration.covariance)
      part.paragraphs = {correlation_words(report.model.calibration)};
    page.sections.push_back(std::move(part));
  }
  return html(page);
}

}  // namespace proofmass::report
