#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>

namespace proofmass::estimate::packed {

/// ln of a product of many positive numbers, with a single logarithm.
class LogProduct {
 public:
  void multiply(double factor) {
    int exponent = 0;
    mantissa_ = std::frexp(mantissa_ * factor, &exponent);
    exponent_ += exponent;
  }
  /// Multiplies by factor to the power of count.
  void multiply(double factor, std::size_t count) {
    powers_ += static_cast<double>(count) * std::log(factor);
  }
  [[nodiscard]] double value() const {
    return std::log(mantissa_) + static_cast<double>(exponent_) * std::numbers::ln2 + powers_;
  }

 private:
  double mantissa_ = 1.0, powers_ = 0.0;
  std::int64_t exponent_ = 0;
};

}  // namespace proofmass::estimate::packed
