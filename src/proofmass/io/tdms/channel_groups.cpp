#include "proofmass/io/tdms/channel_groups.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <string_view>

#include "proofmass/core/units.hpp"
#include "proofmass/io/csv/layout.hpp"
#include "proofmass/io/text/wording.hpp"

namespace proofmass::io::tdms {
namespace {

constexpr double longest_increment_s = 1e9;

/// The waveform properties of a channel.
struct Waveform {
  std::optional<double> increment_s;
  std::optional<double> rate_hz;
  std::optional<std::int64_t> start_ns;
};

bool is_read(const Object& object) {
  return object.has_index && !object.changes_kind && object.kind <= Kind::instant;
}

/// The rate whose period is `increment_s` to the last bit, an integer if there is one.
double rate_of(double increment_s) {
  const double rate_hz = 1.0 / increment_s;
  const double whole = std::round(rate_hz);
  return whole > 0.0 && 1.0 / whole == increment_s ? whole : rate_hz;
}

bool is_time_axis(const Properties& properties) {
  const std::string unit = text_of(properties, "wf_xunit_string");
  if (unit.empty()) return true;
  const auto parsed = parse_unit(unit);
  return parsed && parsed->quantity == Quantity::time && parsed->to_si == 1.0;
}

Waveform waveform_of(const Properties& properties) {
  Waveform waveform;
  if (const auto start = instant_of(properties, "wf_start_time")) {
    waveform.start_ns = start->unix_ns();
    const double offset_ns = 1e9 * number_of(properties, "wf_start_offset").value_or(0.0);
    if (waveform.start_ns && std::abs(offset_ns) < 1e18) {
      std::int64_t sum = 0;
      if (!__builtin_add_overflow(*waveform.start_ns, std::llround(offset_ns), &sum))
        waveform.start_ns = sum;
    }
  }
  const double increment_s = number_of(properties, "wf_increment").value_or(0.0);
  const bool is_step = increment_s > 1.0 / longest_increment_s && increment_s < longest_increment_s;
  if (!is_step || !is_time_axis(properties)) return waveform;
  waveform.increment_s = increment_s;
  // Our own files also contain the rate, whose inverse is the increment.
  const auto stated_hz = number_of(properties, "rate_hz");
  waveform.rate_hz =
      stated_hz && 1.0 / *stated_hz == increment_s ? *stated_hz : rate_of(increment_s);
  return waveform;
}

std::string heading_of(const Map& map, std::uint32_t channel) {
  const Object& object = map.objects[channel];
  const std::string name = object.name.empty() ? object.group : object.name;
  if (object.kind == Kind::instant) return name + " (s)";
  std::string unit = text_of(object.properties, "unit_string");
  if (unit.empty()) unit = text_of(object.properties, "NI_UnitDescription");
  // The unit is that of the scaled values.
  if (!scaling_of(map, channel)) unit.clear();
  const bool has_unit = name.ends_with("(" + unit + ")") || name.ends_with("[" + unit + "]");
  return unit.empty() || has_unit ? name : fmt::format("{} ({})", name, unit);
}

/// A table, and the properties that its channels must share.
struct Draft {
  Group group;
  std::uint64_t promised = 0;
  Waveform waveform;

