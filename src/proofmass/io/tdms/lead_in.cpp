#include "proofmass/io/tdms/lead_in.hpp"

#include <algorithm>
#include <array>
#include <string_view>

#include "proofmass/io/tdms/cursor.hpp"

namespace proofmass::io::tdms {
Result<LeadIn> take_lead_in(Cursor& cursor, std::uint64_t at, std::uint64_t size) {
  cursor.enter(at, size, false);
  std::array<char, 4> tag{};
  for (char& c : tag) c = cursor.take<char>();
  const std::string_view word(tag.data(), tag.size());
  if (word == "TDSh")
    return Error{Errc::unsupported,
                 "is the index of a TDMS file (TDSh), without values: open the .tdms beside it"};
  if (!cursor.broken() && word != "TDSm")
    return at_byte(at, "no segment of a TDMS file (TDSm) begins here");
  LeadIn lead;
  lead.at = at;
  lead.contents = cursor.take<std::uint32_t>();
  cursor.set_big_endian(lead.has(LeadIn::big_endian));
  lead.version = cursor.take<std::uint32_t>();
  const auto next = cursor.take<std::uint64_t>();
  const auto raw = cursor.take<std::uint64_t>();
  if (cursor.broken()) return at_byte(at, "the file breaks off within a segment's lead-in");
  const std::uint64_t room = size - at - LeadIn::bytes;
  lead.is_complete = next <= room;
  lead.is_unfinished = next == ~std::uint64_t{0};
  lead.end = at + LeadIn::bytes + std::min(next, room);
  if (lead.is_complete && raw > next)
    return at_byte(at, "a segment's values would begin after its end");
  lead.raw_at = at + LeadIn::bytes + std::min(raw, room);
  return lead;
}

}  // namespace proofmass::io::tdms
