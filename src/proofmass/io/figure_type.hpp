#pragma once

#include <cstddef>

namespace proofmass::io {

/// How one figure of a binary format is stored.
struct FigureType {
  char kind = 'f';  ///< f, i, u, b as in NumPy; 0: not a figure, passed over
  std::size_t bytes = 8;
  bool big_endian = false;
};

/// The figure that begins at `bytes`, of any kind but 0, as the nearest double.
[[nodiscard]] double load_figure(const char* bytes, const FigureType& type);

}  // namespace proofmass::io
