#include <algorithm>
#include <filesystem>
#include <fmt/format.h>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "proofmass/io/names.hpp"
#include "proofmass/io/parquet/duckdb_library.hpp"
#include "proofmass/io/parquet/facts.hpp"
#include "proofmass/io/reading/recording_writers.hpp"

namespace proofmass::io::parquet {
namespace {

/// Temporary database for the rows; deleted with its owner.
class WaitingRoom {
 public:
  explicit WaitingRoom(std::string path) : path_(std::move(path)) { clear(); }
  WaitingRoom(const WaitingRoom&) = delete;
  WaitingRoom& operator=(const WaitingRoom&) = delete;
  ~WaitingRoom() { clear(); }

  [[nodiscard]] const std::string& path() const { return path_; }

 private:
  void clear() const {
    std::error_code ignored;
    for (const char* end : {"", ".wal", ".tmp"}) std::filesystem::remove_all(path_ + end, ignored);
  }

  std::string path_;
};

/// Column names that differ only in case are equal in SQL.
std::vector<std::string> column_names(const std::vector<std::string>& names) {
  std::vector<std::string> unique;
  std::set<std::string> taken;
  for (const std::string& name : names) {
    std::string free = name.empty() ? "column" : name;
    for (int number = 2; !taken.insert(lower(free)).second; ++number)
      free = fmt::format("{} {}", name, number);
    unique.push_back(std::move(free));
  }
  return unique;
}

class Writer final : public RecordingWriter {
 public:
  Writer(std::unique_ptr<OutputFile> output, const WriterHead& head)
      : output_(std::move(output)),
        room_(output_->part_path() + ".duckdb"),
        time_(head.recording.time),
        has_stamps_(head.has_stamps) {
    if (is_timed()) names_.emplace_back("time");
    for (const Channel& channel : head.recording.channels) names_.push_back(channel.name);
    columns_ = column_names(names_);
  }

  Status begin(const WriterHead& head, const WriteOptions& options) {
    auto opened = Duckdb::open(options.duckdb_library, room_.path());
    if (!opened) return opened.error();
    database_.emplace(std::move(opened).value());
    std::string table = "CREATE TABLE recording (";
    for (std::size_t c = 0; c < columns_.size(); ++c)
      table += fmt::format("{}c{} DOUBLE", c == 0 ? "" : ", ", c);
    // Never committed: temporary data need not survive.
    if (const Status begun = database_->run("BEGIN TRANSACTION"); !begun)
      return failed(begun.error());
    if (const Status made = database_->run(table + ")"); !made) return failed(made.error());
    auto appender = database_->append_to("recording", columns_.size());
    if (!appender) return failed(appender.error());
    appender_.emplace(std::move(appender).value());
    put_facts(head, options);
    return Done{};
  }

  [[nodiscard]] Status write(const Block& block) override {
    std::vector<std::span<const double>> columns;
    if (is_timed()) columns.push_back(times_of(block));
    columns.insert(columns.end(), block.channels.begin(), block.channels.end());
    const Status appended = appender_->append(columns);
    return appended ? appended : failed(appended.error());
  }

  [[nodiscard]] Status finish(const Recording& recording) override {
    put_labels(recording);
    Status done = appender_->close();
    if (done) done = database_->run(copy());
    appender_.reset();
    database_.reset();
    return done ? output_->keep() : failed(done.error());
  }

 private:
  [[nodiscard]] bool is_timed() const { return time_.source != TimeSource::none; }

  View<double> times_of(const Block& block) {
    if (has_stamps_) return block.stamps_s;
    times_.resize(block.rows());
    for (std::size_t k = 0; k < times_.size(); ++k) times_[k] = time_.at(block.first + k);
    return times_;
  }

  void put_facts(const WriterHead& head, const WriteOptions& options) {
    using namespace parquet;
    const auto put = [&](std::string_view key, std::string text) {
      facts_.insert_or_assign(std::string(key), std::move(text));
    };
    facts_ = options.metadata;
    if (!options.sensor_file.empty()) put("sensor_file", options.sensor_file);
    if (time_.start_ns) put(start_key, fmt::format("{}", *time_.start_ns));
    if (is_timed()) {
      put(time_key, columns_.front());
      put(fmt::format("{}{}", unit_prefix, columns_.front()), std::string("s"));
      if (!has_stamps_) put(rate_key, fmt::format("{}", time_.rate_hz));
    }
    for (std::size_t c = is_timed() ? 1 : 0; c < columns_.size(); ++c)
      put(fmt::format("{}{}", unit_prefix, columns_[c]),
          head.recording.channels[c - (is_timed() ? 1 : 0)].unit.symbol);
    for (std::size_t c = 0; c < columns_.size(); ++c)
      if (columns_[c] != names_[c]) put(fmt::format("{}{}", name_prefix, columns_[c]), names_[c]);
  }

  void put_labels(const Recording& recording) {
    if (recording.labels.empty()) return;
    std::string lines;
    for (const Label& label : recording.labels) {
      std::string text = label.text;
      std::ranges::replace(text, '\n', ' ');
      lines += fmt::format("{} {} {}\n", label.first, label.last, text);
    }
    facts_[std::string(parquet::labels_key)] = lines;
    facts_[std::string(parquet::label_channel_key)] = recording.label_channel;
  }

  [[nodiscard]] std::string copy() const {
    constexpr std::size_t most_figures = std::size_t{8} << 20;
    constexpr std::size_t most_rows = 122'880;
    constexpr std::size_t fewest_rows = 2048;
    std::string sql = "COPY (SELECT ";
    for (std::size_t c = 0; c < columns_.size(); ++c)
      sql += fmt::format("{}c{} AS {}", c == 0 ? "" : ", ", c, sql_name(columns_[c]));
    sql += fmt::format(
        " FROM recording) TO {} (FORMAT parquet, COMPRESSION snappy, USE_TMP_FILE false, "
        "ROW_GROUP_SIZE {}",
        sql_text(output_->part_path()),
        std::clamp(most_figures / columns_.size(), fewest_rows, most_rows));
    std::string facts;
    for (const auto& [key, text] : facts_)
      facts += fmt::format("{}{}: {}", facts.empty() ? "" : ", ", sql_text(key), sql_text(text));
    if (!facts.empty()) sql += ", KV_METADATA {" + facts + "}";
    return sql + ")";
  }

  [[nodiscard]] std::string path() const {
    const std::string& part = output_->part_path();
    return part.substr(0, part.rfind(".part"));
  }
  [[nodiscard]] Error failed(const Error& error) const {
    return Error{Errc::unwritable, "cannot be written: " + error.message}.at(path());
  }

  std::unique_ptr<OutputFile> output_;
  WaitingRoom room_;
  TimeBase time_;
  bool has_stamps_;
  std::vector<std::string> names_;    ///< the time's first, if there is one
  std::vector<std::string> columns_;  ///< their names in the file
  std::map<std::string, std::string> facts_;
  std::vector<double> times_;
  std::optional<Duckdb> database_;
  std::optional<DuckdbAppender> appender_;  ///< destroyed before the database
};

}  // namespace

Result<std::unique_ptr<RecordingWriter>> create(std::unique_ptr<OutputFile> file,
                                                const WriterHead& head,
                                                const WriteOptions& options) {
  auto writer = std::make_unique<Writer>(std::move(file), head);
  if (const Status begun = writer->begin(head, options); !begun) return begun.error();
  return std::unique_ptr<RecordingWriter>(std::move(writer));
}

}  // namespace proofmass::io::parquet
