#include "proofmass/acquire/recorder/event.hpp"

#include <array>
#include <ctime>
#include <nlohmann/json.hpp>

#include "proofmass/acquire/source.hpp"

namespace proofmass::acquire {
namespace {

using Json = nlohmann::ordered_json;

/// Invalid UTF-8 is replaced, because texts come from devices.
std::string text_of(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

const char* name_of_severity(Severity severity) {
  constexpr std::array names{"info", "warning", "bad"};
  return names[static_cast<std::size_t>(severity)];
}

}  // namespace

HostTimes host_times_now() {
  timespec now{};
  clock_gettime(CLOCK_REALTIME, &now);
  return {host_now_ns(), std::int64_t{now.tv_sec} * 1'000'000'000 + now.tv_nsec};
}

std::string json_of(const RecordEvent& event, double origin_s, const HostTimes& now) {
  return text_of({{"time_s", event.time_s - origin_s},
                  {"duration_s", event.duration_s},
                  {"host_ns", now.steady_ns},
                  {"realtime_ns", now.realtime_ns},
                  {"kind", name_of(event.kind)},
                  {"severity", name_of_severity(event.severity)},
                  {"rows", event.rows},
                  {"text", event.text}});
}

std::string clock_json(double time_s, const HostTimes& arrived) {
  return text_of(
      {{"time_s", time_s}, {"host_ns", arrived.steady_ns}, {"realtime_ns", arrived.realtime_ns}});
}

}  // namespace proofmass::acquire
