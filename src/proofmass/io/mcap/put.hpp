#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "proofmass/io/mcap/records.hpp"

namespace proofmass::io {

/// Append to a record's content; the counterpart of mcap/records.hpp.
void put_number(std::string& out, std::uint64_t value, std::size_t bytes);
void put_mcap_text(std::string& out, std::string_view text);
void put_mcap_map(std::string& out, const McapMap& map);
/// The header of a record of the given size.
void put_record_head(std::string& out, McapOp op, std::uint64_t bytes);

[[nodiscard]] std::string content_of(const McapSchema& schema);
[[nodiscard]] std::string content_of(const McapChannel& channel);

}  // namespace proofmass::io
