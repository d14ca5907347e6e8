#include "proofmass/io/lvm/header.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <fmt/format.h>

#include "proofmass/io/cell.hpp"
#include "proofmass/io/clock_text.hpp"
#include "proofmass/io/csv/header.hpp"
#include "proofmass/io/csv/layout.hpp"
#include "proofmass/io/decimal.hpp"
#include "proofmass/io/names.hpp"
#include "proofmass/io/shown_text.hpp"
#include "proofmass/io/text/unit_in_text.hpp"

namespace proofmass::io::lvm {
namespace {

using Fields = std::vector<std::string>;

constexpr std::array<std::string_view, 31> tags{"Channels",
                                                "Samples",
                                                "Date",
                                                "Time",
                                                "Y_Unit_Label",
                                                "Y_Dimension",
                                                "X_Dimension",
                                                "X_Unit_Label",
                                                "X0",
                                                "Delta_X",
                                                "Notes",
                                                "Test_Name",
                                                "Test_Numbers",
                                                "Test_Series",
                                                "UUT_Name",
                                                "UUT_M/N",
                                                "UUT_S/N",
                                                "Writer_Version",
                                                "Operator",
                                                "Reader_Version",
                                                "Description",
                                                "Separator",
                                                "Project",
                                                "Multi_Headings",
                                                "X_Columns",
                                                "Time_Pref",
                                                "Comment",
                                                "Data_Type",
                                                "Decimal_Separator",
                                                "LabVIEW Measurement",
                                                "X_Value"};

/// The tag at the beginning of a line, whatever the separator after it; empty: none.
std::string_view tag_of(std::string_view line) {
  std::string_view longest;
  for (const std::string_view tag : tags) {
    if (!line.starts_with(tag) || tag.size() <= longest.size()) continue;
    const char after = line.size() == tag.size() ? '\t' : line[tag.size()];
    const bool goes_on = std::isalnum(static_cast<unsigned char>(after)) != 0 || after == '_';
    if (!goes_on) longest = tag;
  }
  return longest;
}

void add_text(std::string& texts, std::string_view tag, std::string_view text) {
  const std::string words = shown(text);
  if (words.empty() || texts.size() > 400) return;
  texts += fmt::format("{}{} \"{}\"", texts.empty() ? "" : ", ", tag, words);
}

std::string_view field(const Fields& fields, std::size_t column) {
  return column < fields.size() ? std::string_view(fields[column]) : std::string_view{};
}

/// A number of the header, and half a unit in its last written digit.
struct Figure {
  double value = 0.0;
  double half_unit = 0.0;
};
std::optional<Figure> figure_of(std::string_view text, char point) {
  const std::string padded = std::string(trimmed(text)) + std::string(decimal_padding, ' ');
  Decimal decimal;
  const char* end = scan_decimal(padded.c_str(), point, decimal);
  // Some headers use the point although the rows have commas.
  if (end == nullptr || *end != ' ')
    end = scan_decimal(padded.c_str(), point == '.' ? ',' : '.', decimal);
  if (end == nullptr || *end != ' ' || decimal.exponent10 < -300 || decimal.exponent10 > 300)
    return std::nullopt;
  return Figure{to_double(decimal), 0.5 * std::pow(10.0, decimal.exponent10)};
}

/// Date and time of a channel's start; none if LabVIEW had none and wrote the beginning of its
/// calendar.
std::optional<std::int64_t> start_of(std::string_view date, std::string_view time) {
  if (date.empty() || time.empty()) return std::nullopt;
  const auto clock = read_clock(fmt::format("{} {}", date.substr(0, 16), time.substr(0, 30)));
  if (!clock || clock->days.value_or(0) <= 0) return std::nullopt;
  return instant_ns(*clock);
}

void take_file_tag(std::string_view tag, std::string_view value, File& file) {
  constexpr std::array<std::string_view, 3> stated{"Operator", "Description", "Project"};
  if (tag == "Decimal_Separator" && !value.empty()) {
    file.point = value.front() == ',' ? ',' : '.';
    file.point_is_stated = true;
  } else if (tag == "X_Columns") {
    const std::string which = lower(value);
    file.x = which.starts_with("no")      ? XColumns::no
             : which.starts_with("multi") ? XColumns::multi
                                          : XColumns::one;
  } else if (tag == "Time_Pref") {
    file.is_absolute = lower(value).starts_with("absolute");
  } else if (std::ranges::find(stated, tag) != stated.end()) {
    add_text(file.texts, tag, value);
  }
}

}  // namespace

bool is_tag(std::string_view line) {
  return !tag_of(line).empty();
}

bool is_mark(std::string_view line, std::string_view word) {
  return line.starts_with("***") && line.substr(3).starts_with(word) &&
         line.substr(3 + word.size()).starts_with("***");
}

Result<File> read_file_header(LineReader& lines) {
  File file;
  for (;;) {
    const auto there = lines.next();
    if (!there) return there.error();
    if (!*there)
      return Error{Errc::corrupt, fmt::format("line {}: breaks off within the header: expected "
                                              "***End_of_Header***",
                                              lines.number())};
    const std::string_view line = lines.text();
    if (is_mark(line, "End_of_Header")) return file;
    const std::string_view tag = tag_of(line);
    if (tag.empty() || line.size() <= tag.size()) continue;
    // The character after the tag is the separator, whatever its name.
    if (tag == "Separator" || tag == "Writer_Version") file.separator = line[tag.size()];
    take_file_tag(tag, trimmed(line.substr(tag.size() + 1)), file);
  }
}

/// Fields of a line by their column; if separator and decimal mark are the same character, digits
/// after it belong to the previous number.
Fields SegmentHeader::fields_of(std::string_view line) const {
  std::vector<std::string_view> views;
  split_fields(line, file_.separator, views);
  Fields fields;
  bool may_go_on = false;
  for (const std::string_view view : views) {
    const std::string_view text = trimmed(view);
    const bool goes_on = may_go_on && file_.separator == file_.point && !text.empty() &&
                         is_digit(text.front()) && text.find(':') == std::string_view::npos &&
                         text.find('/') == std::string_view::npos;
    if (goes_on)
      fields.back() += "." + std::string(text);
    else
      fields.emplace_back(text);
    may_go_on = !goes_on && !text.empty() && is_digit(text.back());
    if (fields.size() > most_columns) break;
  }
  return fields;
}

void SegmentHeader::add(std::string_view line) {
  const std::string_view tag = tag_of(line);
  if (tag.empty()) return;
  constexpr std::array<std::string_view, 7> stated{
      "Notes", "Test_Name", "Test_Numbers", "Test_Series", "UUT_Name", "UUT_M/N", "UUT_S/N"};
  if (std::ranges::find(stated, tag) != stated.end())
    add_text(texts_, tag, line.substr(tag.size()));
  else if (tag == "Channels")
    // The only number here that cannot have decimals.
    std::from_chars(line.data() + std::min(line.size(), tag.size() + 1), line.data() + line.size(),
                    channels_);
  else if (tag == "Samples")
    samples_ = fields_of(line);
  else if (tag == "Date")
    dates_ = fields_of(line);
  else if (tag == "Time")
    times_ = fields_of(line);
  else if (tag == "Y_Unit_Label")
    units_ = fields_of(line);
  else if (tag == "X_Dimension")
    dimensions_ = fields_of(line);
  else if (tag == "X_Unit_Label")
    x_units_ = fields_of(line);
  else if (tag == "X0")
    x0_ = fields_of(line);
  else if (tag == "Delta_X")
    delta_x_ = fields_of(line);
}

Channel SegmentHeader::channel(std::size_t index, Fields& unknown_units) const {
  Channel channel;
  channel.column = file_.x == XColumns::multi ? 2 * index + 1 : index + 1;
  const std::string_view name = field(names_, channel.column);
  channel.heading = name.empty() ? fmt::format("channel_{}", index + 1) : shown(name);
  const std::string_view unit = field(units_, channel.column);
  const std::string symbol = unit_symbol(unit);
  const bool has_unit = read_label(channel.heading).unit.quantity != Quantity::unknown;
  if (!symbol.empty() && !has_unit)
    channel.heading += " (" + symbol + ")";
  else if (!unit.empty() && !has_unit && !channel.heading.ends_with(fmt::format("({})", unit)))
    unknown_units.push_back(fmt::format("{} ({})", channel.heading, shown(unit)));
  channel.delta_text = field(delta_x_, channel.column);
  if (const auto delta = figure_of(channel.delta_text, file_.point);
      delta && delta->value > 0.0 && std::isfinite(delta->value)) {
    channel.delta_x = delta->value;
    channel.delta_half_unit = delta->half_unit;
  }
  if (const auto x0 = figure_of(field(x0_, channel.column), file_.point);
      x0 && std::abs(x0->value) < 9e9)
    channel.x0 = x0->value;
  const std::string_view samples = field(samples_, channel.column);
  std::from_chars(samples.data(), samples.data() + samples.size(), channel.samples);
  channel.start_ns = start_of(field(dates_, channel.column), field(times_, channel.column));
  return channel;
}

/// Only columns that occur in the lines present.
std::size_t SegmentHeader::count_channels() const {
  std::size_t stated = std::max({names_.size(), samples_.size(), delta_x_.size()});
  while (stated > 0 && field(names_, stated - 1).empty() && field(samples_, stated - 1).empty() &&
         field(delta_x_, stated - 1).empty())
    --stated;
  if (stated > 1 && lower(field(names_, stated - 1)) == "comment") --stated;
  if (stated == 0) return 0;
  const std::size_t count = file_.x == XColumns::multi ? stated / 2 : stated - 1;
  return channels_ > 0 ? std::min(count, channels_) : count;
}

Segment SegmentHeader::finish(std::string_view names) {
  names_ = fields_of(names);
  Segment segment;
  const std::size_t count = count_channels();
  Fields unknown_units;
  for (std::size_t i = 0; i < count; ++i) segment.channels.push_back(channel(i, unknown_units));
  const std::string_view dimension = field(dimensions_, 1);
  segment.x_is_time = dimension.empty() || lower(dimension) == "time";
  if (!segment.x_is_time)
    segment.x_heading = fmt::format("{} ({})", shown(dimension), shown(field(x_units_, 1)));
  std::string units;
  for (std::size_t i = 0; i < std::min<std::size_t>(unknown_units.size(), 8); ++i)
    units += (i == 0 ? "" : ", ") + unknown_units[i];
  if (!units.empty())
    segment.notes.push_back({Severity::info, "units that are not known here: " + units});
  if (!texts_.empty()) segment.notes.push_back({Severity::info, "the segment says: " + texts_});
  return segment;
}

}  // namespace proofmass::io::lvm
