#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "proofmass/io/stamp_reader.hpp"
#include "proofmass/io/tdms_layout.hpp"
#include "proofmass/io/tdms_value.hpp"

namespace proofmass::io {

/// How the values of a piece are stored.
struct TdmsEncoding {
  TdmsKind kind = TdmsKind::f64;
  bool big_endian = false;
  std::uint8_t bit = TdmsScaler::no_bit;  ///< the one bit that is the value
  Int128 origin_ns = 0;  ///< what points in time are counted from, in nanoseconds since 1970
};

/// Values at even distances as the nearest doubles; points in time as seconds since the origin, NaN
/// where none is set. Precondition: figures or points in time.
void decode_tdms(const char* first,
                 std::size_t stride,
                 const TdmsEncoding& encoding,
                 std::span<double> into);

/// The point in time that begins at `bytes`.
[[nodiscard]] TdmsInstant load_instant(const char* bytes, bool big_endian);

}  // namespace proofmass::io
