#include <algorithm>
#include <fmt/format.h>
#include <hdf5.h>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "proofmass/io/hdf5/handle.hpp"
#include "proofmass/io/hdf5/runs.hpp"
#include "proofmass/io/hdf5/text.hpp"
#include "proofmass/io/reading/recording_writers.hpp"

namespace proofmass::io::hdf5 {
namespace {

/// The library has global state.
std::mutex& library() {
  static std::mutex mutex;
  return mutex;
}

/// A valid, unused name in a path, without a slash.
std::string link_name(std::string name, hid_t group) {
  std::ranges::replace(name, '/', '_');
  std::erase(name, '\0');
  if (name.empty() || name == "." || name == "..") name = "channel";
  std::string free = name;
  for (int number = 2; H5Lexists(group, free.c_str(), H5P_DEFAULT) > 0; ++number)
    free = fmt::format("{} {}", name, number);
  return free;
}

/// The system's reason if the library passes one on, else the library's.
std::string reason() {
  constexpr std::string_view before = "error message = '";
  const std::string message = failure_reason();
  const std::size_t begin = message.find(before);
  if (begin == std::string::npos) return fmt::format("the HDF5 library says \"{}\"", message);
  const std::string words = message.substr(begin + before.size());
  return words.substr(0, words.find('\''));
}

/// An extensible dataset of doubles.
class Column {
 public:
  Column(hid_t group, const std::string& name, hsize_t chunk_rows)
      : dataset_(create(group, name, chunk_rows)) {}

  explicit operator bool() const { return static_cast<bool>(dataset_); }
  [[nodiscard]] hid_t id() const { return dataset_; }

  bool append(View<double> values) {
    const hsize_t begin = rows_;
    const hsize_t count = values.size();
    if (count == 0) return true;
    rows_ += count;
    if (H5Dset_extent(dataset_, &rows_) < 0) return false;
    const Handle space(H5Dget_space(dataset_), H5Sclose);
    const Handle memory(H5Screate_simple(1, &count, nullptr), H5Sclose);
    return H5Sselect_hyperslab(space, H5S_SELECT_SET, &begin, nullptr, &count, nullptr) >= 0 &&
           H5Dwrite(dataset_, H5T_NATIVE_DOUBLE, memory, space, H5P_DEFAULT, values.data()) >= 0;
  }

 private:
  static Handle create(hid_t group, const std::string& name, hsize_t chunk_rows) {
    constexpr hsize_t none = 0;
    constexpr hsize_t unlimited = H5S_UNLIMITED;
    const Handle space(H5Screate_simple(1, &none, &unlimited), H5Sclose);
    const Handle creation(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
    H5Pset_chunk(creation, 1, &chunk_rows);
    const Handle access(H5Pcreate(H5P_DATASET_ACCESS), H5Pclose);
    constexpr std::size_t slots = 11;
    H5Pset_chunk_cache(access, slots, chunk_rows * sizeof(double), 1.0);
    const Handle link(H5Pcreate(H5P_LINK_CREATE), H5Pclose);
    H5Pset_char_encoding(link, H5T_CSET_UTF8);
    return {H5Dcreate2(group, name.c_str(), H5T_IEEE_F64LE, space, link, creation, access),
            H5Dclose};
  }

  Handle dataset_;
  hsize_t rows_ = 0;
};

/// A group that stores the order of creation of its members.
Handle ordered_group(hid_t file, const char* name) {
  const Handle creation(H5Pcreate(H5P_GROUP_CREATE), H5Pclose);
  H5Pset_link_creation_order(creation, H5P_CRT_ORDER_TRACKED | H5P_CRT_ORDER_INDEXED);
  return {H5Gcreate2(file, name, H5P_DEFAULT, creation, H5P_DEFAULT), H5Gclose};
}

class Writer final : public RecordingWriter {
 public:
  explicit Writer(std::unique_ptr<OutputFile> output)
      : output_(std::move(output)), file_(-1, H5Fclose), group_(-1, H5Gclose) {}
  ~Writer() override {
    const std::lock_guard lock(library());
    close();
  }

