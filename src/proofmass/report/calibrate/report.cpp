#include "proofmass/report/calibrate/report.hpp"

#include <limits>

namespace proofmass::report {
namespace {

using calibrate::Pose;
using calibrate::PoseResidual;

constexpr double none = std::numeric_limits<double>::quiet_NaN();

const Unit& plain() {
  static const Unit unit{Quantity::unknown, 1.0, 0.0, "1"};
  return unit;
}

template <class Value>
void add(Recording& out, std::string name, const Unit& unit, std::size_t n, Value value) {
  std::vector<double> values;
  for (std::size_t k = 0; k < n; ++k) values.push_back(value(k));
  out.channels.push_back({std::move(name), unit, std::move(values)});
}

bool times_known(const CalibrateReport& report, std::size_t k) {
  return report.files[report.pose_file[k]].times_known;
}

}  // namespace

Recording calibrate_series(const CalibrateReport& report) {
  Recording out;
  out.source = "proofmass calibrate";
  out.format = "series";
  const std::size_t n = report.poses.size();
  const Unit second = *parse_unit("s"), accel = *parse_unit("m/s^2");
  const std::vector<Pose>& poses = report.poses;
  const std::vector<PoseResidual>& residuals = report.fit.poses;
  add(out, "position", plain(), n, [](std::size_t k) { return static_cast<double>(k + 1); });
  add(out, "start", second, n, [&](std::size_t k) {
    return times_known(report, k) ? poses[k].start_s.value_or(none) : none;
  });
  add(out, "end", second, n,
      [&](std::size_t k) { return times_known(report, k) ? poses[k].end_s.value_or(none) : none; });
  constexpr const char* axes[] = {"x", "y", "z"};
  for (Eigen::Index i = 0; i < 3; ++i) {
    add(out, std::string("mean_") + axes[i], report.unit, n,
        [&](std::size_t k) { return poses[k].mean(i); });
  }
  for (Eigen::Index i = 0; i < 3; ++i) {
    add(out, std::string("force_") + axes[i], accel, n,
        [&](std::size_t k) { return residuals[k].force_mps2(i); });
  }
  add(out, "residual", accel, n, [&](std::size_t k) { return residuals[k].residual_mps2; });
  add(out, "predicted_std", accel, n, [&](std::size_t k) {
    return residuals[k].predicted_std_mps2 > 0.0 ? residuals[k].predicted_std_mps2 : none;
  });
  add(out, "leave_one_out", accel, n,
      [&](std::size_t k) { return residuals[k].leave_one_out_mps2.value_or(none); });
  add(out, "suspect", plain(), n, [&](std::size_t k) { return residuals[k].suspect ? 1.0 : 0.0; });
  add(out, "used", plain(), n, [&](std::size_t k) { return residuals[k].used ? 1.0 : 0.0; });
  return out;
}

}  // namespace proofmass::report
