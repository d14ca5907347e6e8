#include "proofmass/acquire/iio/timing.hpp"

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <fmt/format.h>
#include <string_view>

#include "proofmass/acquire/iio/handle.hpp"

namespace proofmass::acquire {
namespace {

constexpr const char* rate_attribute = "sampling_frequency";

struct ChosenTrigger {
  const iio_device* device = nullptr;
  std::string refusals{};  // "t0: Invalid argument"
};

Error refused(const iio_device* device, const iio_device* trigger, int code) {
  const std::string name = iio_name(device), other = iio_name(trigger);
  if (code == -EBUSY)
    return {Errc::device,
            fmt::format("trigger {}: {} is being read: stop the reader; if there is none, one "
                        "that died left its buffer enabled: write 0 to its buffer/enable",
                        other, name)};
  return {Errc::device,
          fmt::format("{} refuses the trigger {} ({}): its driver takes no trigger but its own; "
                      "leave trigger= out, or choose another device",
                      name, other, iio_reason(code))};
}

const iio_device* current_trigger(const iio_device* device) {
  const iio_device* trigger = nullptr;
  return iio_device_get_trigger(device, &trigger) >= 0 ? trigger : nullptr;
}

Result<ChosenTrigger> set_named(const iio_context* context,
                                const iio_device* device,
                                const std::string& wanted) {
  const iio_device* const trigger = iio_context_find_device(context, wanted.c_str());
  if (trigger == nullptr || !iio_device_is_trigger(trigger))
    return Error{Errc::invalid_argument, fmt::format("trigger={}: no such trigger; there are: {}",
                                                     wanted, list_of(iio_devices(context, true)))};
  // A program that died while reading leaves the buffer enabled; then no trigger can be set.
  if (trigger == current_trigger(device)) return ChosenTrigger{trigger};
  const int code = iio_device_set_trigger(device, trigger);
  if (code < 0) return refused(device, trigger, code);
  return ChosenTrigger{trigger};
}

Result<ChosenTrigger> set_trigger(const iio_context* context,
                                  const iio_device* device,
                                  const std::string& wanted) {
  if (!wanted.empty()) return set_named(context, device, wanted);
  ChosenTrigger chosen{current_trigger(device)};
  if (chosen.device != nullptr) return chosen;
  for (const iio_device* const trigger : iio_devices(context, true)) {
    const int code = iio_device_set_trigger(device, trigger);
    if (code == -EBUSY) return refused(device, trigger, code);
    if (code >= 0) return ChosenTrigger{trigger};
    chosen.refusals += fmt::format("{}{}: {}", chosen.refusals.empty() ? "" : ", ",
                                   iio_name(trigger), iio_reason(code));
  }
  return chosen;
}

std::vector<double> numbers_in(std::string_view text) {
  std::vector<double> numbers;
  while (!text.empty()) {
    double number = 0.0;
    const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (problem == std::errc{}) numbers.push_back(number);
    text.remove_prefix(std::max<std::size_t>(static_cast<std::size_t>(end - text.data()), 1));
  }
  return numbers;
}

// The rate of a device is its own attribute or one of its channels'.
std::optional<std::string> own_text(iio_device* device, const char* attribute) {
  if (auto text = iio_text(device, attribute)) return text;
  for (unsigned k = 0; k < iio_device_get_channels_count(device); ++k)
    if (auto text = iio_text(iio_device_get_channel(device, k), attribute)) return text;
  return std::nullopt;
}

double own_rate(iio_device* device) {
  const std::vector<double> numbers = numbers_in(own_text(device, rate_attribute).value_or(""));
  return numbers.empty() ? 0.0 : numbers.front();
}

long write_own_rate(iio_device* device, const std::string& rate) {
  if (iio_device_find_attr(device, rate_attribute) != nullptr)
    return iio_device_attr_write(device, rate_attribute, rate.c_str());
  for (unsigned k = 0; k < iio_device_get_channels_count(device); ++k) {
    iio_channel* const channel = iio_device_get_channel(device, k);
    if (iio_channel_find_attr(channel, rate_attribute) != nullptr)
      return iio_channel_attr_write(channel, rate_attribute, rate.c_str());
  }
  return -ENOENT;
}

Status ask_rate(iio_device* timer, double rate_hz) {
  const long code = write_own_rate(timer, fmt::format("{}", rate_hz));
  if (code >= 0) return Done{};
  const auto there = own_text(timer, "sampling_frequency_available");
  if (code == -ENOENT)
    return Error{Errc::device, fmt::format("rate={}: the rate cannot be set: {} has none", rate_hz,
                                           iio_name(timer))};
  return Error{Errc::device, fmt::format("rate={}: {} refuses it ({}){}", rate_hz, iio_name(timer),
                                         iio_reason(code), there ? "; it takes " + *there : "")};
}

// A chip that converts more slowly than it is read repeats each value.
void keep_up(iio_device* device, IioTiming& timing) {
  if (own_rate(device) >= timing.rate_hz || timing.rate_hz <= 0.0) return;
  std::vector<double> there =
      numbers_in(own_text(device, "sampling_frequency_available").value_or(""));
  std::ranges::sort(there);
  for (const double rate_hz : there)
    if (rate_hz >= timing.rate_hz && write_own_rate(device, fmt::format("{}", rate_hz)) >= 0) break;
  const double own = own_rate(device);
  if (own > 0.0)
    timing.settings.emplace_back("rate of the device itself", fmt::format("{} Hz", own));
  if (own > 0.0 && own < timing.rate_hz)
    timing.notes.push_back(
        {Severity::warning, fmt::format("{} converts at {} Hz and is read at {} Hz: values repeat",
                                        iio_name(device), own, timing.rate_hz)});
}

Status set_rate(iio_device* device,
                const iio_device* trigger,
                std::optional<double> rate_hz,
                IioTiming& timing) {
  const bool is_trigger_timed =
      trigger != nullptr && iio_device_find_attr(trigger, rate_attribute) != nullptr;
  iio_device* const timer =
      is_trigger_timed
          ? iio_context_find_device(iio_device_get_context(trigger), iio_device_get_id(trigger))
          : device;
  if (rate_hz) {
    const Status asked = ask_rate(timer, *rate_hz);
    if (!asked) return asked;
    timing.settings.emplace_back("rate asked", fmt::format("{} Hz", *rate_hz));
  }
  // A trigger fired by a program has no rate, and the device's then has no meaning.
  const bool is_fired_by_hand = trigger != nullptr && iio_name(trigger).starts_with("sysfstrig");
  timing.rate_hz = is_fired_by_hand ? 0.0 : own_rate(timer);
  timing.settings.emplace_back("rate granted",
                               timing.rate_hz > 0.0
                                   ? fmt::format("{} Hz, by {}", timing.rate_hz, iio_name(timer))
                                   : "unknown");
  if (is_trigger_timed) keep_up(device, timing);
  return Done{};
}

// By default the kernel stamps with the time of day, which can be set and jump.
void choose_clock(const iio_device* device, IioTiming& timing) {
  constexpr const char* clock = "current_timestamp_clock";
  const auto now = iio_text(device, clock);
  if (!now) return;
  if (*now != "monotonic") (void)iio_device_attr_write(device, clock, "monotonic");
  timing.settings.emplace_back("clock", iio_text(device, clock).value_or(*now));
}

}  // namespace

Result<IioTiming> set_timing(const iio_context* context,
                             iio_device* device,
                             const std::string& wanted,
                             std::optional<double> rate_hz) {
  const auto trigger = set_trigger(context, device, wanted);
  if (!trigger) return trigger.error();
  IioTiming timing;
  const std::string refusals =
      trigger->refusals.empty() ? "" : fmt::format(", and refuses {}", trigger->refusals);
  if (trigger->device != nullptr) {
    timing.settings.emplace_back("trigger", iio_name(trigger->device));
    timing.why_silent = fmt::format("the trigger {} does not fire", iio_name(trigger->device));
  } else {
    timing.settings.emplace_back("trigger", "none" + refusals);
    timing.why_silent =
        fmt::format("no trigger fires: {} has none{}; give it one that it takes with trigger=NAME",
                    iio_name(device), refusals);
  }
  const Status rate = set_rate(device, trigger->device, rate_hz, timing);
  if (!rate) return rate.error();
  choose_clock(device, timing);
  return timing;
}

}  // namespace proofmass::acquire
