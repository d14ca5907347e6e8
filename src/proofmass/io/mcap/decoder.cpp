#include "proofmass/io/mcap/decoder.hpp"

#include <fmt/format.h>

#include "proofmass/io/mcap/samples.hpp"
#include "proofmass/io/shown_text.hpp"

namespace proofmass::io {

Result<std::unique_ptr<McapDecoder>> mcap_decoder(const McapTopic& topic) {
  const std::string& encoding = topic.channel.encoding;
  if (encoding == mcap_samples_encoding) return mcap_samples_decoder(topic);
  if (encoding == "cdr" || encoding == "ros1") return mcap_ros_decoder(topic);
  if (encoding == "json") return mcap_json_decoder(topic);
  return Error{Errc::unsupported, fmt::format("in {}, which is not read",
                                              encoding.empty() ? "no encoding" : shown(encoding))};
}

}  // namespace proofmass::io
