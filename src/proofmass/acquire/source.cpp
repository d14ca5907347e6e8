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
  host_ns = 0;
  notes.clear();
}

std::string shown_uri(const std::string& uri) {
  constexpr std::string_view key = "password=";
  for (std::size_t at = uri.find(key); at != std::string::npos; at = uri.find(key, at + 1)) {
    if (at == 0 || (uri[at - 1] != '?' && uri[at - 1] != '&')) continue;
    const std::size_t from = at + key.size();
    return uri.substr(0, from) + "…" + uri.substr(std::min(uri.find('&', from), uri.size()));
  }
  return uri;
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
