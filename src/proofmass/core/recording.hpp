#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "proofmass/core/result.hpp"
#include "proofmass/core/samples.hpp"
#include "proofmass/core/units.hpp"
#include "proofmass/core/view.hpp"

namespace proofmass {

/// Severity of a note. `--strict` fails on `bad`.
enum class Severity { info, warning, bad };

/// A finding of a reader or an audit for the user: one sentence that includes the location.
struct Note {
  Severity severity = Severity::info;
  std::string text;  ///< "Acc_X: 3 values of 3e34 at 12.40 s … 12.43 s (lines 1490 … 1493)"
  std::vector<Advice> advice{};

  /// The same note with outer context, as Error::at; unchanged if `where` is empty.
  [[nodiscard]] Note at(std::string_view where) const {
    return where.empty() ? *this : Note{severity, std::string(where) + ": " + text, advice};
  }
};

/// One column of a recording, in the unit in which it was recorded.
struct Channel {
  std::string name;  ///< as in the file, without its unit: "Acc_X"
  Unit unit;         ///< Quantity::unknown if neither the file nor the user states it
  Samples values;    ///< as recorded, NaN where the file has no number
};

/// Source of the sample times.
enum class TimeSource {
  stamps,      ///< a time column of the file
  counter,     ///< a sample counter with a known rate
  given_rate,  ///< as requested, or a rate in the file's header
  none,        ///< no time information: time is the sample number and rate_hz is 0
};

/// Time of each sample: either uniform, from rate_hz alone, or by stamps.
struct TimeBase {
  TimeSource source = TimeSource::none;
  std::string channel;   ///< name of the source column, empty if none
  double rate_hz = 0.0;  ///< nominal rate: given, or 1 / median stamp interval; 0 if unknown
  std::vector<double>
      stamps_s;  ///< seconds since the first sample; empty where the base is uniform
  /// Time of the first sample on the file's own clock, whose origin may be an epoch, a power-on or
  /// arbitrary. Used to align two recordings of one clock.
  std::optional<std::int64_t> start_ns;
  /// Width of the band about an even grid within which the stamps lie when no row is missing. Set
  /// where a single interval cannot show a missing row (stamps rounded to about one sample period,
  /// rows in bursts); 0 where it can.
  double band_s = 0.0;
  std::size_t mended = 0;            ///< stamps that a reader replaced: not a number, or far off
  std::size_t mended_backwards = 0;  ///< corrected stamps that were below the previous one

  [[nodiscard]] bool is_uniform() const { return stamps_s.empty(); }
  /// Seconds from the first sample to sample k; k itself if no rate is known.
  [[nodiscard]] double at(std::size_t k) const {
    if (!stamps_s.empty()) return stamps_s[k];
    return rate_hz > 0.0 ? static_cast<double>(k) / rate_hz : static_cast<double>(k);
  }
};

/// A run of samples with a name given in the recording: "x_up", "walking".
struct Label {
  std::string text;
  std::size_t first = 0;
  std::size_t last = 0;  ///< last sample, inclusive
  friend bool operator==(const Label&, const Label&) = default;
};

/// A multi-channel recording: channels of equal length on one time base.
struct Recording {
  std::string source;  ///< file name, "-" for standard input, or the name of the generator
  std::string format;  ///< "CSV", "npy", …
  TimeBase time;
  std::vector<Channel> channels;
  std::vector<Note> notes;
  /// Line of the file (1 = first) with sample 0; sample k is on line first_line + k. 0 for formats
  /// without lines, or if lines and samples do not advance together.
  std::size_t first_line = 0;
  /// Runs of one word in a text column, ordered and disjoint; samples without a word are in none.
  std::vector<Label> labels{};
  std::string label_channel{};  ///< name of that column, empty if there is none

  [[nodiscard]] std::size_t samples() const {
    return channels.empty() ? 0 : channels.front().values.size();
  }
  [[nodiscard]] double duration_s() const { return samples() < 2 ? 0.0 : time.at(samples() - 1); }
  /// nullptr if no channel has that name (exact, then ignoring case).
  [[nodiscard]] const Channel* find(std::string_view name) const;
};

/// The samples k with from_s <= time < to_s, with time counted from the first sample kept; labels
/// are cut accordingly.
/// Errors: invalid_argument (from_s not below to_s), too_few_samples (none in the window).
[[nodiscard]] Result<Recording> cut(const Recording& recording, double from_s, double to_s);

/// Up to three accelerometer channels that belong to one sensor, as indices into
/// Recording::channels.
struct Triad {
  std::string name;  ///< common part of the three names: "acc1", "Acc"
  std::optional<std::size_t> x, y, z;
  [[nodiscard]] std::size_t axes() const {
    return std::size_t{x.has_value()} + std::size_t{y.has_value()} + std::size_t{z.has_value()};
  }
};

/// Groups the acceleration channels into sensors by their names: "Acc_X Acc_Y Acc_Z", "x1 y1 x2
/// y2", "ax ay az", "acc1_x …", "Accelerometer X (g)". If there are none, uses the voltages or
/// counts whose names end in an axis. Names belong to one sensor if they differ only in the axis
/// letter. In the order of the file.
[[nodiscard]] std::vector<Triad> accelerometer_triads(const Recording& recording);

}  // namespace proofmass
