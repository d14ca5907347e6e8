#pragma once

#include <string>

// Number formatting for people, shared by all modules. Independent of the process locale: the
// decimal mark is a point.
namespace proofmass {

/// A number with `digits` significant digits, "−0.00123", "1.23e+08": scientific notation below
/// 1e-4 and from 1e6. "none" if it is not finite.
[[nodiscard]] std::string significant(double value, int digits);

/// A number with at most `digits` significant digits and no trailing zeros: "60", "91.6",
/// "120.0048".
[[nodiscard]] std::string compact(double value, int digits);

/// A number with `decimals` decimals and "−" for a minus sign; never "−0.00".
[[nodiscard]] std::string fixed(double value, int decimals);

}  // namespace proofmass
