#include "proofmass/io/mcap/decoder.hpp"

#include <fmt/format.h>

#include "proofmass/io/mcap/samples.hpp"
#include "proofmass/io/shown_text.hpp"

namespace proofmass::io::mcap {

Result<std::unique_ptr<Decoder>> decoder_of(const Topic& topic) {
  const std::string& encoding = topic.channel.encoding;
  if (encoding == samples_encoding) return samples_decoder(topic);
  if (encoding == "cdr" || encoding == "ros1") return ros_decoder(topic);
  if (encoding == "json") return json_decoder(topic);
  return Error{Errc::unsupported, fmt::format("in {}, which is not read",
                                              encoding.empty() ? "no encoding" : shown(encoding))};
}

}  // namespace proofmass::io::mcap
