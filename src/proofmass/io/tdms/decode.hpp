#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "proofmass/io/stamp_reader.hpp"
#include "proofmass/io/tdms/layout.hpp"
#include "proofmass/io/tdms/value.hpp"

namespace proofmass::io::tdms {

/// Storage of the values of a piece.
struct Encoding {
  Kind kind = Kind::f64;
  bool big_endian = false;
  std::uint8_t bit = Scaler::no_bit;  ///< the bit that holds the value
  Int128 origin_ns = 0;               ///< origin of timestamps, in nanoseconds since 1970
};

/// Evenly spaced values as the nearest doubles; timestamps as seconds from the origin, NaN if not
/// set. Precondition: numbers or timestamps.
void decode(const char* first,
            std::size_t stride,
            const Encoding& encoding,
            std::span<double> into);

/// The timestamp at `bytes`.
[[nodiscard]] Instant load_instant(const char* bytes, bool big_endian);

}  // namespace proofmass::io::tdms
