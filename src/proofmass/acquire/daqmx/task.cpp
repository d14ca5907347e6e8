#include "proofmass/acquire/daqmx/task.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <functional>
#include <string_view>

#include "proofmass/acquire/daqmx/channels.hpp"

namespace proofmass::acquire {
namespace {

// Constants and codes of the driver; see daqmx/library.hpp for the source.
constexpr std::int32_t volts = 10348;
constexpr std::int32_t rising_edge = 10280;
constexpr std::int32_t continuous_samples = 10123;
constexpr std::uint32_t group_by_scan_number = 1;
constexpr std::int32_t samples_not_yet_available = -200284;
/// SamplesNoLongerAvailable, AcqStoppedToPreventInputBufferOverwrite, InputFIFOOverflow 1, 2, 3.
constexpr std::array<std::int32_t, 5> overruns{-200279, -200222, -200010, -200361, -209829};

struct Terminals {
  std::string_view word;
  std::int32_t value;
};
constexpr std::array<Terminals, 5> all_terminals{
    {{"default", -1}, {"rse", 10083}, {"nrse", 10078}, {"diff", 10106}, {"pseudodiff", 12529}}};

std::string word_of(std::int32_t terminals) {
  const auto known = std::ranges::find(all_terminals, terminals, &Terminals::value);
  return known != all_terminals.end() ? std::string(known->word) : std::to_string(terminals);
}

std::string range_of(double lowest_v, double highest_v) {
  return lowest_v == -highest_v ? fmt::format("±{:g} V", highest_v)
                                : fmt::format("{:g} … {:g} V", lowest_v, highest_v);
}

Error refused(const std::string& words, const std::string& advice) {
  return {Errc::device, words + (advice.empty() ? "" : "; " + advice)};
}

/// "Dev1 (USB-6009) has Dev1/ai0, …, in the ranges ±5 V, ±10 V", or the available devices.
std::string advice_on_channels(const DaqmxCalls& calls, const std::string& device) {
  const auto channels = daqmx_channels_of(calls, device);
  if (channels.empty()) {
    const auto devices = daqmx_devices(calls);
    return devices.empty() ? "the driver has no device"
                           : fmt::format("there are {}", fmt::join(devices, ", "));
  }
  std::string text = fmt::format("{} ({}) has {}", device, daqmx_product(calls, device),
                                 fmt::join(daqmx_names(channels), ", "));
  std::array<double, 64> limits{};
  if (calls.get_dev_ai_voltage_rngs == nullptr ||
      calls.get_dev_ai_voltage_rngs(device.c_str(), limits.data(), limits.size()) < 0)
    return text;
  std::vector<std::string> ranges;
  for (std::size_t k = 0; k < limits.size() && limits[k] < limits[k + 1]; k += 2)
    ranges.push_back(range_of(limits[k], limits[k + 1]));
  return text + fmt::format(" in the ranges {}; see terminal= too", fmt::join(ranges, ", "));
}

std::string advice_on_rate(const DaqmxCalls& calls, const std::string& device) {
  double most_hz = 0.0;
  if (calls.get_dev_ai_max_multi_chan_rate == nullptr ||
      calls.get_dev_ai_max_multi_chan_rate(device.c_str(), &most_hz) < 0)
    return "request a lower rate=";
  return fmt::format(
      "{} takes {:g} samples a second at most, which the channels share where it "
      "takes them one by one",
      device, most_hz);
}

/// The values of the channels, written once if all are the same.
std::string of_each(const std::vector<std::string>& channels,
                    const std::function<std::optional<std::string>(const char*)>& word) {
  std::vector<std::string> all;
  for (const std::string& channel : channels) {
    const auto said = word(channel.c_str());
    if (!said) return {};
    all.push_back(*said);
  }
  if (std::ranges::all_of(all, [&](const std::string& one) { return one == all.front(); }))
    return all.front();
  const auto names = daqmx_names(channels);
  for (std::size_t c = 0; c < all.size(); ++c) all[c] = names[c] + " " + all[c];
  return fmt::format("{}", fmt::join(all, ", "));
}

}  // namespace

DaqmxTask::~DaqmxTask() {
  if (task_ != nullptr) calls_->clear_task(task_);
}

Result<std::unique_ptr<DaqmxTask>> DaqmxTask::start(std::shared_ptr<const DaqmxCalls> calls,
                                                    const DaqmxRequest& request) {
  std::unique_ptr<DaqmxTask> task(new DaqmxTask(std::move(calls)));
  if (const std::int32_t status = task->calls_->create_task("", &task->task_); status < 0)
    return refused(task->calls_->words(status), "");
  if (const Status added = task->add_channels(request); !added) return added.error();
  if (const Status set = task->set_clock(request); !set) return set.error();
  if (const std::int32_t status = task->calls_->start_task(task->task_); status < 0)
    return refused(task->calls_->words(status),
                   advice_on_rate(*task->calls_, daqmx_device_of(request.channels.front())));
  return task;
}

Status DaqmxTask::add_channels(const DaqmxRequest& request) {
  channels_ = request.channels;
  const auto terminals =
      std::ranges::find(all_terminals, std::string_view(request.terminals), &Terminals::word);
  PM_EXPECTS(terminals != all_terminals.end());
  const std::string list = fmt::format("{}", fmt::join(channels_, ", "));
  const std::int32_t status =
      calls_->create_ai_voltage_chan(task_, list.c_str(), "", terminals->value, request.lowest_v,
                                     request.highest_v, volts, nullptr);
  if (status >= 0) return Done{};
  return refused(calls_->words(status),
                 advice_on_channels(*calls_, daqmx_device_of(channels_.front())));
}

Status DaqmxTask::set_clock(const DaqmxRequest& request) {
  // The driver buffers ten seconds while nobody reads.
  const auto buffer = static_cast<std::uint64_t>(std::clamp(10.0 * request.rate_hz, 1e3, 1e7));
  std::int32_t status = calls_->cfg_samp_clk_timing(task_, "", request.rate_hz, rising_edge,
                                                    continuous_samples, buffer);
  if (status >= 0) status = calls_->get_samp_clk_rate(task_, &rate_hz_);
  if (status < 0)
    return refused(calls_->words(status),
                   advice_on_rate(*calls_, daqmx_device_of(channels_.front())));
  constexpr double most_hz = 1e9;
  if (!(rate_hz_ > 0.0 && rate_hz_ <= most_hz))
    return refused(fmt::format("the driver granted a rate of {:g} Hz, which cannot be", rate_hz_),
                   "");
  return Done{};
}

std::vector<std::pair<std::string, std::string>> DaqmxTask::settings(
    const DaqmxRequest& request) const {
  const std::string device = daqmx_device_of(channels_.front());
  std::vector<std::pair<std::string, std::string>> all{
      {"device", fmt::format("{} ({})", daqmx_product(*calls_, device), device)},
      {"rate asked", fmt::format("{:.10g} Hz", request.rate_hz)},
      {"rate granted", fmt::format("{:.10g} Hz", rate_hz_)},
      {"range asked", range_of(request.lowest_v, request.highest_v)},
      {"range granted", of_each(channels_,
                                [&](const char* channel) -> std::optional<std::string> {
                                  double low = 0.0;
                                  double high = 0.0;
                                  if (calls_->get_ai_rng_low == nullptr ||
                                      calls_->get_ai_rng_high == nullptr ||
                                      calls_->get_ai_rng_low(task_, channel, &low) < 0 ||
                                      calls_->get_ai_rng_high(task_, channel, &high) < 0)
                                    return std::nullopt;
                                  return range_of(low, high);
                                })},
      {"terminals asked", request.terminals},
      {"terminals granted",
       of_each(channels_, [&](const char* channel) -> std::optional<std::string> {
         std::int32_t terminals = 0;
         if (calls_->get_ai_term_cfg == nullptr ||
             calls_->get_ai_term_cfg(task_, channel, &terminals) < 0)
           return std::nullopt;
         return word_of(terminals);
       })}};
  double convert_hz = 0.0;
  if (channels_.size() > 1 && calls_->get_ai_conv_rate != nullptr &&
      calls_->get_ai_conv_rate(task_, &convert_hz) >= 0 && convert_hz > 0.0)
    all.emplace_back("channel skew", fmt::format("{:.4g} us", 1e6 / convert_hz));
  std::erase_if(all, [](const auto& setting) { return setting.second.empty(); });
  return all;
}

DaqmxReading DaqmxTask::read(std::size_t rows, std::vector<double>& into) {
  constexpr double timeout_s = 0.1;
  into.resize(rows * channels_.size());
  std::int32_t count = 0;
  const std::int32_t status = calls_->read_analog_f64(
      task_, static_cast<std::int32_t>(rows), timeout_s, group_by_scan_number, into.data(),
      static_cast<std::uint32_t>(into.size()), &count, nullptr);
  DaqmxReading reading;
  // Data received before a failure are included.
  reading.rows = std::min(rows, static_cast<std::size_t>(std::max(count, 0)));
  rows_read_ += reading.rows;
  if (status == samples_not_yet_available || status == 0) return reading;
  if (status > 0) {
    if (std::exchange(warning_, status) != status) reading.words = calls_->words(status);
    return reading;
  }
  reading.words = calls_->words(status);
  reading.state = std::ranges::find(overruns, status) != overruns.end()
                      ? DaqmxReading::State::overrun
                      : DaqmxReading::State::failed;
  return reading;
}

std::optional<std::uint64_t> DaqmxTask::unread() const {
  std::uint64_t taken = 0;
  if (calls_->get_read_total_samp_per_chan_acquired == nullptr ||
      calls_->get_read_total_samp_per_chan_acquired(task_, &taken) < 0 || taken < rows_read_)
    return std::nullopt;
  return taken - rows_read_;
}

Status DaqmxTask::start_anew() {
  // Stopping repeats the error that reading reported already.
  (void)calls_->stop_task(task_);
  rows_read_ = 0;
  if (const std::int32_t status = calls_->start_task(task_); status < 0)
    return refused(calls_->words(status), "");
  return Done{};
}

}  // namespace proofmass::acquire
