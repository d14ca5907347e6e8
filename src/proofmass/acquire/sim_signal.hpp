#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "proofmass/acquire/source_uri.hpp"
#include "proofmass/core/recording.hpp"
#include "proofmass/core/result.hpp"

namespace proofmass::acquire {

/// What a simulated device measures, made as it is asked for.
struct SimSignal {
  Recording head;  ///< channels without values, and the rate
  /// Appends the next rows to the columns; no more than there are.
  std::function<void(std::size_t rows, std::vector<std::vector<double>>& columns)> make;
  std::optional<std::uint64_t> rows{};  ///< that there are; absent: without end
};

/// Of the URI's place: a wheel, a wheel at rest, or a procedure; with the settings that say what is
/// measured.
/// Errors: invalid_argument, those of reading a description.
[[nodiscard]] Result<SimSignal> sim_signal(SourceUri& uri);

}  // namespace proofmass::acquire
