#include "proofmass/estimate/wheel/gravity_fit.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "proofmass/core/linalg.hpp"
#include "proofmass/core/statistics.hpp"

namespace proofmass::estimate {
namespace {

constexpr double no_angle = std::numeric_limits<double>::quiet_NaN();

/// Half of the time over which calm() takes changes, s.
double reach_s_at(double speed_radps) {
  constexpr double half_rad = rad_per_turn / 8.0, half_s = 0.5;
  return std::min(half_rad / std::abs(speed_radps), half_s);
}

/// Sets acceleration, calm speed and jerk from those of the parabolas.
void calm(const std::vector<double>& time_s, std::vector<EncoderMotion>& motion) {
  const std::vector<EncoderMotion> sharp = motion;
  // f(k, first and last epoch within its reach)
  const auto for_each_reach = [&](const auto& f) {
    std::size_t from = 0, to = 0;
    for (std::size_t k = 0; k < motion.size(); ++k) {
      const double reach_s = reach_s_at(sharp[k](1));
      while (time_s[from] < time_s[k] - reach_s) ++from;
      while (from > 0 && time_s[from - 1] >= time_s[k] - reach_s) --from;
      to = std::max(to, k);
      while (to + 1 < sharp.size() && time_s[to + 1] <= time_s[k] + reach_s) ++to;
      while (to > k && time_s[to] > time_s[k] + reach_s) --to;
      if (to > from) f(k, from, to);
    }
  };
  for_each_reach([&](std::size_t k, std::size_t from, std::size_t to) {
    const double span_s = time_s[to] - time_s[from];
    motion[k](2) = (sharp[to](1) - sharp[from](1)) / span_s;
    motion[k](3) = (sharp[to](0) - sharp[from](0)) / span_s;
  });
  for_each_reach([&](std::size_t k, std::size_t from, std::size_t to) {
    motion[k](4) = (motion[to](2) - motion[from](2)) / (time_s[to] - time_s[from]);
  });
}

/// ∂ψ'/∂p of the errors.
GravityFit::Row by_angle(double psi) {
  GravityFit::Row x = GravityFit::Row::Zero();
  for (int n = 1; n <= GravityFit::orders; ++n) {
    x(GravityFit::errors + 2 * n - 2) = -std::cos(n * psi);
    x(GravityFit::errors + 2 * n - 1) = -std::sin(n * psi);
  }
  return x;
}

/// Normal equations of a turn.
struct Block {
  Mat<GravityFit::count, GravityFit::count> normal =
      Mat<GravityFit::count, GravityFit::count>::Zero();
  GravityFit::Row score = GravityFit::Row::Zero();
};

}  // namespace

std::vector<EncoderMotion> motion_of(const signal::AngleFixes& fixes,
                                     std::vector<double> time_s,
                                     double age_s) {
  for (double& t : time_s) t -= age_s;
  const signal::AngleMotion motion = signal::motion_at(fixes, time_s);
  std::vector<EncoderMotion> out;
  const auto known = [](double angle) { return !std::isnan(angle); };
  const auto first = std::ranges::find_if(motion.angle_rad, known);
  double latest = first == motion.angle_rad.end() ? 0.0 : *first;
  out.reserve(time_s.size());
  for (std::size_t k = 0; k < time_s.size(); ++k) {
    const double angle = motion.angle_rad[k];
    if (!known(angle)) {
      out.push_back((EncoderMotion() << latest, 0.0, 0.0, 0.0, 0.0).finished());
      continue;
    }
    latest = angle;
    const double speed = motion.speed_radps[k];
    out.push_back((EncoderMotion() << angle, speed, motion.accel_radps2[k], speed, 0.0).finished());
  }
  calm(time_s, out);
  return out;
}

double range_of(const std::vector<EncoderMotion>& motion) {
  const auto angle = [](const EncoderMotion& at) { return at(0); };
  const auto [lowest, highest] = std::ranges::minmax_element(motion, {}, angle);
  return (*highest)(0) - (*lowest)(0);
}

bool is_steady(const EncoderMotion& at) {
  constexpr double half_rad = rad_per_turn / 24.0, largest_change = 0.25;
  return std::abs(at(2)) * half_rad < largest_change * square(at(1));
}

bool has_one_speed(const std::vector<EncoderMotion>& motion) {
  std::vector<double> speeds;
  for (const EncoderMotion& at : motion)
    if (is_steady(at)) speeds.push_back(std::abs(at(3)));
  const auto low = quantile(speeds, 0.05), high = quantile(speeds, 0.95);
  return !low || *high < 1.05 * *low;
}

GravityFit::GravityFit(const Uncertain& delay_s,
                       const EncoderErrors& errors_rad,
                       bool one_speed,
                       double gravity_mps2)
    : gravity_mps2_(gravity_mps2) {
  prior_std_.setConstant(100.0);
  for (int axis = 0; axis < 2; ++axis)
    prior_std_.segment<2>(linear * axis + 2).setConstant(ConstantsPrior{}.place_m);
  prior_std_(delay) = delay_s.std;
  prior_std_(radius) = 1.0;
  prior_std_.tail<2 * orders>().setConstant(0.05);
  for (int i = 0; i < wheel::encoder_states - 1; ++i) {
    prior_(errors + i) = errors_rad[static_cast<std::size_t>(i)].value;
    prior_std_(errors + i) = errors_rad[static_cast<std::size_t>(i)].std;
  }
  prior_(delay) = delay_s.value;
  if (one_speed)
    for (const int i : {2, 3, linear + 2, linear + 3, +delay, +radius}) prior_std_(i) = 1e-6;
  at_ = prior_;
}

signal::AngleFixes GravityFit::corrected(signal::AngleFixes fixes) const {
  for (double& angle : fixes.angle_rad) angle += by_angle(angle).dot(at_);
  return fixes;
}

void GravityFit::step(const WheelReadings& readings, const std::vector<EncoderMotion>& motion) {
  constexpr double most_blocks = 200.0;
  const double block_rad = std::max(rad_per_turn, range_of(motion) / most_blocks);
  std::vector<Block> blocks;
  double turn = no_angle, squares = 0.0, lost = 0.0, used = 0.0;
  for_each_reading(readings, motion, [&](std::size_t k, const Mat<2>& reading) {
    if (const double now = std::floor(motion[k](0) / block_rad); now != turn) {
      blocks.emplace_back();
      turn = now;
    }
    auto& [normal, score] = blocks.back();
    const auto [off, by_rotation, rows] = residual_of(reading, motion[k]);
    for (int axis = 0; axis < 2; ++axis) {
      const Row x = rows.col(axis);
      normal += x * x.transpose() / variance_;
      score += off(axis) / variance_ * x;
      squares += square(off(axis));
      lost += std::min(square(off(axis) / (0.3 * gravity_mps2_)), 1.0);
      used += 1.0;
    }
  });
  if (used == 0.0) return;
  const Row information = prior_std_.array().square().inverse();
  Block all{information.asDiagonal(), information.cwiseProduct(prior_ - at_)};
  for (const Block& block : blocks) {
    all.normal += block.normal;
    all.score += block.score;
  }
  const Row move = positive_inverse(all.normal) * all.score;
  // What the prior contributes, and the scatter of the estimates without one of the blocks.
  Row variance =
      (positive_inverse(all.normal) * information.cwiseSqrt().asDiagonal()).rowwise().squaredNorm();
  for (const Block& block : blocks)
    variance += (positive_inverse(all.normal - block.normal) * (all.score - block.score) - move)
                    .cwiseAbs2();
  std_ = variance.cwiseSqrt();
  const Row before = at_;
  at_ += move;
  at_(delay) = std::max(at_(delay), 0.0);
  last_move_ = (at_ - before).cwiseQuotient(std_).cwiseAbs().maxCoeff();
  variance_ = std::max(squares / used, 1e-8);
  lost_ = lost / used;
}

GravityFit::Residual GravityFit::residual_of(const Mat<2>& reading,
                                             const EncoderMotion& motion) const {
  const double psi = motion(0), w = motion(1), al = motion(2), jerk = motion(4);
  Row by_square = Row::Zero(), by_accel = Row::Zero();  // ∂ω²/∂p and ∂α/∂p
  by_square(delay) = -2.0 * motion(3) * al;
  by_accel(delay) = -jerk;
  const double reach_rad = std::abs(w) * reach_s_at(w);
  for (int n = 1; n <= orders; ++n) {
    const double cos_n = n * std::cos(n * psi), sin_n = n * std::sin(n * psi);
    by_square.segment<2>(errors + 2 * n - 2) << 2.0 * w * w * sin_n, -2.0 * w * w * cos_n;
    // The change of speed over the reach is smaller than the acceleration.
    const double share = reach_rad > 0.0 ? std::sin(n * reach_rad) / (n * reach_rad) : 1.0;
    by_accel.segment<2>(errors + 2 * n - 2) << share * (al * sin_n + n * w * w * cos_n),
        share * (-al * cos_n + n * w * w * sin_n);
  }
  const double hub_s2 = at_(radius) / gravity_mps2_;
  Row x = by_angle(psi) - hub_s2 * by_accel;  // ∂ψ'/∂p of the common parameters
  x(delay) -= motion(3);
  x(radius) = -al / gravity_mps2_;
  const double at = psi - hub_s2 * al;
  Mat<linear> own;
  own << std::sin(at), std::cos(at), w * w, al, 1.0;
  Residual out;
  for (int axis = 0; axis < 2; ++axis) {
    const auto response = at_.segment<linear>(linear * axis);
    out.off(axis) = reading(axis) - response.dot(own);
    out.by_rotation(axis) = response(0) * own(1) - response(1) * own(0);
    out.by_parameters.col(axis) =
        out.by_rotation(axis) * x + response(2) * by_square + response(3) * by_accel;
    out.by_parameters.col(axis).segment<linear>(linear * axis) = own;
  }
  return out;
}

}  // namespace proofmass::estimate
