#include "proofmass/io/wav/labels.hpp"

#include <cmath>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <map>
#include <string_view>

#include "proofmass/io/cell.hpp"
#include "proofmass/io/clock_text.hpp"
#include "proofmass/io/names.hpp"
#include "proofmass/io/shown_text.hpp"
#include "proofmass/io/text/wording.hpp"

namespace proofmass::io::wav {
namespace {

using Fields = std::map<std::string, std::string>;

/// "Channel-1: Accel-X" and similar, one per line.
Fields fields_of(std::string_view comment) {
  Fields fields;
  while (!comment.empty()) {
    const std::size_t end = std::min(comment.find('\n'), comment.size());
    const std::string_view line = comment.substr(0, end);
    const std::size_t colon = line.find(':');
    if (colon != std::string_view::npos)
      fields.emplace(lower(trimmed(line.substr(0, colon))), shown(line.substr(colon + 1)));
    comment.remove_prefix(std::min(end + 1, comment.size()));
  }
  return fields;
}

std::string find(const Fields& fields, const std::string& key) {
  const auto found = fields.find(key);
  return found == fields.end() ? std::string{} : found->second;
}

/// A date and time of day, assumed to be UTC unless it has a zone.
std::optional<std::int64_t> instant_of(std::string_view text) {
  const auto clock = read_clock(trimmed(text));
  return clock ? instant_ns(*clock) : std::nullopt;
}

/// The full scale in g given in the comment for an acceleration in integers.
std::optional<double> scale_of(const Header& header,
                               const Fields& fields,
                               const std::string& name,
                               const std::string& number) {
  if (header.figure.kind == 'u' || !bare_name(name).starts_with("accel")) return std::nullopt;
  const Cell scale = read_cell(find(fields, "scale-" + number), '.');
  const bool is_stated =
      scale.kind == CellKind::number && scale.value > 0.0 && std::isfinite(scale.value);
  return is_stated ? std::optional(scale.value) : std::nullopt;
}

/// True if a channel marks which samples are present: only 16-bit samples have this layout.
bool is_auxiliary(const Header& header, std::string_view name) {
  return bare_name(name) == "aux" && header.figure.kind == 'i' && header.figure.bytes == 2;
}

void label_channels(const Header& header, const Fields& fields, Labels& labels) {
  const bool is_whole = header.figure.kind != 'f';
  const std::string_view own_unit = is_whole ? " (counts)" : "";
  const double full_scale =
      is_whole ? std::ldexp(1.0, static_cast<int>(8 * header.figure.bytes) - 1) : 1.0;
  std::vector<std::string> scaled;
  for (std::size_t c = 0; c < header.channels; ++c) {
    const std::string number = std::to_string(c + 1);
    std::string name = find(fields, "channel-" + number);
    if (name.empty()) name = "channel_" + number;
    const auto scale = scale_of(header, fields, name, number);
    labels.headings.push_back(name + std::string(scale ? " (g)" : own_unit));
    labels.factors.push_back(scale.value_or(full_scale) / full_scale);
    if (scale) scaled.push_back(fmt::format("{} ±{} g", name, in_words(*scale)));
    if (is_auxiliary(header, name)) labels.validity = c;
  }
  if (scaled.empty()) labels.validity.reset();
  if (!scaled.empty())
    labels.notes.push_back({Severity::info, fmt::format("full scale as the comment of the file "
                                                        "says: {}",
                                                        fmt::join(scaled, ", "))});
}

void note_scale(const Header& header, Labels& labels) {
  const std::size_t bits = 8 * header.figure.bytes;
  if (header.figure.kind == 'f') {
    labels.notes.push_back(
        {Severity::info, fmt::format("floating-point samples of {} bits, kept as they are: full "
                                     "scale is by custom ±1, without a unit",
                                     bits)});
    return;
  }
  std::string text = fmt::format("whole numbers of {} bits, kept as counts: ", bits);
  text += header.figure.kind == 'u'
              ? "0 to 255, of which 128 is silence"
              : fmt::format("full scale is ±{}", std::uint64_t{1} << (bits - 1));
  if (header.valid_bits < bits)
    text += fmt::format("; the topmost {} bits are the figure", header.valid_bits);
  labels.notes.push_back({Severity::info, text});
}

}  // namespace

Labels labels_of(const Header& header) {
  Labels labels;
  const Fields fields = fields_of(find(header.texts, "ICMT"));
  note_scale(header, labels);
  label_channels(header, fields, labels);
  labels.start_ns = instant_of(find(header.texts, "ICRD"));
  if (!labels.start_ns) labels.start_ns = instant_of(find(fields, "time"));
  std::string list;
  for (const auto& [name, text] : header.texts)
    if (const std::string words = shown(text); !words.empty() && list.size() < 400)
      list += fmt::format("{}{} \"{}\"", list.empty() ? "" : ", ", name, words);
  if (!list.empty()) labels.notes.push_back({Severity::info, "texts of the file: " + list});
  return labels;
}

}  // namespace proofmass::io::wav
