#include "proofmass/acquire/phone/sensor_server_messages.hpp"

#include <optional>

#include "proofmass/acquire/phone/phone_stream_merge.hpp"
#include "proofmass/io/json_leaves.hpp"

namespace proofmass::acquire {
namespace {

/// More than Android provides for any sensor.
constexpr std::size_t most_values = 64;

}  // namespace

Status parse_sensor_message(std::string_view text, SensorMessage& out) {
  std::optional<std::int64_t> timestamp_ns;
  out.type.clear();
  out.values.clear();
  out.accuracy = -1;
  const Status read = io::visit_json(text, [&](const io::JsonLeaf& leaf) {
    if (leaf.path.starts_with("values.") && out.values.size() < most_values)
      out.values.push_back(leaf.figure);
    else if (leaf.path == "timestamp")
      timestamp_ns = leaf.whole;
    else if (leaf.path == "accuracy" && leaf.figure >= 0.0 && leaf.figure <= 3.0)
      out.accuracy = static_cast<int>(leaf.figure);
    else if (leaf.path == "type" && leaf.text)
      out.type = *leaf.text;
  });
  if (!read) return read.error();
  if (!timestamp_ns || *timestamp_ns > PhoneStreamMerge::largest_ns ||
      *timestamp_ns < -PhoneStreamMerge::largest_ns)
    return Error{Errc::corrupt, "has no timestamp in nanoseconds"};
  if (out.values.empty()) return Error{Errc::corrupt, "has no values"};
  out.timestamp_ns = *timestamp_ns;
  return Done{};
}

}  // namespace proofmass::acquire
