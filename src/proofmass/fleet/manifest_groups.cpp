#include <algorithm>
#include <charconv>
#include <chrono>
#include <cmath>
#include <fmt/format.h>
#include <map>

#include "proofmass/fleet/manifest.hpp"

// Recordings that are analysed as one.
namespace proofmass::fleet {
namespace {

constexpr std::size_t of_day = 10;  // letters of "2026-11-25"

std::optional<double> number_in(std::string_view text) {
  double value = 0.0;
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  return error == std::errc() && stop == end ? std::optional(value) : std::nullopt;
}

// The digits of the seconds in "04:30:00.5" and what follows it.
std::string_view seconds_in(std::string_view time) {
  constexpr std::size_t before = 6;
  if (time.size() <= before || time[before - 1] != ':') return "0";
  time.remove_prefix(before);
  return time.substr(0, time.find_first_not_of("0123456789."));
}

// How far the zone's clock is ahead in "04:30:00+02:00"; 0 for "Z" and without a zone.
std::optional<double> zone_s(std::string_view time) {
  const std::size_t at = time.find_first_of("+-");
  if (at == std::string_view::npos) return 0.0;
  const std::string_view zone = time.substr(at + 1);
  const auto hours = number_in(zone.substr(0, 2));
  const auto minutes = number_in(zone.size() < 5 ? "0" : zone.substr(3, 2));
  if (!hours || !minutes) return std::nullopt;
  return (time[at] == '-' ? -1.0 : 1.0) * (*hours * 3600.0 + *minutes * 60.0);
}

void order_by_date(std::vector<const Job*>& members) {
  const auto date = [](const Job* job) { return day_of(manifest_field(job->columns, "date")); };
  if (std::ranges::all_of(members, [&](const Job* job) { return date(job).has_value(); }))
    std::ranges::stable_sort(members, {}, [&](const Job* job) { return *date(job); });
}

std::vector<double> starts_of(const std::vector<const Job*>& members) {
  constexpr double day_s = 86400.0;
  std::vector<double> starts_s;
  for (const Job* job : members) {
    const std::string_view date = manifest_field(job->columns, "date");
    const auto day = day_of(date);
    if (!day || date.size() <= of_day) return {};
    starts_s.push_back(*day * day_s);
  }
  const double first_s = starts_s.front();
  // To the millisecond, which is about what a day since 1970 resolves.
  for (double& start_s : starts_s) start_s = std::round((start_s - first_s) * 1e3) / 1e3;
  return starts_s;
}

Job group_of(const std::string& name, std::vector<const Job*> members) {
  order_by_date(members);
  Job group{.path = name, .flags = members.front()->flags, .columns = {}};
  for (const auto& [key, value] : members.front()->columns)
    if (key == "date" || std::ranges::all_of(members, [&](const Job* job) {
          return manifest_field(job->columns, key) == value;
        }))
      group.columns.emplace_back(key, value);
  for (const Job* job : members) group.parts.push_back(job->path);
  group.starts_s = starts_of(members);
  return group;
}

}  // namespace

std::optional<double> day_of(std::string_view date) {
  if (date.size() < of_day || date[4] != '-' || date[7] != '-') return std::nullopt;
  const auto part = [&](std::size_t from, std::size_t count) -> std::optional<double> {
    return date.size() < from + count ? std::optional(0.0) : number_in(date.substr(from, count));
  };
  const auto year = part(0, 4), month = part(5, 2), day = part(8, 2);
  const std::string_view time = date.substr(std::min(of_day + 1, date.size()));
  const auto hour = part(11, 2), minute = part(14, 2);
  const auto second = number_in(seconds_in(time)), ahead_s = zone_s(time);
  if (!year || !month || !day || !hour || !minute || !second || !ahead_s) return std::nullopt;
  const std::chrono::year_month_day named{std::chrono::year(static_cast<int>(*year)),
                                          std::chrono::month(static_cast<unsigned>(*month)),
                                          std::chrono::day(static_cast<unsigned>(*day))};
  if (!named.ok()) return std::nullopt;
  return static_cast<double>(std::chrono::sys_days(named).time_since_epoch().count()) +
         (*hour * 3600.0 + *minute * 60.0 + *second - *ahead_s) / 86400.0;
}

Result<std::vector<Job>> grouped_by(const std::vector<Job>& jobs, const std::string& column) {
  std::map<std::string, std::vector<const Job*>> members;
  for (const Job& job : jobs) {
    const std::string name(manifest_field(job.columns, column));
    if (name.empty())
      return Error{
          Errc::invalid_argument,
          fmt::format("{}: has no {}: give every recording one in the manifest", job.path, column)};
    auto& group = members[name];
    if (!group.empty() && group.front()->flags != job.flags)
      return Error{Errc::invalid_argument,
                   fmt::format("{} and {} are of {} {}, and have different flags",
                               group.front()->path, job.path, column, name)};
    group.push_back(&job);
  }
  std::vector<Job> groups;
  for (const auto& [name, of] : members) groups.push_back(group_of(name, of));
  return groups;
}

}  // namespace proofmass::fleet
