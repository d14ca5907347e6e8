#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "proofmass/acquire/framing/framing.hpp"
#include "proofmass/acquire/source.hpp"

namespace proofmass::acquire {

/// Source of the bytes of rows: a stream, or packets that are read one at a time.
class BytePump {
 public:
  struct Fed {
    std::size_t bytes = 0;   ///< 0: none within the time
    bool ended = false;      ///< no more data
    std::uint64_t lost = 0;  ///< packets dropped before this one, by the kernel's count
  };
  BytePump() = default;
  BytePump(const BytePump&) = delete;
  BytePump& operator=(const BytePump&) = delete;
  virtual ~BytePump() = default;
  /// Reads the available bytes; waits for the first one for at most `patience`.
  /// Errors: device (it is lost).
  [[nodiscard]] virtual Result<Fed> read(std::span<char> into,
                                         std::chrono::milliseconds patience) = 0;
  /// Driver messages about dropped bytes since the last call.
  [[nodiscard]] virtual std::vector<Note> take_notes() { return {}; }
};

/// Waits until a descriptor is readable or closed; false: neither within the time.
[[nodiscard]] bool wait_readable(int descriptor, std::chrono::milliseconds patience);

/// Larger than any UDP packet; the feed reports larger packets of other kinds.
inline constexpr std::size_t feed_bytes = 65'536;

/// A source of the rows in the feed; returns once its columns are known and a row has arrived.
/// `head` has its name, its format and is_paced. Errors: those of the feed, of Decoder and
/// await_rows.
[[nodiscard]] Result<std::unique_ptr<Source>> open_stream(std::unique_ptr<BytePump> feed,
                                                          const FramingOptions& framing,
                                                          SourceHead head,
                                                          const OpenOptions& options);

}  // namespace proofmass::acquire
