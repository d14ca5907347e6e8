#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "proofmass/core/result.hpp"

namespace proofmass::io {

/// How one figure of an .npy file is stored.
struct NpyType {
  char kind = 'f';  ///< f, i, u, b as in NumPy; 0: not a figure, passed over
  std::size_t bytes = 8;
  bool big_endian = false;
};

/// A field of a row: one column, or `count` of them where it is an array itself.
struct NpyField {
  std::string name;
  NpyType type;
  std::size_t count = 1;
};

/// The header of an .npy file.
struct NpyHeader {
  std::vector<NpyField> fields;  ///< one, without a name, unless the array is structured
  bool is_structured = false;
  bool fortran_order = false;
  std::vector<std::size_t> shape;
};

/// Reads the dictionary of the header: {'descr': '<f8', 'fortran_order': False, 'shape': (3, 4)}.
/// Source: NumPy Enhancement Proposal 1, "A simple file format for NumPy arrays".
/// Errors: corrupt (not such a dictionary), unsupported (pickled objects, complex numbers).
[[nodiscard]] Result<NpyHeader> read_npy_header(std::string_view dictionary);

}  // namespace proofmass::io
