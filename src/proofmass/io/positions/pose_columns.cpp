#include "proofmass/io/positions/pose_columns.hpp"

#include <algorithm>
#include <vector>

#include "proofmass/io/names.hpp"

namespace proofmass::io {
namespace {

/// The runs of letters and of digits in a name, in lower case.
std::vector<std::string> words_of(std::string_view name) {
  std::vector<std::string> words;
  char before = ' ';
  for (const char c : lower(name)) {
    const bool is_digit = c >= '0' && c <= '9';
    const bool goes_on =
        is_lower_letter(c) ? is_lower_letter(before) : before >= '0' && before <= '9';
    if ((is_lower_letter(c) || is_digit) && !goes_on) words.emplace_back();
    if (is_lower_letter(c) || is_digit) words.back() += c;
    before = c;
  }
  return words;
}

/// Information in the words of a name besides axis and sensor.
struct Said {
  bool mean = false;
  bool std = false;
  bool error = false;
  bool direction = false;
  bool other_sensor = false;

  /// False if the word contains no such information.
  bool hear(std::string_view word) {
    bool& flag = flag_of(word);
    flag = true;
    return &flag != &nothing_;
  }

  [[nodiscard]] PoseRole role() const {
    if (error || (mean && std)) return PoseRole::std_of_mean;
    if (std) return PoseRole::std_of_samples;
    if (direction) return PoseRole::direction;
    return mean ? PoseRole::mean : PoseRole::reading;
  }

 private:
  bool& flag_of(std::string_view word) {
    if (is_any_of(word, {"mean", "means", "avg", "average"})) return mean;
    if (is_any_of(word, {"std", "sd", "stdev", "stddev", "sigma", "standard", "deviation"}))
      return std;
    // An error alone is a residual; a standard error is that of a mean.
    if (is_any_of(word, {"sem", "se", "stderr"}) || (std && is_any_of(word, {"err", "error"})))
      return error;
    if (is_any_of(word, {"true", "up", "ref", "reference", "dir", "direction", "nominal"}))
      return direction;
    if (is_any_of(word, {"gyr", "gyro", "gyroscope", "omega", "w", "rate", "mag", "magn",
                         "magnetometer", "residual", "err", "error"}))
      return other_sensor;
    return nothing_;
  }

  bool nothing_ = false;
};

/// The short forms before an axis letter: "ax", "accy", "fz"; nullopt if the word is not an axis.
std::optional<std::string_view> stem_of_axis(std::string_view word) {
  if (word.back() < 'x' || word.back() > 'z') return std::nullopt;
  const std::string_view stem = word.substr(0, word.size() - 1);
  if (!is_any_of(stem, {"", "a", "acc", "accel", "f", "gf"})) return std::nullopt;
  return stem;
}

bool may_be_reading(const Unit& unit) {
  return unit.quantity == Quantity::unknown || unit.quantity == Quantity::acceleration ||
         unit.quantity == Quantity::voltage || unit.quantity == Quantity::counts;
}

}  // namespace

std::optional<PoseColumn> read_pose_column(std::string_view name) {
  PoseColumn column;
  Said said;
  int axes = 0;
  for (const std::string& word : words_of(name)) {
    if (const auto stem = stem_of_axis(word)) {
      ++axes;
      column.axis = static_cast<std::size_t>(word.back() - 'x');
      column.sensor += *stem;
    } else if (!said.hear(word)) {
      column.sensor += word;
    }
  }
  if (axes != 1 || said.other_sensor) return std::nullopt;
  column.role = said.role();
  return column;
}

std::optional<PoseTriple> find_triple(const Recording& recording,
                                      PoseRole role,
                                      std::string_view sensor) {
  struct Found {
    std::string sensor;
    std::array<std::optional<std::size_t>, 3> columns;
  };
  std::vector<Found> all;
  for (std::size_t c = 0; c < recording.channels.size(); ++c) {
    const auto column = read_pose_column(recording.channels[c].name);
    if (!column || column->role != role || !may_be_reading(recording.channels[c].unit)) continue;
    auto at = std::ranges::find(all, column->sensor, &Found::sensor);
    if (at == all.end()) at = all.insert(all.end(), {column->sensor, {}});
    if (!at->columns[column->axis]) at->columns[column->axis] = c;
  }
  std::erase_if(all, [](const Found& found) {
    return std::ranges::any_of(found.columns, [](const auto& c) { return !c.has_value(); });
  });
  if (all.empty()) return std::nullopt;
  auto best = std::ranges::find(all, sensor, &Found::sensor);
  if (best == all.end()) best = all.begin();
  return PoseTriple{best->sensor, {*best->columns[0], *best->columns[1], *best->columns[2]}};
}

std::optional<PoseTriple> find_means(const Recording& recording) {
  const auto means = find_triple(recording, PoseRole::mean);
  return means ? means : find_triple(recording, PoseRole::reading);
}

}  // namespace proofmass::io
