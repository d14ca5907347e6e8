#pragma once

#include <vector>

#include "proofmass/core/recording.hpp"
#include "proofmass/core/result.hpp"
#include "proofmass/io/hdf5/catalogue.hpp"
#include "proofmass/io/matlab/mat_choice.hpp"
#include "proofmass/io/read_recording.hpp"

namespace proofmass::io::hdf5 {

/// The datasets as arrays of a MAT file, the input of table selection. The fastest dimension comes
/// first, as there: is_turned of a table then means that whole samples are contiguous. `catalogue`
/// must outlive them.
[[nodiscard]] std::vector<matlab::Array> arrays_of(const Catalogue& catalogue);

/// "imu/acc (5000 x 3 float64)", dimensions in the order of the file.
[[nodiscard]] std::string description(const Dataset& dataset);

/// The datasets that form the recording.
struct Choice {
  std::vector<matlab::Table> tables;  ///< of equal length, in the order of the file
  std::vector<Note> notes;            ///< the selection, its reason, and the alternatives
};

/// Selects datasets of one length.
///
/// - By default the group with the most values in tables of one length, preferring "acc" in a name;
///   with it the datasets of that length in the groups around and below it, except groups with
///   their own time.
/// - Otherwise the datasets and groups named by the user, with the time beside them.
///
/// `arrays` are arrays_of(catalogue) and must outlive the choice.
/// Errors: too_few_samples (no table), invalid_argument (no dataset of a requested name; tables of
/// different length).
[[nodiscard]] Result<Choice> choose_datasets(const Catalogue& catalogue,
                                             const std::vector<matlab::Array>& arrays,
                                             const ReadOptions& options);

}  // namespace proofmass::io::hdf5
