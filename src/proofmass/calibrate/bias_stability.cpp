#include "proofmass/calibrate/bias_stability.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace proofmass::calibrate {

BiasStability stability_of(const SlowNoiseStrengths& slow_noise,
                           double session_s,
                           std::string source) {
  constexpr double longest_s = 30.0 * 86400.0;
  BiasStability out{.std = {}, .source = std::move(source)};
  const double periods = std::log(longest_s / std::clamp(session_s, 1.0, 0.5 * longest_s));
  for (std::size_t axis = 0; axis < 3; ++axis)
    out.std[axis] = std::sqrt(slow_noise.flicker[axis] * periods +
                              slow_noise.random_walk[axis] * session_s / 3.0);
  return out;
}

std::vector<TypeB> type_b_of(const BiasStability& stability, const std::string& reading_unit) {
  std::vector<TypeB> lines;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    TypeB& line = lines.emplace_back();
    line.source = "stability between sessions";
    line.axis = axis;
    line.std = stability.std[axis];
    line.unit = reading_unit;
  }
  return lines;
}

}  // namespace proofmass::calibrate
