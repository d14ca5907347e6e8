// Wheel angle online: the simulated samples arrive in blocks, as from a device, and the filter
// reports the angle after each.
#include <cmath>
#include <cstdio>
#include <vector>

#include "proofmass/core/rows.hpp"
#include "proofmass/core/units.hpp"
#include "proofmass/estimate/live_wheel.hpp"
#include "proofmass/simulate/running_rig.hpp"

int main() {
  using namespace proofmass;
  auto rig = simulate::RunningRig::start({}).value();

  estimate::LiveWheelOptions options;
  options.sensors = accelerometer_triads(rig.recording());
  options.rate_hz = rig.recording().time.rate_hz;
  options.wheel.radius_m = 0.1;
  const auto wheel = estimate::live_wheel(options).value();

  Rows samples, estimates;
  simulate::RunningRig::Columns truth;
  samples.channels.resize(rig.recording().channels.size());
  truth.resize(rig.truth().channels.size());
  const std::size_t block = 10;  // 50 ms
  for (std::uint64_t first = 0; first < rig.profile_scans(); first += block) {
    samples.clear();
    rig.run(block, samples.channels, &truth);
    for (std::size_t k = 0; k < block; ++k)
      samples.stamps_s.push_back(static_cast<double>(first + k) / options.rate_hz);
    const Status added = wheel->add(view_of(samples, first), estimates);
    if (!added) return 1;
  }

  const double angle = estimates.channels[0].back(), std = estimates.channels[1].back();
  const double turned = truth[0].back() - truth[0].front();
  std::printf("%zu rows; at %.2f s it had turned by %.2f +- %.2f degrees (truth %.2f)\n",
              estimates.rows(), estimates.stamps_s.back(),
              (angle - estimates.channels[0].front()) / rad_per_deg, std / rad_per_deg,
              turned / rad_per_deg);
  return estimates.rows() > 0 && std::abs(angle - estimates.channels[0].front() - turned) < 0.2 ? 0
                                                                                                : 1;
}
