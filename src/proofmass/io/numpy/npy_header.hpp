#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "proofmass/core/result.hpp"
#include "proofmass/io/arrays/figure_type.hpp"

namespace proofmass::io {

/// A field of a row: one column, or `count` of them if it is an array itself.
struct NpyField {
  std::string name;
  FigureType type;
  std::size_t count = 1;
};

/// The header of an .npy file.
struct NpyHeader {
  std::vector<NpyField> fields;  ///< a single unnamed one, unless the array is structured
  bool is_structured = false;
  bool fortran_order = false;
  std::vector<std::size_t> shape;
};

/// Reads the dictionary of the header: {'descr': '<f8', 'fortran_order': False, 'shape': (3, 4)}.
/// Source: NumPy Enhancement Proposal 1, "A simple file format for NumPy arrays".
/// Errors: corrupt (not such a dictionary), unsupported (pickled objects, complex numbers).
[[nodiscard]] Result<NpyHeader> read_npy_header(std::string_view dictionary);

}  // namespace proofmass::io