  Status begin(const WriterHead& head, const WriteOptions& options) {
    const std::lock_guard lock(library());
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
    file_ = {H5Fcreate(output_->part_path().c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT),
             H5Fclose};
    if (!file_) return failed();
    group_ = ordered_group(file_, "recording");
    const bool described =
        group_ && put_metadata(options) && put_time_base(head) && put_columns(head);
    return described ? Status(Done{}) : failed();
  }

  [[nodiscard]] Status write(const Block& block) override {
    const std::lock_guard lock(library());
    bool written = !has_stamps_ || columns_.front().append(block.stamps_s);
    for (std::size_t c = 0; written && c < block.channels.size(); ++c)
      written = columns_[c + (has_stamps_ ? 1 : 0)].append(block.channels[c]);
    return written ? Status(Done{}) : failed();
  }

  [[nodiscard]] Status finish(const Recording& recording) override {
    {
      const std::lock_guard lock(library());
      if (!put_runs(file_, recording) || H5Fflush(file_, H5F_SCOPE_LOCAL) < 0 || !close())
        return failed();
    }
    return output_->keep();
  }

 private:
  bool put_metadata(const WriteOptions& options) {
    constexpr std::size_t most_attribute = 32'000;
    for (const auto& [name, text] : options.metadata) {
      const bool fits = text.size() <= most_attribute;
      const std::string link = fits ? name : link_name(name, file_);
      if (!(fits ? put_text(file_, name, text) : put_text_dataset(file_, link, text))) return false;
    }
    return options.sensor_file.empty() ||
           put_text_dataset(file_, link_name("sensor_file", file_), options.sensor_file);
  }

  bool put_time_base(const WriterHead& head) {
    const TimeBase& time = head.recording.time;
    has_stamps_ = head.has_stamps;
    if (time.source == TimeSource::none) return true;
    const bool rated = has_stamps_ || time.rate_hz <= 0.0 ||
                       put_attribute(group_, "sample_rate_hz", H5T_NATIVE_DOUBLE, &time.rate_hz);
    return rated && (!time.start_ns ||
                     put_attribute(group_, "start_time_ns", H5T_NATIVE_INT64, &*time.start_ns));
  }

  bool put_columns(const WriterHead& head) {
    constexpr hsize_t most_bytes = hsize_t{64} << 20;
    constexpr hsize_t most_rows = 16'384;
    constexpr hsize_t fewest_rows = 128;
    const auto& channels = head.recording.channels;
    const hsize_t chunk_rows =
        std::clamp(most_bytes / sizeof(double) / (channels.size() + 1), fewest_rows, most_rows);
    if (has_stamps_) {
      const auto& start_ns = head.recording.time.start_ns;
      if (!put_column("time", "s", chunk_rows)) return false;
      if (start_ns &&
          !put_attribute(columns_.back().id(), "start_time_ns", H5T_NATIVE_INT64, &*start_ns))
        return false;
    }
    return std::ranges::all_of(channels, [&](const Channel& channel) {
      return put_column(channel.name, channel.unit.symbol, chunk_rows);
    });
  }

  bool put_column(const std::string& name, const std::string& unit, hsize_t chunk_rows) {
    columns_.emplace_back(group_, link_name(name, group_), chunk_rows);
    return columns_.back() && put_text(columns_.back().id(), "channel_name", name) &&
           put_text(columns_.back().id(), "units", unit);
  }

  /// False if something could not be written.
  bool close() {
    columns_.clear();
    group_.close();
    return file_.close();
  }

  [[nodiscard]] Error failed() const {
    const std::string& part = output_->part_path();
    return {Errc::unwritable, fmt::format("{}: cannot be written: {}",
                                          part.substr(0, part.rfind(".part")), reason())};
  }

  std::unique_ptr<OutputFile> output_;
  Handle file_;
  Handle group_;
  std::vector<Column> columns_;
  bool has_stamps_ = false;
};

}  // namespace

Result<std::unique_ptr<RecordingWriter>> create(std::unique_ptr<OutputFile> file,
                                                const WriterHead& head,
                                                const WriteOptions& options) {
  auto writer = std::make_unique<Writer>(std::move(file));
  if (const Status begun = writer->begin(head, options); !begun) return begun.error();
  return std::unique_ptr<RecordingWriter>(std::move(writer));
}

}  // namespace proofmass::io::hdf5
