// The functions without which there is no driver, as National Instruments' C reference describes
// them.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <fmt/format.h>
#include <string>
#include <unistd.h>

#include "task.hpp"

using standin::Card;
using standin::Channel;
using standin::failed;
using standin::Fault;
using standin::Task;

namespace standin {
namespace {

thread_local std::string last_words;

std::int64_t now_ns() {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return std::int64_t{now.tv_sec} * 1'000'000'000 + now.tv_nsec;
}

void sleep_until(std::int64_t time_ns) {
  const timespec until{time_ns / 1'000'000'000, time_ns % 1'000'000'000};
  clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr);
}

/// Adds "Dev1/ai0".
std::int32_t add_channel(Task& task, const std::string& name, std::int32_t terminals, Range asked) {
  const std::size_t slash = name.find('/');
  const Card* const card = card_of(name.substr(0, slash));
  if (card == nullptr) return failed(-200220, "Device identifier is invalid: " + name);
  const std::string local = slash == std::string::npos ? "" : name.substr(slash + 1);
  if (local.size() != 3 || !local.starts_with("ai") || local[2] < '0' || local[2] > '7')
    return failed(-200170, "Physical channel does not exist on this device: " + name);
  const auto index = static_cast<unsigned>(local[2] - '0');
  const auto granted = granted_terminals(index, terminals);
  if (!granted)
    return failed(-200077,
                  "Requested value is not a supported value.\nProperty: AI.TermCfg\n"
                  "Channel: " +
                      name);
  const auto range = granted_range(*granted, asked.low, asked.high);
  if (!range)
    return failed(-200077, fmt::format("Requested value is not a supported value.\nProperty: "
                                       "AI.Max\nRequested value: {:g}\nChannel: {}",
                                       asked.high, name));
  task.card = card;
  task.channels.push_back({name, index, *granted, *range});
  return 0;
}

void copy_rows(Task& task, std::uint64_t count, double* into) {
  for (std::uint64_t r = 0; r < count; ++r, ++task.read)
    for (std::size_t c = 0; c < task.channels.size(); ++c) {
      const double time_s = static_cast<double>(task.read) / task.rate_hz +
                            static_cast<double>(c) / most_samples_per_s;
      *into++ = reading(task.channels[c], task.read, time_s);
    }
}

/// Rows that a reading may give before the card's fault comes.
std::uint64_t rows_before_fault(const Task& task) {
  switch (task.card->fault) {
    case Fault::buffer_overrun:
    case Fault::fifo_overflow:
      return task.is_fault_over ? UINT64_MAX : 200 - task.read;
    case Fault::unplugged:
      return 205 - task.read;
    case Fault::overruns_only:
      return 0;
    default:
      return UINT64_MAX;
  }
}

/// It ends the task.
std::int32_t fault_of(Task& task) {
  task.is_running = false;
  task.is_fault_over = true;
  task.taken = task.read + 50;
  if (task.card->fault == Fault::unplugged)
    return failed(-200045,
                  "Device is not available.  It was removed.\n\nTask Name: _unnamedTask<0>");
  if (task.card->fault == Fault::fifo_overflow)
    return failed(-200361, "Onboard device memory overflow.");
  return failed(-200279, "The application is not able to keep up with the acquisition.");
}

/// Waits until so many rows are there, or until the time is over: how many are.
std::uint64_t wait_for(Task& task, std::uint64_t rows, double timeout_s) {
  const std::int64_t deadline_ns = now_ns() + std::llround(timeout_s * 1e9);
  if (task.card->fault == Fault::silent) {
    sleep_until(deadline_ns);
    return 0;
  }
  const double due_s = static_cast<double>(task.read + rows) / task.rate_hz;
  const std::int64_t due_ns = task.start_ns + std::llround(std::ceil(due_s * 1e9)) + 1;
  sleep_until(std::min(due_ns, deadline_ns));
  const double passed_s = 1e-9 * static_cast<double>(now_ns() - task.start_ns);
  task.taken = std::max(task.read, static_cast<std::uint64_t>(passed_s * task.rate_hz));
  return std::min(rows, task.taken - task.read);
}

}  // namespace

std::int32_t failed(std::int32_t status, const std::string& words) {
  last_words = fmt::format("{}\nStatus Code: {}", words, status);
  return status;
}

std::int32_t give_text(const std::string& list, char* text, std::uint32_t size) {
  const auto needed = static_cast<std::uint32_t>(list.size() + 1);
  if (size == 0) return static_cast<std::int32_t>(needed);
  if (size < needed) return failed(-200228, "Buffer is too small to fit the string.");
  std::memcpy(text, list.c_str(), needed);
  return 0;
}

}  // namespace standin

