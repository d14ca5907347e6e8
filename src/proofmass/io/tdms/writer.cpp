#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "proofmass/io/reading/recording_writers.hpp"
#include "proofmass/io/tdms/value.hpp"
#include "proofmass/io/tdms/writing.hpp"

namespace proofmass::io::tdms {
namespace {

constexpr std::uint32_t has_metadata = 1U << 1;
constexpr std::uint32_t has_new_list = 1U << 2;
constexpr std::uint32_t has_raw_data = 1U << 3;
constexpr std::uint32_t is_interleaved = 1U << 5;
constexpr std::uint32_t version = 4713;
constexpr std::uint32_t no_values = 0xFFFFFFFF;
/// Maximum loss if a file is truncated.
constexpr std::size_t segment_bytes = std::size_t{1} << 20;
constexpr std::string_view group = "recording";

/// "/'recording'/'it''s'"
std::string path_of(std::string_view channel) {
  std::string path = "/'" + std::string(group) + "'";
  if (channel.empty()) return path;
  path += "/'";
  for (const char c : channel) path += c == '\'' ? std::string("''") : std::string(1, c);
  return path + "'";
}

/// Name and properties of a channel.
struct WrittenColumn {
  std::string name;
  PropertyList properties;
};

PropertyList file_properties(const WriteOptions& options) {
  PropertyList list;
  list.text("name", group);
  for (const auto& [name, value] : options.metadata) list.text(name, value);
  if (!options.sensor_file.empty()) list.text("sensor_file", options.sensor_file);
  return list;
}

Instant start_of(const TimeBase& time) {
  return time.start_ns ? instant_at(*time.start_ns) : Instant{};
}

/// A name that no other column has; two objects with one name would be the same to a reader.
std::string free_name(std::string name, const std::vector<WrittenColumn>& taken) {
  if (name.empty()) name = "channel";
  const std::string stem = name;
  for (int n = 2; std::ranges::find(taken, name, &WrittenColumn::name) != taken.end(); ++n)
    name = stem + " " + std::to_string(n);
  return name;
}

/// The channels keep their names; the time is renamed.
std::string time_name(const Recording& recording) {
  for (const char* name : {"time", "timestamp", "sample time"})
    if (recording.find(name) == nullptr) return name;
  return "time of the samples";
}

std::vector<WrittenColumn> columns_of(const WriterHead& head, std::int32_t rows_a_segment) {
  const TimeBase& time = head.recording.time;
  std::vector<WrittenColumn> columns;
  if (head.has_stamps) {
    WrittenColumn column{time_name(head.recording), {}};
    column.properties.text("unit_string", "s");
    if (time.start_ns) column.properties.instant("wf_start_time", start_of(time));
    columns.push_back(std::move(column));
  }
  for (const Channel& channel : head.recording.channels) {
    WrittenColumn column{free_name(channel.name, columns), {}};
    if (!channel.unit.symbol.empty()) column.properties.text("unit_string", channel.unit.symbol);
    if (!head.has_stamps && time.rate_hz > 0.0) {
      column.properties.instant("wf_start_time", start_of(time));
      column.properties.figure("wf_start_offset", 0.0);
      column.properties.figure("wf_increment", 1.0 / time.rate_hz);
      column.properties.whole("wf_samples", rows_a_segment);
      column.properties.figure("rate_hz", time.rate_hz);
    }
    columns.push_back(std::move(column));
  }
  return columns;
}

/// Sample numbers are integers within the range of a double.
PropertyList label_properties(const Recording& recording) {
  PropertyList list;
  list.text("label_channel", recording.label_channel);
  for (std::size_t i = 0; i < recording.labels.size(); ++i) {
    const std::string prefix = "label[" + std::to_string(i) + "]_";
    list.text(prefix + "text", recording.labels[i].text);
    list.figure(prefix + "first", static_cast<double>(recording.labels[i].first));
    list.figure(prefix + "last", static_cast<double>(recording.labels[i].last));
  }
  return list;
}

std::string front_of_segment(std::uint32_t contents,
                             const std::string& metadata,
                             std::size_t data_bytes) {
  std::string out = "TDSm";
  append_value(out, contents);
  append_value(out, version);
  append_value(out, static_cast<std::uint64_t>(metadata.size() + data_bytes));
  append_value(out, static_cast<std::uint64_t>(metadata.size()));
  return out + metadata;
}

class Writer final : public RecordingWriter {
 public:
  Writer(std::unique_ptr<OutputFile> file, const WriterHead& head, const WriteOptions& options)
      : file_(std::move(file)),
        has_stamps_(head.has_stamps),
        width_(head.recording.channels.size() + (head.has_stamps ? 1 : 0)),
        rows_a_segment_(std::max<std::size_t>(1, segment_bytes / (8 * width_))),
        about_file_(file_properties(options)),
        columns_(columns_of(head, static_cast<std::int32_t>(rows_a_segment_))) {}

