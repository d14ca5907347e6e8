#include <cmath>
#include <fmt/format.h>
#include <string>
#include <utility>
#include <vector>

#include "proofmass/io/bytes/column_spool.hpp"
#include "proofmass/io/matlab/mat5_writing.hpp"
#include "proofmass/io/matlab/mat_names.hpp"
#include "proofmass/io/reading/recording_writers.hpp"
#include "proofmass/io/time/row_times.hpp"

namespace proofmass::io::matlab {
namespace {

/// Names of variables that describe the others.
constexpr std::string_view time_name = "time_s";
constexpr std::string_view rate_name = "fs";
constexpr std::string_view start_name = "start_ns";
constexpr std::string_view names_name = "names";
constexpr std::string_view units_name = "units";
constexpr std::string_view origin_name = "proofmass";

class Writer final : public RecordingWriter {
 public:
  Writer(std::unique_ptr<OutputFile> file, const Recording& head, const WriteOptions& options)
      : file_(std::move(file)),
        times_(head.time),
        options_(options),
        row_(head.channels.size() + (times_.is_timed() ? 1 : 0)),
        spool_(row_.size(), file_->part_path()) {
    Names names;
    for (const std::string_view own :
         {time_name, rate_name, start_name, names_name, units_name, origin_name})
      static_cast<void>(names.name_for(own));
    if (times_.is_timed())
      add_variable(std::string(time_name), head.time.channel.empty() ? "time" : head.time.channel,
                   "s");
    for (const Channel& channel : head.channels)
      add_variable(names.name_for(channel.name), channel.name, channel.unit.symbol);
  }

  [[nodiscard]] Status write(const Block& block) override {
    if (spool_.rows() + block.rows() > most_mat5_doubles)
      return Error{
          Errc::unsupported,
          fmt::format("a variable of a .mat file holds 2 GiB at most, which are {} samples: "
                      "write .h5, or cut the recording",
                      most_mat5_doubles)};
    for (std::size_t r = 0; r < block.rows(); ++r) {
      std::size_t c = 0;
      if (times_.is_timed()) row_[c++] = times_.at(block, r);
      for (const View<double>& channel : block.channels) row_[c++] = channel[r];
      if (const Status done = spool_.add(row_); !done) return done;
    }
    return Done{};
  }

  [[nodiscard]] Status finish(const Recording& recording) override {
    if (const Status done = file_->append(mat5_file_header("written by Proofmass")); !done)
      return done;
    for (std::size_t c = 0; c < variables_.size(); ++c)
      if (const Status done = append_column(c); !done) return done;
    const TimeBase& time = recording.time;
    std::string rest;
    if (time.is_uniform() && time.rate_hz > 0.0) rest += mat5_number(rate_name, time.rate_hz);
    if (time.start_ns) rest += mat5_whole_number(start_name, *time.start_ns);
    rest += mat5_texts(names_name, names_) + mat5_texts(units_name, units_) + origin();
    const Status done = file_->append(rest);
    return done ? file_->keep() : done;
  }

 private:
  void add_variable(std::string variable, std::string name, std::string unit) {
    names_.push_back({variable, std::move(name)});
    units_.push_back({variable, std::move(unit)});
    variables_.push_back(std::move(variable));
  }

  Status append_column(std::size_t column) {
    const Status done = file_->append(mat5_column_head(variables_[column], spool_.rows()));
    if (!done) return done;
    return spool_.give(column, [&](std::string_view bytes) { return file_->append(bytes); });
  }

  /// Source of the recording, and the sensor file applied.
  [[nodiscard]] std::string origin() const {
    Names names;
    std::vector<Mat5Text> texts;
    texts.reserve(options_.metadata.size() + 1);
    for (const auto& [key, value] : options_.metadata)
      texts.push_back({names.name_for(key), value});
    if (!options_.sensor_file.empty())
      texts.push_back({names.name_for("sensor_file"), options_.sensor_file});
    return texts.empty() ? std::string{} : mat5_texts(origin_name, texts);
  }

  std::unique_ptr<OutputFile> file_;
  RowTimes times_;
  WriteOptions options_;
  std::vector<double> row_;
  ColumnSpool spool_;
  std::vector<std::string> variables_;
  std::vector<Mat5Text> names_;
  std::vector<Mat5Text> units_;
};

}  // namespace

Result<std::unique_ptr<RecordingWriter>> create(std::unique_ptr<OutputFile> file,
                                                const WriterHead& head,
                                                const WriteOptions& options) {
  return std::unique_ptr<RecordingWriter>(
      std::make_unique<Writer>(std::move(file), head.recording, options));
}

}  // namespace proofmass::io::matlab
