#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <optional>
#include <string_view>

#include "proofmass/report/sensor/report.hpp"
#include "proofmass/report/sensor/slot_fields.hpp"
#include "proofmass/report/wording.hpp"
#include "proofmass/sensor/figure_list.hpp"

namespace proofmass::report {
namespace {

using sensor::FigureSlot;

constexpr std::array<std::string_view, 6> figure_sections{"calibration", "noise",     "drift",
                                                          "electrical",  "gyroscope", "encoder"};

std::string section_words(std::string_view section) {
  if (section == "calibration") return "Calibration";
  if (section == "noise") return "Noise";
  if (section == "drift") return "Warm-up";
  if (section == "gyroscope") return "Gyroscope";
  if (section == "encoder") return "Encoder";
  return "Electrical";
}

// As written in the file, without the unit, which has its own column.
std::string value_words(const sensor::Figure& figure) {
  if (figure.std && *figure.std > 0.0) return with_std({figure.value, *figure.std});
  return compact(figure.value, 9);
}

std::vector<std::string> cells(const FigureSlot& slot) {
  const sensor::Figure& figure = *slot.figure;
  const std::string name = slot.axis ? slot.key + " " + slot.axis_name() : slot.key;
  const std::string unit = figure.unit.symbol == "1" ? "" : print_unit(figure.unit.symbol);
  return {name, value_words(figure), unit, figure.std ? "" : "not stated", figure.origin};
}

// The figures of one section; has a column for reasons of missing standard deviations if there are
// any.
Table section_table(const SensorShow& report, std::string_view section) {
  Table table{section_words(section), {"figure", "value", "unit", "std", "origin"}, {}};
  for (const FigureSlot& slot : sensor::figure_slots(report.model))
    if (slot.section == section && slot.figure) table.rows.push_back(cells(slot));
  if (std::ranges::any_of(table.rows, [](const auto& row) { return !row[3].empty(); }))
    return table;
  table.head.erase(table.head.begin() + 3);
  for (auto& row : table.rows) row.erase(row.begin() + 3);
  return table;
}

// The two calibration figures with the most correlated errors.
std::string correlation_words(const sensor::Calibration& calibration) {
  constexpr std::array<std::string_view, 9> names{
      "bias x",  "bias y",          "bias z",          "scale x",        "scale y",
      "scale z", "misalignment yz", "misalignment zy", "misalignment zx"};
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
      "The file has the covariance of the nine figures; most correlated are {} and {}, {}.",
      names[a], names[b], fixed(largest, 2));
}

// "calibration (9 figures), noise (6 figures); nothing on drift"
std::string contents(const SensorShow& report) {
  std::string known, unknown;
  for (const std::string_view section : figure_sections) {
    const auto slots = sensor::figure_slots(report.model);
    const auto count = static_cast<std::size_t>(std::ranges::count_if(
        slots, [&](const FigureSlot& s) { return s.section == section && s.figure; }));
    if (count > 0)
      known += fmt::format("{}{} ({})", known.empty() ? "" : ", ", section,
                           count_words(count, "figure"));
    else if (section != "gyroscope" && section != "encoder")  // which many sensors do not have
      unknown += fmt::format("{}{}", unknown.empty() ? "" : ", ", section);
  }
  if (known.empty()) return "The file has no figures.";
  return fmt::format("The file has {}{}.", known,
                     unknown.empty() ? "" : fmt::format("; nothing on {}", unknown));
}

Field figures(const sensor::SensorModel& model) {
  std::vector<FigureSlot> slots = sensor::figure_slots(model);
  std::erase_if(slots, [](const FigureSlot& slot) { return !slot.figure; });
  return field::records("figures", slots, [](const FigureSlot& slot) {
    const sensor::Figure& figure = *slot.figure;
    Fields fields = slot_fields(slot);
    append(fields,
           {field::number("value", figure.si()),
            field::magnitude("std", figure.std_si(),
                             {.why_null = "the file states no standard deviation"}),
            field::text("unit", figure.unit.si_symbol, {.meaning = "SI"}),
            field::number("written_value", figure.value, {.meaning = "as in the file"}),
            field::text("written_unit", figure.unit.symbol), field::text("origin", figure.origin)});
    return fields;
  });
}

Field covariance(const sensor::Calibration& calibration) {
  std::optional<Fields> rows;
  if (calibration.covariance) {
    rows.emplace();
    for (const auto& row : *calibration.covariance) rows->push_back(field::numbers({}, row));
  }
  return field::list_or_null("covariance", std::move(rows),
                             {.meaning = "of bias x y z, scale x y z, misalignment yz zy zx; SI",
                              .why_null = "the file has none"});
}

// An optional text of the file; printed only if present.
Field described(const char* key, const std::string& text, const char* label, const char* meaning) {
  return field::text(key, text, {.meaning = meaning, .label = text.empty() ? "" : label});
}

Fields show_fields(const sensor::SensorModel& model) {
  return {field::choice("action", "show", {"show"}),
          described("name", model.name, "Sensor", ""),
          described("serial", model.serial, "Serial number", ""),
          described("date", model.date, "Date", "ISO 8601; empty if the file states none"),
          described("supply_channel", model.electrical.supply_channel, "Supply channel", ""),
          figures(model),
          covariance(model.calibration)};
}

}  // namespace

Document describe(const SensorShow& report) {
  Document document{.page = {.verb = "sensor",
                             .action = "show",
                             .title = file_name(report.file),
                             .inputs = {report.file},
                             .conclusion = contents(report),
                             .notes = report.notes},
                    .fields = show_fields(report.model)};
  document.page.key_figures = key_figures(document.fields);
  Section section{.heading = "Figures", .on_terminal = true};
  for (const std::string_view name : figure_sections)
    if (Table table = section_table(report, name); !table.rows.empty())
      section.tables.push_back(std::move(table));
  if (report.model.calibration.covariance)
    section.paragraphs = {correlation_words(report.model.calibration)};
  if (!section.tables.empty()) document.page.sections = {std::move(section)};
  return document;
}

Document describe(const SensorExport& report) {
  const std::string where = report.output.value_or("this document");
  return {.page = {.verb = "sensor",
                   .action = "export",
                   .title = file_name(report.file),
                   .inputs = {report.file},
                   .conclusion = fmt::format("{}: written to {}", report.format, where),
                   .notes = report.notes},
          .fields = {field::choice("action", "export", {"export"}),
                     field::choice("format", report.format, {"imu-yaml", "c-header"}),
                     field::text_or_null(
                         "output", report.output.value_or(""),
                         {.meaning = "file written; - is standard output; null if the text is "
                                     "only in this document",
                          .why_null = "no --output: the text is in this document only"}),
                     field::text("text", report.text, {.meaning = "the export itself"})}};
}

}  // namespace proofmass::report
