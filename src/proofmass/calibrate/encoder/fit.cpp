#include "proofmass/calibrate/encoder/fit.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>

#include "proofmass/core/linalg.hpp"
#include "proofmass/core/statistics.hpp"

namespace proofmass::calibrate {
namespace {

namespace at = encoder;
using Eigen::Index;

/// Huber's limit, in standard deviations: knocks do not decide.
constexpr double huber = 4.0;

/// e(θ) and its first two derivatives.
struct EncoderError {
  double value = 0.0, slope = 0.0, curve = 0.0;
};

EncoderError error_at(const Eigen::VectorXd& parameters, double angle) {
  EncoderError out;
  for (std::size_t i = 0; i < encoder_orders; ++i) {
    const double n = static_cast<double>(i + 1);
    const double c = parameters(at::errors + 2 * static_cast<Index>(i));
    const double s = parameters(at::errors + 2 * static_cast<Index>(i) + 1);
    const double cos_n = std::cos(n * angle), sin_n = std::sin(n * angle);
    out.value += c * cos_n + s * sin_n;
    out.slope += n * (s * cos_n - c * sin_n);
    out.curve -= n * n * (c * cos_n + s * sin_n);
  }
  return out;
}

/// Legendre polynomials of the time.
std::array<double, at::drift_terms> drift_at(double phase) {
  const double p2 = phase * phase;
  return {1.0, phase, 0.5 * (3.0 * p2 - 1.0), 0.5 * (5.0 * p2 - 3.0) * phase};
}

Eigen::VectorXd priors(const at::Layout& layout,
                       const EncoderOptions& options,
                       const Eigen::VectorXd& parameters) {
  // Wide enough not to matter: the responses and drifts.
  constexpr double open = 1e6, error_std_rad = 0.3;
  Eigen::VectorXd std = Eigen::VectorXd::Constant(parameters.size(), open);
  std.segment<encoder_parameters>(at::errors).setConstant(error_std_rad);
  std(at::delay) = options.delay_s;
  std.segment<4>(at::runout).setConstant(std::max(options.runout_m, 1e-9));
  for (std::size_t sensor = 0; sensor < layout.sensors; ++sensor)
    std.segment<2>(layout.lever(sensor)).setConstant(options.radius_m);
  for (std::size_t axis = 0; axis < layout.axes; ++axis) {
    const Index first = layout.axis(axis);
    const double response = parameters.segment<2>(first + at::sin).norm();
    const double second = 0.5 * options.nonlinearity * std::max(response, 1e-3);
    std.segment<3>(first + at::nonlinear).setConstant(second);
    std.segment<2>(first + at::nonlinear + 3).setConstant(0.5 * second);
    std.segment<2>(first + at::nonlinear + 5).setConstant(1.5 * second);
  }
  return std;
}

/// Motion of the wheel at each row, and that at which the derivatives are taken.
struct WheelPoints {
  std::vector<WheelPoint> wheel, instrument;
};

/// Normal equations of one axis in the parameters that it sees, and the gradient of each block.
struct AxisNormal {
  Eigen::Matrix<double, at::seen, at::seen> information;  ///< Σ h̃ hᵀ/σ²
  Eigen::MatrixXd block_gradients;
  double squares = 0.0;  ///< of the residuals
  std::size_t count = 0;
};

AxisNormal normal_of(const EncoderRecording& recording,
                     const EncoderRows& rows,
                     const WheelPoints& points,
                     const at::Seen& parameters,
                     std::size_t axis,
                     double variance,
                     double gravity_mps2) {
  AxisNormal normal;
  normal.information.setZero();
  normal.block_gradients = Eigen::MatrixXd::Zero(at::seen, static_cast<Index>(rows.blocks));
  for (std::size_t k = 0; k < rows.row.size(); ++k) {
    const double value = recording.axes[axis][rows.row[k]];
    if (std::isnan(value)) continue;
    const AxisPrediction predicted =
        predict_axis(parameters, points.wheel[k], rows.phase[k], gravity_mps2);
    const at::Seen by =
        points.instrument.empty()
            ? predicted.h
            : predict_axis(parameters, points.instrument[k], rows.phase[k], gravity_mps2).h;
    const double residual = value - predicted.value;
    const double off = std::abs(residual) / std::sqrt(variance);
    const double weight = (off > huber ? huber / off : 1.0) / variance;
    normal.information.noalias() += weight * by * predicted.h.transpose();
    normal.block_gradients.col(static_cast<Index>(rows.block[k])) += weight * residual * by;
    normal.squares += residual * residual * weight * variance;
    ++normal.count;
  }
  return normal;
}

/// Normal equations of all.
struct Normal {
  Eigen::MatrixXd information, block_gradients;
};

/// Adds those of an axis, and updates its variance.
void add_axis(const AxisNormal& axis_normal,
              const at::Layout& layout,
              std::size_t axis,
              Normal& normal) {
  std::array<Index, at::seen> place{};
  for (Index i = 0; i < at::seen; ++i) {
    Index to = i;
    if (i >= at::common) to = layout.lever(layout.sensor_of[axis]) + i - at::common;
    if (i >= at::common + 2) to = layout.axis(axis) + i - at::common - 2;
    place[static_cast<std::size_t>(i)] = to;
  }
  for (Index i = 0; i < at::seen; ++i) {
    const Index to = place[static_cast<std::size_t>(i)];
    normal.block_gradients.row(to) += axis_normal.block_gradients.row(i);
    for (Index j = 0; j < at::seen; ++j)
      normal.information(to, place[static_cast<std::size_t>(j)]) += axis_normal.information(i, j);
  }
}

/// H⁻¹ (Σ_b g_b g_bᵀ B/(B − 1)) H⁻ᵀ with the gradients about their mean.
Eigen::MatrixXd scatter_of_blocks(const Normal& normal, const Eigen::MatrixXd& inverse) {
  const double blocks = static_cast<double>(normal.block_gradients.cols());
  const Eigen::VectorXd mean = normal.block_gradients.rowwise().mean();
  const Eigen::MatrixXd about = inverse * (normal.block_gradients.colwise() - mean);
  return about * about.transpose() * (blocks / (blocks - 1.0));
}

std::vector<WheelPoint> points_of(const EncoderMotion& motion, const Eigen::VectorXd& parameters) {
  std::vector<WheelPoint> points;
  points.reserve(motion.jerk_radps3.size());
  for (std::size_t k = 0; k < motion.jerk_radps3.size(); ++k) {
    points.push_back(true_point(parameters, motion.at.angle_rad[k], motion.at.speed_radps[k],
                                motion.at.accel_radps2[k]));
    points.back().jerk = motion.jerk_radps3[k];
  }
  return points;
}

/// Half the sum of squares of all residuals and of the parameters over their priors.
double cost_of(const EncoderRecording& recording,
               const EncoderRows& rows,
               const EncoderOptions& options,
               const EncoderFit& fit,
               const Eigen::VectorXd& parameters) {
  const at::Layout layout = at::layout_of(recording);
  const std::vector<WheelPoint> wheel = points_of(rows.shown, parameters);
  double cost = parameters.cwiseQuotient(fit.prior_std).squaredNorm();
  for (std::size_t axis = 0; axis < layout.axes; ++axis) {
    const at::Seen seen = at::seen_by(parameters, layout, axis);
    for (std::size_t k = 0; k < rows.row.size(); ++k) {
      const double value = recording.axes[axis][rows.row[k]];
      if (std::isnan(value)) continue;
      const double off =
          std::abs(value -
                   predict_axis(seen, wheel[k], rows.phase[k], options.gravity_mps2).value) /
          std::sqrt(fit.variance[axis]);
      cost += off <= huber ? off * off : 2.0 * huber * off - huber * huber;
    }
  }
  return 0.5 * cost;
}

/// The share of a step that reduces the cost, by halving.
double shortened(const EncoderRecording& recording,
                 const EncoderRows& rows,
                 const EncoderOptions& options,
                 const EncoderFit& fit,
                 const Eigen::VectorXd& step) {
  const double before = cost_of(recording, rows, options, fit, fit.parameters);
  double share = 1.0;
  for (int halving = 0; halving < 6; ++halving, share *= 0.5)
    if (cost_of(recording, rows, options, fit, fit.parameters + share * step) <= before) break;
  return share;
}

}  // namespace

at::Layout encoder::layout_of(const EncoderRecording& recording) {
  Layout layout{0, recording.axes.size(), recording.sensor_of};
  for (const std::size_t sensor : recording.sensor_of)
    layout.sensors = std::max(layout.sensors, sensor + 1);
  return layout;
}

at::Seen encoder::seen_by(const Eigen::VectorXd& parameters,
                          const Layout& layout,
                          std::size_t axis) {
  Seen out;
  out << parameters.head<common>(), parameters.segment<2>(layout.lever(layout.sensor_of[axis])),
      parameters.segment<each>(layout.axis(axis));
  return out;
}

WheelPoint true_point(const Eigen::VectorXd& parameters,
                      double shown_rad,
                      double shown_radps,
                      double shown_radps2) {
  double angle = shown_rad;
  for (int round = 0; round < 4; ++round) angle = shown_rad - error_at(parameters, angle).value;
  const EncoderError error = error_at(parameters, angle);
  const double speed = shown_radps / (1.0 + error.slope);
  return {angle, speed, (shown_radps2 - speed * speed * error.curve) / (1.0 + error.slope)};
}

namespace {

/// Second and third powers of the force in the plane, in units of gravity: cos 2θ, sin 2θ, cos 3θ
/// and sin 3θ of gravity alone. Beside a centripetal force the others are not constant, and a
/// nonlinearity is a response to gravity that changes with the speed, as is an error once a turn.
Eigen::Matrix<double, at::nonlinear_terms, 1> powers_of(double sin, double cos) {
  const double sin2 = sin * sin, cos2 = cos * cos, excess = sin2 + cos2 - 1.0;
  Eigen::Matrix<double, at::nonlinear_terms, 1> out;
  out << cos2 - sin2, 2.0 * sin * cos, excess, cos * (cos2 - 3.0 * sin2), sin * (3.0 * cos2 - sin2),
      excess * cos, excess * sin;
  return out;
}

}  // namespace

AxisPrediction predict_axis(const at::Seen& parameters,
                            const WheelPoint& wheel,
                            double phase,
                            double gravity_mps2) {
  AxisPrediction out;
  constexpr Index lever = at::common, own = lever + 2;
  const double p = parameters(own + at::sin), q = parameters(own + at::cos);
  // Everything is seen a time τ later.
  const double late_s = parameters(at::delay);
  const double speed = wheel.speed - late_s * wheel.accel;
  const double w2 = speed * speed, share = w2 / gravity_mps2;
  const double accel = (wheel.accel - late_s * wheel.jerk) / gravity_mps2;
  const double cos_1 = std::cos(wheel.angle), sin_1 = std::sin(wheel.angle);
  const auto h = parameters.segment<4>(at::runout);
  const double x = share * (h(0) * cos_1 + h(1) * sin_1);
  const double y = share * (h(2) * cos_1 + h(3) * sin_1);
  const double shown = wheel.angle - late_s * (wheel.speed - 0.5 * late_s * wheel.accel);
  const double sin_s = std::sin(shown), cos_s = std::cos(shown);
  const double along = p * sin_s + q * cos_s, across = p * cos_s - q * sin_s;
  out.by_angle = (1.0 + y) * across - x * along;
  // The point's own acceleration in the wheel's axes, in units of gravity.
  const double rx = parameters(lever), ry = parameters(lever + 1);
  const double fx = -share * rx - accel * ry, fy = -share * ry + accel * rx;
  out.h(lever) = -share * p + accel * q;
  out.h(lever + 1) = -accel * p - share * q;
  out.h(own + at::sin) = (1.0 + y) * sin_s + x * cos_s + fx;
  out.h(own + at::cos) = (1.0 + y) * cos_s - x * sin_s + fy;
  out.value = p * out.h(own + at::sin) + q * out.h(own + at::cos);
  // Without the tangential part: the noise of α, in the residual as well, would bias them.
  out.h.segment<at::nonlinear_terms>(own + at::nonlinear) =
      powers_of(sin_s - share * rx, cos_s - share * ry);
  const auto drift = drift_at(phase);
  for (Index i = 0; i < at::drift_terms; ++i)
    out.h(own + at::drift + i) = drift[static_cast<std::size_t>(i)];
  constexpr Index linear = at::each - at::nonlinear;
  out.value += out.h.segment<linear>(own + at::nonlinear)
                   .dot(parameters.segment<linear>(own + at::nonlinear));
  // By ω² and α, through which the encoder's errors act on the lever arm.
  const double by_w2 = -(p * rx + q * ry) / gravity_mps2;
  const double by_accel = (q * rx - p * ry) / gravity_mps2;
  for (std::size_t i = 0; i < encoder_orders; ++i) {
    const double n = static_cast<double>(i + 1);
    const double cos_n = std::cos(n * wheel.angle), sin_n = std::sin(n * wheel.angle);
    const Index c = at::errors + 2 * static_cast<Index>(i);
    // ∂ω/∂c = ω n sin nθ, ∂α/∂c = ω² n² cos nθ to first order.
    out.h(c) = -cos_n * out.by_angle + by_w2 * 2.0 * w2 * n * sin_n + by_accel * w2 * n * n * cos_n;
    out.h(c + 1) =
        -sin_n * out.by_angle - by_w2 * 2.0 * w2 * n * cos_n + by_accel * w2 * n * n * sin_n;
  }
  out.h(at::delay) =
      -speed * out.by_angle - by_w2 * 2.0 * speed * wheel.accel - by_accel * wheel.jerk;
  out.h(at::runout) = share * cos_1 * across;
  out.h(at::runout + 1) = share * sin_1 * across;
  out.h(at::runout + 2) = share * cos_1 * along;
  out.h(at::runout + 3) = share * sin_1 * along;
  return out;
}

namespace {

enum class Derivatives { own, smooth };

/// What is fitted.
struct EncoderProblem {
  const EncoderRecording& recording;
  const EncoderRows& rows;
  const EncoderOptions& options;
};

/// Iterations up to `most`, from where `fit` is.
EncoderFit iterated(const EncoderProblem& problem,
                    Derivatives derivatives,
                    int most,
                    EncoderFit fit) {
  const auto& [recording, rows, options] = problem;
  // The model itself is not more accurate than 0.1 mg.
  constexpr double least_std_mps2 = 1e-3;
  constexpr int fewest = 3;
  const at::Layout layout = at::layout_of(recording);
  const Index n = layout.count();
  const int first = fit.iterations;
  for (; fit.iterations < first + most && !fit.converged; ++fit.iterations) {
    fit.prior_std = priors(layout, options, fit.parameters);
    WheelPoints points{points_of(rows.shown, fit.parameters), {}};
    if (derivatives == Derivatives::smooth)
      points.instrument = points_of(rows.smooth, fit.parameters);
    Normal normal{Eigen::MatrixXd::Zero(n, n),
                  Eigen::MatrixXd::Zero(n, static_cast<Index>(rows.blocks))};
    std::vector<double> variance = fit.variance;
    for (std::size_t axis = 0; axis < layout.axes; ++axis) {
      const AxisNormal own =
          normal_of(recording, rows, points, at::seen_by(fit.parameters, layout, axis), axis,
                    fit.variance[axis], options.gravity_mps2);
      add_axis(own, layout, axis, normal);
      if (own.count > 0)
        variance[axis] =
            std::max(own.squares / static_cast<double>(own.count), square(least_std_mps2));
    }
    const Eigen::VectorXd precision = fit.prior_std.array().square().inverse();
    Eigen::MatrixXd information = normal.information;
    information.diagonal() += precision;
    fit.inverse = information.partialPivLu().inverse();
    const Eigen::VectorXd step = fit.inverse * (normal.block_gradients.rowwise().sum() -
                                                precision.cwiseProduct(fit.parameters));
    fit.type_a = scatter_of_blocks(normal, fit.inverse);
    // The root with smooth derivatives is not the least cost.
    const double share =
        derivatives == Derivatives::own ? shortened(recording, rows, options, fit, step) : 1.0;
    fit.parameters += share * step;
    bool settled = fit.iterations >= first + fewest;
    for (std::size_t axis = 0; axis < layout.axes; ++axis)
      settled = settled && std::abs(variance[axis] / fit.variance[axis] - 1.0) < 0.02;
    fit.variance = std::move(variance);
    const double std_rad = std::sqrt(fit.inverse.diagonal().head<encoder_parameters>().sum());
    fit.converged = settled && step.head<encoder_parameters>().norm() < 1e-2 * std_rad;
  }
  return fit;
}

}  // namespace

double log_variance(const EncoderFit& fit) {
  double sum = 0.0;
  for (const double variance : fit.variance) sum += std::log(variance);
  return sum;
}

EncoderFit fit_encoder(const EncoderRecording& recording,
                       const EncoderRows& rows,
                       const EncoderOptions& options,
                       const std::optional<EncoderFit>& from) {
  constexpr int near = 8, near_root = 30, most = 30;
  // The least squares fit some of the encoder's noise: their residuals are up to several times
  // smaller.
  constexpr double usable = 4.0;
  const EncoderProblem problem{recording, rows, options};
  const at::Layout layout = at::layout_of(recording);
  EncoderFit start;
  if (from) {
    start = *from;
    start.iterations = 0;
  } else {
    start.parameters = Eigen::VectorXd::Zero(layout.count());
    start.variance.assign(layout.axes, square(0.1 * options.gravity_mps2));
    start = iterated(problem, Derivatives::own, near, std::move(start));
  }
  start.converged = false;
  EncoderFit fit = iterated(problem, Derivatives::smooth, near_root, start);
  if (fit.converged && log_variance(fit) < log_variance(start) + usable) return fit;
  // At one speed only the ripple shows the lever arm, and the smooth motion may not have it.
  return iterated(problem, Derivatives::own, most, std::move(start));
}

EncoderOffsets offsets_of(const EncoderRecording& recording,
                          const EncoderRows& rows,
                          const EncoderFit& fit,
                          double gravity_mps2) {
  constexpr double width_rad = rad_per_turn / 16.0;
  const at::Layout layout = at::layout_of(recording);
  std::vector<at::Seen> seen;
  for (std::size_t axis = 0; axis < layout.axes; ++axis)
    seen.push_back(at::seen_by(fit.parameters, layout, axis));
  EncoderOffsets out;
  double start_rad = 0.0, weight = 0.0, sum = 0.0, fitted = 0.0, time = 0.0, angle = 0.0;
  double speed = 0.0;
  std::size_t count = 0;
  const auto close = [&] {
    if (count == 0 || !(weight > 0.0)) return;
    const double n = static_cast<double>(count);
    out.time_s.push_back(time / n);
    out.angle_rad.push_back(angle / n);
    out.offset_rad.push_back(sum / weight + fitted / n);
    out.fitted_rad.push_back(fitted / n);
    out.speed_radps.push_back(speed / n);
  };
  // The noise of the acceleration, times a lever arm, would look like single counts.
  EncoderMotion motion = rows.smooth;
  motion.at.angle_rad = rows.shown.at.angle_rad;
  const std::vector<WheelPoint> points = points_of(motion, fit.parameters);
  for (std::size_t k = 0; k < rows.row.size(); ++k) {
    const WheelPoint& wheel = points[k];
    if (count == 0 || std::abs(wheel.angle - start_rad) > width_rad) {
      close();
      start_rad = wheel.angle;
      weight = sum = fitted = time = angle = speed = 0.0;
      count = 0;
    }
    for (std::size_t axis = 0; axis < recording.axes.size(); ++axis) {
      const double value = recording.axes[axis][rows.row[k]];
      if (std::isnan(value)) continue;
      const AxisPrediction predicted = predict_axis(seen[axis], wheel, rows.phase[k], gravity_mps2);
      // θ by the accelerometers is larger by (z − prediction)/(∂z/∂θ), ψ − θ smaller.
      sum -= predicted.by_angle * (value - predicted.value) / fit.variance[axis];
      weight += square(predicted.by_angle) / fit.variance[axis];
    }
    fitted += error_at(fit.parameters, wheel.angle).value;
    time += rows.time_s[k];
    angle += wheel.angle;
    speed += wheel.speed;
    ++count;
  }
  close();
  return out;
}

}  // namespace proofmass::calibrate
