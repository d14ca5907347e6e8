#include <cstdint>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <string>

#include "proofmass/serve/live/arguments.hpp"
#include "proofmass/serve/live/request.hpp"

// What a browser sends about live sources: a WebSocket's message, the request that starts a
// recorder, whose arguments must neither be flags of its own making nor lead out of the folder; and
// what a recorder writes.

using namespace proofmass::serve;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const Folder folder = Folder::open("/usr/share").value();
  const std::string text(reinterpret_cast<const char*>(data), size);
  const auto request = parse_live_request(text);
  if (request && size > most_live_message_bytes) std::abort();
  const auto frame = frame_of(text);
  if (frame && !nlohmann::json::parse(frame->json).is_object()) std::abort();
  const auto json = nlohmann::json::parse(text, nullptr, false);
  if (json.is_discarded()) return 0;
  const auto found = live_arguments(json, folder);
  if (!found) return 0;
  if (found->source.starts_with('-') || found->file.find('/') != std::string::npos ||
      found->file.starts_with('.'))
    std::abort();
  // The verb and the source; all others are flags with their value in the same word.
  for (std::size_t k = 2; k < found->arguments.size(); ++k)
    if (!found->arguments[k].starts_with("--")) std::abort();
  return 0;
}
