#include "proofmass/estimate/wheel_settle.hpp"

#include <complex>
#include <numeric>

#include "proofmass/core/linalg.hpp"

namespace proofmass::estimate {
namespace {

/// One standard deviation of each part of the ripple, about zero: a wheel by hand or by a motor.
constexpr double ripple_share = 0.02;

/// What may be believed of the constants, by how far the wheel turns.
ConstantsPrior prior_for(const WheelPath& path) {
  const auto angle = [](const Mat<wheel::moving>& at) { return at(wheel::angle); };
  const auto [lowest, highest] = std::ranges::minmax_element(path.moving, {}, angle);
  if (angle(*highest) - angle(*lowest) < rad_per_turn) return short_way_prior;
  ConstantsPrior prior;
  prior.ripple = ripple_share;
  return prior;
}

/// The belief with its mean moved to where a place may be, along the directions in which little was
/// believed.
PlacesPrior moved_where_open(const PlacesPrior& belief, const Places& to) {
  PlacesPrior moved = belief;
  const SymmetricEigen axes = symmetric_eigen(belief.cov);
  for (Eigen::Index i = 0; i < axes.values.size(); ++i)
    if (axes.values(i) > 0.25 * axes.values.maxCoeff())
      moved.mean += axes.vectors.col(i).dot(to - belief.mean) * axes.vectors.col(i);
  return moved;
}

/// One round: the readings' variance, the motion's noise and the sensors' places, all about the
/// path found so far.
template <int S>
Settled<S> settle(WheelReadings& readings,
                  const WheelTrack& track,
                  const PlacesPrior& belief,
                  double tuning_factor) {
  auto model = held_model<S>(readings, track.noise, track.path);
  const Places places = track.path.standing.tail<2 * S>();
  WheelPrior prior{track.beginning, prior_for(track.path), places};
  settle_variance(model, prior, readings);
  assume_rolling_radius(readings);
  model.rolling_radius_m = readings.rolling_radius_m.value;
  const Excerpt<S> excerpt = liveliest(model, prior);
  model.noise = tune_noise(model, excerpt, tuning_factor).noise;
  const FoundPlaces likeliest = likeliest_places(model, excerpt, prior, belief);
  WheelPath about = track.path;
  about.standing.tail<2 * S>() = likeliest.mean;
  model.about = &about;
  PlacesPrior moved = moved_where_open(belief, likeliest.mean);
  const FoundPlaces found = places_by_levers(model, levers_of(track.path, readings), prior, moved);
  prior.places = found.mean;
  return {model.noise, prior, found.cov, {}, std::move(moved), likeliest.log_likelihood};
}

}  // namespace

std::size_t instants_of_first_turn(const WheelPath& path) {
  const double start_rad = path.moving.front()(wheel::angle);
  const auto away = std::ranges::find_if(path.moving, [&](const Mat<wheel::moving>& at) {
    return std::abs(at(wheel::angle) - start_rad) > rad_per_turn;
  });
  return static_cast<std::size_t>(away - path.moving.begin());
}

RippleOrders orders_in(const WheelPath& path) {
  std::array<std::complex<double>, highest_order + 1> sums{};
  for (const Mat<wheel::moving>& at : path.moving) {
    const std::complex<double> turn = std::polar(1.0, -at(wheel::angle));
    std::complex<double> power = turn * turn;
    for (std::size_t n = 3; n < sums.size(); ++n) sums[n] += at(wheel::accel) * (power *= turn);
  }
  std::array<int, highest_order - 2> others{};
  std::iota(others.begin(), others.end(), 3);
  const auto is_stronger = [&](int one, int other) {
    const double a = std::norm(sums[static_cast<std::size_t>(one)]);
    const double b = std::norm(sums[static_cast<std::size_t>(other)]);
    return a > b || (a == b && one < other);
  };
  std::ranges::sort(others, is_stronger);
  return {1, 2, others[0], others[1]};
}

template <int S>
void improve(const WheelReadings& readings, const Settled<S>& settled, WheelTrack& track) {
  const auto model = held_model<S>(readings, settled.noise, track.path);
  WheelPath path = track.path;
  const auto end = trace_path(model, prior_state<S>(settled.prior), path);
  track.path = std::move(path);
  track.noise = settled.noise;
  track.beginning.angle_rad = end.mean(wheel::start);
  track.beginning.speed_radps = track.path.moving.front()(wheel::speed);
}

template <int S>
Settled<S> settle_rounds(WheelReadings& readings,
                         WheelTrack& track,
                         const PlacesPrior& belief,
                         int most,
                         const Progress& progress) {
  double tuning_factor = 10.0;
  Settled<S> settled = settle<S>(readings, track, belief, tuning_factor);
  for (int round = 1; round < most; ++round) {
    if (progress) progress("noise and constants", static_cast<double>(round) / most);
    const double before = settled.log_likelihood;
    improve(readings, settled, track);
    tuning_factor = std::sqrt(10.0);
    settled = settle<S>(readings, track, belief, tuning_factor);
    if (round > 1 && std::abs(settled.log_likelihood - before) < 1.0) break;
  }
  settled.widened =
      widening(held_model<S>(readings, settled.noise, track.path), levers_of(track.path, readings),
               readings.time_s, settled.prior, settled.belief);
  const auto by = settled.widened.template tail<2 * S>().asDiagonal();
  settled.places_cov = by * settled.places_cov * by;
  return settled;
}

template void improve(const WheelReadings&, const Settled<1>&, WheelTrack&);
template void improve(const WheelReadings&, const Settled<2>&, WheelTrack&);
template Settled<1> settle_rounds(
    WheelReadings&, WheelTrack&, const PlacesPrior&, int, const Progress&);
template Settled<2> settle_rounds(
    WheelReadings&, WheelTrack&, const PlacesPrior&, int, const Progress&);

}  // namespace proofmass::estimate
