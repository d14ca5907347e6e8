#pragma once

#include <string>
#include <vector>

#include "proofmass/io/mat_choice.hpp"
#include "proofmass/io/read_recording.hpp"

namespace proofmass::io {

/// Headings for all columns of the tables of a MAT file, `values` being their columns: vectors are
/// called as in the file, columns of a matrix by their place, with the matrix's name before it
/// where that says something. None where there is but one matrix whose name says nothing.
[[nodiscard]] std::vector<std::string> headings_of(
    const std::vector<MatTable>& tables,
    const std::vector<std::vector<std::vector<double>>>& values,
    const ReadOptions& options);

/// Puts what the structs "names" and "units" of the file say of vectors into their headings.
void tell_headings(const MatCatalogue& catalogue,
                   const std::vector<MatTable>& tables,
                   std::vector<std::string>& headings);

}  // namespace proofmass::io
