#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "proofmass/core/result.hpp"
#include "proofmass/io/arrays/figure_type.hpp"
#include "proofmass/io/matlab/mat_stream.hpp"

namespace proofmass::io::matlab {

/// A numeric array in a MAT file, and its location.
struct Array {
  std::string path;                ///< "acc", "imu.acc", "runs(2).acc", "parts{3}"
  std::size_t group_length = 0;    ///< length of the path of its struct or cell: "imu"
  std::string_view class_name;     ///< "double", "uint8", "logical", …
  std::vector<std::size_t> shape;  ///< column-major; at least two
  bool is_complex = false;
  Region region;            ///< the variable that contains it
  std::uint64_t begin = 0;  ///< offset of the (real) values in the variable's stream
  FigureType stored;        ///< may be narrower than the class

  [[nodiscard]] std::string_view group() const {
    return std::string_view(path).substr(0, group_length);
  }
  /// "51175 x 4 double"
  [[nodiscard]] std::string description() const;
};

/// A short text in a struct that describes other variables: "units.acc_x" or "names.acc_x".
struct Text {
  std::string path;
  std::string text;  ///< UTF-8
};

/// Contents of a MAT file.
struct Catalogue {
  std::string_view version;          ///< "MAT v5"
  std::vector<Array> arrays;         ///< in the order of the file
  std::vector<Text> texts;           ///< in the structs "names" and "units"
  std::vector<std::string> skipped;  ///< "title (text)", "f (function handle)"
  bool is_cut = false;               ///< the list is incomplete
};

/// Maximum number of listed arrays; a user would not distinguish more.
inline constexpr std::size_t most_arrays = 4096;

/// "acc", printable ASCII, whatever bytes the file has for a name.
[[nodiscard]] std::string name_from(std::string_view bytes);

/// True if the first bytes are those of a MAT file of version 4: it has no magic number, but a
/// header that text cannot be.
[[nodiscard]] bool is_mat4(std::string_view head);
/// True if they are those of version 5, which MATLAB also writes as 6 and 7; 7.3 is HDF5.
[[nodiscard]] bool is_mat5(std::string_view head);

/// Lists the contents of a file without reading the values.
/// Source: The MathWorks, "MAT-File Format" (2019), chapter 1 (version 5) and 2 (version 4).
/// Errors: corrupt (naming the byte), unsupported (version 4 of a VAX or Cray).
[[nodiscard]] Result<Catalogue> list_mat4(std::string_view file);
[[nodiscard]] Result<Catalogue> list_mat5(std::string_view file);

}  // namespace proofmass::io::matlab
