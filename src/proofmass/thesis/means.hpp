#pragma once

#include <cstddef>
#include <vector>

#include "proofmass/core/view.hpp"

namespace proofmass::thesis {

/// Means of `by` samples each: NaN if half of them or more are not finite, else that of the others.
/// An incomplete block at the end is omitted.
[[nodiscard]] std::vector<double> means_over(View<double> samples, std::size_t by);

}  // namespace proofmass::thesis
