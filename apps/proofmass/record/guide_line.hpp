#pragma once

#include <string>
#include <vector>

#include "proofmass/calibrate/pose_guide.hpp"

namespace proofmass::app {

/// What a picture of a guided procedure shows besides the guide's own state.
struct GuideContext {
  std::string procedure;
  std::string said;              ///< the last sentence that was no instruction
  double target_mg = 0.0;        ///< wanted standard deviation at 1 g
  std::vector<double> errors_g;  ///< the error at 1 g after each pose; NaN where unknown
  bool is_done = false;
};

/// The state of a guided procedure as JSON; docs/serve.md lists its fields.
[[nodiscard]] std::string guide_line(const calibrate::PoseGuide& guide,
                                     const GuideContext& context);

}  // namespace proofmass::app
