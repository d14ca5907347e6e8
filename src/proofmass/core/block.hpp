#pragma once

#include <cstddef>
#include <vector>

#include "proofmass/core/view.hpp"

namespace proofmass {

/// Consecutive samples of a recording that is processed in blocks. The views are valid until the
/// next block is requested.
struct Block {
  std::size_t first = 0;                 ///< number of row 0 in the recording
  std::vector<View<double>> channels{};  ///< equally long, in the recording's order and units
  View<double> stamps_s{};  ///< since the recording's first sample; empty where the base is uniform

  [[nodiscard]] std::size_t rows() const { return channels.empty() ? 0 : channels.front().size(); }
};

}  // namespace proofmass
