#pragma once

#include <cstddef>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "proofmass/core/recording.hpp"
#include "proofmass/core/result.hpp"
#include "proofmass/io/mat_catalogue.hpp"
#include "proofmass/io/read_recording.hpp"

namespace proofmass::io {

/// An array as a table of samples.
struct MatTable {
  const MatArray* array = nullptr;
  std::size_t rows = 0;
  std::size_t width = 0;
  bool is_turned = false;  ///< was channels × samples

  [[nodiscard]] std::size_t figures() const { return rows * width; }
  /// The last part of the array's path: "acc" of "imu.acc".
  [[nodiscard]] std::string name() const;
};

/// What a table is by its name, most wanted first: other kinds are angular rates, quaternions,
/// angles, fields, positions and the like.
enum class TableKind : unsigned char { other, unknown, acceleration };
[[nodiscard]] TableKind kind_of(const MatTable& table);

/// Whether a table may be the one that is meant where none is named: long enough beside the longest
/// of the file to be its samples. A matrix of calibration is not.
[[nodiscard]] bool may_be_samples(const MatTable& table, std::size_t longest);

/// Whether one of the channels asked for is a table's: it has the table's name, or that and an
/// ending: "gyr", "gyr_x", "gyr 2".
[[nodiscard]] bool is_asked_for(const MatTable& table, const ReadOptions& options);

/// The arrays of the tables that the channels asked for are of; none where a channel is of no
/// table, or the tables are not equally long.
[[nodiscard]] std::set<const MatArray*> arrays_asked_for(const std::vector<MatTable>& tables,
                                                         const ReadOptions& options);

/// More columns than that are no channels of one instrument.
inline constexpr std::size_t most_mat_channels = 64;

/// Time runs along the longer of the first and the last dimension; nullopt where that is shorter
/// than 2, or the others make more than 64 channels or more channels than samples.
[[nodiscard]] std::optional<MatTable> table_of(const MatArray& array);

/// Whether a single number of that name is a sample rate in Hz: "fs", "SamplingRate".
[[nodiscard]] bool is_rate_name(std::string_view name);
/// Whether an instrument may have it.
[[nodiscard]] bool is_rate(double rate_hz);

/// Those of the tables whose array was chosen, in their order.
/// Errors: invalid_argument where they are not equally long.
[[nodiscard]] Result<std::vector<MatTable>> chosen_tables(const std::vector<MatTable>& tables,
                                                          const std::set<const MatArray*>& chosen);

/// The arrays that make the recording.
struct MatChoice {
  std::vector<MatTable> tables;     ///< equally long, in the order of the file
  const MatArray* rate = nullptr;   ///< a single number called "fs" and the like
  const MatArray* start = nullptr;  ///< an int64 called "start_ns": the clock's time at time 0
  std::vector<Note> notes;          ///< what was chosen, and what else there is
};

/// Chooses the largest table, with the vectors of its length that stand beside it; or what the user
/// names: an array, with the time that stands beside it, or a struct, of which the largest.
/// `catalogue` must outlive the choice.
/// Errors: too_few_samples (no table), invalid_argument (no variable of a name asked for; tables of
/// different length).
[[nodiscard]] Result<MatChoice> choose_tables(const MatCatalogue& catalogue,
                                              const ReadOptions& options);

}  // namespace proofmass::io
