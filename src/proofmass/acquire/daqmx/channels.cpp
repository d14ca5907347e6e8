#include "proofmass/acquire/daqmx/channels.hpp"

#include <algorithm>
#include <charconv>
#include <fmt/format.h>
#include <optional>

namespace proofmass::acquire {
namespace {

constexpr std::size_t most_channels = 512;

Error bad(std::string_view text, std::string_view what) {
  return {
      Errc::invalid_argument,
      fmt::format("\"{}\": {}; expected channels such as Dev1/ai0:5 or Dev1/ai0,ai2", text, what)};
}

/// A number that makes up the entire text.
std::optional<unsigned> number_of(std::string_view text) {
  unsigned number = 0;
  const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (problem != std::errc{} || end != text.data() + text.size() || number > 99'999)
    return std::nullopt;
  return number;
}

/// "ai0:2" of the given device.
Status add_range(std::string_view text, const std::string& device, std::vector<std::string>& out) {
  const std::size_t colon = text.find(':');
  const std::string_view first = text.substr(0, colon);
  const std::string_view stem = first.substr(0, first.find_last_not_of("0123456789") + 1);
  const auto from = number_of(first.substr(stem.size()));
  if (!from || stem.empty()) return bad(text, "no channel");
  auto to = from;
  if (colon != std::string_view::npos) {
    std::string_view last = text.substr(colon + 1);
    if (last.starts_with(stem)) last.remove_prefix(stem.size());
    to = number_of(last);
    if (!to) return bad(text, "no number after the colon");
  }
  const unsigned count = (*from > *to ? *from - *to : *to - *from) + 1;
  if (out.size() + count > most_channels)
    return bad(text, fmt::format("more than {} channels", most_channels));
  for (unsigned k = 0; k < count; ++k)
    out.push_back(fmt::format("{}/{}{}", device, stem, *from > *to ? *from - k : *from + k));
  return Done{};
}

std::string_view trimmed(std::string_view text) {
  text.remove_prefix(std::min(text.find_first_not_of(' '), text.size()));
  return text.substr(0, text.find_last_not_of(' ') + 1);
}

}  // namespace

Result<std::vector<std::string>> daqmx_channels(std::string_view text) {
  std::vector<std::string> channels;
  std::string device;
  for (std::size_t from = 0; from <= text.size();) {
    const std::size_t comma = std::min(text.find(',', from), text.size());
    std::string_view part = trimmed(text.substr(from, comma - from));
    from = comma + 1;
    if (const std::size_t slash = part.rfind('/'); slash != std::string_view::npos) {
      device = part.substr(0, slash);
      part.remove_prefix(slash + 1);
    }
    if (device.empty()) return bad(text, "no device");
    if (const Status added = add_range(part, device, channels); !added) return added.error();
  }
  std::vector<std::string> sorted = channels;
  std::ranges::sort(sorted);
  if (const auto twice = std::ranges::adjacent_find(sorted); twice != sorted.end())
    return bad(text, *twice + " is there twice");
  return channels;
}

std::string daqmx_device_of(const std::string& channel) {
  return channel.substr(0, channel.rfind('/'));
}

std::vector<std::string> daqmx_names(const std::vector<std::string>& channels) {
  std::vector<std::string> names = channels;
  const std::string device = daqmx_device_of(channels.front()) + "/";
  if (std::ranges::all_of(channels, [&](const std::string& c) { return c.starts_with(device); }))
    for (std::string& name : names) name.erase(0, device.size());
  return names;
}

}  // namespace proofmass::acquire
