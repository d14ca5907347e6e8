#include "proofmass/acquire/framing/settings.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>

#include "proofmass/io/cell.hpp"
#include "proofmass/io/names.hpp"

namespace proofmass::acquire {
namespace {

struct ClockUnit {
  std::string_view word;
  std::int64_t ns;
};
constexpr std::array<ClockUnit, 4> clock_units{
    {{"s", 1'000'000'000}, {"ms", 1'000'000}, {"us", 1'000}, {"ns", 1}}};

}  // namespace

std::optional<std::size_t> find_field(const std::vector<RowField>& fields, std::string_view name) {
  const std::string wanted = io::lower(name);
  for (std::size_t f = 0; f < fields.size(); ++f)
    if (io::lower(fields[f].heading) == wanted || io::lower(fields[f].label.name) == wanted)
      return f;
  return std::nullopt;
}

Error no_such_field(const RowEvidence& rows, std::string_view setting, std::string_view name) {
  std::string known;
  std::size_t count = 0;
  constexpr std::size_t most = 12;
  for (const RowField& field : rows.fields) {
    if (!field.is_figures || ++count > most) continue;
    known += (known.empty() ? "" : ", ") + field.label.name;
  }
  return {Errc::invalid_argument,
          fmt::format("{}={}: there is no such column of figures; there are {}{}", setting, name,
                      known, count > most ? ", …" : "")};
}

std::string PerColumn::of(std::size_t field) const {
  for (const auto& [column, text] : some)
    if (column == field) return text;
  return {};
}

Result<PerColumn> per_column(std::string_view text,
                             std::string_view setting,
                             const RowEvidence& rows) {
  PerColumn out;
  if (text.find(':') == std::string_view::npos) {
    out.all = text;
    return out;
  }
  while (!text.empty()) {
    const std::string_view pair = text.substr(0, text.find(','));
    text.remove_prefix(std::min(pair.size() + 1, text.size()));
    const std::size_t colon = pair.find(':');
    if (colon == std::string_view::npos || colon + 1 == pair.size())
      return Error{Errc::invalid_argument,
                   fmt::format("{}={}: expected COLUMN:VALUE", setting, pair)};
    const auto field = find_field(rows.fields, pair.substr(0, colon));
    if (!field) return no_such_field(rows, setting, pair.substr(0, colon));
    out.some.emplace_back(*field, pair.substr(colon + 1));
  }
  return out;
}

Result<Unit> unit_setting(std::string_view text) {
  if (const auto unit = parse_unit(text)) return *unit;
  return Error{Errc::invalid_argument,
               fmt::format("unit={}: expected a unit such as m/s^2, g, mg, deg/s or V", text)};
}

Result<double> scale_setting(std::string_view text) {
  const io::Cell cell = io::read_cell(text, '.');
  if (cell.kind == io::CellKind::number && std::isfinite(cell.value) && cell.value != 0.0)
    return cell.value;
  return Error{Errc::invalid_argument,
               fmt::format("scale={}: expected a number other than 0", text)};
}

std::string_view unit_word(std::int64_t unit_ns) {
  return std::ranges::find(clock_units, unit_ns, &ClockUnit::ns)->word;
}

std::optional<std::int64_t> clock_unit_ns(const Unit& unit) {
  const auto found = std::ranges::find(clock_units, unit.symbol, &ClockUnit::word);
  if (unit.quantity != Quantity::time || found == clock_units.end()) return std::nullopt;
  return found->ns;
}

}  // namespace proofmass::acquire
