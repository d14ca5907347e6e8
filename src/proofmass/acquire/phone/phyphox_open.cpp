#include <cmath>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "proofmass/acquire/framing/words.hpp"
#include "proofmass/acquire/phone/advice.hpp"
#include "proofmass/acquire/phone/phyphox_source.hpp"
#include "proofmass/acquire/source_list.hpp"
#include "proofmass/acquire/stream/host_text.hpp"

namespace proofmass::acquire {
namespace {

using std::chrono::milliseconds;
using Clock = std::chrono::steady_clock;

constexpr unsigned short phyphox_port = 8080;

/// One request and its response while the source is opened.
class Opening {
 public:
  Opening(HttpClient& client, const OpenOptions& options)
      : client_(client), options_(options), until_(Clock::now() + options.patience) {}

  Result<std::string> ask(const std::string& target) {
    client_.ask(target);
    while (Clock::now() < until_) {
      if (options_.stopped && options_.stopped())
        return Error{Errc::device, "was stopped while it was opened"};
      auto answered = client_.answer(milliseconds(50));
      if (!answered) return phyphox_gone(answered.error());
      std::optional<HttpAnswer> answer = std::move(answered).value();
      if (!answer) continue;
      if (answer->status == 200) return std::move(answer->body);
      return phyphox_gone(
          {Errc::device, fmt::format("{} is answered with status {}", target, answer->status)});
    }
    return phyphox_gone(
        {Errc::device, fmt::format("no answer within {} ms", options_.patience.count())});
  }

 private:
  HttpClient& client_;
  const OpenOptions& options_;
  Clock::time_point until_;
};

std::vector<std::string> strings(const std::vector<std::string_view>& words) {
  return {words.begin(), words.end()};
}

/// Adds the request to the error of its response.
template <class Parsed>
Result<Parsed> placed(Result<Parsed> parsed, const char* where) {
  if (parsed) return parsed;
  return phyphox_gone({Errc::device, fmt::format("{} {}", where, parsed.error().message)});
}

/// Determines the ends of the buffers, so that earlier data are skipped; starts the measurement.
Result<PhyphoxStart> begin(Opening& phone, std::vector<PhyphoxGroup> groups) {
  std::vector<std::string> times;
  for (const PhyphoxGroup& group : groups) times.push_back(group.time);
  std::string target;
  for (const std::string& time : times)
    target += (target.empty() ? "/get?" : "&") + query_text(time);
  const auto text = phone.ask(target);
  if (!text) return text.error();
  PhyphoxReply reply;
  if (const Status read = parse_phyphox_reply(*text, times, reply); !read)
    return phyphox_gone({Errc::device, "/get " + read.error().message});
  PhyphoxStart start{.groups = std::move(groups), .cursors = {}, .session = reply.session};
  for (const auto& end : reply.buffers) {
    start.cursors.emplace_back();
    if (!end.empty() && std::isfinite(end.back())) start.cursors.back().start_behind(end.back());
  }
  if (reply.measuring) return start;
  const auto started = phone.ask("/control?cmd=start");
  if (!started) return started.error();
  const auto done = placed(parse_phyphox_result(*started), "/control");
  if (!done) return done.error();
  if (!*done)
    return Error{
        Errc::device,
        "the phone refuses to start the measurement: start it there, and read its message"};
  return start;
}

SourceHead head_of(const SourceUri& uri, const PhyphoxConfig& config, const PhyphoxStart& start) {
  SourceHead head{.recording = {}, .has_device_clock = true};
  head.recording.source = uri.text();
  head.recording.format = "phyphox";
  head.settings.emplace_back("experiment", config.title);
  for (const PhyphoxGroup& group : start.groups) {
    head.settings.emplace_back(group.sensor,
                               fmt::format("{} by {}", fmt::join(group.buffers, ", "), group.time));
    for (std::size_t k = 0; k < group.buffers.size(); ++k)
      head.recording.channels.push_back(
          {.name = group.buffers[k], .unit = group.units[k], .values = {}});
  }
  for (const PhyphoxConfig::Buffer& buffer : config.buffers)
    if (buffer.name == start.groups.front().time && buffer.rows > 0)
      head.settings.emplace_back("buffer", fmt::format("{} rows", buffer.rows));
  if (start.groups.size() > 1)
    head.settings.emplace_back(
        "rows",
        fmt::format("those of the {}; the others' values on the line between their neighbours",
                    start.groups.front().sensor));
  return head;
}

}  // namespace

Result<std::unique_ptr<Source>> open_phyphox(SourceUri& uri, const OpenOptions& options) {
  const std::string sensors = uri.value("sensors").value_or("");
  const std::string buffers = uri.value("buffers").value_or("");
  const PhyphoxWish wish{.sensors = strings(words_of(sensors, ", ")),
                         .buffers = strings(words_of(buffers, ", ")),
                         .time = uri.value("time").value_or("")};
  if (const Status known = uri.nothing_unknown(); !known) return known.error();
  auto place = parse_host_port(uri.place());
  if (!place) return place.error();
  HostPort server = std::move(place).value();
  if (!server.port) server.port = phyphox_port;
  auto client = std::make_unique<HttpClient>(std::move(server));
  Opening phone(*client, options);

  const auto text = phone.ask("/config");
  if (!text) return text.error();
  const auto config = placed(parse_phyphox_config(*text), "/config");
  if (!config) return config.error();
  auto groups = plan_phyphox(*config, wish);
  if (!groups) return groups.error();
  auto start = begin(phone, std::move(groups).value());
  if (!start) return start.error();
  SourceHead head = head_of(uri, *config, *start);
  // Older versions do not report the time.
  const auto times = phone.ask("/time");
  const auto zero_s = times ? parse_phyphox_time(*times) : std::optional<double>();
  if (zero_s && *zero_s)
    head.settings.emplace_back("experiment begun",
                               fmt::format("{:.3f} s since 1970, by the phone", **zero_s));
  return std::unique_ptr<Source>(std::make_unique<PhyphoxSource>(
      std::move(client), std::move(start).value(), std::move(head)));
}

}  // namespace proofmass::acquire
