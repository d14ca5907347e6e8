#pragma once

#include <cstddef>
#include <deque>

#include "proofmass/io/recording_reader.hpp"

namespace proofmass::io {

[[nodiscard]] std::size_t rows_of(const RawRows& rows);

/// Puts the rows of `from` from `first` on in front of those of `to`.
void put_before(const RawRows& from, std::size_t first, RawRows& to);

/// Pieces as one, each given up as it is taken over.
[[nodiscard]] RawRows joined(std::deque<RawRows> pieces);

}  // namespace proofmass::io
