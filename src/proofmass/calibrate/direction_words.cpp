#include "proofmass/calibrate/direction_words.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <vector>

#include "proofmass/core/units.hpp"

namespace proofmass::calibrate {
namespace {

std::string axis_words(Eigen::Index axis, bool down) {
  return std::string(down ? "−" : "+") + "xyz"[axis];
}

}  // namespace

std::string direction_words(const Eigen::Vector3d& force) {
  const double length = force.norm();
  if (!(length > 0.0)) return "";
  const Eigen::Vector3d up = force / length;
  Eigen::Index main = 0;
  const double along = up.cwiseAbs().maxCoeff(&main);
  const auto name = [&](Eigen::Index k) { return axis_words(k, up(k) < 0.0); };
  const double tilt_deg = std::acos(std::min(along, 1.0)) / rad_per_deg;
  std::string text = name(main) + " up";
  if (tilt_deg < 0.95) return text;
  Eigen::Index more = (main + 1) % 3, less = (main + 2) % 3;
  if (std::abs(up(less)) > std::abs(up(more))) std::swap(more, less);
  text += fmt::format(", {:.0f}° to {}", tilt_deg, name(more));
  // Within 22.5° of an axis only the axis is named.
  constexpr double aside = 0.41421356;
  if (std::abs(up(less)) > aside * std::abs(up(more))) text += " and " + name(less);
  return text;
}

std::string laying_words(const Eigen::Vector3i& side) {
  std::vector<std::string> up;
  for (Eigen::Index k = 0; k < 3; ++k)
    if (side(k) != 0) up.push_back(axis_words(k, side(k) < 0));
  if (up.size() == 1) return fmt::format("place it with {} straight up", up[0]);
  if (up.size() == 2)
    return fmt::format("tilt it until {} and {} both point 45° above the horizontal", up[0], up[1]);
  return fmt::format("place it on a corner, with {}, {} and {} all 35° above the horizontal", up[0],
                     up[1], up[2]);
}

}  // namespace proofmass::calibrate
