#include "proofmass/report/simulate_report.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "proofmass/core/units.hpp"
#include "proofmass/report/json.hpp"
#include "proofmass/report/wording.hpp"

namespace proofmass::report {
namespace {

// Turns and fastest speed, from the truth beside the recording.
struct Motion {
  double turns = 0.0, peak_rpm = 0.0;
};

Motion motion(const Recording& truth) {
  Motion found;
  const Channel* angle = truth.find("angle");
  const Channel* speed = truth.find("speed");
  if (angle != nullptr && !angle->values.empty()) {
    found.turns = (angle->values.back() - angle->values.front()) / rad_per_turn;
  }
  if (speed != nullptr) {
    for (const double radps : speed->values) {
      found.peak_rpm = std::max(found.peak_rpm, std::abs(radps) / radps_per_rpm);
    }
  }
  return found;
}

}  // namespace

std::string simulate_json(const SimulateReport& report) {
  const Recording& recording = report.result.recording;
  const Motion wheel = motion(report.result.truth);
  Array channels;
  for (const Channel& channel : recording.channels) {
    channels.push_back(Object{{"name", channel.name}, {"unit", channel.unit.symbol}});
  }
  std::vector<std::string> warnings = texts(recording.notes, Severity::warning);
  return to_json({"simulate", report.inputs, std::move(warnings)},
                 {{"file", report.output},
                  {"truth_file", report.truth},
                  {"seed", report.options.seed},
                  {"samples", recording.samples()},
                  {"rate_hz", report.options.rate_hz},
                  {"duration_s", recording.duration_s()},
                  {"gravity_mps2", report.options.gravity_mps2},
                  {"channels", std::move(channels)},
                  {"truth", Object{{"turns", wheel.turns}, {"peak_speed_rpm", wheel.peak_rpm}}}});
}

std::string simulate_text(const SimulateReport& report) {
  const Recording& recording = report.result.recording;
  const Motion wheel = motion(report.result.truth);
  return fmt::format("Simulated {} at {} Hz, seed {}: {} turns, at most {} rpm.\n",
                     duration_words(recording.duration_s()), compact(report.options.rate_hz, 6),
                     report.options.seed, fixed(wheel.turns, 4), significant(wheel.peak_rpm, 4)) +
         aligned({{"recording", report.output,
                   fmt::format("{} of {}", count_words(recording.channels.size(), "channel"),
                               count_words(recording.samples(), "sample"))},
                  {"truth", report.truth, "angle, speed, acceleration, biases"}});
}

}  // namespace proofmass::report
