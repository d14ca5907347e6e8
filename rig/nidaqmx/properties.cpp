// What a driver may lack.
#include <algorithm>
#include <string_view>

#include "task.hpp"

using standin::Channel;
using standin::failed;
using standin::Task;

namespace {

/// nullptr: the task has no such channel.
const Channel* channel_of(void* handle, const char* name) {
  const Task& task = *static_cast<const Task*>(handle);
  const auto found = std::ranges::find(task.channels, std::string_view(name), &Channel::name);
  return found != task.channels.end() ? &*found : nullptr;
}

}  // namespace

extern "C" {

std::int32_t DAQmxGetAIRngLow(void* task, const char* name, double* volts) {
  const Channel* const channel = channel_of(task, name);
  if (channel == nullptr) return failed(-200087, "Channel does not exist in the task.");
  *volts = channel->range.low;
  return 0;
}

std::int32_t DAQmxGetAIRngHigh(void* task, const char* name, double* volts) {
  const Channel* const channel = channel_of(task, name);
  if (channel == nullptr) return failed(-200087, "Channel does not exist in the task.");
  *volts = channel->range.high;
  return 0;
}

std::int32_t DAQmxGetAITermCfg(void* task, const char* name, std::int32_t* terminals) {
  const Channel* const channel = channel_of(task, name);
  if (channel == nullptr) return failed(-200087, "Channel does not exist in the task.");
  *terminals = channel->terminals;
  return 0;
}

std::int32_t DAQmxGetAIConvRate(void*, double* rate_hz) {
  *rate_hz = standin::most_samples_per_s;
  return 0;
}

std::int32_t DAQmxGetReadTotalSampPerChanAcquired(void* handle, std::uint64_t* samples) {
  *samples = static_cast<const Task*>(handle)->taken;
  return 0;
}

std::int32_t DAQmxGetDevAIVoltageRngs(const char*, double* volts, std::uint32_t size) {
  const auto ranges = standin::ranges();
  if (size == 0) return static_cast<std::int32_t>(2 * ranges.size());
  if (size < 2 * ranges.size()) return failed(-200229, "Buffer is too small to fit read data.");
  for (const standin::Range& range : ranges) {
    *volts++ = range.low;
    *volts++ = range.high;
  }
  return 0;
}

std::int32_t DAQmxGetDevAIMaxMultiChanRate(const char*, double* rate_hz) {
  *rate_hz = standin::most_samples_per_s;
  return 0;
}

}  // extern "C"
