#pragma once

#include <cstddef>

namespace proofmass::io {

/// Storage of one number in a binary format.
struct FigureType {
  char kind = 'f';  ///< f, i, u, b as in NumPy; 0: not a number, skipped
  std::size_t bytes = 8;
  bool big_endian = false;
};

/// The number at `bytes`, of any kind but 0, as the nearest double.
[[nodiscard]] double load_figure(const char* bytes, const FigureType& type);

}  // namespace proofmass::io
