#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "proofmass/core/result.hpp"
#include "proofmass/io/figure_type.hpp"
#include "proofmass/io/mat_stream.hpp"

namespace proofmass::io {

/// An array of numbers in a MAT file, and where they lie.
struct MatArray {
  std::string path;                ///< "acc", "imu.acc", "runs(2).acc", "parts{3}"
  std::size_t group_length = 0;    ///< of the path up to the struct or cell it is in: "imu"
  std::string_view class_name;     ///< "double", "uint8", "logical", …
  std::vector<std::size_t> shape;  ///< column-major; two at least
  bool is_complex = false;
  MatRegion region;         ///< the variable it is part of
  std::uint64_t begin = 0;  ///< of the (real) figures, in the variable's stream
  FigureType stored;        ///< which may be narrower than the class

  [[nodiscard]] std::string_view group() const {
    return std::string_view(path).substr(0, group_length);
  }
  /// "51175 x 4 double"
  [[nodiscard]] std::string description() const;
};

/// A short text in a struct that says something about other variables: "units.acc_x" or
/// "names.acc_x".
struct MatText {
  std::string path;
  std::string text;  ///< UTF-8
};

/// What is in a MAT file.
struct MatCatalogue {
  std::string_view version;          ///< "MAT v5"
  std::vector<MatArray> arrays;      ///< in the order of the file
  std::vector<MatText> texts;        ///< those of the structs "names" and "units"
  std::vector<std::string> skipped;  ///< "title (text)", "f (function handle)"
  bool is_cut = false;               ///< there is more than is listed
};

/// More arrays than anybody tells apart: what is beyond is not listed.
inline constexpr std::size_t most_mat_arrays = 4096;

/// "acc", printable ASCII, whatever bytes the file gives for a name.
[[nodiscard]] std::string mat_name(std::string_view bytes);

/// Whether the first bytes are those of a MAT file of version 4: it has no magic, but a header
/// which text cannot be.
[[nodiscard]] bool is_mat4(std::string_view head);
/// Whether they are those of version 5, which MATLAB writes as 6 and 7 too; 7.3 is HDF5.
[[nodiscard]] bool is_mat5(std::string_view head);

/// Lists what is in a file, without reading the figures.
/// Source: The MathWorks, "MAT-File Format" (2019), chapter 1 (version 5) and 2 (version 4).
/// Errors: corrupt (naming the byte), unsupported (version 4 of a VAX or Cray).
[[nodiscard]] Result<MatCatalogue> list_mat4(std::string_view file);
[[nodiscard]] Result<MatCatalogue> list_mat5(std::string_view file);

}  // namespace proofmass::io
