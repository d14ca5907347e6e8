#include "proofmass/acquire/sim/signal.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <limits>
#include <memory>
#include <string>
#include <utility>

#include "proofmass/core/units.hpp"
#include "proofmass/simulate/procedure.hpp"
#include "proofmass/simulate/procedure_file.hpp"
#include "proofmass/simulate/rig.hpp"
#include "proofmass/simulate/rig_file.hpp"
#include "proofmass/simulate/running_rig.hpp"

namespace proofmass::acquire {
namespace {

using simulate::ProcedureOptions;
using simulate::RigOptions;
using simulate::RunningRig;

/// The settings common to rig and procedure, each if given.
struct Asked {
  std::optional<std::string> file;
  std::optional<double> rate_hz;
  std::optional<std::uint64_t> seed;
  std::optional<simulate::RigOutput> output;
};

Result<Asked> asked_of(SourceUri& uri) {
  Asked asked;
  asked.file = uri.value("file");
  const auto rate_hz = uri.number("rate", 0.0);
  if (!rate_hz) return rate_hz.error();
  asked.rate_hz = *rate_hz;
  const auto seed = uri.whole("seed", 0, std::numeric_limits<std::uint64_t>::max());
  if (!seed) return seed.error();
  asked.seed = *seed;
  if (const auto word = uri.value("output")) {
    asked.output = simulate::output_named(*word);
    if (!asked.output)
      return Error{Errc::invalid_argument,
                   fmt::format("output={}: expected acceleration, voltage or counts", *word)};
  }
  return asked;
}

/// `count` sensors evenly about the axle, otherwise like the first.
std::vector<simulate::RigSensor> spread(const simulate::RigSensor& first, std::size_t count) {
  std::vector<simulate::RigSensor> sensors(count, first);
  for (std::size_t i = 0; i < count; ++i)
    sensors[i].position_rad += rad_per_turn * static_cast<double>(i) / static_cast<double>(count);
  return sensors;
}

/// Sensors and axes of a rig without a description file.
Status equip(SourceUri& uri, bool described, RigOptions& options) {
  const auto sensors = uri.whole("sensors", 1, 9);
  if (!sensors) return sensors.error();
  const auto axes = uri.whole("axes", 2, 3);
  if (!axes) return axes.error();
  if (described && (*sensors || *axes))
    return Error{Errc::invalid_argument,
                 "sensors and axes are given in the rig's file: omit them, or change them there"};
  if (*sensors) options.sensors = spread(options.sensors.front(), **sensors);
  if (*axes) options.axes = static_cast<int>(**axes);
  return Done{};
}

void set_common(const Asked& asked, double supply_v, auto& options) {
  if (asked.rate_hz) options.rate_hz = *asked.rate_hz;
  if (asked.seed) options.seed = *asked.seed;
  if (asked.output) options.output = *asked.output;
  if (options.output == simulate::RigOutput::counts)
    options.daq = simulate::with_steps(options.daq, supply_v);
}

Result<RigOptions> rig_options(SourceUri& uri, const Asked& asked) {
  RigOptions options;
  if (asked.file) {
    auto read = simulate::read_rig_file(*asked.file);
    if (!read) return read.error();
    options = std::move(read).value();
  }
  const bool at_rest = uri.place() == "static";
  if (at_rest && !asked.file) options.sensors.resize(1);
  if (const Status equipped = equip(uri, asked.file.has_value(), options); !equipped)
    return equipped.error();
  set_common(asked, options.supply.nominal_v, options);
  constexpr double most_rpm = 1e6;  // in either direction
  const auto rpm = at_rest ? Result(std::optional(0.0)) : uri.number("rpm", -most_rpm);
  if (!rpm) return rpm.error();
  if (*rpm && **rpm > most_rpm)
    return Error{Errc::invalid_argument,
                 fmt::format("rpm={}: expected {} at most", **rpm, most_rpm)};
  // One constant speed: the length of its segment does not matter.
  if (*rpm)
    options.wheel.profile = {
        {.duration_s = 1.0 / options.rate_hz, .speed_radps = **rpm * radps_per_rpm}};
  return options;
}

Result<SimSignal> rig_signal(SourceUri& uri, const Asked& asked) {
  const auto options = rig_options(uri, asked);
  if (!options) return options.error();
  auto started = RunningRig::start(*options);
  if (!started) return started.error();
  const auto rig = std::make_shared<RunningRig>(std::move(started).value());
  return SimSignal{rig->recording(), [rig](std::size_t rows, RunningRig::Columns& columns) {
                     rig->run(rows, columns);
                   }};
}

/// Plays the recording from its beginning; takes its values out of the head.
SimSignal played(Recording recording) {
  const std::uint64_t rows = recording.samples();
  auto values = std::make_shared<std::vector<std::vector<double>>>();
  for (Channel& channel : recording.channels) values->push_back(std::move(channel.values).take());
  const auto make = [values, next = std::ptrdiff_t{0}](
                        std::size_t count, std::vector<std::vector<double>>& columns) mutable {
    columns.resize(values->size());
    const std::ptrdiff_t end = next + static_cast<std::ptrdiff_t>(count);
    for (std::size_t c = 0; c < columns.size(); ++c)
      columns[c].insert(columns[c].end(), (*values)[c].begin() + next, (*values)[c].begin() + end);
    next = end;
  };
  return {std::move(recording), make, rows};
}

Result<SimSignal> procedure_signal(simulate::Procedure procedure, const Asked& asked) {
  ProcedureOptions options = simulate::default_options(procedure);
  if (asked.file) {
    const auto read = simulate::read_procedure_file(*asked.file, procedure);
    if (!read) return read.error();
    options = *read;
  }
  set_common(asked, options.supply.reference_v, options);
  auto simulated = simulate::simulate_procedure(options);
  if (!simulated) return simulated.error();
  return played(std::move(simulated).value().recording);
}

}  // namespace

Result<SimSignal> sim_signal(SourceUri& uri) {
  const auto asked = asked_of(uri);
  if (!asked) return asked.error();
  const std::string& place = uri.place();
  if (place.empty() || place == "wheel" || place == "static") return rig_signal(uri, *asked);
  if (const auto procedure = simulate::procedure_named(place))
    return procedure_signal(*procedure, *asked);
  return Error{Errc::invalid_argument,
               fmt::format("{}: expected wheel, static, tumble, four-position, six-position, "
                           "multi-position or slide",
                           place)};
}

}  // namespace proofmass::acquire
