#include "proofmass/estimate/wheel/settle.hpp"

#include <numbers>
#include <numeric>

#include "proofmass/core/linalg.hpp"

namespace proofmass::estimate {
namespace {

/// Prior of the constants, depending on how far the wheel turns.
ConstantsPrior prior_for(const WheelPath& path, const WheelReadings& readings) {
  const auto angle = [](const Mat<wheel::moving>& at) { return at(wheel::angle); };
  const auto [lowest, highest] = std::ranges::minmax_element(path.moving, {}, angle);
  const bool short_way = angle(*highest) - angle(*lowest) < rad_per_turn;
  ConstantsPrior prior = short_way ? short_way_prior : ConstantsPrior{};
  if (!short_way) prior.ripple = ripple_share;
  if (readings.encoder) prior.encoder_errors_rad = readings.encoder->errors_rad;
  for (std::size_t s = 0; s < readings.sensors.size(); ++s)
    prior.axle_slopes[s] = readings.sensors[s].axle_slope;
  return prior;
}

/// The prior with its mean moved to a candidate lever arm, along the directions in which it is
/// wide.
PlacesPrior moved_where_open(const PlacesPrior& belief, const Places& to) {
  PlacesPrior moved = belief;
  const SymmetricEigen axes = symmetric_eigen(belief.cov);
  for (Eigen::Index i = 0; i < axes.values.size(); ++i)
    if (axes.values(i) > 0.25 * axes.values.maxCoeff())
      moved.mean += axes.vectors.col(i).dot(to - belief.mean) * axes.vectors.col(i);
  return moved;
}

/// Least squares of one order's (c, s) on the residuals of a path.
struct RippleFit {
  Mat<2, 2> information = Mat<2, 2>::Zero();
  Mat<2> score = Mat<2>::Zero();

