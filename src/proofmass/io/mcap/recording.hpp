#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "proofmass/core/recording.hpp"
#include "proofmass/core/view.hpp"

namespace proofmass::io::mcap {

/// How the messages of an MCAP file are grouped into chunks.
struct Chunking {
  /// A chunk is closed as soon as it reaches this size or its messages span this time.
  std::size_t bytes = std::size_t{1} << 20;
  std::uint64_t span_ns = ~std::uint64_t{0};
  /// Each chunk has all schemas and channels, so that it can be read if earlier ones are lost.
  bool is_self_contained = false;
};

/// The state of a file at the end of a chunk, to which it can be rewound.
struct Mark {
  std::uint64_t bytes = 0;  ///< size of the file so far
  std::uint32_t data_crc = 0;
  std::size_t chunk_index_bytes = 0, attachment_index_bytes = 0, metadata_index_bytes = 0;
  std::uint32_t chunks = 0, attachments = 0, metadata = 0;
  std::uint64_t start_ns = 0, end_ns = 0, messages = 0;
  std::vector<std::uint32_t> sequences{};  ///< sequence numbers of the channels
};

/// A topic with blocks of samples.
struct SamplesTopic {
  std::string name;                     ///< "recording"
  const std::vector<Channel>& columns;  ///< names and units; values are ignored
  bool has_stamps = true;
  std::optional<double> rate_hz{};  ///< if there are no stamps
  std::optional<std::int64_t> start_ns{};
  std::string derived_from{};  ///< the topic from which it was computed; empty: measured
};

/// Time of a sample as the log time of a message, which cannot be negative.
[[nodiscard]] std::uint64_t log_time_ns(std::int64_t start_ns, double since_s);

/// Writes our own recordings as an MCAP file, sequentially, into bytes that the caller stores. See
/// docs/formats.md.
class RecordingEncoder {
 public:
  using Topic = std::uint16_t;

  explicit RecordingEncoder(Chunking chunking = {});
  RecordingEncoder(RecordingEncoder&&) noexcept;
  RecordingEncoder& operator=(RecordingEncoder&&) noexcept;
  ~RecordingEncoder();

  [[nodiscard]] Topic add_samples_topic(const SamplesTopic& topic);
  /// Messages are JSON. Readers identify the topic by the schema's name.
  [[nodiscard]] Topic add_json_topic(const std::string& name, const std::string& schema_name);
  /// A block whose first row has the number `first`; stamps are empty if the topic has none.
  void add_samples(Topic topic,
                   std::uint64_t first,
                   std::uint64_t log_ns,
                   View<double> stamps_s,
                   std::span<const View<double>> columns);
  void add_json(Topic topic, std::uint64_t log_ns, std::string_view text);
  void add_metadata(const std::string& name, const std::map<std::string, std::string>& values);
  void add_attachment(const std::string& name,
                      const std::string& media_type,
                      std::uint64_t log_ns,
                      std::string_view data);
  /// Adds the labels of a recording whose samples are in the topic "recording".
  void add_labels(const Recording& recording, std::uint64_t log_ns);
  /// Completes the open chunk: the data added so far can be taken and survive a crash.
  void close_chunk();
  /// Writes the end of the data and the summary. Nothing can be added afterwards.
  void finish();

  /// Returns the bytes since the last call: whole records.
  [[nodiscard]] std::string take_bytes();
  [[nodiscard]] std::uint64_t bytes() const;  ///< taken, pending and in the open chunk
  /// State after the bytes taken; no others may be pending.
  [[nodiscard]] Mark mark() const;
  /// Rewinds to the mark: everything after it was not written.
  void rewind(const Mark& mark);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Schema names of the data stored beside the samples; readers do not present them as tables.
inline constexpr std::string_view event_schema = "proofmass.event";
inline constexpr std::string_view clock_schema = "proofmass.clock";

}  // namespace proofmass::io::mcap
