#include "proofmass/io/positions/pose_table.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "proofmass/io/names.hpp"
#include "proofmass/io/positions/pose_columns.hpp"
#include "proofmass/io/read_recording.hpp"
#include "proofmass/io/text/wording.hpp"

namespace proofmass::io {
namespace {

using Names = View<std::string_view>;

bool is_called(const std::string& name, Names names) {
  return std::ranges::find(names, std::string_view(name)) != names.end();
}

constexpr auto starts = std::to_array<std::string_view>(
    {"start", "starts", "begin", "from", "tstart", "startt", "starttime"});
constexpr auto ends =
    std::to_array<std::string_view>({"end", "ends", "stop", "to", "tend", "endt", "endtime"});
constexpr auto numbers = std::to_array<std::string_view>(
    {"n", "samples", "nsamples", "samplecount", "count", "numberofsamples"});
constexpr auto positions = std::to_array<std::string_view>(
    {"position", "pose", "id", "no", "nr", "label", "orientation", "index"});

/// A numeric column in SI; nullopt if none has one of these names.
std::optional<std::vector<double>> column_called(const Recording& recording, Names names) {
  for (const Channel& channel : recording.channels) {
    if (!is_called(bare_name(channel.name), names)) continue;
    std::vector<double> values = channel.values.copy();
    for (double& value : values) value = channel.unit.si(value);
    return values;
  }
  return std::nullopt;
}

/// A column of times, which the reader may have used as stamps.
std::optional<std::vector<double>> times_called(const Recording& recording, Names names) {
  const TimeBase& time = recording.time;
  if (!is_called(bare_name(time.channel), names) || time.source != TimeSource::stamps ||
      time.mended > 0)
    return column_called(recording, names);
  std::vector<double> times_s(recording.samples());
  const double origin_s = static_cast<double>(time.start_ns.value_or(0)) * 1e-9;
  for (std::size_t k = 0; k < times_s.size(); ++k) times_s[k] = origin_s + time.at(k);
  return times_s;
}

/// "x_mean, y_mean, z_mean"
std::string names_of(const Recording& recording, const PoseTriple& triple) {
  std::string names;
  for (const std::size_t c : triple.columns)
    names += (names.empty() ? "" : ", ") + recording.channels[c].name;
  return names;
}

/// Three columns and the conversion of their values to the unit of the means.
struct Axes {
  std::array<View<double>, 3> values;
  std::array<double, 3> factor{1.0, 1.0, 1.0};

  [[nodiscard]] std::array<double, 3> at(std::size_t row) const {
    return {factor[0] * values[0][row], factor[1] * values[1][row], factor[2] * values[2][row]};
  }
};

Axes axes_of(const Recording& recording, const PoseTriple& triple) {
  Axes axes;
  for (std::size_t i = 0; i < 3; ++i) axes.values[i] = recording.channels[triple.columns[i]].values;
  return axes;
}

/// The same in `unit`; a column without a unit is assumed to have it.
Result<Axes> axes_in(const Recording& recording, const PoseTriple& triple, const Unit& unit) {
  Axes axes = axes_of(recording, triple);
  for (std::size_t i = 0; i < 3; ++i) {
    const Channel& channel = recording.channels[triple.columns[i]];
    if (channel.unit.quantity == Quantity::unknown || unit.quantity == Quantity::unknown) continue;
    if (channel.unit.quantity != unit.quantity)
      return Error{Errc::corrupt, fmt::format("{} in {} does not go with means in {}", channel.name,
                                              channel.unit.symbol, unit.symbol)};
    axes.factor[i] = channel.unit.to_si / unit.to_si;
  }
  return axes;
}

bool are_finite(const std::array<double, 3>& v) {
  return std::ranges::all_of(v, [](double x) { return std::isfinite(x); });
}

/// Reads the rows of a table whose columns of means are known.
class TableReader {
 public:
  TableReader(const Recording& recording, const PoseTriple& means)
      : recording_(recording), means_(means) {
    for (const std::size_t c : means.columns)
      if (file_unit_.quantity == Quantity::unknown) file_unit_ = recording.channels[c].unit;
    start_s_ = times_called(recording, starts);
    end_s_ = times_called(recording, ends);
    samples_ = column_called(recording, numbers);
    positions_ = column_called(recording, positions);
  }

  Result<PoseTable> read(const std::optional<Unit>& given) {
    const Unit unit = given.value_or(file_unit_);
    report(Severity::info, fmt::format("means of positions: {}{}", names_of(recording_, means_),
                                       unit.symbol.empty() ? "" : " in " + unit.symbol));
    const auto means = axes_in(recording_, means_, file_unit_);
    if (!means) return means.error();
    if (const Status found = find_deviations(); !found) return found.error();
    if (const auto triple = find_triple(recording_, PoseRole::direction))
      directions_ = axes_of(recording_, *triple);
    for (std::size_t k = 0; k < recording_.samples(); ++k) {
      PoseRow row;
      row.row = k;
      row.unit = unit;
      row.mean = means->at(k);
      if (are_finite(row.mean)) {
        if (const Status read = complete(row); !read) return read.error();
        table_.rows.push_back(std::move(row));
      } else {
        report(Severity::warning, place(k) + ": a mean is not a number: left out");
      }
    }
    if (table_.rows.empty()) return Error{Errc::too_few_samples, "has no row of three means"};
    return std::move(table_);
  }

 private:
  void report(Severity severity, std::string text) {
    table_.notes.push_back({severity, std::move(text)});
  }

  [[nodiscard]] std::string place(std::size_t row) const {
    return recording_.first_line > 0 ? fmt::format("line {}", recording_.first_line + row)
                                     : fmt::format("row {}", row + 1);
  }

