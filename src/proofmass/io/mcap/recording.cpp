#include "proofmass/io/mcap/recording.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "proofmass/core/version.hpp"
#include "proofmass/io/mcap/builder.hpp"
#include "proofmass/io/mcap/labels.hpp"
#include "proofmass/io/mcap/samples.hpp"

namespace proofmass::io::mcap {

struct RecordingEncoder::State {
  Builder builder;
  std::string message{};
};

RecordingEncoder::RecordingEncoder(Chunking chunking)
    : state_(std::make_unique<State>(
          State{Builder(fmt::format("proofmass {}", version()), chunking)})) {}
RecordingEncoder::RecordingEncoder(RecordingEncoder&&) noexcept = default;
RecordingEncoder& RecordingEncoder::operator=(RecordingEncoder&&) noexcept = default;
RecordingEncoder::~RecordingEncoder() = default;

std::uint64_t log_time_ns(std::int64_t start_ns, double since_s) {
  constexpr double longest_s = 9e9;
  const double ns = std::isfinite(since_s) ? std::clamp(since_s, -longest_s, longest_s) * 1e9 : 0.0;
  std::int64_t at = 0;
  if (__builtin_add_overflow(start_ns, static_cast<std::int64_t>(ns), &at)) return 0;
  return static_cast<std::uint64_t>(std::max<std::int64_t>(at, 0));
}

RecordingEncoder::Topic RecordingEncoder::add_samples_topic(const SamplesTopic& topic) {
  SamplesLayout layout;
  for (const Channel& channel : topic.columns)
    layout.columns.push_back({channel.name, channel.unit.symbol});
  layout.has_stamps = topic.has_stamps;
  layout.rate_hz = topic.rate_hz;
  layout.start_ns = topic.start_ns;
  layout.derived_from = topic.derived_from;
  Builder& builder = state_->builder;
  const std::uint16_t schema =
      builder.add_schema({0, "proofmass.samples", "jsonschema", samples_schema(layout)});
  return builder.add_channel(
      {0, schema, topic.name, std::string(samples_encoding), samples_metadata(layout)});
}

RecordingEncoder::Topic RecordingEncoder::add_json_topic(const std::string& name,
                                                         const std::string& schema_name) {
  Builder& builder = state_->builder;
  const std::uint16_t schema =
      builder.add_schema({0, schema_name, "jsonschema", R"({"type":"object"})"});
  return builder.add_channel({0, schema, name, "json", {}});
}

void RecordingEncoder::add_samples(Topic topic,
                                   std::uint64_t first,
                                   std::uint64_t log_ns,
                                   View<double> stamps_s,
                                   std::span<const View<double>> columns) {
  write_samples(first, stamps_s, columns, state_->message);
  state_->builder.add_message(topic, log_ns, state_->message);
}

void RecordingEncoder::add_json(Topic topic, std::uint64_t log_ns, std::string_view text) {
  state_->builder.add_message(topic, log_ns, text);
}

void RecordingEncoder::add_metadata(const std::string& name,
                                    const std::map<std::string, std::string>& values) {
  state_->builder.add_metadata({name, values});
}

void RecordingEncoder::add_attachment(const std::string& name,
                                      const std::string& media_type,
                                      std::uint64_t log_ns,
                                      std::string_view data) {
  state_->builder.add_attachment(
      {.log_ns = log_ns, .create_ns = 0, .name = name, .media_type = media_type}, data);
}

void RecordingEncoder::add_labels(const Recording& recording, std::uint64_t log_ns) {
  add_attachment(std::string(labels_name), "text/csv", log_ns, labels_table(recording));
}

void RecordingEncoder::close_chunk() {
  state_->builder.close_chunk();
}
void RecordingEncoder::finish() {
  state_->builder.finish();
}
std::string RecordingEncoder::take_bytes() {
  return state_->builder.take_bytes();
}
std::uint64_t RecordingEncoder::bytes() const {
  return state_->builder.bytes();
}
Mark RecordingEncoder::mark() const {
  return state_->builder.mark();
}
void RecordingEncoder::rewind(const Mark& mark) {
  state_->builder.rewind(mark);
}

}  // namespace proofmass::io::mcap
