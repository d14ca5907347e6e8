#pragma once

#include <cstddef>

namespace proofmass::estimate::test {

/// Number of allocations by this test program so far.
[[nodiscard]] std::size_t allocations();

}  // namespace proofmass::estimate::test
