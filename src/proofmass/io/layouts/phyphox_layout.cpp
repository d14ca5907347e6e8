#include <cmath>
#include <fmt/format.h>

#include "proofmass/io/archive/names.hpp"
#include "proofmass/io/cell.hpp"
#include "proofmass/io/layouts/layout.hpp"
#include "proofmass/io/names.hpp"
#include "proofmass/io/stamp_reader.hpp"
#include "proofmass/io/text/wording.hpp"

namespace proofmass::io {
namespace {

/// A line of time.csv: start or pause of the experiment.
struct Event {
  bool is_start = false;
  double experiment_s = 0.0;
  std::int64_t experiment_ns = 0;
  std::int64_t system_ns = 0;  ///< since 1970
};

/// A number in seconds as whole nanoseconds; nullopt if it is not a number.
std::optional<std::int64_t> ns_of(const std::string& field, char point) {
  StampReader reader(StampSpelling::figures, point);
  reader.read(field);
  if (!reader.origin()) return std::nullopt;
  return reader.origin()->ns(1.0);
}

std::optional<char> separator_of(std::string_view header) {
  for (const char separator : {',', ';', '\t'})
    if (lower(field_of(header, separator, 0)) == "event" &&
        lower(field_of(header, separator, 1)) == "experiment time")
      return separator;
  return std::nullopt;
}

/// The events of time.csv; none if the text is not such a file. The app uses the separator and
/// decimal mark chosen by its user.
std::vector<Event> events_of(std::string_view text) {
  std::vector<Event> events;
  const auto lines = lines_of(text);
  const auto separator = lines.empty() ? std::nullopt : separator_of(lines.front());
  if (!separator) return events;
  for (const std::string_view line : lines) {
    const std::string kind = field_of(line, *separator, 0);
    if (kind != "START" && kind != "PAUSE") continue;
    for (const char point : {'.', ','}) {
      if (point == *separator) continue;
      const auto experiment = ns_of(field_of(line, *separator, 1), point);
      const auto system = ns_of(field_of(line, *separator, 2), point);
      if (!experiment || !system) continue;
      events.push_back(
          {kind == "START", static_cast<double>(*experiment) * 1e-9, *experiment, *system});
      break;
    }
  }
  return events;
}

/// Information from the wall clock: the start, and pauses of the experiment.
void note_clock(const std::vector<Event>& events, MemberHint& hint) {
  if (events.empty() || !events.front().is_start) return;
  std::int64_t zero = 0;
  if (__builtin_sub_overflow(events.front().system_ns, events.front().experiment_ns, &zero)) return;
  hint.zero_ns = zero;
  hint.notes.push_back(
      {Severity::info, "the stamps begin where meta/time.csv has the START on the wall clock"});
  constexpr std::size_t most_noted = 20;
  for (std::size_t i = 1; i < events.size() && hint.notes.size() < most_noted; ++i) {
    const bool resumes = events[i].is_start && !events[i - 1].is_start;
    const double away_s = 1e-9 * (static_cast<double>(events[i].system_ns) -
                                  static_cast<double>(events[i - 1].system_ns)) -
                          (events[i].experiment_s - events[i - 1].experiment_s);
    constexpr double shortest_pause_s = 0.01;  // the two clocks differ by less than this
    if (resumes && std::abs(away_s) > shortest_pause_s)
      hint.notes.push_back(
          {Severity::warning,
           fmt::format("was paused at {} s for {} s of the wall clock, which the stamps leave out",
                       in_words(events[i - 1].experiment_s), in_words(away_s))});
  }
}

/// "phyphox 1.1.12 on Apple iPhone13,4 (release 17.2.1)"
std::string device_in(std::string_view text) {
  std::map<std::string, std::string> properties;
  for (const std::string_view line : lines_of(text))
    for (const char separator : {',', ';', '\t'})
      if (const std::string value = field_of(line, separator, 1); !value.empty())
        properties.try_emplace(field_of(line, separator, 0), plain_name(value).substr(0, 60));
  if (!properties.contains("deviceModel")) return {};
  std::string description = "phyphox";
  if (properties.contains("version")) description += " " + properties["version"];
  description += " on";
  if (properties.contains("deviceBrand")) description += " " + properties["deviceBrand"];
  description += " " + properties["deviceModel"];
  if (properties.contains("deviceRelease"))
    description += " (release " + properties["deviceRelease"] + ")";
  return description;
}

/// The folder whose recordings a metadata file describes: the one above "meta/".
std::string subject_of(std::string_view path) {
  std::string folder(folder_part(path));
  if (folder == "meta/") return {};
  if (folder.ends_with("/meta/")) folder.resize(folder.size() - 5);
  return folder;
}

}  // namespace

void read_phyphox_layout(Archive& archive, ArchiveLayout& layout) {
  const auto entries = archive.entries();
  for (std::size_t e = 0; e < entries.size(); ++e) {
    const std::string file = without_endings(file_part(entries[e].name));
    const bool is_time = file == "time";
    const bool is_device = file == "device" && folder_part(entries[e].name).ends_with("meta/");
    if (!is_time && !is_device) continue;
    const std::string text = text_of(archive, e);
    MemberHint found;
    if (is_time) note_clock(events_of(text), found);
    if (const std::string device = is_device ? device_in(text) : ""; !device.empty())
      found.notes.push_back({Severity::info, "recorded by " + device});
    if (found.notes.empty()) continue;
    layout[e].is_recording = false;
    for (std::size_t other = 0; other < entries.size(); ++other) {
      if (folder_part(entries[other].name) != subject_of(entries[e].name)) continue;
      MemberHint& hint = layout[other];
      if (found.zero_ns) hint.zero_ns = found.zero_ns;
      hint.notes.insert(hint.notes.end(), found.notes.begin(), found.notes.end());
    }
  }
}

}  // namespace proofmass::io
