#include "proofmass/acquire/comedi/command.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <fmt/format.h>
#include <numeric>

namespace proofmass::acquire {
namespace {

struct FreeCalibration {
  void operator()(comedi_calibration_t* file) const { comedi_cleanup_calibration(file); }
};
using CalibrationFile = std::unique_ptr<comedi_calibration_t, FreeCalibration>;

Error command_refused(std::string message) {
  return {Errc::device, std::move(message)};
}

Status open_inputs(const ComediRequest& request, ComediCommand& out) {
  comedi_loglevel(0);
  out.device.reset(comedi_open(request.path.c_str()));
  if (!out.device)
    return command_refused(
        fmt::format("{} cannot be opened ({}); expected a card such as /dev/comedi0, "
                    "with its driver attached",
                    request.path, comedi_reason()));
  const int found = comedi_find_subdevice_by_type(out.device.get(), COMEDI_SUBD_AI, 0);
  if (found < 0)
    return command_refused(fmt::format("{} ({}) has no analogue inputs", request.path,
                                       comedi_get_board_name(out.device.get())));
  out.subdevice = static_cast<unsigned>(found);
  const auto flags =
      static_cast<unsigned>(comedi_get_subdevice_flags(out.device.get(), out.subdevice));
  if ((flags & SDF_CMD_READ) == 0)
    return command_refused(
        fmt::format("{} ({}) gives single values only, which cannot be recorded at a "
                    "rate",
                    request.path, comedi_get_board_name(out.device.get())));
  out.sample_bytes = (flags & SDF_LSAMPL) != 0 ? sizeof(lsampl_t) : sizeof(sampl_t);
  // The largest buffer that the card allows, so that a late reader loses nothing.
  const int most = comedi_get_max_buffer_size(out.device.get(), out.subdevice);
  if (most > 0)
    (void)comedi_set_buffer_size(out.device.get(), out.subdevice, static_cast<unsigned>(most));
  return Done{};
}

Status check_range(const ComediRequest& request, const ComediCommand& out, unsigned channel) {
  comedi_t* const device = out.device.get();
  const int ranges = comedi_get_n_ranges(device, out.subdevice, channel);
  if (ranges > 0 && request.range < static_cast<unsigned>(ranges)) return Done{};
  std::string there;
  for (int k = 0; k < ranges; ++k)
    if (const comedi_range* range =
            comedi_get_range(device, out.subdevice, channel, static_cast<unsigned>(k)))
      there += fmt::format("{}{}: {} … {}", k == 0 ? "" : ", ", k, range->min, range->max);
  return Error{Errc::invalid_argument, fmt::format("range={}: channel {} has {}", request.range,
                                                   channel, there.empty() ? "none" : there)};
}

// Cards with software calibration keep their coefficients in a file written by
// comedi_soft_calibrate; the others correct themselves.
CalibrationFile calibration_of(ComediCommand& out) {
  comedi_t* const device = out.device.get();
  const auto flags = static_cast<unsigned>(comedi_get_subdevice_flags(device, out.subdevice));
  if ((flags & SDF_SOFT_CALIBRATED) == 0) {
    out.settings.emplace_back("calibration", "the card's own");
    return nullptr;
  }
  const std::unique_ptr<char, decltype(&std::free)> path(
      comedi_get_default_calibration_path(device), &std::free);
  CalibrationFile file(path ? comedi_parse_calibration_file(path.get()) : nullptr);
  out.settings.emplace_back("calibration", file ? path.get() : "none");
  if (!file)
    out.notes.push_back({Severity::warning,
                         "the card has not been calibrated: voltages are nominal; "
                         "comedi_soft_calibrate does it"});
  return file;
}

Status add_channel(unsigned channel,
                   const ComediRequest& request,
                   const comedi_calibration_t* file,
                   ComediCommand& out) {
  const Status range = check_range(request, out, channel);
  if (!range) return range;
  comedi_t* const device = out.device.get();
  comedi_polynomial_t polynomial{};
  const bool is_known = (file != nullptr && comedi_get_softcal_converter(
                                                out.subdevice, channel, request.range,
                                                COMEDI_TO_PHYSICAL, file, &polynomial) >= 0) ||
                        comedi_get_hardcal_converter(device, out.subdevice, channel, request.range,
                                                     COMEDI_TO_PHYSICAL, &polynomial) >= 0;
  if (!is_known)
    return command_refused(
        fmt::format("channel {}: the card does not state the scale of its values ({})", channel,
                    comedi_reason()));
  const comedi_range* const bounds =
      comedi_get_range(device, out.subdevice, channel, request.range);
  const bool is_volts = bounds != nullptr && bounds->unit == UNIT_volt;
  out.list.push_back(CR_PACK(channel, request.range, request.reference));
  out.to_physical.push_back(polynomial);
  out.heads.push_back(
      {fmt::format("ch{}", channel), is_volts ? parse_unit("V").value_or(Unit{}) : Unit{}, {}});
  if (bounds != nullptr && out.list.size() == 1)
    out.settings.emplace_back(
        "range", fmt::format("{} … {}{}", bounds->min, bounds->max, is_volts ? " V" : ""));
  return Done{};
}

Status add_channels(const ComediRequest& request, ComediCommand& out) {
  const int there = comedi_get_n_channels(out.device.get(), out.subdevice);
  const unsigned count = there > 0 ? static_cast<unsigned>(there) : 0;
  std::vector<unsigned> channels = request.channels;
  if (channels.empty()) {
    channels.resize(count);
    std::iota(channels.begin(), channels.end(), 0U);
  }
  const CalibrationFile file = calibration_of(out);
  for (const unsigned channel : channels) {
    if (channel >= count)
      return Error{Errc::invalid_argument,
                   fmt::format("channels={}: the card has {}, counted from 0", channel, count)};
    const Status added = add_channel(channel, request, file.get(), out);
    if (!added) return added;
  }
  return Done{};
}

// The card rounds the periods to the resolution of its clock on every call: repeat until nothing
// changes.
Status set_rate(const ComediRequest& request, ComediCommand& out) {
  comedi_t* const device = out.device.get();
  const double period_ns = std::clamp(1e9 / request.rate_hz, 1.0, 4e9);
  if (comedi_get_cmd_generic_timed(device, out.subdevice, &out.command,
                                   static_cast<unsigned>(out.list.size()),
                                   static_cast<unsigned>(std::lround(period_ns))) < 0)
    return command_refused(fmt::format("rate={}: the card has no timed reading of {} channels ({})",
                                       request.rate_hz, out.list.size(), comedi_reason()));
  out.command.chanlist = out.list.data();
  out.command.chanlist_len = static_cast<unsigned>(out.list.size());
  out.command.stop_src = TRIG_NONE;
  out.command.stop_arg = 0;
  int complaint = 0;
  for (int attempt = 0; attempt < 3; ++attempt)
    complaint = comedi_command_test(device, &out.command);
  if (complaint != 0)
    return command_refused(
        fmt::format("rate={}: the card refuses {} channels at this rate, range and "
                    "reference (stage {} of its test)",
                    request.rate_hz, out.list.size(), complaint));
  const unsigned scan_ns = out.command.scan_begin_src == TRIG_TIMER
                               ? out.command.scan_begin_arg
                               : out.command.convert_arg * out.command.chanlist_len;
  if (scan_ns == 0) return command_refused("the card does not state its sample rate");
  out.rate_hz = 1e9 / scan_ns;
  out.settings.emplace_back("rate asked", fmt::format("{} Hz", request.rate_hz));
  out.settings.emplace_back("rate granted", fmt::format("{:.9g} Hz", out.rate_hz));
  out.settings.emplace_back("between channels", out.command.convert_src == TRIG_TIMER
                                                    ? fmt::format("{} ns", out.command.convert_arg)
                                                    : "0 ns, or as the card's clock has it");
  return Done{};
}

}  // namespace

std::string comedi_reason() {
  return comedi_strerror(comedi_errno());
}

Result<ComediCommand> prepare_command(const ComediRequest& request) {
  ComediCommand out;
  Status done = open_inputs(request, out);
  if (!done) return done.error();
  out.settings.emplace_back("card", comedi_get_board_name(out.device.get()));
  out.settings.emplace_back("driver", comedi_get_driver_name(out.device.get()));
  done = add_channels(request, out);
  if (!done) return done.error();
  done = set_rate(request, out);
  if (!done) return done.error();
  return out;
}

Status start(ComediCommand& command) {
  if (comedi_command(command.device.get(), &command.command) >= 0) return Done{};
  return command_refused(
      fmt::format("the card does not start ({}); if it is busy, another program reads "
                  "it: stop that",
                  comedi_reason()));
}

}  // namespace proofmass::acquire
