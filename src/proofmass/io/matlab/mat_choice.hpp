#pragma once

#include <cstddef>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "proofmass/core/recording.hpp"
#include "proofmass/core/result.hpp"
#include "proofmass/io/matlab/mat_catalogue.hpp"
#include "proofmass/io/read_recording.hpp"

namespace proofmass::io::matlab {

/// An array interpreted as a table of samples.
struct Table {
  const Array* array = nullptr;
  std::size_t rows = 0;
  std::size_t width = 0;
  bool is_turned = false;  ///< was channels × samples

  [[nodiscard]] std::size_t figures() const { return rows * width; }
  /// The last part of the array's path: "acc" of "imu.acc".
  [[nodiscard]] std::string name() const;
};

/// Kind of a table according to its name, least preferred first: other kinds are angular rates,
/// quaternions, angles, fields, positions and the like.
enum class TableKind : unsigned char { other, unknown, acceleration };
[[nodiscard]] TableKind kind_of(const Table& table);

/// True if the table may be selected by default: long enough relative to the longest of the file to
/// be its samples. A calibration matrix is not.
[[nodiscard]] bool may_be_samples(const Table& table, std::size_t longest);

/// True if one of the requested channels belongs to a table: it has the table's name, optionally
/// with a suffix: "gyr", "gyr_x", "gyr 2".
[[nodiscard]] bool is_asked_for(const Table& table, const ReadOptions& options);

/// The arrays of the tables with the requested channels; none if a channel is in no table, or the
/// tables differ in length.
[[nodiscard]] std::set<const Array*> arrays_asked_for(const std::vector<Table>& tables,
                                                      const ReadOptions& options);

/// Maximum number of channels of one instrument.
inline constexpr std::size_t most_channels = 64;

/// Time runs along the longer of the first and the last dimension; nullopt if that is shorter than
/// 2, or the others give more than 64 channels or more channels than samples.
[[nodiscard]] std::optional<Table> table_of(const Array& array);

/// True if a scalar of that name is a sample rate in Hz: "fs", "SamplingRate".
[[nodiscard]] bool is_rate_name(std::string_view name);
/// True if the rate is plausible for an instrument.
[[nodiscard]] bool is_rate(double rate_hz);

/// The tables whose array was selected, in their order.
/// Errors: invalid_argument if they differ in length.
[[nodiscard]] Result<std::vector<Table>> chosen_tables(const std::vector<Table>& tables,
                                                       const std::set<const Array*>& chosen);

/// The arrays that form the recording.
struct Choice {
  std::vector<Table> tables;     ///< of equal length, in the order of the file
  const Array* rate = nullptr;   ///< a scalar named "fs" or similar
  const Array* start = nullptr;  ///< an int64 named "start_ns": the clock's time at time 0
  std::vector<Note> notes;       ///< the selection and the alternatives
};

/// Selects the largest table, with the vectors of its length beside it; or those named by the user:
/// an array with the time beside it, or a struct, of which the largest table. `catalogue` must
/// outlive the choice.
/// Errors: too_few_samples (no table), invalid_argument (no variable of a requested name; tables of
/// different length).
[[nodiscard]] Result<Choice> choose_tables(const Catalogue& catalogue, const ReadOptions& options);

}  // namespace proofmass::io::matlab
