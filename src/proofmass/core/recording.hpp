#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "proofmass/core/result.hpp"
#include "proofmass/core/units.hpp"
#include "proofmass/core/view.hpp"

namespace proofmass {

/// How grave a note is. The exit status of `--strict` hangs on `bad`.
enum class Severity { info, warning, bad };

/// Something a reader or an audit has seen and a person should know: one sentence, with its place.
struct Note {
  Severity severity = Severity::info;
  std::string text;  ///< "Acc_X: 3 values of 3e34 at 12.40 s … 12.43 s (lines 1490 … 1493)"
};

/// One column of a recording, in the unit in which it was recorded.
struct Channel {
  std::string name;            ///< as in the file, less its unit: "Acc_X"
  Unit unit;                   ///< Quantity::unknown where neither file nor user says
  std::vector<double> values;  ///< as recorded, NaN where the file has no number
};

/// Where the time of the samples comes from.
enum class TimeSource {
  stamps,      ///< a time column of the file
  counter,     ///< a sample counter with a known rate
  given_rate,  ///< --rate, or a rate in the file's header
  none,        ///< nothing says: time is the sample's number and rate_hz is 0
};

/// When each sample was taken: either evenly, from rate_hz alone, or by stamps.
struct TimeBase {
  TimeSource source = TimeSource::none;
  std::string channel;   ///< name of the column behind it, empty if none
  double rate_hz = 0.0;  ///< nominal rate: given, or 1 / median step of the stamps; 0 unknown
  std::vector<double>
      stamps_s;  ///< seconds since the first sample; empty where the base is uniform
  /// The first sample's time on the file's own clock (its origin may be an epoch, a power-up or
  /// nothing at all): what two recordings of one clock are laid beside each other with.
  std::optional<std::int64_t> start_ns;
  /// Where single steps do not say whether a row is missing (stamps rounded to about a step of the
  /// samples, rows in bursts): the width of the band about evenly spaced instants that the stamps
  /// lie in while none is. 0 where they do.
  double band_s = 0.0;
  std::size_t mended = 0;            ///< stamps that a reader replaced, being no number or far off
  std::size_t mended_backwards = 0;  ///< stamps below the one before that no longer are

  [[nodiscard]] bool is_uniform() const { return stamps_s.empty(); }
  /// Seconds from the first sample to sample k; k itself where no rate is known.
  [[nodiscard]] double at(std::size_t k) const {
    if (!stamps_s.empty()) return stamps_s[k];
    return rate_hz > 0.0 ? static_cast<double>(k) / rate_hz : static_cast<double>(k);
  }
};

/// A run of samples that whoever recorded them gave one name: "x_up", "walking".
struct Label {
  std::string text;
  std::size_t first = 0;
  std::size_t last = 0;  ///< sample; it belongs to the run
  friend bool operator==(const Label&, const Label&) = default;
};

/// What an instrument wrote down: equally long channels on one time base.
struct Recording {
  std::string source;  ///< file name, "-" for standard input, or what made it
  std::string format;  ///< "CSV", "npy", …
  TimeBase time;
  std::vector<Channel> channels;
  std::vector<Note> notes;
  /// Line of the file (1 = first) on which sample 0 stands, and that of each later sample where
  /// lines and samples do not run in step; 0 for formats without lines.
  std::size_t first_line = 0;
  /// Runs of one word in a column of words, in order and apart; samples without a word are in none.
  std::vector<Label> labels{};
  std::string label_channel{};  ///< name of that column, empty where there is none

  [[nodiscard]] std::size_t samples() const {
    return channels.empty() ? 0 : channels.front().values.size();
  }
  [[nodiscard]] double duration_s() const { return samples() < 2 ? 0.0 : time.at(samples() - 1); }
  /// nullptr if there is none of that name (exact, then ignoring case).
  [[nodiscard]] const Channel* find(std::string_view name) const;
};

/// The samples k with from_s <= time < to_s, with their time counted from the first that is kept;
/// labels are cut with them.
/// Errors: invalid_argument (from_s not below to_s), too_few_samples (none in the window).
[[nodiscard]] Result<Recording> cut(const Recording& recording, double from_s, double to_s);

/// Up to three accelerometer channels that belong to one sensor, as indices into
/// Recording::channels.
struct Triad {
  std::string name;  ///< what the three names share: "acc1", "Acc"
  std::optional<std::size_t> x, y, z;
  [[nodiscard]] std::size_t axes() const {
    return std::size_t{x.has_value()} + std::size_t{y.has_value()} + std::size_t{z.has_value()};
  }
};

/// Sorts the acceleration channels (and, where there are none, the voltages or counts whose names
/// end in an axis) into sensors by their names: "Acc_X Acc_Y Acc_Z", "x1 y1 x2 y2", "ax ay az",
/// "acc1_x …", "Accelerometer X (g)". A name is one sensor's if it is the same but for the axis
/// letter. In the order of the file.
[[nodiscard]] std::vector<Triad> accelerometer_triads(const Recording& recording);

}  // namespace proofmass
