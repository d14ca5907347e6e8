#pragma once

#include <cstddef>
#include <vector>

#include "proofmass/core/block.hpp"

namespace proofmass {

/// Samples with their own storage; a Block is a view of them. Clearing keeps the capacity.
struct Rows {
  std::vector<double> stamps_s{};  ///< since the recording's first sample
  std::vector<std::vector<double>> channels{};

  [[nodiscard]] std::size_t rows() const { return channels.empty() ? 0 : channels.front().size(); }
  void clear() {
    stamps_s.clear();
    for (std::vector<double>& channel : channels) channel.clear();
  }
};

/// View of the current rows; `first` is the number of row 0 in the recording.
[[nodiscard]] inline Block view_of(const Rows& rows, std::size_t first) {
  return {first, {rows.channels.begin(), rows.channels.end()}, rows.stamps_s};
}

}  // namespace proofmass