  Status find_deviations() {
    const auto of_mean = find_triple(recording_, PoseRole::std_of_mean, means_.sensor);
    const auto of_samples = find_triple(recording_, PoseRole::std_of_samples, means_.sensor);
    if (!of_mean && !of_samples) return Done{};
    const PoseTriple& triple = of_mean ? *of_mean : *of_samples;
    if (!of_mean && !samples_) {
      report(Severity::warning,
             names_of(recording_, triple) +
                 ": standard deviations of the samples, and no column samples says how many: "
                 "not used");
      return Done{};
    }
    const auto axes = axes_in(recording_, triple, file_unit_);
    if (!axes) return axes.error();
    deviations_ = *axes;
    over_root_n_ = !of_mean;
    report(Severity::info,
           names_of(recording_, triple) +
               (of_mean ? ": standard deviations of the means"
                        : ": standard deviations of the samples, over the root of their number as "
                          "for white noise"));
    return Done{};
  }

  /// Fills in everything except the mean.
  Status complete(PoseRow& row) const {
    const std::size_t k = row.row;
    row.label = label_of(k);
    row.start_s = finite(start_s_, k);
    row.end_s = finite(end_s_, k);
    if (const auto n = finite(samples_, k); n && *n >= 1.0 && *n < 1e15)
      row.samples = static_cast<std::size_t>(*n);
    row.std_of_mean = std_of_mean(k, row.samples);
    if (!directions_) return Done{};
    std::array<double, 3> up = directions_->at(k);
    if (std::ranges::all_of(up, [](double x) { return std::isnan(x); })) return Done{};
    const double length = std::hypot(up[0], up[1], up[2]);
    if (!std::isfinite(length) || length == 0.0)
      return Error{Errc::corrupt,
                   place(k) + ": the true direction needs three figures that are not all zero"};
    for (double& component : up) component /= length;
    row.up = up;
    return Done{};
  }

  [[nodiscard]] std::optional<std::array<double, 3>> std_of_mean(
      std::size_t k, const std::optional<std::size_t>& samples) const {
    if (!deviations_ || (over_root_n_ && !samples)) return std::nullopt;
    std::array<double, 3> std = deviations_->at(k);
    for (double& s : std) {
      if (!std::isfinite(s) || s < 0.0) return std::nullopt;
      if (over_root_n_) s /= std::sqrt(static_cast<double>(*samples));
    }
    return std;
  }

  [[nodiscard]] std::string label_of(std::size_t k) const {
    for (const Label& label : recording_.labels)
      if (label.first <= k && k <= label.last) return label.text;
    const auto number = finite(positions_, k);
    return number ? in_words(*number) : std::string{};
  }

  static std::optional<double> finite(const std::optional<std::vector<double>>& column,
                                      std::size_t k) {
    if (!column || !std::isfinite((*column)[k])) return std::nullopt;
    return (*column)[k];
  }

  const Recording& recording_;
  PoseTriple means_;
  Unit file_unit_;
  std::optional<std::vector<double>> start_s_, end_s_, samples_, positions_;
  std::optional<Axes> deviations_, directions_;
  bool over_root_n_ = false;
  PoseTable table_;
};

// One column for each position, and rows x, y, z.
bool is_turned(const Recording& recording) {
  return recording.samples() == 3 && recording.channels.size() > 3;
}

Recording turned_upright(const Recording& recording) {
  Recording upright;
  upright.source = recording.source;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    Channel channel{std::string(1, "xyz"[axis]), recording.channels.front().unit, {}};
    for (const Channel& position : recording.channels)
      channel.values.edit().push_back(position.values[axis]);
    upright.channels.push_back(std::move(channel));
  }
  return upright;
}

}  // namespace

bool is_plain_pose_table(const Recording& recording) {
  constexpr std::size_t most_rows = 1000;
  const bool plain = std::ranges::all_of(recording.channels, [](const Channel& channel) {
    return channel.unit.quantity != Quantity::angular_rate;
  });
  return plain && accelerometer_triads(recording).empty() &&
         (is_turned(recording) || (recording.channels.size() == 3 && recording.samples() > 0 &&
                                   recording.samples() <= most_rows));
}

bool looks_like_pose_table(const Recording& recording) {
  constexpr std::size_t most_rows = 1000;
  if (recording.samples() > most_rows) return false;
  if (find_triple(recording, PoseRole::mean)) return true;
  return find_triple(recording, PoseRole::direction) && find_triple(recording, PoseRole::reading);
}

Result<PoseTable> pose_table(const Recording& recording, const std::optional<Unit>& unit) {
  if (const auto means = find_means(recording)) return TableReader(recording, *means).read(unit);
  if (recording.channels.size() == 3 && recording.samples() > 0)
    return TableReader(recording, {{}, {0, 1, 2}}).read(unit);
  if (is_turned(recording)) {
    const Recording upright = turned_upright(recording);
    Result<PoseTable> read = TableReader(upright, {{}, {0, 1, 2}}).read(unit);
    if (!read) return read.error();
    PoseTable table = std::move(read).value();
    table.notes.push_back(
        {Severity::info, fmt::format("the table has three rows and {} columns: each column is a "
                                     "position, the rows are x, y and z",
                                     recording.channels.size())});
    return table;
  }
  return Error{Errc::corrupt,
               "is not a table of means: expected three columns such as x_mean, y_mean, z_mean, or "
               "three columns or three rows in all"};
}

Result<PoseTable> read_pose_table(const std::string& path, const std::optional<Unit>& unit) {
  const auto recording = read_recording(path, {});
  if (!recording) return recording.error();
  auto table = pose_table(*recording, unit);
  if (!table) return table.error().at(path == "-" ? "standard input" : path);
  return table;
}

}  // namespace proofmass::io
