#include "proofmass/simulate/rig.hpp"

#include <algorithm>
#include <utility>

#include "proofmass/simulate/running_rig.hpp"

namespace proofmass::simulate {
namespace {

void fill(Recording& recording, RunningRig::Columns&& columns) {
  for (std::size_t c = 0; c < columns.size(); ++c)
    recording.channels[c].values = std::move(columns[c]);
}

}  // namespace

Result<RigResult> simulate_rig(const RigOptions& options, const Progress& progress) {
  auto started = RunningRig::start(options);
  if (!started) return started.error();
  RunningRig rig = std::move(started).value();
  RigResult result{rig.recording(), rig.truth(), rig.sensors()};
  const std::uint64_t scans = rig.profile_scans();
  RunningRig::Columns recorded(result.recording.channels.size());
  RunningRig::Columns truth(result.truth.channels.size());
  for (auto* columns : {&recorded, &truth})
    for (std::vector<double>& column : *columns) column.reserve(scans);
  while (rig.scan() < scans) {
    if (progress)
      progress("simulating the rig", static_cast<double>(rig.scan()) / static_cast<double>(scans));
    constexpr std::uint64_t piece = 65536;
    rig.run(std::min(piece, scans - rig.scan()), recorded, &truth);
  }
  fill(result.recording, std::move(recorded));
  fill(result.truth, std::move(truth));
  if (progress) progress("simulating the rig", 1.0);
  return result;
}

}  // namespace proofmass::simulate
