#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "common_flags.hpp"
#include "proofmass/core/recording.hpp"
#include "proofmass/core/units.hpp"
#include "proofmass/io/recording_stream.hpp"
#include "proofmass/report/noise_report.hpp"

// From recordings at rest to the evenly sampled series that the analyses of them take.
namespace proofmass::app {

struct RestOptions {
  std::vector<std::string> files;
  InputFlags input;
  OutputFlags output;
  std::string temperature;             ///< name of the channel that holds it; empty: none is named
  bool find_temperature = false;       ///< where none is named, the only channel with a temperature
  bool for_sensor_file = false;        ///< refuse what a sensor file cannot take (--update-sensor)
  bool rates_for_sensor_file = false;  ///< which may also be a gyroscope's axes
  bool is_phase = false;               ///< the channels hold the integral of the quantity over time
  bool may_drift = false;  ///< rest is looked for beside the drift, once that is known: not here
};

/// One channel, in SI where its unit is known, or why it cannot be analysed.
struct RestChannel {
  std::string name;   ///< as in the file
  std::string title;  ///< the same, behind the file's name where there are several files
  std::string file;
  Unit unit;
  std::string refused;
  std::vector<double> series;  ///< NaN where a sample is missing; empty if refused
  double rate_hz = 0.0;
  std::optional<double> lsb;        ///< step of the converter, in the series' unit
  std::optional<std::size_t> axis;  ///< 0, 1, 2 for x, y, z of the only accelerometer or gyroscope
  /// How much of the recording is at rest; absent where its quantity says nothing of motion.
  std::optional<report::RestShare> rest;
};

/// The temperature beside the channels, on their grid.
struct RestTemperature {
  std::string name;
  Unit unit;  ///< K, or none where it is not known
  std::vector<double> series;
};

/// What is to be analysed of one file.
struct RestRecording {
  std::vector<RestChannel> channels;
  std::optional<RestTemperature> temperature;
  std::optional<std::int64_t> start_ns;  ///< of the first sample on the file's own clock
};

/// How much of each channel is at rest. Channels of one quantity are looked at together, three at a
/// time: a sensor that moves along one axis is not at rest along the others. start_s is the first
/// sample's on the recording's clock.
void find_share_at_rest(double start_s, std::vector<RestChannel>& channels);

/// Opens one of the files, whole or as a stream where it is larger than --memory. Throws Failure,
/// also where there is no time base.
[[nodiscard]] std::variant<Recording, io::RecordingStream> open_rest(const std::string& file,
                                                                     const RestOptions& options);

/// What is to be analysed of a recording, as rest_recordings() says.
[[nodiscard]] RestRecording rest_recording(Recording recording,
                                           const RestOptions& options,
                                           std::vector<Note>& notes);

/// "run1.csv: " where there are several files, else nothing.
[[nodiscard]] std::string file_prefix(const std::string& file, const RestOptions& options);

/// Throws Failure unless a sensor file can take the channel's figures.
void expect_axis(const RestChannel& channel, const RestOptions& options);

/// All files, each with its channels to analyse: without --channel all accelerations, else the
/// voltages or counts that look like axes, else all but a counter. Notes of reading and preparing
/// are added to `notes`. Throws Failure; for a sensor file also unless all is of one recording, of
/// x, y or z of one accelerometer and in m/s^2.
[[nodiscard]] std::vector<RestRecording> rest_recordings(const RestOptions& options,
                                                         std::vector<Note>& notes);

}  // namespace proofmass::app
