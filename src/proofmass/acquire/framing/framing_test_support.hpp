#pragma once

#include <algorithm>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "proofmass/acquire/framing/framing.hpp"

namespace proofmass::acquire {

/// The complete output of a decoder, arrivals concatenated.
struct Decoded {
  SourceHead head{};
  std::vector<std::vector<double>> channels{};
  std::vector<std::int64_t> device_ns{};
  std::vector<std::uint64_t> lost_before{};  ///< per row
  std::vector<std::string> notes{};
  DecodeCounts counts{};

  [[nodiscard]] std::size_t rows() const { return channels.empty() ? 0 : channels[0].size(); }
  [[nodiscard]] std::vector<std::string> names() const {
    std::vector<std::string> out;
    for (const Channel& channel : head.recording.channels) out.push_back(channel.name);
    return out;
  }
  [[nodiscard]] bool is_noted(std::string_view part) const {
    return std::ranges::any_of(
        notes, [&](const std::string& note) { return note.find(part) != std::string::npos; });
  }
};

inline void drain(Decoder& decoder, Decoded& out) {
  Arrival arrival;
  for (bool more = true; more;) {
    more = decoder.hand_out(arrival);
    for (const Note& note : arrival.notes) out.notes.push_back(note.text);
    out.channels.resize(std::max(out.channels.size(), arrival.channels.size()));
    for (std::size_t c = 0; c < arrival.channels.size(); ++c)
      out.channels[c].insert(out.channels[c].end(), arrival.channels[c].begin(),
                             arrival.channels[c].end());
    out.device_ns.insert(out.device_ns.end(), arrival.device_ns.begin(), arrival.device_ns.end());
    out.lost_before.resize(out.rows());
    if (arrival.rows() > 0) out.lost_before[out.rows() - arrival.rows()] = arrival.lost_before;
  }
}

inline FramingOptions options_of(const std::string& settings, Carrier carrier = Carrier::pipe) {
  SourceUri uri = SourceUri::parse("x:y?" + settings).value();
  return framing_options(uri, carrier).value();
}

/// Decodes a text in pieces of the given size, each a millisecond after the previous one.
inline Decoded decode(std::string_view bytes, const FramingOptions& options, std::size_t piece) {
  const std::unique_ptr<Decoder> decoder = Decoder::make(options).value();
  Decoded out;
  std::int64_t host_ns = 0;
  for (; !bytes.empty(); host_ns += 1'000'000) {
    decoder->take(bytes.substr(0, piece), host_ns);
    bytes.remove_prefix(std::min(piece, bytes.size()));
    if (decoder->settle(false).value()) drain(*decoder, out);
  }
  decoder->finish(host_ns);
  if (decoder->settle(true).value()) {
    drain(*decoder, out);
    decoder->describe(out.head);
  }
  out.counts = decoder->counts();
  return out;
}
inline Decoded decode(std::string_view bytes,
                      const std::string& settings = "",
                      Carrier carrier = Carrier::pipe) {
  return decode(bytes, options_of(settings, carrier), bytes.size());
}

}  // namespace proofmass::acquire
