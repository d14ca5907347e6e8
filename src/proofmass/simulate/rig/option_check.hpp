#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <string>
#include <string_view>

#include "proofmass/core/result.hpp"

namespace proofmass::simulate {

/// Keeps the first error found.
class Verdict {
 public:
  void require(bool holds, std::string_view where, std::string_view what) {
    if (!holds && message_.empty()) message_ = std::string(where) + " " + std::string(what);
  }
  void operator()(std::string_view key, double value, double, const auto&) {
    require(std::isfinite(value), key, "must be a finite number");
  }
  template <std::size_t N>
  void operator()(std::string_view key, const std::array<double, N>& values, double, const auto&) {
    for (const double v : values) require(std::isfinite(v), key, "must be finite numbers");
  }
  template <class Other>  // switches, counts and choices are always finite
  void operator()(std::string_view, const Other&, double, const auto&) {}

  [[nodiscard]] Status status() const {
    if (message_.empty()) return Done{};
    return Error{Errc::invalid_argument, message_};
  }

 private:
  std::string message_;
};

}  // namespace proofmass::simulate
