#include <algorithm>
#include <cmath>
#include <numbers>

#include "proofmass/estimate/wheel/live_filter.hpp"

// Online estimation of the sensors' lever arms.
namespace proofmass::estimate {

/// Replaces the prior of the lever arm by the given radius: the sensor is on its circle or, while
/// the measurements do not show on which side, within it.
template <int S>
void LiveWheelFilter<S>::use_radius(double radius_m) {
  const double within_m = std::max(radius_m / std::numbers::sqrt2, 2e-4);
  const double more = 1.0 / (within_m * within_m) - 1.0 / std::pow(ConstantsPrior{}.place_m, 2);
  for (int i = 0; i < places && more > 0.0; ++i)
    learn_place(Mat<places>::Unit(i), -main_.x.mean(first_place + i), 1.0 / more);
  const double std_m = std::max(0.02 * radius_m, 2e-4);
  for (int s = 0; s < S; ++s) {
    if (!shows_place(s)) continue;
    const Mat<2> place = main_.x.mean.template segment<2>(first_place + 2 * s);
    Mat<places> outward = Mat<places>::Zero();
    outward.template segment<2>(2 * s) = place.normalized();
    learn_place(outward, radius_m - place.norm(), std_m * std_m);
  }
}

/// Whether the side of the axle on which a sensor is mounted is determined.
template <int S>
bool LiveWheelFilter<S>::shows_place(int sensor) const {
  const double found2 = main_.x.mean.template segment<2>(first_place + 2 * sensor).squaredNorm();
  return found2 > 25.0 * places_cov_.template block<2, 2>(2 * sensor, 2 * sensor).trace();
}

template <int S>
bool LiveWheelFilter<S>::knows_places() const {
  for (int s = 0; s < S; ++s) {
    const double found_m = main_.x.mean.template segment<2>(first_place + 2 * s).norm();
    const double std_m = std::sqrt(places_cov_.template block<2, 2>(2 * s, 2 * s).trace());
    if (std_m > std::max(0.05 * found_m, 2e-3)) return false;
  }
  return true;
}

/// Each innovation as a function of the lever arms: y(p + δ) = y − slopeᵀ δ.
template <int S>
void LiveWheelFilter<S>::expect() {
  for (std::size_t c = 0; c < static_cast<std::size_t>(step_.count); ++c) {
    Mat<places> slope;
    for (int i = 0; i < places; ++i)
      slope(i) =
          (step_.updates[c].innovation - moved_[static_cast<std::size_t>(i)].innovations[c]) /
          place_step_m;
    expected_[c] = step_.updates[c].expected + slope.dot(places_cov_ * slope);
  }
}

/// A measurement `residual` = slopeᵀ (p − p̂) + noise. States that depend on the lever arms are
/// updated with them, with the sensitivities from the parallel filters.
template <int S>
void LiveWheelFilter<S>::learn_place(const Mat<places>& slope, double residual, double variance) {
  const Mat<places> across = places_cov_ * slope;
  const double weight = 1.0 / (variance + slope.dot(across));
  places_cov_ -= weight * across * across.transpose();
  const Mat<places> by = weight * residual * across;
  Mat<states> change = Mat<states>::Zero();
  for (int i = 0; i < places; ++i)
    change +=
        by(i) / place_step_m * (moved_[static_cast<std::size_t>(i)].state.x.mean - main_.x.mean);
  main_.x.mean += change;
  for (Moved& moved : moved_) moved.state.x.mean += change;
  for (Rival& rival : rivals_) rival.state.x.mean += change;
}

/// Uncertainty of the wheel's angle and speed due to the lever arms.
template <int S>
Mat<2> LiveWheelFilter<S>::places_variance() const {
  const auto motion = [this](const FilterState<states>& state) {
    const auto now = model_.motion(state.x.mean);
    return Mat<2>{now.angle, now.speed};
  };
  const Mat<2> here = motion(main_);
  Mat<2, places> slope;
  for (int i = 0; i < places; ++i)
    slope.col(i) = (motion(moved_[static_cast<std::size_t>(i)].state) - here) / place_step_m;
  return (slope * places_cov_).cwiseProduct(slope).rowwise().sum();
}

template void LiveWheelFilter<1>::use_radius(double);
template bool LiveWheelFilter<1>::knows_places() const;
template bool LiveWheelFilter<1>::shows_place(int) const;
template void LiveWheelFilter<1>::expect();
template void LiveWheelFilter<1>::learn_place(const Mat<2>&, double, double);
template Mat<2> LiveWheelFilter<1>::places_variance() const;

template void LiveWheelFilter<2>::use_radius(double);
template bool LiveWheelFilter<2>::knows_places() const;
template bool LiveWheelFilter<2>::shows_place(int) const;
template void LiveWheelFilter<2>::expect();
template void LiveWheelFilter<2>::learn_place(const Mat<4>&, double, double);
template Mat<2> LiveWheelFilter<2>::places_variance() const;

}  // namespace proofmass::estimate
