#pragma once

#include <vector>

#include "proofmass/core/recording.hpp"
#include "proofmass/core/result.hpp"
#include "proofmass/io/hdf5_catalogue.hpp"
#include "proofmass/io/mat_choice.hpp"
#include "proofmass/io/read_recording.hpp"

namespace proofmass::io {

/// The datasets as arrays of a MAT file, which the choice of tables is made from. The fastest
/// dimension comes first, as there: is_turned of a table then means that whole samples lie
/// together. `catalogue` must outlive them.
[[nodiscard]] std::vector<MatArray> arrays_of(const Hdf5Catalogue& catalogue);

/// "imu/acc (5000 x 3 float64)", as the file counts dimensions.
[[nodiscard]] std::string description(const Hdf5Dataset& dataset);

/// The datasets that make the recording.
struct Hdf5Choice {
  std::vector<MatTable> tables;  ///< equally long, in the order of the file
  std::vector<Note> notes;       ///< what was chosen and why, and what else there is
};

/// Chooses the datasets of one length: the group with the most figures in tables of one length,
/// those with "acc" in a name before others; with it what has that length in the groups around and
/// below it, but for groups with a time of their own. Or what the user names: datasets and groups,
/// with the time beside them.
/// `arrays` are arrays_of(catalogue) and must outlive the choice.
/// Errors: too_few_samples (no table), invalid_argument (no dataset of a name asked for; tables of
/// different length).
[[nodiscard]] Result<Hdf5Choice> choose_datasets(const Hdf5Catalogue& catalogue,
                                                 const std::vector<MatArray>& arrays,
                                                 const ReadOptions& options);

}  // namespace proofmass::io
