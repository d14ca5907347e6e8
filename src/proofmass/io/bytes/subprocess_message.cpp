#include <algorithm>
#include <array>
#include <cstring>
#include <string>
#include <utility>

#include "proofmass/io/bytes/subprocess.hpp"
#include "proofmass/io/bytes/subprocess_frames.hpp"

namespace proofmass::io {
namespace {

Error broken_off() {
  return {Errc::corrupt, "is damaged: what was unpacked of it breaks off"};
}

/// Fills all of `into`.
Status fill(const BytePump& feed, std::span<char> into) {
  while (!into.empty()) {
    const auto count = feed(into);
    if (!count) return count.error();
    if (*count == 0 || *count > into.size()) return broken_off();
    into = into.subspan(*count);
  }
  return Done{};
}

Error sent_error(std::span<const char> bytes) {
  constexpr std::array codes{Errc::corrupt, Errc::unsupported, Errc::too_few_samples,
                             Errc::unreadable, Errc::invalid_argument};
  const auto code = std::ranges::find_if(
      codes, [&](Errc known) { return !bytes.empty() && bytes[0] == static_cast<char>(known); });
  std::string message;
  for (const char c : bytes.empty() ? bytes : bytes.subspan(1))
    message += static_cast<unsigned char>(c) < 32 || c == 127 ? ' ' : c;
  if (message.empty()) message = "cannot be unpacked";
  return {code == codes.end() ? Errc::corrupt : *code, std::move(message)};
}

}  // namespace

Result<std::span<const char>> MessageReader::next() {
  while (!is_at_end_) {
    std::array<char, sizeof(FrameHeader)> start;
    if (const Status begun = fill(feed_, start); !begun) return begun.error();
    FrameHeader header;
    std::memcpy(&header, start.data(), sizeof header);
    if (header.bytes > most_frame_bytes) return broken_off();
    bytes_.resize(header.bytes);
    if (const Status filled = fill(feed_, bytes_); !filled) return filled.error();
    if (header.kind == FrameKind::error) return sent_error(bytes_);
    if (header.kind != FrameKind::end && header.kind != FrameKind::data) return broken_off();
    is_at_end_ = header.kind == FrameKind::end;
    if (!is_at_end_ && !bytes_.empty()) return std::span<const char>(bytes_);
  }
  return std::span<const char>{};
}

Status take_message(const BytePump& feed, const ByteTaker& take) {
  MessageReader message(feed);
  for (;;) {
    const auto bytes = message.next();
    if (!bytes) return bytes.error();
    if (bytes->empty()) return Done{};
    if (const Status taken = take(*bytes); !taken) return taken;
  }
}

}  // namespace proofmass::io
