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

namespace proofmass::io {

/// How the messages of an MCAP file are put into chunks.
struct McapChunking {
  /// A chunk is closed as soon as it is as large or its messages span as much time.
  std::size_t bytes = std::size_t{1} << 20;
  std::uint64_t span_ns = ~std::uint64_t{0};
  /// Each has all schemas and channels, so that it can be read if those before it are lost.
  bool is_self_contained = false;
};

/// The state of a file at the end of a chunk, to which it can be taken back.
struct McapMark {
  std::uint64_t bytes = 0;  ///< of the file up to here
  std::uint32_t data_crc = 0;
  std::size_t chunk_index_bytes = 0, attachment_index_bytes = 0, metadata_index_bytes = 0;
  std::uint32_t chunks = 0, attachments = 0, metadata = 0;
  std::uint64_t start_ns = 0, end_ns = 0, messages = 0;
  std::vector<std::uint32_t> sequences{};  ///< of the channels
};

/// A topic of blocks of samples.
struct McapSamplesTopic {
  std::string name;                     ///< "recording"
  const std::vector<Channel>& columns;  ///< names and units; values are not looked at
  bool has_stamps = true;
  std::optional<double> rate_hz{};  ///< without stamps
  std::optional<std::int64_t> start_ns{};
  std::string derived_from{};  ///< the topic that it was worked out of; empty: measured
};

/// Time of a sample as the log time of a message, which cannot be below zero.
[[nodiscard]] std::uint64_t mcap_log_ns(std::int64_t start_ns, double since_s);

/// Our own recordings in an MCAP file, from front to end, as bytes for whoever writes them. See
/// docs/formats.md.
class McapRecording {
 public:
  using Topic = std::uint16_t;

  explicit McapRecording(McapChunking chunking = {});
  McapRecording(McapRecording&&) noexcept;
  McapRecording& operator=(McapRecording&&) noexcept;
  ~McapRecording();

  [[nodiscard]] Topic add_samples_topic(const McapSamplesTopic& topic);
  /// Messages are JSON. The schema's name is what readers know the topic by.
  [[nodiscard]] Topic add_json_topic(const std::string& name, const std::string& schema_name);
  /// A block whose first row has the number `first`; stamps are empty where the topic has none.
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
  /// The labels of a recording whose samples are in the topic "recording".
  void add_labels(const Recording& recording, std::uint64_t log_ns);
  /// What was added so far can be taken and outlives a crash.
  void close_chunk();
  /// The end of the data and the summary. Nothing can be added afterwards.
  void finish();

  /// Bytes that follow those taken before: whole records.
  [[nodiscard]] std::string take_bytes();
  [[nodiscard]] std::uint64_t bytes() const;  ///< taken, waiting and in the open chunk
  /// Of the bytes that were taken; there must be no others.
  [[nodiscard]] McapMark mark() const;
  /// All that came after the mark was not written.
  void rewind(const McapMark& mark);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// The names of the schemas of what is told beside the samples; readers make no table of them.
inline constexpr std::string_view mcap_event_schema = "proofmass.event";
inline constexpr std::string_view mcap_clock_schema = "proofmass.clock";

}  // namespace proofmass::io
