#pragma once

namespace proofmass {

/// A value and its standard deviation, in the same unit. Where a figure could not be determined
/// there is none: std::optional<Uncertain> without a value, never NaN.
struct Uncertain {
  double value = 0.0;
  double std = 0.0;
};

}  // namespace proofmass
