#include "proofmass/acquire/source.hpp"

#include <algorithm>
#include <ctime>
#include <fmt/format.h>

#include "proofmass/acquire/source_list.hpp"

namespace proofmass::acquire {

std::int64_t host_now_ns() {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return std::int64_t{now.tv_sec} * 1'000'000'000 + now.tv_nsec;
}

void Arrival::clear(std::size_t channel_count) {
  channels.resize(channel_count);
  for (std::vector<double>& channel : channels) channel.clear();
  device_ns.clear();
  lost_before = 0;
  first_count.reset();
  last_count.reset();
  host_ns = 0;
  notes.clear();
}

std::string shown_uri(const std::string& uri) {
  std::string out = uri;
  // The part of the place before an @ is a user name and password, whatever the scheme.
  const std::size_t at = out.find('@');
  const std::size_t place = out.find(':') + 1;
  if (at < out.find('?') && place > 0) {
    const std::size_t from = out.compare(place, 2, "//") == 0 ? place + 2 : place;
    if (at > from) out.replace(from, at - from, "…");
  }
  constexpr std::string_view key = "password=";
  for (std::size_t k = out.find(key); k != std::string::npos; k = out.find(key, k + 1)) {
    if (k == 0 || (out[k - 1] != '?' && out[k - 1] != '&')) continue;
    const std::size_t from = k + key.size();
    return out.substr(0, from) + "…" + out.substr(std::min(out.find('&', from), out.size()));
  }
  return out;
}

Result<std::unique_ptr<Source>> open_source(const std::string& text, const OpenOptions& options) {
  auto parsed = SourceUri::parse(text);
  if (!parsed) return parsed.error();
  SourceUri uri = std::move(parsed).value();
  std::string known;
  for (const SourceEntry& entry : source_entries()) {
    if (entry.kind.scheme == uri.scheme()) {
      auto source = entry.open(uri, options);
      if (!source) return source.error().at(shown_uri(text));
      return source;
    }
    known += (known.empty() ? "" : ", ") + entry.kind.scheme + ":";
  }
  return Error{Errc::invalid_argument,
               fmt::format("{}: no such kind of source; there are {}", text, known)};
}

std::vector<SourceKind> source_kinds() {
  std::vector<SourceKind> kinds;
  for (const SourceEntry& entry : source_entries()) kinds.push_back(entry.kind);
  return kinds;
}

}  // namespace proofmass::acquire