  [[nodiscard]] Status write(const Block& block) override {
    for (std::size_t row = 0; row < block.rows();) {
      const std::size_t rows = std::min(block.rows() - row, rows_a_segment_ - rows_);
      append_rows(block, row, rows);
      row += rows;
      if (rows_ < rows_a_segment_) continue;
      if (const Status done = end_segment(); !done) return done;
    }
    return Done{};
  }

  [[nodiscard]] Status finish(const Recording& recording) override {
    if (rows_ > 0 || is_first_)
      if (const Status done = end_segment(); !done) return done;
    if (!recording.labels.empty())
      if (const Status done = append_labels(recording); !done) return done;
    return file_->keep();
  }

 private:
  void append_rows(const Block& block, std::size_t from, std::size_t rows) {
    const std::size_t at = values_.size();
    values_.resize(at + rows * width_);
    std::size_t column = 0;
    const auto put_column = [&](View<double> values) {
      double* out = values_.data() + at + column++;
      for (std::size_t r = 0; r < rows; ++r, out += width_) *out = values[from + r];
    };
    if (has_stamps_) put_column(block.stamps_s);
    for (const View<double>& channel : block.channels) put_column(channel);
    rows_ += rows;
  }

  /// Metadata only if they are new: in the first segment, and where the number of rows differs,
  /// which is in the last.
  Status end_segment() {
    const bool says_more = is_first_ || rows_ != declared_rows_;
    const std::string metadata = says_more ? metadata_of(rows_) : std::string{};
    const std::size_t data_bytes = values_.size() * sizeof(double);
    std::uint32_t contents = is_interleaved | (rows_ > 0 ? has_raw_data : 0U);
    if (says_more) contents |= has_metadata | has_new_list;
    std::string out = front_of_segment(contents, metadata, data_bytes);
    const std::size_t at = out.size();
    out.resize(at + data_bytes);
    if constexpr (std::endian::native == std::endian::big)
      for (double& value : values_)
        value = std::bit_cast<double>(__builtin_bswap64(std::bit_cast<std::uint64_t>(value)));
    if (data_bytes > 0) std::memcpy(out.data() + at, values_.data(), data_bytes);
    values_.clear();
    declared_rows_ = rows_;
    rows_ = 0;
    is_first_ = false;
    return file_->append(out);
  }

  /// Data known only at the end: a segment of metadata alone.
  Status append_labels(const Recording& recording) {
    std::string metadata;
    constexpr std::uint32_t objects = 1;
    append_value(metadata, objects);
    append_text(metadata, "/");
    append_value(metadata, no_values);
    label_properties(recording).append_to(metadata);
    return file_->append(front_of_segment(has_metadata, metadata, 0));
  }

  [[nodiscard]] std::string metadata_of(std::size_t rows) const {
    std::string out;
    append_value(out, static_cast<std::uint32_t>(columns_.size() + 2));
    append_text(out, "/");
    append_value(out, no_values);
    (is_first_ ? about_file_ : PropertyList{}).append_to(out);
    append_text(out, path_of({}));
    append_value(out, no_values);
    PropertyList{}.append_to(out);
    for (const WrittenColumn& column : columns_) {
      append_text(out, path_of(column.name));
      constexpr std::uint32_t index_bytes = 20;
      constexpr std::uint32_t dimensions = 1;
      append_value(out, rows > 0 ? index_bytes : no_values);
      if (rows > 0) {
        append_value(out, double_type);
        append_value(out, dimensions);
        append_value(out, static_cast<std::uint64_t>(rows));
      }
      (is_first_ ? column.properties : PropertyList{}).append_to(out);
    }
    return out;
  }

  std::unique_ptr<OutputFile> file_;
  bool has_stamps_;
  std::size_t width_;
  std::size_t rows_a_segment_;
  PropertyList about_file_;
  std::vector<WrittenColumn> columns_;
  std::vector<double> values_;  ///< rows of the segment, each with all its columns
  std::size_t rows_ = 0;
  std::size_t declared_rows_ = 0;
  bool is_first_ = true;
};

}  // namespace

Result<std::unique_ptr<RecordingWriter>> create(std::unique_ptr<OutputFile> file,
                                                const WriterHead& head,
                                                const WriteOptions& options) {
  return std::unique_ptr<RecordingWriter>(std::make_unique<Writer>(std::move(file), head, options));
}

}  // namespace proofmass::io::tdms
