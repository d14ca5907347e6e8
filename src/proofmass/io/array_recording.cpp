#include "proofmass/io/array_recording.hpp"

#include <algorithm>
#include <cmath>

#include "proofmass/io/csv_columns.hpp"
#include "proofmass/io/finish_recording.hpp"

namespace proofmass::io {
namespace {

/// Names for columns that have none as for a CSV without a header.
CsvHeader header_of(const std::vector<std::string>& headings, const CsvLayout& layout) {
  if (headings.empty()) return read_header(layout);
  CsvHeader header;
  header.found = true;
  for (const std::string& heading : headings) header.labels.push_back(read_label(heading));
  complete_names(header.labels, header.notes);
  return header;
}

StampColumn stamps_of(const ColumnLabel& label, std::vector<double> values, bool is_named) {
  StampColumn stamps{label.name, label.unit, {}, std::move(values), is_named};
  const auto sane =
      std::ranges::find_if(stamps.values, [](double stamp) { return std::abs(stamp) < 9e18; });
  if (sane == stamps.values.end()) return stamps;
  const double first = *sane;
  stamps.origin = std::abs(first) < 9e9 ? StampOrigin{std::llround(first * 1e9), -9}
                                        : StampOrigin{std::llround(first), 0};
  for (double& stamp : stamps.values) stamp -= first;
  return stamps;
}

}  // namespace

bool ascends(View<double> values) {
  return values.size() > 2 && std::ranges::adjacent_find(values, [](double a, double b) {
                                return !(a < b) || !std::isfinite(b);
                              }) == values.end();
}

std::optional<std::size_t> time_among(const std::vector<std::string>& headings,
                                      const ReadOptions& options) {
  if (headings.empty()) return std::nullopt;
  CsvLayout layout;
  layout.columns.assign(headings.size(), ColumnKind::number);
  const auto chosen = choose_columns(layout, header_of(headings, layout), options);
  return chosen ? chosen->stamps : std::nullopt;
}

Result<Recording> recording_of(ArrayColumns columns,
                               Recording recording,
                               const ReadOptions& options) {
  CsvLayout layout;
  layout.columns.assign(columns.values.size(), ColumnKind::number);
  layout.first_ascends =
      columns.headings.empty() && columns.values.size() > 1 && ascends(columns.values[0]);
  const CsvHeader header = header_of(columns.headings, layout);
  recording.notes.insert(recording.notes.end(), header.notes.begin(), header.notes.end());
  const auto chosen = choose_columns(layout, header, options);
  if (!chosen) return chosen.error();
  std::optional<StampColumn> stamps;
  for (std::size_t c = 0; c < columns.values.size(); ++c) {
    ColumnLabel label = header.labels[c];
    if (chosen->stamps != c) {
      recording.channels.push_back({label.name, label.unit, std::move(columns.values[c])});
      continue;
    }
    if (!header.found) label.unit = *parse_unit("s");
    stamps = stamps_of(label, std::move(columns.values[c]), header.found);
  }
  return finish_recording(std::move(recording), std::move(stamps), columns.rate_hz, options);
}

}  // namespace proofmass::io
