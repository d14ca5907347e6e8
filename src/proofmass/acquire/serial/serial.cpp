#include <cmath>
#include <fmt/format.h>

#include "proofmass/acquire/serial/port.hpp"
#include "proofmass/acquire/source_list.hpp"
#include "proofmass/acquire/stream/byte_pump.hpp"

namespace proofmass::acquire {
namespace {

Result<SerialSettings> serial_settings(SourceUri& uri) {
  SerialSettings settings{.device = uri.place()};
  if (settings.device.empty())
    return Error{Errc::invalid_argument, "expected a device, as in serial:/dev/ttyACM0"};
  const auto baud = uri.number("baud", 0.0);
  if (!baud) return baud.error();
  constexpr double fastest = 4e9;
  if (*baud && (**baud > fastest || **baud != std::floor(**baud)))
    return Error{Errc::invalid_argument,
                 fmt::format("baud={}: expected a whole number of baud", **baud)};
  if (*baud) settings.baud = static_cast<unsigned>(**baud);
  const auto flow = uri.choice("flow", {"none", "hard"});
  if (!flow) return flow.error();
  settings.hardware_flow = *flow == "hard";
  return settings;
}

/// With a baud rate error of 2.5 % the last of ten bits is misread.
std::optional<Note> baud_note(unsigned asked, unsigned granted) {
  constexpr double most = 0.025;
  if (std::abs(static_cast<double>(granted) / asked - 1.0) <= most) return std::nullopt;
  return Note{Severity::warning, fmt::format("{} baud were asked for, {} granted", asked, granted)};
}

}  // namespace

Result<std::unique_ptr<Source>> open_serial(SourceUri& uri, const OpenOptions& options) {
  const auto settings = serial_settings(uri);
  if (!settings) return settings.error();
  const auto framing = framing_options(uri, Carrier::stream);
  if (!framing) return framing.error();
  if (const Status known = uri.nothing_unknown(); !known) return known.error();
  auto port = open_serial_port(*settings);
  if (!port) return port.error();
  SerialPort opened = std::move(port).value();
  SourceHead head;
  head.recording.source = uri.text();
  head.recording.format = "serial";
  head.settings.emplace_back("baud", std::to_string(opened.baud));
  head.settings.emplace_back("flow", settings->hardware_flow ? "hard" : "none");
  if (const auto note = baud_note(settings->baud, opened.baud))
    head.recording.notes.push_back(*note);
  return open_stream(std::move(opened.feed), *framing, std::move(head), options);
}

}  // namespace proofmass::acquire
