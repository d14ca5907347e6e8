#pragma once

#include "proofmass/estimate/fast/packed_kalman.hpp"
#include "proofmass/estimate/fast/uniform_lanes.hpp"

// Every loop over lanes is written as one lane's work on its own numbers, the form that the
// compiler vectorises.
namespace proofmass::estimate::packed {

template <int Count>
[[gnu::always_inline]] inline void load(const LaneNumbers* from, int lane, double (&to)[Count]) {
  detail::each<Count>([&](auto i) __attribute__((always_inline)) { to[i()] = from[i()][lane]; });
}

template <int Count>
[[gnu::always_inline]] inline void store(const double (&from)[Count], int lane, LaneNumbers* to) {
  detail::each<Count>([&](auto i) __attribute__((always_inline)) { to[i()][lane] = from[i()]; });
}

template <int N>
[[gnu::always_inline]] inline void add_gain(const double (&K)[N], double y, double (&x)[N]) {
  detail::each<N>([&](auto i) __attribute__((always_inline)) { x[i()] += K[i()] * y; });
}

}  // namespace proofmass::estimate::packed
