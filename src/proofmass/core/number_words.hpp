#pragma once

#include <string>

// Numbers as people read them, in the words of every module. Never the process locale: the decimal
// mark is a point.
namespace proofmass {

/// A number with so many significant digits, "−0.00123", "1.23e+08": scientific where plain digits
/// would take more than a glance (below 1e-4, from 1e6). "none" if it is not finite.
[[nodiscard]] std::string significant(double value, int digits);

/// A number with at most so many significant digits and no zeros behind: "60", "91.6", "120.0048".
[[nodiscard]] std::string compact(double value, int digits);

/// A number with so many decimals and "−" for a minus sign; never "−0.00".
[[nodiscard]] std::string fixed(double value, int decimals);

}  // namespace proofmass
