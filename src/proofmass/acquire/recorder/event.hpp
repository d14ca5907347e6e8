#pragma once

#include <cstdint>
#include <string>

#include "proofmass/core/recording_log.hpp"

namespace proofmass::acquire {

/// Simultaneous values of the host's two clocks.
struct HostTimes {
  std::int64_t steady_ns = 0;    ///< host_now_ns()
  std::int64_t realtime_ns = 0;  ///< time of day, since 1970, UTC
};
[[nodiscard]] HostTimes host_times_now();

/// An event in the format of the topic "events", its time counted from `origin_s`.
[[nodiscard]] std::string json_of(const RecordEvent& event, double origin_s, const HostTimes& now);
/// One message of the topic "clock": a row of the recording and its arrival time.
[[nodiscard]] std::string clock_json(double time_s, const HostTimes& arrived);

}  // namespace proofmass::acquire
