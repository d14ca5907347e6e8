#pragma once

#include <cstddef>
#include <vector>

#include "proofmass/core/view.hpp"

namespace proofmass {

/// Consecutive samples of a recording that is handled a piece at a time. The views are valid until
/// the next piece is asked for.
struct Block {
  std::size_t first = 0;                 ///< sample of the recording that row 0 is
  std::vector<View<double>> channels{};  ///< equally long, in the recording's order and units
  View<double> stamps_s{};  ///< since the recording's first sample; empty where the base is uniform

  [[nodiscard]] std::size_t rows() const { return channels.empty() ? 0 : channels.front().size(); }
};

}  // namespace proofmass
