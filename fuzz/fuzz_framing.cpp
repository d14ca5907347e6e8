#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

#include "proofmass/acquire/framing/framing.hpp"

namespace {

using namespace proofmass::acquire;

void require(bool kept) {
  if (!kept) std::abort();
}

/// The first byte of the input selects the options.
FramingOptions options_for(unsigned choice) {
  constexpr std::array<std::string_view, 10> settings{
      "time=none",
      "",
      "rate=100&unit=g&scale=0.5",
      "columns=x,y,z&counter=none",
      "framing=cobs&fields=u32 t_us, i16 x y, u8 seq, crc16",
      "framing=slip&fields=be f32 x, f64 y, u16 t_ms, crc8",
      "framing=sync:AA55&fields=u16 t_us, i24 x, u8 counter, crc32",
      "framing=sync:AA&fields=u8 n, pad 1, be i16 x, f32 t_s",
      "framing=sync:AA55&fields=u64 t_ns, i64 x, crc16-modbus",
      "fields=f64 t_s, i8 x, u8 seq"};
  const std::string_view chosen = settings[choice % settings.size()];
  const bool in_datagrams = chosen.starts_with("fields") || (choice & 0x80) != 0;
  SourceUri uri = SourceUri::parse("x:?" + std::string(chosen)).value();
  const auto options = framing_options(uri, in_datagrams           ? Carrier::datagrams
                                            : (choice & 0x40) != 0 ? Carrier::pipe
                                                                   : Carrier::stream);
  if (options) return *options;
  uri = SourceUri::parse("x:?").value();
  return framing_options(uri, Carrier::datagrams).value();
}

/// Checks the guarantees common to all sources.
void drain(Decoder& decoder, std::uint64_t& rows) {
  Arrival arrival;
  for (bool more = true; more;) {
    more = decoder.hand_out(arrival);
    require(more == (arrival.rows() > 0));
    for (const auto& channel : arrival.channels) require(channel.size() == arrival.rows());
    require(arrival.device_ns.empty() || arrival.device_ns.size() == arrival.rows());
    for (const auto& note : arrival.notes) require(!note.text.empty());
    rows += arrival.rows();
  }
}

/// Decodes the input in pieces; returns the number of rows.
std::uint64_t decode(std::string_view bytes, const FramingOptions& options, std::size_t piece) {
  const auto made = Decoder::make(options);
  require(made.has_value());
  Decoder& decoder = **made;
  std::uint64_t rows = 0;
  std::int64_t host_ns = 0;
  while (!bytes.empty()) {
    const std::string_view some = bytes.substr(0, piece);
    if (options.carrier == Carrier::datagrams)
      decoder.take_packet(some, host_ns);
    else
      decoder.take(some, host_ns);
    bytes.remove_prefix(some.size());
    host_ns += 1'000'000;
  }
  decoder.finish(host_ns);
  const auto settled = decoder.settle(true);
  if (!settled) {
    require(!settled.error().message.empty());
    return 0;
  }
  require(*settled || !decoder.has_rows());
  (void)decoder.what_came();
  if (!*settled) return 0;
  drain(decoder, rows);
  SourceHead head;
  decoder.describe(head);
  require(!head.recording.channels.empty());
  for (const auto& channel : head.recording.channels) require(!channel.name.empty());
  require(decoder.counts().rows == rows);
  return rows;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const FramingOptions options = options_for(data[0]);
  const std::string_view bytes(reinterpret_cast<const char*>(data) + 1, size - 1);
  const std::uint64_t rows = decode(bytes, options, std::max<std::size_t>(bytes.size(), 1));
  // Not compared for datagrams, whose boundaries matter, or for clocks whose unit depends on the
  // arrival time.
  const std::uint64_t in_pieces = decode(bytes, options, 7);
  if (options.framing != Framing::lines && options.carrier != Carrier::datagrams)
    require(in_pieces == rows);
  return 0;
}