extern "C" {

std::int32_t DAQmxGetExtendedErrorInfo(char* text, std::uint32_t size) {
  return standin::give_text(standin::last_words, text, size);
}

std::int32_t DAQmxGetSysDevNames(char* text, std::uint32_t size) {
  return standin::give_text("Dev1, Dev2", text, size);
}

std::int32_t DAQmxGetDevProductType(const char* device, char* text, std::uint32_t size) {
  if (standin::card_of(device) == nullptr) return failed(-200220, "Device identifier is invalid.");
  return standin::give_text("USB-6009", text, size);
}

std::int32_t DAQmxGetDevAIPhysicalChans(const char* device, char* text, std::uint32_t size) {
  if (standin::card_of(device) == nullptr) return failed(-200220, "Device identifier is invalid.");
  std::string list;
  for (unsigned k = 0; k < standin::inputs; ++k)
    list += fmt::format("{}{}/ai{}", k == 0 ? "" : ", ", device, k);
  return standin::give_text(list, text, size);
}

std::int32_t DAQmxCreateTask(const char*, void** task) {
  *task = new Task;
  return 0;
}

std::int32_t DAQmxClearTask(void* task) {
  delete static_cast<Task*>(task);
  return 0;
}

std::int32_t DAQmxCreateAIVoltageChan(void* handle,
                                      const char* physical,
                                      const char*,
                                      std::int32_t terminals,
                                      double lowest,
                                      double highest,
                                      std::int32_t units,
                                      const char*) {
  Task& task = *static_cast<Task*>(handle);
  if (units != 10348) return failed(-200077, "Requested value is not a supported value: units");
  const std::string list = physical;
  for (std::size_t from = 0; from < list.size();) {
    const std::size_t comma = std::min(list.find(", ", from), list.size());
    const std::int32_t status =
        standin::add_channel(task, list.substr(from, comma - from), terminals, {lowest, highest});
    if (status < 0) return status;
    from = comma + 2;
  }
  return 0;
}

std::int32_t DAQmxCfgSampClkTiming(void* handle,
                                   const char*,
                                   double rate_hz,
                                   std::int32_t edge,
                                   std::int32_t mode,
                                   std::uint64_t samples) {
  Task& task = *static_cast<Task*>(handle);
  if (edge != 10280 || mode != 10123)
    return failed(-200077, "Requested value is not a supported value: edge or mode");
  task.buffer_rows = samples;
  task.rate_hz = rate_hz;
  return 0;
}

std::int32_t DAQmxGetSampClkRate(void* handle, double* rate_hz) {
  Task& task = *static_cast<Task*>(handle);
  const double granted_hz = standin::granted_rate_hz(task.rate_hz, task.channels.size());
  if (granted_hz == 0.0)
    return failed(-200077, fmt::format("Requested value is not a supported value.\nProperty: "
                                       "SampClk.Rate\nRequested value: {:g}",
                                       task.rate_hz));
  task.rate_hz = granted_hz;
  *rate_hz = task.card->fault == Fault::wild_rate ? std::nan("") : granted_hz;
  return 0;
}

std::int32_t DAQmxStartTask(void* handle) {
  Task& task = *static_cast<Task*>(handle);
  if (task.card->fault == Fault::unreachable)
    return failed(-201003, "Device cannot be accessed.  It is no longer present in the system.");
  task.is_running = true;
  task.start_ns = standin::now_ns();
  task.taken = task.read = 0;
  return 0;
}

std::int32_t DAQmxStopTask(void* handle) {
  static_cast<Task*>(handle)->is_running = false;
  return 0;
}

std::int32_t DAQmxReadAnalogF64(void* handle,
                                std::int32_t rows,
                                double timeout_s,
                                std::uint32_t fill_mode,
                                double* into,
                                std::uint32_t size,
                                std::int32_t* rows_read,
                                std::uint32_t*) {
  Task& task = *static_cast<Task*>(handle);
  *rows_read = 0;
  if (fill_mode != 1 || rows < 1 || size / task.channels.size() < static_cast<std::uint32_t>(rows))
    return failed(-200229, "Buffer is too small to fit read data.");
  if (!task.is_running) return failed(-200286, "No acquisition was started.");
  while (task.card->fault == Fault::hangs) pause();
  const auto asked = static_cast<std::uint64_t>(rows);
  const std::uint64_t before_fault = standin::rows_before_fault(task);
  std::uint64_t there = standin::wait_for(task, std::min(asked, before_fault), timeout_s);
  if (task.taken - task.read > task.buffer_rows) {
    task.is_running = false;
    return failed(-200279, "The application is not able to keep up with the acquisition.");
  }
  if (task.card->fault == Fault::short_reads) there = std::min<std::uint64_t>(there, 60);
  standin::copy_rows(task, there, into);
  *rows_read = static_cast<std::int32_t>(there);
  if (there == asked) return 0;
  if (there == before_fault) return standin::fault_of(task);
  return failed(-200284, "Some or all of the samples requested have not yet been acquired.");
}

}  // extern "C"
