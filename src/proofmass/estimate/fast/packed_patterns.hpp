#pragma once

#include <array>

#include "proofmass/estimate/fast/packed_model.hpp"

// The patterns of the compiled kernels, narrower ones first.
namespace proofmass::estimate::packed {

/// Position, velocity and acceleration in a chain, followed by a state that depends only on itself.
template <int N>
[[nodiscard]] constexpr Pattern chain(unsigned h_zero, unsigned h_one) {
  Pattern chain{0, 0, h_zero, h_one, true};
  for (int i = 0; i < N; ++i)
    for (int j = 0; j < N; ++j) {
      const unsigned bit = 1U << (i * N + j);
      if (j < i || (j == 3 && i < 3)) chain.F_zero |= bit;
      if (j == i && i < 3) chain.F_one |= bit;
    }
  return chain;
}

/// The acceleration is measured, or the position.
template <int N>
inline constexpr std::array<Pattern, 1> patterns{Pattern{}};
template <>
inline constexpr std::array<Pattern, 3> patterns<3>{chain<3>(0b011, 0b100), chain<3>(0b110, 0b001),
                                                    Pattern{}};
template <>
inline constexpr std::array<Pattern, 3> patterns<4>{chain<4>(0b0011, 0b1100),
                                                    chain<4>(0b1110, 0b0001), Pattern{}};

/// The first that fits the model; the last fits any.
template <int N>
[[nodiscard]] constexpr std::size_t pattern_of(const StepModel<N>& model) {
  std::size_t i = 0;
  while (!fits(patterns<N>[i], model)) ++i;
  return i;
}

}  // namespace proofmass::estimate::packed
