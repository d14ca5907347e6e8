#include "proofmass/estimate/wheel/model.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "proofmass/core/units.hpp"

namespace proofmass::estimate {

std::size_t turned_after(const WheelPath& path, std::size_t first) {
  const double start_rad = path.moving[first](wheel::angle);
  const auto is_away = [&](const Mat<wheel::moving>& at) {
    return std::abs(at(wheel::angle) - start_rad) > rad_per_turn;
  };
  const auto from = path.moving.begin() + static_cast<std::ptrdiff_t>(first);
  return static_cast<std::size_t>(std::find_if(from, path.moving.end(), is_away) -
                                  path.moving.begin());
}

std::vector<double> mean_accel_radps2(const std::vector<double>& time_s,
                                      const std::vector<Mat<wheel::moving>>& moving) {
  constexpr double half_s = 0.2;
  std::vector<double> mean;
  mean.reserve(time_s.size());
  std::size_t first = 0, last = 0;  // epochs within half_s of epoch k
  for (std::size_t k = 0; k < time_s.size(); ++k) {
    while (time_s[k] - time_s[first] > half_s) ++first;
    while (last + 1 < time_s.size() && time_s[last + 1] - time_s[k] <= half_s) ++last;
    const double span_s = time_s[last] - time_s[first];
    mean.push_back(span_s > 0.0
                       ? (moving[last](wheel::speed) - moving[first](wheel::speed)) / span_s
                       : moving[k](wheel::accel));
  }
  return mean;
}

std::vector<Mat<wheel::moving>> moving_at(const std::vector<double>& time_s,
                                          const std::vector<double>& path_time_s,
                                          const std::vector<Mat<wheel::moving>>& path) {
  std::vector<Mat<wheel::moving>> moving;
  moving.reserve(time_s.size());
  std::size_t at = 0;
  for (const double t : time_s) {
    while (at + 1 < path_time_s.size() &&
           std::abs(path_time_s[at + 1] - t) <= std::abs(path_time_s[at] - t))
      ++at;
    moving.push_back(constant_jerk(t - path_time_s[at]) * path[at]);
  }
  return moving;
}

template void advance_in_place(const WheelModel<1>&,
                               std::size_t,
                               const Gate&,
                               FilterStateAt<wheel::states(1)>,
                               StepOf<WheelModel<1>>&);
template void advance_in_place(const WheelModel<2>&,
                               std::size_t,
                               const Gate&,
                               FilterStateAt<wheel::states(2)>,
                               StepOf<WheelModel<2>>&);
template void look_back(BackwardInformation<wheel::states(1)>&, const StepOf<WheelModel<1>>&);
template void look_back(BackwardInformation<wheel::states(2)>&, const StepOf<WheelModel<2>>&);

}  // namespace proofmass::estimate
