#include "proofmass/calibrate/recording_poses.hpp"

#include <array>
#include <fmt/format.h>
#include <utility>

#include "proofmass/signal/channel_audit.hpp"
#include "proofmass/signal/rests.hpp"

namespace proofmass::calibrate {
namespace {

// The three axes in SI.
struct Axes {
  std::array<std::vector<double>, 3> values;
  std::array<double, 3> lsb{};
  Unit unit;

  [[nodiscard]] std::array<View<double>, 3> views() const {
    return {values[0], values[1], values[2]};
  }
};

Result<Axes> axes_in_si(const Recording& recording, const Triad& triad) {
  Axes axes;
  std::size_t k = 0;
  for (const auto& index : {triad.x, triad.y, triad.z}) {
    const Channel& channel = recording.channels[*index];
    const Result<Unit> si = pose_unit(channel.unit);
    if (!si) return si.error();
    if (k > 0 && si->symbol != axes.unit.symbol)
      return Error{Errc::invalid_argument, "the three axes are in different units"};
    axes.unit = *si;
    axes.values[k] = channel.values.copy();
    if (channel.unit.quantity != Quantity::counts)
      for (double& value : axes.values[k]) value = channel.unit.si(value);
    axes.lsb[k] = signal::find_lsb(axes.values[k]).value_or(0.0);
    ++k;
  }
  return axes;
}

Result<std::vector<Dwell>> found_dwells(const std::array<View<double>, 3>& axes,
                                        double rate_hz,
                                        const std::optional<double>& shortest_s) {
  const signal::RestSearch search =
      signal::find_rests(axes, {.rate_hz = rate_hz, .shortest_s = shortest_s});
  if (search.rests.empty()) return Error{Errc::not_observable, "no rest found: " + search.why_none};
  std::vector<Dwell> dwells;
  dwells.reserve(search.rests.size());
  for (const signal::Rest& rest : search.rests) dwells.push_back({rest.first, rest.last});
  return dwells;
}

void set_times(const Recording& recording, View<Dwell> dwells, std::vector<Pose>& poses) {
  for (std::size_t k = 0; k < dwells.size(); ++k) {
    poses[k].start_s = recording.time.at(dwells[k].first);
    poses[k].end_s = recording.time.at(dwells[k].last);
  }
}

}  // namespace

Result<Triad> only_accelerometer(const Recording& recording) {
  const std::vector<Triad> triads = accelerometer_triads(recording);
  if (triads.size() == 1 && triads.front().axes() == 3) return triads.front();
  if (triads.size() <= 1)
    return Error{Errc::invalid_argument, "no accelerometer with three axes found"};
  std::string names;
  for (const Triad& triad : triads) names += (names.empty() ? "" : ", ") + triad.name;
  return Error{Errc::invalid_argument,
               fmt::format("{} accelerometers ({}), expected one", triads.size(), names)};
}

Result<Unit> pose_unit(const Unit& unit) {
  switch (unit.quantity) {
    case Quantity::acceleration:
      return *parse_unit("m/s^2");
    case Quantity::voltage:
      return *parse_unit("V");
    case Quantity::counts:
      return unit;
    default:
      return Error{Errc::invalid_argument,
                   fmt::format("the measurements are in {}: expected an acceleration, a voltage or "
                               "counts",
                               unit.symbol.empty() ? "no known unit" : unit.symbol)};
  }
}

Result<RecordingPoses> recording_poses(const Recording& recording,
                                       const RecordingPosesOptions& options) {
  Result<Triad> triad = only_accelerometer(recording);
  if (!triad) return triad.error();
  const Result<Axes> axes = axes_in_si(recording, *triad);
  if (!axes) return axes.error();
  const std::array<View<double>, 3> views = axes->views();
  std::vector<Dwell> dwells = options.dwells;
  if (dwells.empty()) {
    auto found = found_dwells(views, recording.time.rate_hz, options.shortest_s);
    if (!found) return found.error();
    dwells = std::move(found).value();
  }
  Result<PoseMeans> means = pose_means(views, dwells, axes->lsb);
  if (!means) return means.error();
  RecordingPoses out{*triad, axes->unit, dwells, std::move(means).value()};
  set_times(recording, dwells, out.means.poses);
  return out;
}

}  // namespace proofmass::calibrate