  [[nodiscard]] bool takes(const Object& object,
                           const Waveform& other,
                           const std::string& group_name) const {
    if (group_name != group.name || object.promised != promised) return false;
    if (!waveform.increment_s || !other.increment_s) return true;
    if (*waveform.increment_s != *other.increment_s) return false;
    if (!waveform.start_ns || !other.start_ns) return true;
    // Channels of one task may have started a fraction of a period apart.
    const double apart_s = 1e-9 * std::abs(static_cast<double>(*waveform.start_ns) -
                                           static_cast<double>(*other.start_ns));
    return apart_s < 0.5 * *waveform.increment_s;
  }
};

void add(Draft& draft, const Map& map, std::uint32_t channel, const Waveform& waveform) {
  const Object& object = map.objects[channel];
  if (!draft.waveform.increment_s) draft.waveform.increment_s = waveform.increment_s;
  if (!draft.waveform.rate_hz) draft.waveform.rate_hz = waveform.rate_hz;
  if (!draft.waveform.start_ns) draft.waveform.start_ns = waveform.start_ns;
  draft.group.channels.push_back(channel);
  draft.group.headings.push_back(heading_of(map, channel));
  draft.group.rows = std::max(draft.group.rows, object.values);
}

/// Timestamps, or else seconds since a start given by the channel itself.
std::optional<std::size_t> time_column_of(const Map& map, const Group& group) {
  for (std::size_t c = 0; c < group.channels.size(); ++c)
    if (map.objects[group.channels[c]].kind == Kind::instant) return c;
  for (std::size_t c = 0; c < group.channels.size(); ++c) {
    const Properties& properties = map.objects[group.channels[c]].properties;
    const auto unit = parse_unit(text_of(properties, "unit_string"));
    const auto start = instant_of(properties, "wf_start_time");
    if (unit && unit->quantity == Quantity::time && unit->to_si == 1.0 && start &&
        start->unix_ns() && !number_of(properties, "wf_increment"))
      return c;
  }
  return std::nullopt;
}

void note_short_channels(const Map& map, Group& group) {
  std::string names;
  std::size_t count = 0;
  for (const std::uint32_t channel : group.channels) {
    const Object& object = map.objects[channel];
    if (object.values == group.rows) continue;
    constexpr std::size_t most_named = 5;
    if (++count <= most_named)
      names += fmt::format("{}{} {}", names.empty() ? "" : ", ", object.name, object.values);
  }
  if (count > 0)
    group.notes.push_back(
        {Severity::bad,
         fmt::format("{} of {} channels end before the others' {} values ({}{}): the rest is NaN",
                     count, group.channels.size(), group.rows, names, count > 5 ? ", …" : "")});
}

Group finished(const Map& map, Draft draft) {
  Group& group = draft.group;
  group.rate_hz = draft.waveform.rate_hz;
  group.start_ns = draft.waveform.start_ns;
  group.time_column = time_column_of(map, group);
  note_short_channels(map, group);
  if (group.channels.size() > most_columns) {
    group.notes.push_back({Severity::warning, fmt::format("{} channels: the first {} are read",
                                                          group.channels.size(), most_columns)});
    group.channels.resize(most_columns);
    group.headings.resize(most_columns);
    if (group.time_column && *group.time_column >= most_columns) group.time_column.reset();
  }
  return group;
}

/// Gives tables of one group distinct names by rate, else by length, else by number.
void name_apart(std::vector<Group>& groups) {
  const auto is_taken = [&](const std::string& name, std::size_t self) {
    for (std::size_t i = 0; i < groups.size(); ++i)
      if (i != self && groups[i].name == name) return true;
    return false;
  };
  std::vector<std::size_t> alike;
  for (std::size_t i = 0; i < groups.size(); ++i)
    if (is_taken(groups[i].name, i)) alike.push_back(i);
  std::vector<std::string> names;
  names.reserve(alike.size());
  for (const std::size_t i : alike)
    names.push_back(groups[i].rate_hz
                        ? fmt::format("{} {} Hz", groups[i].name, in_words(*groups[i].rate_hz))
                        : fmt::format("{} {} values", groups[i].name, groups[i].rows));
  for (std::size_t k = 0; k < alike.size(); ++k) {
    const bool again = std::ranges::count(names, names[k]) > 1;
    groups[alike[k]].name = again ? fmt::format("{} #{}", names[k], k + 1) : names[k];
  }
}

/// "remarks (text, 12 values)"
std::string described(const Object& object) {
  std::string what = "changes its type";
  if (!object.changes_kind) what = object.kind == Kind::text ? "text" : words_for_type(object.type);
  return fmt::format("{} ({}, {} values)", object.name.empty() ? object.group : object.name, what,
                     object.values);
}

}  // namespace

Result<std::optional<Scaling>> scaling_of(const Map& map, std::uint32_t channel) {
  const Object& object = map.objects[channel];
  const std::vector<std::uint32_t> scalers = scalers_of(map, channel);
  const Properties* const said[]{&object.properties, &map.properties_of(object.group),
                                 &map.properties_of("")};
  for (const Properties* properties : said)
    if (properties->contains("NI_Number_Of_Scales")) return Scaling::of(*properties, scalers);
  return std::optional<Scaling>{};
}

std::vector<std::uint32_t> scalers_of(const Map& map, std::uint32_t channel) {
  std::vector<std::uint32_t> scalers;
  for (const Layout& layout : map.layouts) {
    const auto entries = layout.of(channel);
    if (entries.empty()) continue;
    if (layout.is_daqmx)
      for (const Entry& entry : entries) scalers.push_back(entry.scaler);
    break;
  }
  return scalers;
}

std::vector<Group> group_channels(const Map& map) {
  // A file with more tables does not contain measurements.
  constexpr std::size_t most_tables = 1024;
  std::vector<Draft> drafts;
  for (std::uint32_t i = 0; i < map.objects.size(); ++i) {
    const Object& object = map.objects[i];
    if (!is_read(object) || object.promised == 0) continue;
    const Waveform waveform = waveform_of(object.properties);
    auto draft = std::ranges::find_if(
        drafts, [&](const Draft& one) { return one.takes(object, waveform, object.group); });
    if (draft == drafts.end()) {
      if (drafts.size() == most_tables) break;
      drafts.emplace_back();
      draft = drafts.end() - 1;
      draft->group.name = object.group;
      draft->promised = object.promised;
    }
    add(*draft, map, i, waveform);
  }
  std::vector<Group> groups;
  for (Draft& draft : drafts)
    if (draft.group.rows > 0) groups.push_back(finished(map, std::move(draft)));
  name_apart(groups);
  return groups;
}

std::vector<Note> notes_on_unread(const Map& map) {
  constexpr std::size_t most_named = 8;
  std::string list;
  std::size_t count = 0;
  for (const Object& object : map.objects) {
    if (!object.has_index || is_read(object)) continue;
    if (++count > most_named) continue;
    if (!list.empty()) list += ", ";
    list += described(object);
  }
  if (count == 0) return {};
  if (count > most_named) list += fmt::format(" and {} more", count - most_named);
  return {{Severity::warning, "not read: " + list}};
}

}  // namespace proofmass::io::tdms
