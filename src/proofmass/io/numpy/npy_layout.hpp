#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "proofmass/core/result.hpp"
#include "proofmass/io/arrays/figure_type.hpp"
#include "proofmass/io/bytes/byte_source.hpp"
#include "proofmass/io/numpy/npy_header.hpp"

namespace proofmass::io {

/// One numeric column in a row of bytes.
struct NpyColumn {
  FigureType type;
  std::size_t offset = 0;  ///< within the row
  std::string name;        ///< name of a structured array's field; else empty
};

/// Layout of an array in its file, as a table.
struct NpyLayout {
  std::vector<NpyColumn> columns;  ///< the numeric ones
  std::size_t rows = 0;
  std::size_t row_bytes = 0;  ///< size of all columns, including skipped ones
  std::uint64_t begin = 0;    ///< file offset of the values
  bool by_column = false;     ///< column-major
  bool is_structured = false;
  bool is_turned = false;  ///< was channels × samples

  [[nodiscard]] std::uint64_t figure_bytes() const { return std::uint64_t{rows} * row_bytes; }
};

/// The header of an .npy file, and the offset of the values.
struct NpyPreface {
  NpyHeader header;
  std::size_t bytes = 0;
};

/// Inspects the beginning of an .npy file without consuming it. Errors: corrupt, unsupported.
[[nodiscard]] Result<NpyPreface> peek_npy_preface(PeekSource& source);

/// The array as a table: fields of a structured array are columns; else samples run along the first
/// dimension, or the last if `is_turned`, and all other dimensions form the columns.
/// Errors: corrupt (larger than any file, too many columns), too_few_samples (empty).
[[nodiscard]] Result<NpyLayout> npy_layout(const NpyPreface& preface, bool is_turned);

}  // namespace proofmass::io
