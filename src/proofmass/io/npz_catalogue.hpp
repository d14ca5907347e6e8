#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "proofmass/core/result.hpp"
#include "proofmass/io/archive.hpp"
#include "proofmass/io/mat_catalogue.hpp"
#include "proofmass/io/npy_layout.hpp"

namespace proofmass::io {

/// Where an array of an archive is kept.
struct NpzArray {
  std::size_t entry = 0;  ///< of the archive
  NpyPreface preface;
  std::size_t first_column = 0;        ///< of a field of a structured array, among its figures
  std::optional<std::size_t> columns;  ///< of the field; nullopt: the array is not structured
};

/// The arrays of an archive as variables of a MAT file, which the choice of tables is made from.
/// Shapes are as NumPy prints them, one dimension as a column.
struct NpzCatalogue {
  MatCatalogue variables;
  std::vector<NpzArray> places;  ///< one an array
};

/// Reads the headers of all arrays. Those that cannot be read are among the skipped, with the
/// reason.
[[nodiscard]] NpzCatalogue list_npz(Archive& archive);

}  // namespace proofmass::io
