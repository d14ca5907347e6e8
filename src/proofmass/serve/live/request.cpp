#include "proofmass/serve/live/request.hpp"

#include <nlohmann/json.hpp>
#include <utility>

namespace proofmass::serve {

Result<LiveRequest> parse_live_request(std::string_view message) {
  const Error other{Errc::invalid_argument, "expected {\"watch\": ID} or {\"watch\": null}"};
  if (message.size() > most_live_message_bytes) return other;
  const auto json = nlohmann::json::parse(message, nullptr, false);
  if (!json.is_object() || json.size() != 1 || !json.contains("watch")) return other;
  const auto& watch = json["watch"];
  if (watch.is_null()) return LiveRequest{};
  if (!watch.is_number_unsigned() || watch.get<std::uint64_t>() == 0) return other;
  return LiveRequest{watch.get<std::uint64_t>()};
}

std::shared_ptr<const LiveFrame> frame_of(std::string line) {
  constexpr std::string_view begin = "{\"";
  if (!line.starts_with(begin)) return nullptr;
  const std::size_t end = line.find('"', begin.size());
  if (end == std::string::npos || !nlohmann::json::accept(line)) return nullptr;
  auto frame = std::make_shared<LiveFrame>();
  frame->kind = line.substr(begin.size(), end - begin.size());
  frame->may_be_left_out =
      frame->kind == "rows" || frame->kind == "estimates" || frame->kind == "state";
  frame->json = std::move(line);
  return frame;
}

}  // namespace proofmass::serve
