#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "proofmass/core/result.hpp"
#include "proofmass/io/archive/archive.hpp"
#include "proofmass/io/matlab/mat_catalogue.hpp"
#include "proofmass/io/numpy/npy_layout.hpp"

namespace proofmass::io {

/// Location of an array in an archive.
struct NpzArray {
  std::size_t entry = 0;  ///< index in the archive
  NpyPreface preface;
  std::size_t first_column = 0;        ///< position of a structured field among the numeric columns
  std::optional<std::size_t> columns;  ///< width of the field; nullopt: not a structured array
};

/// The arrays of an archive as variables of a MAT file, the input of table selection. Shapes are as
/// printed by NumPy, one dimension as a column.
struct NpzCatalogue {
  matlab::Catalogue variables;
  std::vector<NpzArray> places;  ///< one per array
};

/// Reads the headers of all arrays. Unreadable ones are listed as skipped, with the reason.
[[nodiscard]] NpzCatalogue list_npz(Archive& archive);

}  // namespace proofmass::io
