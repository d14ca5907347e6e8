#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "proofmass/core/recording.hpp"
#include "proofmass/core/result.hpp"
#include "proofmass/io/mcap/catalogue.hpp"
#include "proofmass/io/mcap/records.hpp"
#include "proofmass/io/table_reader.hpp"

namespace proofmass::io::mcap {

/// Converts the messages of one topic to rows of numbers. Interface of the encodings.
class Decoder {
 public:
  Decoder() = default;
  Decoder(const Decoder&) = delete;
  Decoder& operator=(const Decoder&) = delete;
  virtual ~Decoder() = default;

  /// Without rows.
  [[nodiscard]] virtual const TableHead& head() const = 0;
  /// Inspects the next message and returns its number of rows; its bytes must stay unchanged until
  /// the next call. `lost_bytes` of earlier messages have been skipped so far.
  /// Errors: corrupt, for this message only.
  [[nodiscard]] virtual Result<std::size_t> take(const Message& message,
                                                 std::uint64_t lost_bytes) = 0;
  /// Copies `count` of these rows, from `first` on, into the columns, starting at row `at` of each.
  virtual void copy(std::size_t first,
                    std::size_t count,
                    std::span<const std::span<double>> into,
                    std::size_t at) const = 0;
  /// Notes on the messages so far.
  [[nodiscard]] virtual std::vector<Note> notes() const = 0;
};

/// All information of a file on a topic.
struct Topic {
  ChannelRecord channel;
  Schema schema;       ///< empty if the file has none for it
  FirstMessage first;  ///< the topic's first message
};

/// Selects the decoder by encoding. Errors: unsupported (an encoding or schema), corrupt.
[[nodiscard]] Result<std::unique_ptr<Decoder>> decoder_of(const Topic& topic);

/// Blocks of samples, in the layout of mcap/samples.hpp.
[[nodiscard]] Result<std::unique_ptr<Decoder>> samples_decoder(const Topic& topic);
/// ROS messages, of version 2 ("cdr") and 1 ("ros1"): the numbers of all fields that occur once.
[[nodiscard]] Result<std::unique_ptr<Decoder>> ros_decoder(const Topic& topic);
/// JSON: the numbers of the first message.
[[nodiscard]] Result<std::unique_ptr<Decoder>> json_decoder(const Topic& topic);

}  // namespace proofmass::io::mcap
