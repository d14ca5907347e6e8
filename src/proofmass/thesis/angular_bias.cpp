#include "proofmass/thesis/angular_bias.hpp"

#include <cmath>
#include <fmt/format.h>
#include <utility>

#include "proofmass/calibrate/tumble/dwells.hpp"
#include "proofmass/sensor/datasheet.hpp"
#include "proofmass/simulate/procedure.hpp"
#include "proofmass/thesis/bias/tumble_parts.hpp"

namespace proofmass::thesis {
namespace {

constexpr double converter_range_v = 5.0;

// The thesis's sensor on its wheel: the values of table 5.1 in a sensor with the noise of the
// datasheet and no other error. The thesis does not state the duration at rest; a minute is used
// here.
simulate::ProcedureOptions tumble_of_table_5_1(std::uint64_t seed, double gravity_mps2) {
  simulate::ProcedureOptions options = simulate::default_options(simulate::Procedure::tumble);
  options.seed = seed;
  options.rate_hz = 200.0;
  options.gravity_mps2 = gravity_mps2;
  options.output = simulate::RigOutput::voltage;
  options.labelled = true;
  options.timing.dwell_s = 60.0;
  options.table.positions = 4;
  options.daq = {.bits = sensor::usb6009.bits_differential,
                 .min_v = -converter_range_v,
                 .max_v = converter_range_v};
  simulate::ProcedureSensor& sensor = options.sensor;
  sensor.bias_spread_mps2 = sensor.scale_spread = sensor.misalignment_spread_rad = 0.0;
  sensor.flicker_mps2 = sensor.bias_walk_mps2_rts = {};  // the datasheet has none
  sensor.scale = {1.0 + printed_x().scale_error, 1.0 + printed_y().scale_error, 1.0};
  sensor.equation[0].K0 = printed_x().bias_mps2;
  sensor.equation[1].K0 = printed_y().bias_mps2;
  for (std::size_t axis = 0; axis < 3; ++axis)  // white up to half the rate
    sensor.noise_rms_mps2[axis] =
        sensor::adxl335.noise_density_mps2_rthz[axis] * std::sqrt(0.5 * options.rate_hz);
  return options;
}

}  // namespace

const PrintedAxis& printed_x() {
  static const PrintedAxis x{.name = "x",
                             .at_0_mps2 = -0.17517 * standard_gravity_mps2,
                             .at_180_mps2 = -0.22057 * standard_gravity_mps2,
                             .worked_mps2 = -19.78 * mg_mps2,
                             .bias_mps2 = 19.68 * mg_mps2,
                             .scale_error = 0.0041e-2,
                             .place = &TumbledAxes::x};
  return x;
}

const PrintedAxis& printed_y() {
  static const PrintedAxis y{.name = "y",
                             .at_0_mps2 = 0.58541 * standard_gravity_mps2,
                             .at_180_mps2 = -1.0330 * standard_gravity_mps2,
                             .worked_mps2 = 22.38 * mg_mps2,
                             .bias_mps2 = 22.29 * mg_mps2,
                             .scale_error = 0.0869e-2,
                             .place = &TumbledAxes::y};
  return y;
}

std::string absent_words(const PrintedAxis& printed, const TumbledAxes& axes) {
  std::string words = fmt::format("No channel stands for {}.", printed.name);
  for (const std::string& refused : axes.refused) words += " " + refused;
  return words;
}

Result<TumbleRecord> simulate_tumble(std::uint64_t seed, double gravity_mps2) {
  const auto result = simulate::simulate_procedure(tumble_of_table_5_1(seed, gravity_mps2));
  if (!result) return result.error();
  const Recording& recording = result->recording;
  const Channel* angle = recording.find("angle");
  TumbleRecord out{.source = "simulated", .simulated = true, .positions = {}, .channels = {}};
  std::vector<calibrate::Dwell> rests;
  for (const Label& label : recording.labels) {
    rests.push_back({.first = label.first, .last = label.last});
    out.positions.push_back(
        {.angle_rad = angle->unit.si(angle->values[label.first]),
         .time_s = 0.5 * (recording.time.at(label.first) + recording.time.at(label.last))});
  }
  for (const char* name : {"acc_x", "acc_y", "acc_z"}) {
    const Channel* channel = recording.find(name);
    const auto means = calibrate::dwell_outputs(
        channel->values, rests,
        sensor::lsb_v(converter_range_v, sensor::usb6009.bits_differential));
    if (!means) return means.error().at(name);
    out.channels.push_back({.name = std::string(1, name[4]),
                            .unit = channel->unit,
                            .output = means->mean,
                            .std = means->std,
                            .noise_dof = means->noise_dof});
  }
  return out;
}

Result<std::vector<Item>> tumble_items(const TumbleRecord& record, double gravity_mps2) {
  const Result<TumbledAxes> axes = analyse_tumble(record, gravity_mps2);
  if (!axes) return axes.error();
  return std::vector<Item>{orientation_item(),
                           output_item("figure 5.5", printed_x(), *axes, record, gravity_mps2),
                           output_item("figure 5.6", printed_y(), *axes, record, gravity_mps2),
                           bias_scale_item(*axes, record, gravity_mps2)};
}

}  // namespace proofmass::thesis
