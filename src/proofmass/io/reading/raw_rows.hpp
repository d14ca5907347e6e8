#pragma once

#include <cstddef>
#include <deque>

#include "proofmass/io/reading/recording_reader.hpp"

namespace proofmass::io {

[[nodiscard]] std::size_t rows_of(const RawRows& rows);

/// Inserts the rows of `from`, starting at `first`, before those of `to`.
void put_before(const RawRows& from, std::size_t first, RawRows& to);

/// Concatenates pieces, releasing each once it is copied.
[[nodiscard]] RawRows joined(std::deque<RawRows> pieces);

}  // namespace proofmass::io
