#include "proofmass/estimate/wheel/model.hpp"

namespace proofmass::estimate {

template void advance(const WheelModel<1>&,
                      std::size_t,
                      const Gate&,
                      FilterState<wheel::states(1)>&,
                      StepOf<WheelModel<1>>&);
template void advance(const WheelModel<2>&,
                      std::size_t,
                      const Gate&,
                      FilterState<wheel::states(2)>&,
                      StepOf<WheelModel<2>>&);
template void look_back(BackwardInformation<wheel::states(1)>&, const StepOf<WheelModel<1>>&);
template void look_back(BackwardInformation<wheel::states(2)>&, const StepOf<WheelModel<2>>&);

}  // namespace proofmass::estimate
