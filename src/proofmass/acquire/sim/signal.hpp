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

/// Measurements of a simulated device, generated on demand.
struct SimSignal {
  Recording head;  ///< channels without values, and the rate
  /// Appends the next rows to the columns, at most as many as there are.
  std::function<void(std::size_t rows, std::vector<std::vector<double>>& columns)> make;
  std::optional<std::uint64_t> rows{};  ///< total number; absent: unlimited
};

/// For the URI's place: a wheel, a wheel at rest, or a procedure; with the settings that define the
/// signal.
/// Errors: invalid_argument, those of reading a description.
[[nodiscard]] Result<SimSignal> sim_signal(SourceUri& uri);

}  // namespace proofmass::acquire
