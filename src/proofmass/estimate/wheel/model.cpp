#include "proofmass/estimate/wheel/model.hpp"

#include <algorithm>
#include <cstddef>

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

template void advance_in_place(const WheelModel<1>&,
                               std::size_t,
                               const Gate&,
                               Gaussian<wheel::states(1)>&,
                               int&,
                               StepOf<WheelModel<1>>&);
template void advance_in_place(const WheelModel<2>&,
                               std::size_t,
                               const Gate&,
                               Gaussian<wheel::states(2)>&,
                               int&,
                               StepOf<WheelModel<2>>&);
template void look_back(BackwardInformation<wheel::states(1)>&, const StepOf<WheelModel<1>>&);
template void look_back(BackwardInformation<wheel::states(2)>&, const StepOf<WheelModel<2>>&);

}  // namespace proofmass::estimate
