#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "cli/common_flags.hpp"
#include "proofmass/core/recording.hpp"
#include "proofmass/core/units.hpp"
#include "proofmass/io/recording_stream.hpp"
#include "proofmass/report/noise/report.hpp"

// Evenly sampled series from recordings at rest, for the analyses of noise and drift.
namespace proofmass::app {

struct RestOptions {
  std::vector<std::string> files;
  InputFlags input;
  OutputFlags output;
  std::string temperature;             ///< name of the temperature channel; empty: not given
  bool find_temperature = false;       ///< if not given, use the only temperature channel
  bool for_sensor_file = false;        ///< refuse what cannot be stored in a sensor file
                                       ///< (--update-sensor)
  bool rates_for_sensor_file = false;  ///< which may also be a gyroscope's axes
  bool is_phase = false;               ///< the channels are integrals of the quantity over time
  bool leave_rest = false;  ///< the caller determines rest: after drift or beside other work
};

/// One channel, in SI if its unit is known, or the reason for refusal.
struct RestChannel {
  std::string name;   ///< as in the file
  std::string title;  ///< preceded by the file's name if there are several
  std::string file;
  Unit unit;
  std::string refused;
  Samples series;  ///< NaN for missing samples; empty if refused
  double rate_hz = 0.0;
  std::optional<double> lsb;        ///< quantisation step, in the series' unit
  std::optional<std::size_t> axis;  ///< 0, 1, 2 for x, y, z of the only accelerometer or gyroscope
  /// Fraction of the recording at rest; absent if the quantity does not respond to motion.
  std::optional<report::RestShare> rest;
};

/// Temperature on the time grid of the channels.
struct RestTemperature {
  std::string name;
  Unit unit;  ///< K, or none if unknown
  Samples series;
};

/// The channels of one file to be analysed.
struct RestRecording {
  std::vector<RestChannel> channels;
  std::optional<RestTemperature> temperature;
  std::optional<std::int64_t> start_ns;  ///< time of the first sample on the file's clock
};

/// Time of a recording's first sample that is used, on its clock.
[[nodiscard]] double first_used_s(const InputFlags& input);

/// Determines the fraction of each channel at rest. Channels of one quantity of a file are tested
/// together, three at a time: a sensor that moves along one axis is not at rest along the others.
/// start_s: that of first_used_s().
void find_share_at_rest(double start_s, const std::vector<RestChannel*>& channels);
[[nodiscard]] std::vector<RestChannel*> pointers_to(std::vector<RestChannel>& channels);

/// Opens one of the files, whole or as a stream if it is larger than --memory. Throws Failure, also
/// if there is no time base.
[[nodiscard]] std::variant<Recording, io::RecordingStream> open_rest(const std::string& file,
                                                                     const RestOptions& options);

/// The channels of a recording to be analysed, as in rest_recordings().
[[nodiscard]] RestRecording rest_recording(Recording recording,
                                           const RestOptions& options,
                                           std::vector<Note>& notes);

/// "run1.csv: " if there are several files, else empty.
[[nodiscard]] std::string file_prefix(const std::string& file, const RestOptions& options);

/// Throws Failure if the channel's figures cannot be stored in a sensor file.
void expect_axis(const RestChannel& channel, const RestOptions& options);

/// All files, each with its channels to be analysed: without --channel all accelerations, else the
/// voltages or counts that look like axes, else all but a counter. Notes of reading and preparation
/// are added to `notes`. Throws Failure; for a sensor file also unless all channels are x, y or z
/// of one accelerometer in one recording, in m/s^2.
[[nodiscard]] std::vector<RestRecording> rest_recordings(const RestOptions& options,
                                                         std::vector<Note>& notes);

}  // namespace proofmass::app
