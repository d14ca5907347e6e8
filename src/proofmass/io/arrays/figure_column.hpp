#pragma once

#include <cstddef>
#include <span>

#include "proofmass/io/arrays/figure_type.hpp"

namespace proofmass::io {

/// Numbers `stride` bytes apart, the first at `bytes`, as the nearest doubles: out.size() of them.
/// Values of any kind but 0; integers of three bytes are supported too.
void load_figures(const char* bytes,
                  std::size_t stride,
                  const FigureType& type,
                  std::span<double> out);

}  // namespace proofmass::io
