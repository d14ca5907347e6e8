#include "proofmass/io/column_names.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "proofmass/io/csv/columns.hpp"

namespace proofmass::io {
namespace {

CsvHeader header_of(const std::vector<std::string>& headings, const CsvLayout& layout) {
  if (headings.empty()) return read_header(layout);
  CsvHeader header;
  header.found = true;
  for (const std::string& heading : headings) header.labels.push_back(read_label(heading));
  complete_names(header.labels, header.notes);
  return header;
}

}  // namespace

Result<NamedColumns> name_columns(const std::vector<std::string>& headings,
                                  std::size_t columns,
                                  bool first_ascends,
                                  const ReadOptions& options) {
  CsvLayout layout;
  layout.columns.assign(columns, ColumnKind::number);
  layout.first_ascends = headings.empty() && columns > 1 && first_ascends;
  CsvHeader header = header_of(headings, layout);
  const auto chosen = choose_columns(layout, header, options);
  if (!chosen) return chosen.error();
  NamedColumns named{std::move(header.labels), chosen->stamps, !header.found,
                     std::move(header.notes)};
  if (named.are_made_up && named.time) named.labels[*named.time].unit = *parse_unit("s");
  return named;
}

bool ascends(View<double> values) {
  return values.size() > 2 && std::ranges::adjacent_find(values, [](double a, double b) {
                                return !(a < b) || !std::isfinite(b);
                              }) == values.end();
}

std::optional<std::size_t> time_among(const std::vector<std::string>& headings,
                                      const ReadOptions& options) {
  if (headings.empty()) return std::nullopt;
  const auto named = name_columns(headings, headings.size(), false, options);
  return named ? named->time : std::nullopt;
}

std::optional<StampOrigin> origin_of(View<double> stamps) {
  const auto sane = std::ranges::find_if(stamps, [](double s) { return std::abs(s) < 9e18; });
  if (sane == stamps.end()) return std::nullopt;
  return std::abs(*sane) < 9e9 ? StampOrigin{std::llround(*sane * 1e9), -9}
                               : StampOrigin{std::llround(*sane), 0};
}

}  // namespace proofmass::io
