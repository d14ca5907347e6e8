#include "tumble/table.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>

#include "cli/exit_status.hpp"
#include "proofmass/report/wording.hpp"

namespace proofmass::app {
namespace {

using calibrate::TumblePosition;

std::optional<std::size_t> axis_of(const Recording& recording, std::size_t channel) {
  const std::vector<Triad> triads = accelerometer_triads(recording);
  if (triads.size() != 1) return std::nullopt;
  const std::array places{triads[0].x, triads[0].y, triads[0].z};
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (places[axis] == channel) return axis;
  return std::nullopt;
}

// Unit of a column; --unit replaces an unknown one.
Unit unit_of(const Channel& channel, const InputFlags& flags) {
  if (channel.unit.quantity != Quantity::unknown || flags.unit.empty()) return channel.unit;
  return *parse_unit(flags.unit);
}

Unit si_unit(const Unit& unit) {
  if (unit.quantity == Quantity::acceleration) return *parse_unit("m/s^2");
  if (unit.quantity == Quantity::voltage) return *parse_unit("V");
  return unit;
}

// Direction from a word or a number: +1 forwards, −1 backwards.
int direction_in_words(const std::string& word) {
  if (word.empty()) return 0;
  const char c = static_cast<char>(word[0] | 0x20);
  const bool forward = c == 'f' || c == 'u' || word == "cw" || word == "CW" || word == "+";
  const bool backward =
      c == 'b' || c == 'd' || c == 'r' || word == "ccw" || word == "CCW" || word == "-";
  return forward ? 1 : backward ? -1 : 0;
}

std::vector<int> directions(const Recording& recording, const TumbleColumns& columns) {
  std::vector<int> out(recording.samples(), 0);
  if (columns.direction) {
    const Samples& values = recording.channels[*columns.direction].values;
    for (std::size_t k = 0; k < out.size(); ++k) out[k] = (values[k] > 0.0) - (values[k] < 0.0);
    return out;
  }
  const std::string& name = recording.label_channel;
  if (!name.starts_with("dir") && !name.starts_with("Dir") && name != "way" && name != "sense")
    return out;
  for (const Label& label : recording.labels)
    for (std::size_t k = label.first; k <= label.last; ++k) out[k] = direction_in_words(label.text);
  return out;
}

int checked_plane(double value, const Recording& recording, std::size_t row) {
  if (value == 1.0 || value == 2.0) return static_cast<int>(value);
  throw Failure(bad_input, fmt::format("{}: row {}: plane {}: expected 1 or 2", recording.source,
                                       row + 1, report::compact(value, 6)));
}

std::vector<TumblePosition> table_positions(const Recording& recording,
                                            const TumbleColumns& columns,
                                            const std::vector<std::size_t>& rows) {
  const std::vector<double> angle = angles_rad(recording.channels[*columns.angle]);
  const std::vector<int> way = directions(recording, columns);
  std::vector<TumblePosition> out;
  const auto at = [&](const std::optional<std::size_t>& column, std::size_t row, double absent) {
    return column ? recording.channels[*column].values[row] : absent;
  };
  for (const std::size_t row : rows) {
    TumblePosition p;
    p.angle_rad = angle[row];
    p.direction = way[row];
    p.plane = checked_plane(at(columns.plane, row, 1.0), recording, row);
    p.mount_rad = columns.mount ? angles_rad(recording.channels[*columns.mount])[row] : 0.0;
    if (columns.time)
      p.time_s = at(columns.time, row, 0.0);
    else if (recording.time.source == TimeSource::stamps)
      p.time_s = recording.time.at(row);
    if (columns.temperature) {
      const Channel& channel = recording.channels[*columns.temperature];
      p.temperature = channel.unit.quantity == Quantity::temperature
                          ? channel.unit.si(channel.values[row])
                          : channel.values[row];
    }
    p.label = recording.first_line > 0 ? fmt::format("line {}", recording.first_line + row)
                                       : fmt::format("row {}", row + 1);
    out.push_back(std::move(p));
  }
  return out;
}

// Rows with an angle and all outputs.
std::vector<std::size_t> whole_rows(const Recording& recording, const TumbleColumns& columns) {
  std::vector<std::size_t> needed = columns.outputs, rows;
  needed.push_back(*columns.angle);
  for (std::size_t row = 0; row < recording.samples(); ++row) {
    const bool whole = std::all_of(needed.begin(), needed.end(), [&](std::size_t k) {
      return std::isfinite(recording.channels[k].values[row]);
    });
    if (whole) rows.push_back(row);
  }
  return rows;
}

// The stated standard deviation of an output at those rows; 0 if there is none.
std::vector<double> stated_std(const Recording& recording,
                               const Channel& output,
                               std::optional<std::size_t> column,
                               const std::vector<std::size_t>& rows,
                               double factor) {
  std::vector<double> out(rows.size(), 0.0);
  if (!column) return out;
  const Channel& channel = recording.channels[*column];
  const bool own_unit =
      channel.unit.quantity == output.unit.quantity && output.unit.quantity != Quantity::unknown;
  const double to = own_unit ? channel.unit.to_si : factor;
  for (std::size_t k = 0; k < rows.size(); ++k)
    if (std::isfinite(channel.values[rows[k]])) out[k] = channel.values[rows[k]] * to;
  return out;
}

}  // namespace

TumbleOutput make_output(const Recording& recording, std::size_t k, const InputFlags& flags) {
  TumbleOutput out;
  out.name = recording.channels[k].name;
  out.unit = si_unit(unit_of(recording.channels[k], flags));
  out.axis = axis_of(recording, k);
  return out;
}

double to_si(const Channel& channel, const InputFlags& flags) {
  const Unit unit = unit_of(channel, flags);
  return si_unit(unit).to_si == unit.to_si ? 1.0 : unit.to_si;
}

TumblePart read_table(const Recording& recording,
                      const TumbleColumns& columns,
                      const InputFlags& flags,
                      std::vector<Note>& notes) {
  const std::vector<std::size_t> rows = whole_rows(recording, columns);
  if (rows.size() < recording.samples())
    notes.push_back(
        {Severity::warning,
         fmt::format("{}: {} without angle or output: omitted", report::file_name(recording.source),
                     report::count_words(recording.samples() - rows.size(), "row"))});
  TumblePart part;
  part.readings.positions = table_positions(recording, columns, rows);
  const bool calibrated = !flags.sensors.empty();
  for (std::size_t j = 0; j < columns.outputs.size(); ++j) {
    const Channel& channel = recording.channels[columns.outputs[j]];
    TumbleOutput out = make_output(recording, columns.outputs[j], flags);
    const double factor = to_si(channel, flags);
    for (const std::size_t row : rows) out.values.push_back(channel.values[row] * factor);
    out.std = stated_std(recording, channel, calibrated ? std::nullopt : columns.output_std[j],
                         rows, factor);
    part.readings.outputs.push_back(std::move(out));
  }
  if (calibrated && columns.output_std.front())
    notes.push_back({Severity::warning,
                     "--sensor: the stated noise of the outputs is left aside: it is that of the "
                     "readings before the calibration"});
  return part;
}

}  // namespace proofmass::app
