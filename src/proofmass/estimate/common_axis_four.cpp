#include "proofmass/estimate/common_axis.hpp"

namespace proofmass::estimate {

template AxisEstimate estimate_axis<3>(const std::vector<double>&,
                                       const Chosen&,
                                       const FusionOptions&);
template AxisEstimate estimate_axis<4>(const std::vector<double>&,
                                       const Chosen&,
                                       const FusionOptions&);

}  // namespace proofmass::estimate
