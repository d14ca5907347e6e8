#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "proofmass/io/mcap/records.hpp"

namespace proofmass::io::mcap {

/// Append to a record's content; the counterpart of mcap/records.hpp.
void put_number(std::string& out, std::uint64_t value, std::size_t bytes);
void put_text(std::string& out, std::string_view text);
void put_map(std::string& out, const Map& map);
/// The header of a record of the given size.
void put_record_head(std::string& out, Op op, std::uint64_t bytes);

[[nodiscard]] std::string content_of(const Schema& schema);
[[nodiscard]] std::string content_of(const ChannelRecord& channel);

}  // namespace proofmass::io::mcap
