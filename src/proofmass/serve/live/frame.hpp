#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

namespace proofmass::serve {

/// A line of a recorder, for all who watch it.
struct LiveFrame {
  std::string kind;  ///< the key of the line's object: "rows"
  std::string json;  ///< the line
  bool may_be_left_out = true;
};

/// Whoever watches a source: a browser.
class LiveListener {
 public:
  LiveListener() = default;
  LiveListener(const LiveListener&) = delete;
  LiveListener& operator=(const LiveListener&) = delete;
  virtual ~LiveListener() = default;
  /// Called by the source's thread; does not wait.
  virtual void take(std::uint64_t source, std::shared_ptr<const LiveFrame> frame) = 0;
};

/// The frame of a line, whose kind is its first key. Null if it is not a JSON object of one key.
[[nodiscard]] std::shared_ptr<const LiveFrame> frame_of(std::string line);

/// What a browser sends: {"watch": ID}, or {"watch": null} to watch nothing.
struct LiveRequest {
  std::uint64_t watch = 0;  ///< 0: nothing
};

}  // namespace proofmass::serve
