#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "proofmass/io/stamp_reader.hpp"
#include "proofmass/io/tdms/layout.hpp"
#include "proofmass/io/tdms/value.hpp"

namespace proofmass::io {

/// Storage of the values of a piece.
struct TdmsEncoding {
  TdmsKind kind = TdmsKind::f64;
  bool big_endian = false;
  std::uint8_t bit = TdmsScaler::no_bit;  ///< the bit that holds the value
  Int128 origin_ns = 0;                   ///< origin of timestamps, in nanoseconds since 1970
};

/// Evenly spaced values as the nearest doubles; timestamps as seconds from the origin, NaN if not
/// set. Precondition: numbers or timestamps.
void decode_tdms(const char* first,
                 std::size_t stride,
                 const TdmsEncoding& encoding,
                 std::span<double> into);

/// The timestamp at `bytes`.
[[nodiscard]] TdmsInstant load_instant(const char* bytes, bool big_endian);

}  // namespace proofmass::io
