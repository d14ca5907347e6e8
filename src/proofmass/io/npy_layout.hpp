#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "proofmass/core/result.hpp"
#include "proofmass/io/byte_source.hpp"
#include "proofmass/io/figure_type.hpp"
#include "proofmass/io/npy_header.hpp"

namespace proofmass::io {

/// One column of figures in a row of bytes.
struct NpyColumn {
  FigureType type;
  std::size_t offset = 0;  ///< within the row
  std::string name;        ///< of a structured array's field; else empty
};

/// How an array lies in its file, as a table.
struct NpyLayout {
  std::vector<NpyColumn> columns;  ///< those that are figures
  std::size_t rows = 0;
  std::size_t row_bytes = 0;  ///< of all columns, the passed over included
  std::uint64_t begin = 0;    ///< byte at which the figures begin
  bool by_column = false;     ///< whole columns one after another
  bool is_structured = false;
  bool is_turned = false;  ///< was channels × samples

  [[nodiscard]] std::uint64_t figure_bytes() const { return std::uint64_t{rows} * row_bytes; }
};

/// The header of an .npy file, and where the figures begin.
struct NpyPreface {
  NpyHeader header;
  std::size_t bytes = 0;
};

/// Looks at the front of an .npy file; nothing is taken. Errors: corrupt, unsupported.
[[nodiscard]] Result<NpyPreface> peek_npy_preface(PeekSource& source);

/// The array as a table: fields of a structured array are columns; else samples run along the
/// first dimension, or the last if `is_turned`, and all other dimensions make the columns.
/// Errors: corrupt (more than any file can hold, too many columns), too_few_samples (empty).
[[nodiscard]] Result<NpyLayout> npy_layout(const NpyPreface& preface, bool is_turned);

}  // namespace proofmass::io
