#include <cmath>
#include <string>
#include <string_view>

#include "proofmass/simulate/rig.hpp"
#include "proofmass/simulate/rig/fields.hpp"
#include "proofmass/simulate/rig/option_check.hpp"

namespace proofmass::simulate {
namespace {

void check_wheel(const RigWheel& wheel, Verdict& verdict) {
  const auto require = [&](bool holds, std::string_view where, std::string_view what) {
    verdict.require(holds, where, what);
  };
  visit_wheel(wheel, verdict);
  visit_ripple(wheel.ripple, verdict);
  require(!wheel.profile.empty(), "segment", "must be there at least once");
  for (const SpeedSegment& segment : wheel.profile) {
    visit_segment(segment, verdict);
    require(segment.duration_s > 0.0, "duration_s", "of a segment must be positive");
    require(segment.ramp_s >= 0.0 && segment.ramp_s <= segment.duration_s, "ramp_s",
            "of a segment must lie between 0 and its duration");
  }
  require(wheel.ripple.fraction >= 0.0, "fraction", "must not be negative");
  require(wheel.ripple.random_fraction_rms >= 0.0, "random_fraction_rms", "must not be negative");
  require(wheel.ripple.order > 0.0, "order", "must be positive");
  require(wheel.ripple.random_max_order > 0.0, "random_max_order", "must be positive");
  require(wheel.rolling_radius_m >= 0.0, "rolling_radius_m", "must not be negative");
  require(wheel.shake_horizontal_rms_mps2 >= 0.0, "shake_horizontal_rms_mps2",
          "must not be negative");
  require(wheel.shake_vertical_rms_mps2 >= 0.0, "shake_vertical_rms_mps2", "must not be negative");
  require(wheel.shake_bandwidth_hz > 0.0, "shake_bandwidth_hz", "must be positive");
}

void check_sensor(const RigSensor& sensor, Verdict& verdict) {
  visit_sensor(sensor, verdict);
  const auto positive = [&](double value, std::string_view key) {
    verdict.require(value > 0.0, key, "must be positive");
  };
  verdict.require(sensor.radius_m >= 0.0, "radius_m", "must not be negative");
  positive(sensor.full_scale_mps2, "full_scale_mps2");
  positive(sensor.warm_up_time_s, "warm_up_time_s");
  positive(sensor.bandwidth_hz, "bandwidth_hz");
  positive(sensor.sensitivity_v_per_mps2, "sensitivity_v_per_mps2");
  for (std::size_t axis = 0; axis < 3; ++axis) {
    positive(sensor.scale[axis], "scale");
    verdict.require(sensor.noise_rms_mps2[axis] >= 0.0, "noise_rms_mps2", "must not be negative");
    verdict.require(sensor.noise_density_mps2_rthz[axis] >= 0.0, "noise_density_mps2_rthz",
                    "must not be negative");
    verdict.require(sensor.bias_walk_mps2_rts[axis] >= 0.0, "bias_walk_mps2_rts",
                    "must not be negative");
  }
}

void check_electronics(const RigOptions& options, Verdict& verdict) {
  const RigDaq& daq = options.daq;
  visit_supply(options.supply, verdict);
  visit_daq(daq, verdict);
  verdict.require(options.supply.nominal_v > 0.0, "nominal_v", "must be positive");
  verdict.require(options.supply.ripple_rms_v >= 0.0, "ripple_rms_v", "must not be negative");
  verdict.require(daq.bits >= 0 && daq.bits <= 32, "bits", "must lie between 0 and 32");
  verdict.require(daq.min_v < daq.max_v, "min_v", "must be below max_v");
  verdict.require(daq.bits > 0 || options.output != RigOutput::counts, "output",
                  "\"counts\" needs a converter; set daq.bits");
  const double channels = static_cast<double>(options.sensors.size()) * options.axes +
                          (options.supply.recorded ? 1.0 : 0.0);
  verdict.require(daq.skew_s >= 0.0 && daq.skew_s * channels * options.rate_hz <= 1.0, "skew_s",
                  "must not be negative, and a scan of all channels must end before the next");
}

}  // namespace

Status check(const RigOptions& options) {
  Verdict verdict;
  visit_general(options, verdict);
  verdict.require(options.rate_hz > 0.0, "rate_hz", "must be positive");
  verdict.require(options.axes == 2 || options.axes == 3, "axes", "must be 2 or 3");
  verdict.require(options.bias_spread_mps2 >= 0.0, "bias_spread_mps2", "must not be negative");
  verdict.require(!options.sensors.empty() && options.sensors.size() <= 9, "sensor",
                  "must be there 1 to 9 times");
  check_wheel(options.wheel, verdict);
  for (const RigSensor& sensor : options.sensors) check_sensor(sensor, verdict);
  check_electronics(options, verdict);
  double duration_s = 0.0;
  for (const SpeedSegment& segment : options.wheel.profile) duration_s += segment.duration_s;
  const double samples = duration_s * options.rate_hz;
  verdict.require(samples >= 1.0 && samples <= 1e8, "duration_s",
                  "of all segments must hold between 1 and 1e8 scans at that rate");
  return verdict.status();
}

}  // namespace proofmass::simulate
