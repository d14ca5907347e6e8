#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "proofmass/core/recording.hpp"
#include "proofmass/core/result.hpp"
#include "proofmass/io/mcap_catalogue.hpp"
#include "proofmass/io/mcap_records.hpp"
#include "proofmass/io/table_reader.hpp"

namespace proofmass::io {

/// Makes rows of figures of the messages of one topic. What a reader of an encoding writes.
class McapDecoder {
 public:
  McapDecoder() = default;
  McapDecoder(const McapDecoder&) = delete;
  McapDecoder& operator=(const McapDecoder&) = delete;
  virtual ~McapDecoder() = default;

  /// Without rows.
  [[nodiscard]] virtual const TableHead& head() const = 0;
  /// Looks into the next message and says how many rows it brings; its bytes must stay as they are
  /// until the next. `lost_bytes` of messages before it have been passed over so far.
  /// Errors: corrupt, of this message only.
  [[nodiscard]] virtual Result<std::size_t> take(const McapMessage& message,
                                                 std::uint64_t lost_bytes) = 0;
  /// Copies `count` of these rows, from `first` on, into the columns, each from its row `at` on.
  virtual void copy(std::size_t first,
                    std::size_t count,
                    std::span<const std::span<double>> into,
                    std::size_t at) const = 0;
  /// What was seen in the messages so far.
  [[nodiscard]] virtual std::vector<Note> notes() const = 0;
};

/// All that a file says of a topic.
struct McapTopic {
  McapChannel channel;
  McapSchema schema;       ///< empty if there is none
  McapFirstMessage first;  ///< of the topic
};

/// Decoders by encoding. Errors: unsupported (an encoding or schema that is not read), corrupt.
[[nodiscard]] Result<std::unique_ptr<McapDecoder>> mcap_decoder(const McapTopic& topic);

/// Blocks of samples, as mcap_samples.hpp lays them out.
[[nodiscard]] Result<std::unique_ptr<McapDecoder>> mcap_samples_decoder(const McapTopic& topic);
/// ROS messages, of version 2 ("cdr") and 1 ("ros1"): the figures of all fields that are there
/// once.
[[nodiscard]] Result<std::unique_ptr<McapDecoder>> mcap_ros_decoder(const McapTopic& topic);
/// JSON: the figures that the first message has.
[[nodiscard]] Result<std::unique_ptr<McapDecoder>> mcap_json_decoder(const McapTopic& topic);

}  // namespace proofmass::io
