#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>
#include <vector>

#include "proofmass/acquire/phone/phone_stream_merge.hpp"
#include "proofmass/acquire/phone/phyphox_cursor.hpp"
#include "proofmass/acquire/phone/phyphox_messages.hpp"
#include "proofmass/acquire/phone/phyphox_plan.hpp"
#include "proofmass/acquire/phone/sensor_server_messages.hpp"

// Messages of phones, which come from an untrusted peer.
namespace {

using namespace proofmass::acquire;

void require(bool kept) {
  if (!kept) std::abort();
}

void check_config(std::string_view text) {
  const auto config = parse_phyphox_config(text);
  if (!config) return require(!config.error().message.empty());
  const auto groups = plan_phyphox(*config, {});
  if (!groups) return require(!groups.error().message.empty());
  require(!groups->empty());
  for (const PhyphoxGroup& group : *groups)
    require(!group.buffers.empty() && group.buffers.size() == group.units.size());
}

/// Two successive responses, as during a recording.
void check_replies(std::string_view first, std::string_view second) {
  PhyphoxCursor cursor;
  PhyphoxReply reply;
  for (const std::string_view text : {first, second, first}) {
    if (!parse_phyphox_reply(text, {"t", "x"}, reply)) continue;
    require(reply.buffers.size() == 2 && reply.is_there.size() == 2);
    const std::size_t rows = level_buffers({reply.buffers.data(), 2});
    require(reply.buffers[0].size() == reply.buffers[1].size() &&
            rows <= first.size() + second.size());
    const auto [begin, end] = cursor.take(reply.buffers);
    require(begin <= end && end <= reply.buffers[0].size());
    require(!cursor.threshold().empty());
    if (!reply.buffers[0].empty()) cursor.see_end(reply.buffers[0].front());
  }
}

/// Messages of two sensors in alternation, one per line.
void check_messages(std::string_view lines) {
  PhoneStreamMerge merge({1, 2});
  SensorMessage message;
  Arrival arrival;
  arrival.clear(3);
  std::size_t messages = 0;
  while (!lines.empty()) {
    const std::string_view line = lines.substr(0, lines.find('\n'));
    lines.remove_prefix(std::min(line.size() + 1, lines.size()));
    if (!parse_sensor_message(line, message)) continue;
    require(!message.values.empty());
    message.values.resize(1 + messages % 2);
    merge.add(messages % 2, message.timestamp_ns, message.values);
    merge.take(arrival);
    ++messages;
  }
  require(arrival.rows() <= messages && arrival.device_ns.size() == arrival.rows());
  for (const auto& channel : arrival.channels) require(channel.size() == arrival.rows());
  (void)merge.take_notes();
}

}  // namespace

/// The first byte of the input selects the kind of message.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const std::string_view text(reinterpret_cast<const char*>(data) + 1, size - 1);
  if (data[0] % 4 == 0) check_config(text);
  if (data[0] % 4 == 1)
    check_replies(text.substr(0, text.find('\n')),
                  text.substr(std::min(text.find('\n'), text.size())));
  if (data[0] % 4 == 2) check_messages(text);
  if (data[0] % 4 == 3) {
    (void)parse_phyphox_time(text);
    (void)parse_phyphox_result(text);
  }
  return 0;
}
