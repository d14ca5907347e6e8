#include "proofmass/estimate/drive/model.hpp"

#include <cmath>

#include "proofmass/core/statistics.hpp"
#include "proofmass/core/units.hpp"
#include "proofmass/estimate/filter/iteration.hpp"

namespace proofmass::estimate::drive {
namespace {

using State = Mat<at::states>;
using Rows = Readings<at::states, Model::channels>;

// Zero-velocity measurements while all wheels stand.
constexpr double standing_std_mps = 0.01, standing_std_radps = 0.002;
// Toe, Ackermann error and tyre slip of a steered wheel; steering angle when nearly standing.
constexpr double steer_std_rad = 0.02, parked_steer_std_rad = 0.5;
// White error of a gyroscope's yaw: on the frame that of stamps by some milliseconds in a bend of
// 0.3 rad/s; on a wheel its axes rotate, and their errors with them.
constexpr double wheel_yaw_std_rad = 0.002, frame_yaw_std_rad = 0.0007;
// Sideways motion of the reference point is a random walk of the size of slip.
constexpr double huber = 3.0, reject_beyond = 12.0;

Reading<at::states>& add_row(Rows& out) {
  auto& row = out.rows[static_cast<std::size_t>(out.count++)];
  row.h.setZero();
  return row;
}

// d(R(angle) (u, v)) / d angle and R itself.
struct Turned {
  double c, s;
  explicit Turned(double angle) : c(std::cos(angle)), s(std::sin(angle)) {}
  [[nodiscard]] Mat<2> operator()(const Mat<2>& a) const {
    return {c * a(0) - s * a(1), s * a(0) + c * a(1)};
  }
  [[nodiscard]] Mat<2> slope(const Mat<2>& a) const {
    return {-s * a(0) - c * a(1), c * a(0) - s * a(1)};
  }
};

}  // namespace

Rolling rolling(const State& x, double side, bool steered) {
  const double v = x(at::speed), w = x(at::rate), c = 0.5 * side * x(at::track);
  const double along = v - w * c;
  Rolling wheel;
  if (!steered) {
    wheel.speed = along;
    wheel.by_speed = {1.0, -c, -0.5 * side * w, 0.0};
    wheel.by_steer.setZero();
    return wheel;
  }
  const double b = x(at::base), across = w * b;
  const double size = std::hypot(along, across), sign = along < 0.0 ? -1.0 : 1.0;
  const Mat<4> d_along{1.0, -c, -0.5 * side * w, 0.0}, d_across{0.0, b, 0.0, w};
  wheel.speed = sign * size;
  if (size < 1e-9) {
    wheel.by_speed = d_along;
    wheel.by_steer.setZero();
    return wheel;
  }
  wheel.by_speed = sign * (along * d_along + across * d_across) / size;
  wheel.steer = std::atan(across / (along == 0.0 ? 1e-9 : along));
  wheel.by_steer = (along * d_across - across * d_along) / (size * size);
  return wheel;
}

Transition<at::states, at::dynamic> Model::transition(const State& x, std::size_t k) const {
  const double h = (*epochs)[k].dt_s;
  const double v = x(at::speed), w = x(at::rate), psi = x(at::heading) + 0.5 * w * h;
  const double c = std::cos(psi), s = std::sin(psi);
  const double direction = (*epochs)[k].direction;
  Transition<states, moving> step;
  // Columns of speed and rate: they act in the step in which they change.
  Mat<moving> by_v = Mat<moving>::Zero(), by_w = by_v;
  by_v(at::x) = h * c;
  by_v(at::y) = h * s;
  by_v(at::path) = h * direction;
  by_v(at::speed) = 1.0;
  by_w(at::x) = -0.5 * v * h * h * s;
  by_w(at::y) = 0.5 * v * h * h * c;
  by_w(at::heading) = h;
  by_w(at::rate) = 1.0;
  step.F.setIdentity();
  step.mean = x.head<moving>();
  step.mean(at::x) += v * h * c;
  step.mean(at::y) += v * h * s;
  step.mean(at::heading) += w * h;
  step.mean(at::path) += v * h * direction;
  step.F(at::x, at::heading) = -v * h * s;
  step.F(at::y, at::heading) = v * h * c;
  const double slip2_m2 = square(noise.slip_m_per_rtm) * std::abs(v) * h;
  step.Q.setZero();
  for (int i = 0; i < vehicle.wheels; ++i) {
    const auto n = static_cast<std::size_t>(i);
    const Rolling wheel = rolling(x, vehicle.side[n], vehicle.steered[n]);
    const double nominal_s = h * std::exp(-x(at::radius + i));
    step.mean(at::rolled + i) += wheel.speed * nominal_s;
    by_v(at::rolled + i) = wheel.by_speed(0) * nominal_s;
    by_w(at::rolled + i) = wheel.by_speed(1) * nominal_s;
    step.F(at::rolled + i, at::track) = wheel.by_speed(2) * nominal_s;
    step.F(at::rolled + i, at::base) = wheel.by_speed(3) * nominal_s;
    step.F(at::rolled + i, at::radius + i) = -wheel.speed * nominal_s;
    step.Q(at::rolled + i, at::rolled + i) = slip2_m2;
  }
  step.F.col(at::speed) = by_v;
  step.F.col(at::rate) = by_w;
  step.Q += noise.speed_psd * h * by_v * by_v.transpose();
  step.Q += noise.rate_psd * h * by_w * by_w.transpose();
  step.Q(at::x, at::x) += slip2_m2;
  step.Q(at::y, at::y) += slip2_m2;
  const double fade = std::exp(-h / noise.wander_s);
  for (const int i : {at::wander, at::wander + 1}) {
    step.F(i, i) = fade;
    step.mean(i) *= fade;
    step.Q(i, i) = with_fixes ? square(noise.wander_std_m) * (1.0 - fade * fade) : 0.0;
  }
  step.walk.setZero();
  for (int j = 0; j < most_gyros; ++j)
    step.walk(at::drift + j) = (*epochs)[k].yaw_walk_rad2[static_cast<std::size_t>(j)];
  return step;
}

void Model::measure_wheels(const State& x, const Epoch& now, Rows& out) const {
  for (int i = 0; i < vehicle.wheels; ++i) {
    const auto n = static_cast<std::size_t>(i);
    if (std::isnan(now.angle_rad[n])) continue;
    auto& row = add_row(out);
    const double per_m = 1.0 / vehicle.radius_m[n];
    const int clock = vehicle.clock[n];
    const double lead_s = x(at::clock + clock) - vehicle.offset_s[static_cast<std::size_t>(clock)];
    row.value = now.angle_rad[n];
    row.predicted = x(at::rolled + i) * per_m - now.angle_rate_radps[n] * lead_s;
    row.variance = square(now.angle_std_rad[n]);
    row.h(at::rolled + i) = per_m;
    row.h(at::clock + clock) = -now.angle_rate_radps[n];
  }
}

void Model::measure_yaw(const State& x, const Epoch& now, Rows& out) const {
  for (int j = 0; j < most_gyros; ++j) {
    const auto n = static_cast<std::size_t>(j);
    if (std::isnan(now.yaw_rad[n])) continue;
    auto& row = add_row(out);
    const bool steered = j < most_wheels && vehicle.steered[n];
    const double gain = 1.0 + x(at::yaw_scale + j);
    Rolling wheel;
    wheel.by_steer.setZero();
    if (steered && now.turns) wheel = rolling(x, vehicle.side[n], true);
    const int clock = vehicle.clock[n];
    const double lead_s = x(at::clock + clock) - vehicle.offset_s[static_cast<std::size_t>(clock)];
    const double seen = x(at::heading) + wheel.steer;
    row.value = now.yaw_rad[n];
    row.predicted = gain * seen + x(at::drift + j) - now.yaw_rate_radps[n] * lead_s;
    const bool as_steered = steered || (comparing && j < most_wheels);
    row.variance = square(as_steered        ? (now.turns ? steer_std_rad : parked_steer_std_rad)
                          : j < most_wheels ? wheel_yaw_std_rad
                                            : frame_yaw_std_rad);
    row.h(at::heading) = gain;
    row.h(at::yaw_scale + j) = seen;
    row.h(at::drift + j) = 1.0;
    row.h(at::clock + clock) = -now.yaw_rate_radps[n];
    for (int i = 0; i < 2; ++i) row.h(at::speed + i) += gain * wheel.by_steer(i);
    row.h(at::track) = gain * wheel.by_steer(2);
    row.h(at::base) = gain * wheel.by_steer(3);
    row.predicted += x(at::rate_bias + j) * now.moving_s;
    row.h(at::rate_bias + j) = now.moving_s;
  }
}

void Model::measure_fix(const State& x, const Epoch& now, Rows& out) const {
  if (!with_fixes || std::isnan(now.fix_east_m)) return;
  const double late_s = now.fix_after_s - x(at::clock + vehicle.fix_clock);
  const Turned along(x(at::heading)), chart(x(at::bearing));
  const Mat<2> a = x.segment<2>(at::antenna);
  const Mat<2> ahead = along(Mat<2>(1.0, 0.0)), lever = along(a);
  const Mat<2> local = x.segment<2>(at::x) + x(at::speed) * late_s * ahead + lever;
  const Mat<2> seen = x.segment<2>(at::origin) + chart(local) + x.segment<2>(at::wander);
  const Mat<2> by_heading =
      chart(x(at::speed) * late_s * along.slope(Mat<2>(1.0, 0.0)) + along.slope(a));
  const Mat<2> by_clock = chart(-x(at::speed) * ahead), by_bearing = chart.slope(local);
  const Mat<2> by_speed = chart(late_s * ahead);
  const Mat<2> ax = chart(along(Mat<2>(1.0, 0.0))), ay = chart(along(Mat<2>(0.0, 1.0)));
  const Mat<2> ex = chart(Mat<2>(1.0, 0.0)), ey = chart(Mat<2>(0.0, 1.0));
  for (int i = 0; i < 2; ++i) {
    auto& row = add_row(out);
    row.value = i == 0 ? now.fix_east_m : now.fix_north_m;
    row.predicted = seen(i);
    row.variance = square(noise.fix_std_m) + now.fix_variance_m2;
    row.h(at::x) = ex(i);
    row.h(at::y) = ey(i);
    row.h(at::heading) = by_heading(i);
    row.h(at::speed) = by_speed(i);
    row.h(at::clock + vehicle.fix_clock) = by_clock(i);
    row.h(at::bearing) = by_bearing(i);
    row.h(at::antenna) = ax(i);
    row.h(at::antenna + 1) = ay(i);
    row.h(at::origin + i) = row.h(at::wander + i) = 1.0;
  }
}

void Model::measure(const State& x, std::size_t k, Rows& out) const {
  out.count = out.constraints = 0;
  const Epoch& now = (*epochs)[k];
  measure_wheels(x, now, out);
  measure_yaw(x, now, out);
  measure_fix(x, now, out);
  if (now.direction != 0) return;
  for (const int i : {at::speed, at::rate}) {
    auto& row = add_row(out);
    row.value = 0.0;
    row.predicted = x(i);
    row.variance = square(i == at::speed ? standing_std_mps : standing_std_radps);
    row.h(i) = 1.0;
  }
  out.constraints = 2;
}

Mat<seen_states> seen(const State& x) {
  const Mat<2> p = Turned(x(at::bearing))(Mat<2>(x.segment<2>(at::x)));
  Mat<seen_states> out;
  out << p, x(at::bearing) + x(at::heading), x(at::path), x(at::speed);
  return out;
}

Mat<at::states, seen_states> seen_slopes(const State& x) {
  const Turned chart(x(at::bearing));
  const Mat<2> by_bearing = chart.slope(Mat<2>(x.segment<2>(at::x)));
  Mat<at::states, seen_states> G = Mat<at::states, seen_states>::Zero();
  for (int i = 0; i < 2; ++i) {
    G(at::x, i) = i == 0 ? chart.c : chart.s;
    G(at::y, i) = i == 0 ? -chart.s : chart.c;
    G(at::bearing, i) = by_bearing(i);
  }
  G(at::heading, 2) = G(at::bearing, 2) = G(at::path, 3) = G(at::speed, 4) = 1.0;
  return G;
}

namespace {

// The model linearised about a path. Speed and yaw rate act in the step in which they change, so a
// step is linearised about their values at its end: with those at its start the product of a
// scale and the change would be lost, and since the change follows the measurements' noise, the sum
// of these products is not zero.
struct AboutPath : detail::LinearAbout<Model> {
  [[nodiscard]] Transition<states, moving> transition(const State& x, std::size_t k) const {
    State about = path[k - 1];
    about(at::speed) = path[k](at::speed);
    about(at::rate) = path[k](at::rate);
    Transition<states, moving> step = model.transition(about, k);
    step.mean += step.F * (x - about).head<moving>();
    return step;
  }
};

template <class AnyModel>
void run_into(const AnyModel& model,
              const Model& plain,
              const Gaussian<at::states>& prior,
              bool backwards,
              Pass& pass) {
  const Gate gate{.huber = huber, .limit = reject_beyond};
  const FilterState<at::states> start{prior, 0};
  const auto forward = [&](std::size_t k, const StepOf<Model>& step) {
    const Epoch& epoch = (*plain.epochs)[k];
    const bool has_fix = plain.with_fixes && !std::isnan(epoch.fix_east_m);
    const int constraints = epoch.direction == 0 ? 2 : 0;
    if (has_fix) ++pass.fixes;
    for (int i = 0; i < step.count; ++i) {
      const auto& update = step.updates[static_cast<std::size_t>(i)];
      // Down-weighted and rejected measurements count with the gate's bound.
      const double nis = std::min(update.nis(), square(huber) * 2.0);
      pass.log_likelihood -= 0.5 * (std::log(update.expected) + nis);
      const bool of_fix =
          has_fix && i >= step.count - constraints - 2 && i < step.count - constraints;
      if (of_fix && update.used && !epoch.fix_doubted && i == step.count - constraints - 1)
        ++pass.fixes_used;
      pass.chi2 += nis;
      if (i < step.count - constraints) {
        pass.nis += nis;
        ++pass.readings;
      }
    }
    if (k + 1 == plain.size()) pass.end = step.filtered;
  };
  if (!backwards) {
    FilterState<at::states> state = start;
    filter(model, {0, model.size()}, gate, state, forward);
    return;
  }
  pass.path.resize(model.size());
  pass.seen_cov.resize(model.size());
  smooth(
      model, start, gate, forward,
      [&](std::size_t k, const StepOf<Model>& step, const BackwardInformation<at::states>& later) {
        pass.path[k] = later.mean(step.filtered);
        const Mat<at::states, seen_states> G = seen_slopes(pass.path[k]);
        const Mat<at::states, seen_states> PG = step.filtered.cov.lazyProduct(G);
        const Mat<at::states, seen_states> LPG = later.Lambda.lazyProduct(PG);
        pass.seen_cov[k] = G.transpose() * PG - PG.transpose() * LPG;
        if (k == 0) pass.start = {pass.path[0], later.template cov<at::states>(step.filtered)};
      });
}

}  // namespace

Pass run(const Model& model,
         const Gaussian<at::states>& prior,
         const std::vector<State>& about,
         bool backwards) {
  Pass pass;
  if (about.size() == model.size())
    run_into(AboutPath{{model, about.data()}}, model, prior, backwards, pass);
  else
    run_into(model, model, prior, backwards, pass);
  if (pass.readings > 0) pass.nis /= static_cast<double>(pass.readings);
  return pass;
}

}  // namespace proofmass::estimate::drive
