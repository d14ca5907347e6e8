#include "proofmass/acquire/framing/plan.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <optional>
#include <string_view>

#include "proofmass/acquire/framing/settings.hpp"
#include "proofmass/acquire/framing/time.hpp"
#include "proofmass/signal/resample/counter.hpp"

namespace proofmass::acquire {
namespace {

/// Whether a field is called and behaves like a counter of rows.
bool is_counter(const RowEvidence& rows, std::size_t field) {
  const RowField& found = rows.fields[field];
  if (!found.is_figures || !signal::is_counter_name(found.heading)) return false;
  if (found.bits > 0) return true;
  signal::RunningCounter counter;
  if (!rows.first.empty()) counter.add(rows.first[field]);
  return counter.counts_rows();
}

Result<std::optional<RowPlan::Counter>> find_counter(const RowEvidence& rows,
                                                     const FramingOptions& options) {
  const auto counter_of = [&](std::size_t field) {
    const RowField& found = rows.fields[field];
    return std::optional(RowPlan::Counter{field, found.label.name, found.bits});
  };
  if (options.counter == "none") return std::optional<RowPlan::Counter>();
  if (!options.counter.empty()) {
    const auto field = find_field(rows.fields, options.counter);
    if (!field || !rows.fields[*field].is_figures)
      return no_such_field(rows, "counter", options.counter);
    return counter_of(*field);
  }
  for (std::size_t f = 0; rows.has_names && f < rows.fields.size(); ++f)
    if (is_counter(rows, f)) return counter_of(f);
  return std::optional<RowPlan::Counter>();
}

/// The fields of columns=, each once, without the clock.
Result<std::vector<std::size_t>> listed_fields(const RowEvidence& rows,
                                               const FramingOptions& options,
                                               std::optional<std::size_t> clock) {
  std::vector<std::size_t> fields;
  for (const std::string& name : options.columns) {
    const auto field = find_field(rows.fields, name);
    if (!field || !rows.fields[*field].is_figures) return no_such_field(rows, "columns", name);
    if (*field != clock && std::ranges::find(fields, *field) == fields.end())
      fields.push_back(*field);
  }
  return fields;
}

/// The fields that are channels, in the order of columns= or in their own.
Result<std::vector<std::size_t>> channel_fields(const RowEvidence& rows,
                                                const FramingOptions& options,
                                                std::optional<std::size_t> clock) {
  std::vector<std::size_t> fields;
  if (rows.has_names && !options.columns.empty()) {
    auto listed = listed_fields(rows, options, clock);
    if (!listed) return listed.error();
    fields = std::move(listed).value();
  } else {
    for (std::size_t f = 0; f < rows.fields.size(); ++f)
      if (f != clock && rows.fields[f].is_figures) fields.push_back(f);
  }
  if (fields.empty())
    return Error{Errc::invalid_argument, "there is no column of figures besides the clock"};
  return fields;
}

/// A channel's own unit replaces that of its heading; one for all applies to headings without unit.
Status apply_unit(const PerColumn& units, RowPlan::Column& column) {
  const std::string own = units.of(column.field);
  const bool is_open = column.head.unit.quantity == Quantity::unknown;
  if (own.empty() && (!is_open || units.all.empty())) return Done{};
  const auto unit = unit_setting(own.empty() ? units.all : own);
  if (!unit) return unit.error();
  column.head.unit = *unit;
  return Done{};
}

Status apply_scale(const PerColumn& scales, RowPlan::Column& column) {
  const std::string own = scales.of(column.field);
  const std::string& text = own.empty() ? scales.all : own;
  if (text.empty()) return Done{};
  const auto scale = scale_setting(text);
  if (!scale) return scale.error();
  column.scale = *scale;
  return Done{};
}

/// Applies units and factors from the settings to channels that are not counters.
Status apply_settings(const RowEvidence& rows, const FramingOptions& options, RowPlan& plan) {
  const auto units = per_column(options.unit, "unit", rows);
  if (!units) return units.error();
  const auto scales = per_column(options.scale, "scale", rows);
  if (!scales) return scales.error();
  for (RowPlan::Column& column : plan.columns) {
    if (plan.counter && column.field == plan.counter->field) continue;
    if (const Status applied = apply_unit(*units, column); !applied) return applied;
    if (const Status applied = apply_scale(*scales, column); !applied) return applied;
  }
  return Done{};
}

void note_what_is_left(const RowEvidence& rows, DecidedPlan& decided) {
  std::vector<std::string> words;
  for (std::size_t f = 0; f < rows.fields.size(); ++f)
    if (!rows.fields[f].is_figures && f != decided.clock_field)
      words.push_back(rows.fields[f].label.name);
  if (!words.empty())
    decided.notes.push_back(
        {Severity::warning, fmt::format("no figures in {}: not recorded", fmt::join(words, ", "))});
  if (!rows.has_names)
    decided.notes.push_back(
        {Severity::info, "the columns have no names: named by position; columns=x,y,z names them"});
}

}  // namespace

Result<DecidedPlan> decide_plan(const RowEvidence& rows, const FramingOptions& options) {
  DecidedPlan decided;
  const auto clock = find_clock(rows, options, decided.notes);
  if (!clock) return clock.error();
  if (*clock) {
    decided.clock_field = (*clock)->field;
    decided.plan.clock = (*clock)->clock;
    decided.settings.emplace_back(
        "device clock",
        fmt::format("{}, in {}", decided.plan.clock->name, unit_word(decided.plan.clock->unit_ns)));
  }
  auto counter = find_counter(rows, options);
  if (!counter) return counter.error();
  decided.plan.counter = std::move(counter).value();
  if (decided.plan.counter && decided.plan.counter->field == decided.clock_field)
    decided.plan.counter.reset();
  if (decided.plan.counter) decided.settings.emplace_back("counter", decided.plan.counter->name);
  const auto fields = channel_fields(rows, options, decided.clock_field);
  if (!fields) return fields.error();
  for (const std::size_t field : *fields) {
    const io::ColumnLabel& label = rows.fields[field].label;
    decided.plan.columns.push_back({field, 1.0, {label.name, label.unit, {}}});
    if (decided.plan.counter && field == decided.plan.counter->field)
      decided.plan.columns.back().head.unit = *parse_unit("counts");
  }
  if (const Status applied = apply_settings(rows, options, decided.plan); !applied)
    return applied.error();
  note_what_is_left(rows, decided);
  return decided;
}

}  // namespace proofmass::acquire
