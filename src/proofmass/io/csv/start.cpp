#include "proofmass/io/csv/start.hpp"

#include <fmt/format.h>
#include <string>
#include <string_view>

#include "proofmass/io/cell.hpp"
#include "proofmass/io/clock_text.hpp"
#include "proofmass/io/names.hpp"

namespace proofmass::io {
namespace {

constexpr std::string_view logger = "Gulf Coast Data Concepts";

/// A date with a time of day, as nanoseconds since 1970.
std::optional<std::int64_t> ns_of(std::string_view text) {
  const auto reading = read_clock(text);
  return reading ? instant_ns(*reading) : std::nullopt;
}

class StartFinder {
 public:
  explicit StartFinder(const CsvLayout& layout) : layout_(layout) {}

  CsvStart find() {
    for (const PreambleLine& line : layout_.preamble) {
      if (!line.is_comment) continue;
      split_fields(line.text, ',', fields_);
      const std::string tag = lower(trimmed(fields_.front()));
      if (tag == "title") title(line.text);
      if (tag == "start_time") start(std::string(field(1)) + " " + std::string(field(2)));
      if (tag == "gain" && is_logger_) stated_ += ", gain " + std::string(field(1));
      if (tag == "deadband" && is_logger_) dead_band(field(1));
      constexpr std::string_view started = "recording started at:";
      if (lower(line.text).starts_with(started)) start(line.text.substr(started.size()));
    }
    if (is_logger_)
      found_.notes.insert(
          found_.notes.begin(),
          {Severity::info,
           fmt::format("{}{}; the file names no scale of its counts", logger, stated_)});
    return std::move(found_);
  }

 private:
  [[nodiscard]] std::string_view field(std::size_t k) const {
    return k < fields_.size() ? trimmed(fields_[k]).substr(0, 60) : std::string_view{};
  }
  void title(const std::string& text) {
    is_logger_ = text.find("gcdataconcepts") != std::string::npos;
    if (!is_logger_) return;
    stated_ = " " + std::string(field(2));
    if (!field(3).empty()) stated_ += " (" + std::string(field(3)) + ")";
  }
  void start(const std::string& text) {
    found_.zero_ns = ns_of(trimmed(text));
    if (found_.zero_ns)
      found_.notes.push_back(
          {Severity::info, fmt::format("starts at {} by its header, taken as UTC", trimmed(text))});
  }
  void dead_band(std::string_view counts) {
    const Cell cell = read_cell(counts, '.');
    if (cell.kind == CellKind::number && cell.value > 0.0)
      found_.notes.push_back(
          {Severity::warning,
           fmt::format("dead band of {} counts: samples that differ by less were not written",
                       counts)});
  }

  const CsvLayout& layout_;
  CsvStart found_;
  std::vector<std::string_view> fields_;
  bool is_logger_ = false;
  std::string stated_;
};

}  // namespace

CsvStart read_csv_start(const CsvLayout& layout) {
  return StartFinder(layout).find();
}

}  // namespace proofmass::io
