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

// Recordings from the input flags.
namespace proofmass::app {

/// Like load(), with even times where the stamps do not show single intervals
/// (signal::with_even_stamps()) or a computer was busy (signal::without_late_stamps()): for
/// estimates of motion.
[[nodiscard]] Recording load_even(const std::string& file,
                                  const InputFlags& flags,
                                  const Progress& progress);

/// Without the samples whose time does not increase (reported in a note).
[[nodiscard]] Recording with_rising_time(const Recording& whole);

/// Like load_even(), without samples whose time does not increase (reported in a note).
[[nodiscard]] Recording load_rising(const std::string& file,
                                    const InputFlags& flags,
                                    const Progress& progress);

/// Reads a recording according to the flags, cut to --from and --to, without rows that a logger
/// wrote twice (without_repeated_rows()). Throws Failure.
[[nodiscard]] Recording load(const std::string& file,
                             const InputFlags& flags,
                             const Progress& progress);

/// The host's recording of this name, processed according to the flags; nullopt if none. Throws
/// Failure.
[[nodiscard]] std::optional<Recording> given_recording(const std::string& file,
                                                       const InputFlags& flags);

/// Options for the readers.
[[nodiscard]] io::ReadOptions read_options(const InputFlags& flags, const Progress& progress);

/// Path in PROOFMASS_DUCKDB_LIB, the library that reads and writes Parquet; empty if not set.
[[nodiscard]] std::string duckdb_library();

/// The samples between --from and --to. Throws Failure.
[[nodiscard]] Recording cut_to_window(Recording recording, const InputFlags& flags);

using sensor::Accelerometer;

/// sensor::accelerometers() that throws Failure.
[[nodiscard]] std::vector<Accelerometer> accelerometers(const std::vector<Recording>& recordings);

/// The sensor files of --sensor, with the supply replaced by --supply. Their notes are added to
/// `notes`. Throws Failure, also if --supply is given and no sensor is ratiometric.
[[nodiscard]] std::vector<sensor::SensorModel> load_sensors(const InputFlags& flags,
                                                            std::vector<Note>& notes);

/// sensor::apply() to accelerometers; throws Failure.
void calibrate(const std::vector<sensor::SensorModel>& models,
               const std::vector<Accelerometer>& found,
               std::vector<Recording>& recordings);

/// Samples in blocks, from the channels of --channel, calibrated by --sensor. The sensor files'
/// notes are added to `notes`. Throws Failure: no accelerometer, an unknown unit, a sensor file for
/// another unit.
[[nodiscard]] sensor::CalibratedBlocks calibrated_blocks(const InputFlags& flags,
                                                         const Recording& head,
                                                         std::vector<Note>& notes);

/// Time between power-on and the first sample kept, if --since-switch-on states it for the first
/// sample of the file.
[[nodiscard]] std::optional<double> on_at_start_s(const InputFlags& flags);

/// Subtracts the warm-up of the sensor files from the calibrated accelerometers if
/// --since-switch-on is given; otherwise a note suggests it. Throws Failure if the flag is given
/// and no sensor file has a warm-up.
void remove_warm_up(const InputFlags& flags,
                    const std::vector<sensor::SensorModel>& models,
                    const std::vector<Accelerometer>& found,
                    std::vector<Recording>& recordings,
                    std::vector<Note>& notes);

/// Local gravity: from --gravity, from --latitude and --height, or the standard value.
[[nodiscard]] double gravity_mps2(const InputFlags& flags);

/// The same with its standard deviation: std_mps2 if given; else 0 for --gravity, that of gravity
/// anomalies for a latitude, and that of all places on Earth if the location is unknown, with a
/// note.
[[nodiscard]] Uncertain uncertain_gravity_mps2(const InputFlags& flags,
                                               const std::optional<double>& std_mps2,
                                               std::vector<Note>& notes);

/// "x", "-z", "0,0.1,1" as a vector. Throws Failure (usage).
[[nodiscard]] std::array<double, 3> parse_axis(const std::string& text);

}  // namespace proofmass::app
