#pragma once

#include <cstddef>
#include <vector>

#include "tumble/columns.hpp"
#include "tumble/positions.hpp"

// A table with one row for each position.
namespace proofmass::app {

/// The part of the test in one file.
struct TumblePart {
  TumbleReadings readings;
  std::size_t rests = 0;  ///< number of rests detected in a recording
};

/// The output in a column, without its values: SI if its unit, or --unit, is known.
[[nodiscard]] TumbleOutput make_output(const Recording& recording,
                                       std::size_t column,
                                       const InputFlags& flags);

/// Factor that converts the column's values to the unit of make_output().
[[nodiscard]] double to_si(const Channel& channel, const InputFlags& flags);

/// Rows without angle or output are omitted, with a note. Throws Failure.
[[nodiscard]] TumblePart read_table(const Recording& recording,
                                    const TumbleColumns& columns,
                                    const InputFlags& flags,
                                    std::vector<Note>& notes);

}  // namespace proofmass::app
