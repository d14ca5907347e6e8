#pragma once

#include <string>
#include <vector>

#include "proofmass/io/matlab/mat_choice.hpp"
#include "proofmass/io/read_recording.hpp"

namespace proofmass::io::matlab {

/// Headings for all columns of the tables of a MAT file, `values` being their columns: vectors are
/// named as in the file, columns of a matrix by position, prefixed with the matrix's name if that
/// is informative. Empty if there is only one matrix with an uninformative name.
[[nodiscard]] std::vector<std::string> headings_of(
    const std::vector<Table>& tables,
    const std::vector<std::vector<std::vector<double>>>& values,
    const ReadOptions& options);

/// Applies the structs "names" and "units" of the file to the headings of vectors.
void note_headings(const Catalogue& catalogue,
                   const std::vector<Table>& tables,
                   std::vector<std::string>& headings);

}  // namespace proofmass::io::matlab
