#pragma once

namespace proofmass {

/// A value and its standard deviation, in the same unit. A figure that could not be determined is a
/// std::optional<Uncertain> without a value, never NaN.
struct Uncertain {
  double value = 0.0;
  double std = 0.0;
};

}  // namespace proofmass
