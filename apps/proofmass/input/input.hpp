#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "cli/common_flags.hpp"
#include "proofmass/core/progress.hpp"
#include "proofmass/core/quantity.hpp"
#include "proofmass/core/recording.hpp"
#include "proofmass/io/read_recording.hpp"
#include "proofmass/sensor/calibrated_channels.hpp"
#include "proofmass/sensor/sensor_file.hpp"

// From the input flags to recordings.
namespace proofmass::app {

/// As load(), without samples whose time does not rise (a note says so): for estimates of motion.
[[nodiscard]] Recording load_rising(const std::string& file,
                                    const InputFlags& flags,
                                    const Progress& progress);

/// Reads a recording as the flags say, cut to --from and --to. Throws Failure.
[[nodiscard]] Recording load(const std::string& file,
                             const InputFlags& flags,
                             const Progress& progress);

/// The recording that the host gives for a file of this name, as the flags say; or none. Throws
/// Failure.
[[nodiscard]] std::optional<Recording> given_recording(const std::string& file,
                                                       const InputFlags& flags);

/// What the flags say to the readers.
[[nodiscard]] io::ReadOptions read_options(const InputFlags& flags, const Progress& progress);

/// Of PROOFMASS_DUCKDB_LIB, which Parquet is read and written with; empty if it is not set.
[[nodiscard]] std::string duckdb_library();

/// What --from and --to leave. Throws Failure.
[[nodiscard]] Recording cut_to_window(Recording recording, const InputFlags& flags);

using sensor::Accelerometer;

/// sensor::accelerometers(), or Failure.
[[nodiscard]] std::vector<Accelerometer> accelerometers(const std::vector<Recording>& recordings);

/// The sensor files of --sensor, with the supply of --supply in place of their own. Their notes are
/// added to `notes`. Throws Failure, also where --supply is given and no sensor is ratiometric.
[[nodiscard]] std::vector<sensor::SensorModel> load_sensors(const InputFlags& flags,
                                                            std::vector<Note>& notes);

/// sensor::apply() to accelerometers, or Failure.
void calibrate(const std::vector<sensor::SensorModel>& models,
               const std::vector<Accelerometer>& found,
               std::vector<Recording>& recordings);

/// Samples that come a block at a time, of the channels that --channel leaves, calibrated by
/// --sensor. The sensor files' notes are added to `notes`. Throws Failure: no accelerometer, a unit
/// that is not known, a sensor file for another unit.
[[nodiscard]] sensor::CalibratedBlocks calibrated_blocks(const InputFlags& flags,
                                                         const Recording& head,
                                                         std::vector<Note>& notes);

/// How long the sensors had been on at the first sample that is kept, where --since-switch-on says
/// so of the first in the file.
[[nodiscard]] std::optional<double> on_at_start_s(const InputFlags& flags);

/// Takes the warm-up that the sensor files know of out of the calibrated accelerometers, where
/// --since-switch-on says how long they had been on; where it does not, a note says what it is for.
/// Throws Failure where the flag is given and no sensor file has a warm-up.
void remove_warm_up(const InputFlags& flags,
                    const std::vector<sensor::SensorModel>& models,
                    const std::vector<Accelerometer>& found,
                    std::vector<Recording>& recordings,
                    std::vector<Note>& notes);

/// Local gravity: --gravity, or by --latitude and --height, or the standard one.
[[nodiscard]] double gravity_mps2(const InputFlags& flags);

/// The same with its standard deviation: std_mps2 if given, else 0 of --gravity, that of gravity
/// anomalies by latitude, and where nobody says where it was, that of all places on Earth, which a
/// note says.
[[nodiscard]] Uncertain uncertain_gravity_mps2(const InputFlags& flags,
                                               const std::optional<double>& std_mps2,
                                               std::vector<Note>& notes);

/// "x", "-z", "0,0.1,1" as a vector. Throws Failure (usage).
[[nodiscard]] std::array<double, 3> parse_axis(const std::string& text);

}  // namespace proofmass::app
