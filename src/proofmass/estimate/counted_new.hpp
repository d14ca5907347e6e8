#pragma once

#include <cstddef>

namespace proofmass::estimate::test {

/// How often this test program has asked for memory so far.
[[nodiscard]] std::size_t allocations();

}  // namespace proofmass::estimate::test
