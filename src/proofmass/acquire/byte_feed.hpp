#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "proofmass/acquire/framing.hpp"
#include "proofmass/acquire/source.hpp"

namespace proofmass::acquire {

/// Where the bytes of rows come from: a stream, or packets that are read one at a time.
class ByteFeed {
 public:
  struct Fed {
    std::size_t bytes = 0;   ///< 0: nothing within the time
    bool ended = false;      ///< there will be no more
    std::uint64_t lost = 0;  ///< packets that were dropped in front of it, by the kernel's count
  };
  ByteFeed() = default;
  ByteFeed(const ByteFeed&) = delete;
  ByteFeed& operator=(const ByteFeed&) = delete;
  virtual ~ByteFeed() = default;
  /// What is there, waiting for its first byte as long as patience says.
  /// Errors: device (it is gone).
  [[nodiscard]] virtual Result<Fed> read(std::span<char> into,
                                         std::chrono::milliseconds patience) = 0;
  /// What the driver says of bytes that it dropped since it was asked last.
  [[nodiscard]] virtual std::vector<Note> take_notes() { return {}; }
};

/// Waits until a descriptor can be read, or is gone; false: neither within the time.
[[nodiscard]] bool wait_readable(int descriptor, std::chrono::milliseconds patience);

/// Larger than any packet of UDP; of larger ones of another kind the feed says so.
inline constexpr std::size_t feed_bytes = 65'536;

/// A source of the rows in what is fed; returns once its columns are known and a row is there.
/// `head` has its name, its format and is_paced. Errors: those of the feed, of Decoder and
/// await_rows.
[[nodiscard]] Result<std::unique_ptr<Source>> open_stream(std::unique_ptr<ByteFeed> feed,
                                                          const FramingOptions& framing,
                                                          SourceHead head,
                                                          const OpenOptions& options);

}  // namespace proofmass::acquire
