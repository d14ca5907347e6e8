#include "proofmass/io/foreign_formats.hpp"

#include <algorithm>
#include <array>

namespace proofmass::io {
namespace {

struct Foreign {
  std::string_view magic;
  std::string_view refusal;
};
constexpr std::array foreign = std::to_array<Foreign>({
    {"#ROSBAG", "is a ROS 1 bag, which is not read: make an MCAP file of it (mcap convert)"},
    {"BZh", "is compressed by bzip2, which is not read: unpack it, or use gzip or xz"},
    {"\x04\x22\x4D\x18", "is compressed by lz4, which is not read: unpack it, or use gzip or xz"},
    {"SQLite format 3", "is an SQLite data base, which is not read: export the table as CSV"},
    {"%PDF", "is a PDF: expected a recording"},
    {"{", "is a JSON document: expected a table, such as CSV"},
    {"<", "is an XML or HTML document: expected a table, such as CSV"},
});

const Foreign* find_foreign(std::string_view head) {
  const auto* found =
      std::ranges::find_if(foreign, [&](const Foreign& f) { return head.starts_with(f.magic); });
  return found == foreign.end() ? nullptr : found;
}

}  // namespace

bool claims_foreign(std::string_view head, std::string_view) {
  return find_foreign(head) != nullptr;
}

Result<std::unique_ptr<TableFile>> refuse_foreign(std::unique_ptr<PeekSource> source,
                                                  const ReadOptions&) {
  const auto head = source->peek(64);
  if (!head) return head.error();
  const Foreign* found = find_foreign(*head);
  return Error{Errc::unsupported,
               std::string(found != nullptr ? found->refusal
                                            : std::string_view("is of no format that is read"))};
}

}  // namespace proofmass::io