  void add(const Mat<2>& h, double residual) {
    information += h * h.transpose();
    score += h * residual;
  }
  /// Reduction of the sum of squares.
  [[nodiscard]] double explained() const {
    const double cc = information(0, 0), cs = information(0, 1), ss = information(1, 1);
    const double determinant = cc * ss - cs * cs;
    if (!(determinant > 1e-12 * square(cc + ss))) return 0.0;
    return (ss * square(score(0)) - 2.0 * cs * score(0) * score(1) + cc * square(score(1))) /
           determinant;
  }
};

/// The hub's acceleration ρ α tilts the apparent gravity: to a model with another rolling radius, a
/// ripple c of order n appears as c (1 + n² ω² ρ/g). Adapts the path's ripple from one radius to
/// another. A ripple found with ρ = 0 may be ten times too large, and its acceleration, in a model
/// with ρ > 0, further from the measurements than a filter linearised about it can return.
template <int S>
void adapt_ripple(double from_m, double to_m, const WheelReadings& readings, WheelPath& path) {
  double square_sum = 0.0;
  for (const Mat<wheel::moving>& at : path.moving) square_sum += square(at(wheel::speed));
  const double mean_square = square_sum / static_cast<double>(path.moving.size());
  for (std::size_t i = 0; i < readings.orders.size(); ++i) {
    const double per_m = square(readings.orders[i]) * mean_square / readings.gravity_mps2;
    const int at = wheel::ripple(S) - wheel::first_of(0) + 2 * static_cast<int>(i);
    path.standing.segment<2>(at) *= (1.0 + per_m * from_m) / (1.0 + per_m * to_m);
  }
}

/// Changes the model's rolling radius, and with it the ripple of the path, whose own difference
/// from the model's is reset.
template <int S>
void change_rolling_radius(double to_m,
                           const WheelReadings& readings,
                           WheelModel<S>& model,
                           WheelPath& path) {
  if (to_m == model.rolling_radius_m) return;
  adapt_ripple<S>(model.rolling_radius_m, to_m, readings, path);
  path.standing(wheel::rolling(S) - wheel::first_of(0)) = 0.0;
  model.rolling_radius_m = to_m;
}

/// Whether the recording shows that the wheel does not roll on the radius assumed for a hub that
/// vibrates. What a strong ripple leaves in the residuals, in proportion to the speed, resembles a
/// vehicle's vibration; but with a vehicle's radius, the hub's acceleration would be far from what
/// is measured.
template <int S>
bool is_not_a_vehicle(const WheelReadings& readings,
                      WheelModel<S> model,
                      WheelPrior prior,
                      const WheelPath& path) {
  if (!readings.shakes || readings.given_rolling_radius_m || readings.found_rolling_radius_m ||
      model.rolling_radius_m != 0.0)
    return false;
  constexpr std::size_t most_epochs = 20'000;
  // An epoch. Without a gyroscope it is below 0.4 for vehicles and about 50 for benches. With one,
  // which shows what acceleration the hub would have: below 0 for vehicles, 0.1 for a bench.
  const double clearly = model.with_gyro ? 0.02 : 5.0;
  const std::size_t epochs = std::min(model.size(), most_epochs);
  if (model.with_gyro) prior.spread.rolling_m = 0.0;
  const double fixed = log_likelihood_of(model, prior_state<S>(prior), 0, epochs);
  WheelPath rolling = path;
  model.about = &rolling;
  change_rolling_radius(readings.rolling_radius_m.value, readings, model, rolling);
  if (model.with_gyro) prior.spread.rolling_m = rolling_prior_std_m(readings, true);
  const double vehicle = log_likelihood_of(model, prior_state<S>(prior), 0, epochs);
  return fixed - vehicle > clearly * static_cast<double>(epochs);
}

/// One iteration: the measurements' variance, the motion noise and the sensors' lever arms, all
/// about the current path, whose ripple is adapted to the rolling radius.
template <int S>
Settled<S> settle(WheelReadings& readings, WheelTrack& track, const PlacesPrior& belief) {
  auto model = held_model<S>(readings, track.noise, track.path);
  const Places places = track.path.standing.tail<2 * S>();
  WheelPrior prior{track.beginning, prior_for(track.path, readings), places};
  settle_variance(model, prior, readings);
  // Before the ripple is fitted it raises the residuals as vibration does, and with a vehicle's
  // rolling radius in the model it could not be fitted.
  const int ripple_at = wheel::ripple(S) - wheel::first_of(0);
  if (track.path.standing.segment<2 * wheel::ripple_orders>(ripple_at).isZero())
    readings.shakes = false;
  assume_rolling_radius(readings);
  if (is_not_a_vehicle(readings, model, prior, track.path)) {
    readings.shakes = false;
    assume_rolling_radius(readings);
  }
  change_rolling_radius(readings.rolling_radius_m.value, readings, model, track.path);
  if (model.with_gyro) prior.spread.rolling_m = rolling_prior_std_m(readings, true);
  const Excerpt<S> excerpt = excerpt_to_tune(model, prior);
  model.noise = tune_noise(model, excerpt, track.tuned).noise;
  const FoundPlaces likeliest = likeliest_places(model, excerpt, prior, belief);
  WheelPath about = track.path;
  about.standing.tail<2 * S>() = likeliest.mean;
  model.about = &about;
  PlacesPrior moved = moved_where_open(belief, likeliest.mean);
  const FoundPlaces found = places_by_levers(model, levers_of(track.path, readings), prior, moved);
  prior.places = found.mean;
  return {model.noise, prior, found.cov, {}, std::move(moved), likeliest.log_likelihood};
}

/// The model's orders on the residuals of a path.
template <int S>
std::array<RippleFit, wheel::ripple_orders> fit_orders(const WheelModel<S>& model,
                                                       const WheelPath& path) {
  std::array<RippleFit, wheel::ripple_orders> fits;
  typename WheelModel<S>::State x = WheelModel<S>::State::Zero();
  x.template tail<wheel::standing(S)>() = path.standing;
  Readings<wheel::states(S), WheelModel<S>::channels> out;
  // That is enough for the choice, in steps that are short against a cycle.
  constexpr std::size_t enough = 50'000;
  const std::size_t stride = std::max<std::size_t>(1, model.size() / enough);
  for (std::size_t k = 0; k < model.size(); k += stride) {
    x.template head<wheel::moving>() = path.moving[k];
    model.measure(x, k, out);
    const double turned = std::abs(path.moving[k](wheel::speed)) * (*model.epochs)[k].dt_s;
    for (std::size_t o = 0; o < fits.size(); ++o) {
      // Beyond half a cycle between measurements an order is aliased.
      if (!(model.orders[o] * turned < std::numbers::pi)) continue;
      const int at = wheel::ripple(S) + 2 * static_cast<int>(o);
      for (int i = 0; i < out.count - out.constraints; ++i) {
        const auto& row = out.rows[static_cast<std::size_t>(i)];
        fits[o].add(row.h.template segment<2>(at), row.value - row.predicted);
      }
    }
  }
  return fits;
}

}  // namespace

template <int S>
RippleOrders orders_in(const WheelReadings& readings, const WheelPath& path) {
  WheelModel<S> model = held_model<S>(readings, {}, path);
  std::array<double, highest_order + 1> explained{};
  for (const RippleOrders& tried : {RippleOrders{3, 4, 5, 6}, {7, 8, 9, 10}, {9, 10, 11, 12}}) {
    model.orders = tried;
    const auto fits = fit_orders(model, path);
    for (std::size_t o = 0; o < tried.size(); ++o)
      explained[static_cast<std::size_t>(tried[o])] = fits[o].explained();
  }
  std::array<int, highest_order - 2> others{};
  std::iota(others.begin(), others.end(), 3);
  std::ranges::stable_sort(others, std::ranges::greater{},
                           [&](int n) { return explained[static_cast<std::size_t>(n)]; });
  return {1, 2, others[0], others[1]};
}

template <int S>
Calibrated<S> improve(const WheelReadings& readings, const Settled<S>& settled, WheelTrack& track) {
  const auto model = held_model<S>(readings, settled.noise, track.path);
  Traced<S> traced = trace_path(model, prior_state<S>(settled.prior));
  track.path = std::move(traced.path);
  track.noise = settled.noise;
  track.tuned = true;
  track.beginning.angle_rad = traced.end.mean(wheel::start);
  track.beginning.speed_radps = track.path.moving.front()(wheel::speed);
  constexpr int count = wheel::standing(S);
  return {traced.first, traced.end.cov.template bottomRightCorner<count, count>()};
}

template <int S>
Settled<S> settle_rounds(WheelReadings& readings,
                         WheelTrack& track,
                         const PlacesPrior& belief,
                         int most,
                         const Progress& progress) {
  Settled<S> settled = settle<S>(readings, track, belief);
  for (int round = 1; round < most; ++round) {
    if (progress) progress("noise and constants", static_cast<double>(round) / most);
    const double before = settled.log_likelihood;
    improve(readings, settled, track);
    settled = settle<S>(readings, track, belief);
    if (round > 1 && std::abs(settled.log_likelihood - before) < 1.0) break;
  }
  settled.widened =
      widening(held_model<S>(readings, settled.noise, track.path), levers_of(track.path, readings),
               readings.time_s, settled.prior, settled.belief);
  const auto by = settled.widened.template tail<2 * S>().asDiagonal();
  settled.places_cov = by * settled.places_cov * by;
  return settled;
}

template RippleOrders orders_in<1>(const WheelReadings&, const WheelPath&);
template RippleOrders orders_in<2>(const WheelReadings&, const WheelPath&);
template Calibrated<1> improve(const WheelReadings&, const Settled<1>&, WheelTrack&);
template Calibrated<2> improve(const WheelReadings&, const Settled<2>&, WheelTrack&);
template Settled<1> settle_rounds(
    WheelReadings&, WheelTrack&, const PlacesPrior&, int, const Progress&);
template Settled<2> settle_rounds(
    WheelReadings&, WheelTrack&, const PlacesPrior&, int, const Progress&);

}  // namespace proofmass::estimate
