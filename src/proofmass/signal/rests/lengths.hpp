#pragma once

#include <cstddef>

#include "proofmass/signal/rests.hpp"

namespace proofmass::signal {

struct RestLengths {
  std::size_t window, shortest;  ///< samples
};

[[nodiscard]] RestLengths rest_lengths(const RestOptions& options);

}  // namespace proofmass::signal
