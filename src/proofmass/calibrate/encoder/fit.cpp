#include "proofmass/calibrate/encoder/fit.hpp"

#include <algorithm>
#include <cmath>

#include "proofmass/core/linalg.hpp"
#include "proofmass/core/statistics.hpp"

namespace proofmass::calibrate {
namespace {

namespace at = encoder;
using Eigen::Index;

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

Eigen::VectorXd priors(const EncoderRecording& recording,
                       const EncoderOptions& options,
                       const Eigen::VectorXd& parameters) {
  constexpr double open = 1e6, error_std_rad = 0.3;
  Eigen::VectorXd std = Eigen::VectorXd::Constant(parameters.size(), open);
  std.segment<encoder_parameters>(at::errors).setConstant(error_std_rad);
  std(at::delay) = options.delay_s;
  std.segment<4>(at::runout).setConstant(std::max(options.runout_m, 1e-9));
  for (std::size_t axis = 0; axis < recording.axes.size(); ++axis) {
    const Index first = at::axis(axis);
    const double response = parameters.segment<2>(first + at::sin).norm();
    const double second = 0.5 * options.nonlinearity * std::max(response, 1e-3);
    std.segment<2>(first + at::by_speed2).setConstant(options.radius_m);
    std.segment<2>(first + at::nonlinear).setConstant(second);
    std.segment<2>(first + at::nonlinear + 2).setConstant(0.5 * second);
  }
  return std;
}

/// Normal equations, and the gradient of each block.
struct Normal {
  Eigen::MatrixXd information;
  Eigen::VectorXd gradient;
  Eigen::MatrixXd block_gradients;  ///< one column a block
  std::vector<double> squares;      ///< of the residuals of each axis
  std::vector<std::size_t> counts;
};

void add_row(const AxisPrediction& predicted,
             double residual,
             double weight,
             std::size_t axis,
             Normal& normal,
             Index block) {
  const Index first = at::axis(axis);
  const auto& c = predicted.h_common;
  const auto& a = predicted.h_axis;
  normal.information.topLeftCorner<at::common, at::common>() += weight * c * c.transpose();
  normal.information.block<at::common, at::each>(0, first) += weight * c * a.transpose();
  normal.information.block<at::each, at::each>(first, first) += weight * a * a.transpose();
  auto gradient = normal.block_gradients.col(block);
  gradient.head<at::common>() += weight * residual * c;
  gradient.segment<at::each>(first) += weight * residual * a;
}

Normal accumulate(const EncoderRecording& recording,
                  const EncoderRows& rows,
                  const EncoderOptions& options,
                  const Eigen::VectorXd& parameters,
                  const std::vector<double>& variance) {
  const Index n = parameters.size();
  const std::size_t axes = recording.axes.size();
  Normal normal{Eigen::MatrixXd::Zero(n, n), {},
                Eigen::MatrixXd::Zero(n, static_cast<Index>(rows.blocks)),
                std::vector<double>(axes, 0.0), std::vector<std::size_t>(axes, 0)};
  for (std::size_t k = 0; k < rows.row.size(); ++k) {
    const WheelPoint wheel = true_point(parameters, rows.shown.angle_rad[k],
                                        rows.shown.speed_radps[k], rows.shown.accel_radps2[k]);
    for (std::size_t axis = 0; axis < axes; ++axis) {
      const double value = recording.axes[axis][rows.row[k]];
      if (std::isnan(value)) continue;
      const AxisPrediction predicted =
          predict_axis(parameters, wheel, axis, rows.phase[k], options.gravity_mps2);
      // Huber's weight: knocks do not decide.
      constexpr double huber = 4.0;
      const double residual = value - predicted.value;
      const double off = std::abs(residual) / std::sqrt(variance[axis]);
      const double weight = (off > huber ? huber / off : 1.0) / variance[axis];
      add_row(predicted, residual, weight, axis, normal, static_cast<Index>(rows.block[k]));
      normal.squares[axis] += residual * residual * weight * variance[axis];
      ++normal.counts[axis];
    }
  }
  for (std::size_t axis = 0; axis < axes; ++axis) {
    const Index first = at::axis(axis);
    normal.information.block<at::each, at::common>(first, 0) =
        normal.information.block<at::common, at::each>(0, first).transpose();
  }
  normal.gradient = normal.block_gradients.rowwise().sum();
  return normal;
}

/// H⁻¹ (Σ_b g_b g_bᵀ B/(B − 1)) H⁻¹ with the gradients about their mean.
Eigen::MatrixXd scatter_of_blocks(const Normal& normal, const Eigen::MatrixXd& inverse) {
  const double blocks = static_cast<double>(normal.block_gradients.cols());
  const Eigen::VectorXd mean = normal.gradient / blocks;
  const Eigen::MatrixXd about = inverse * (normal.block_gradients.colwise() - mean);
  return about * about.transpose() * (blocks / (blocks - 1.0));
}

}  // namespace

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

AxisPrediction predict_axis(const Eigen::VectorXd& parameters,
                            const WheelPoint& wheel,
                            std::size_t axis,
                            double phase,
                            double gravity_mps2) {
  AxisPrediction out;
  out.h_common.setZero();
  const Index first = at::axis(axis);
  const double p = parameters(first + at::sin), q = parameters(first + at::cos);
  const double w2 = wheel.speed * wheel.speed, share = w2 / gravity_mps2;
  const double cos_1 = std::cos(wheel.angle), sin_1 = std::sin(wheel.angle);
  const auto h = parameters.segment<4>(at::runout);
  const double x = share * (h(0) * cos_1 + h(1) * sin_1);
  const double y = share * (h(2) * cos_1 + h(3) * sin_1);
  const double seen = wheel.angle - parameters(at::delay) * wheel.speed;
  const double sin_s = std::sin(seen), cos_s = std::cos(seen);
  const double along = p * sin_s + q * cos_s, across = p * cos_s - q * sin_s;
  out.by_angle = (1.0 + y) * across - x * along;
  auto& own = out.h_axis;
  own(at::sin) = (1.0 + y) * sin_s + x * cos_s;
  own(at::cos) = (1.0 + y) * cos_s - x * sin_s;
  own(at::by_speed2) = w2;
  own(at::by_accel) = wheel.accel;
  for (const int n : {2, 3}) {
    own(at::nonlinear + 2 * (n - 2)) = std::cos(n * wheel.angle);
    own(at::nonlinear + 2 * (n - 2) + 1) = std::sin(n * wheel.angle);
  }
  const auto drift = drift_at(phase);
  for (Index i = 0; i < at::drift_terms; ++i)
    own(at::drift + i) = drift[static_cast<std::size_t>(i)];
  out.value = own.dot(parameters.segment<at::each>(first));
  const double l = parameters(first + at::by_speed2), m = parameters(first + at::by_accel);
  for (std::size_t i = 0; i < encoder_orders; ++i) {
    const double n = static_cast<double>(i + 1);
    const double cos_n = std::cos(n * wheel.angle), sin_n = std::sin(n * wheel.angle);
    const Index c = at::errors + 2 * static_cast<Index>(i);
    // ∂ω/∂c = ω n sin nθ, ∂α/∂c = ω² n² cos nθ to first order.
    out.h_common(c) = -cos_n * out.by_angle + l * 2.0 * w2 * n * sin_n + m * w2 * n * n * cos_n;
    out.h_common(c + 1) =
        -sin_n * out.by_angle - l * 2.0 * w2 * n * cos_n + m * w2 * n * n * sin_n;
  }
  out.h_common(at::delay) = -wheel.speed * out.by_angle;
  out.h_common(at::runout) = share * cos_1 * across;
  out.h_common(at::runout + 1) = share * sin_1 * across;
  out.h_common(at::runout + 2) = share * cos_1 * along;
  out.h_common(at::runout + 3) = share * sin_1 * along;
  return out;
}

EncoderFit fit_encoder(const EncoderRecording& recording,
                       const EncoderRows& rows,
                       const EncoderOptions& options,
                       Eigen::VectorXd start) {
  EncoderFit fit;
  fit.parameters = std::move(start);
  const std::size_t axes = recording.axes.size();
  fit.variance.assign(axes, square(0.1 * options.gravity_mps2));
  constexpr int most = 20;
  for (; fit.iterations < most && !fit.converged; ++fit.iterations) {
    fit.prior_std = priors(recording, options, fit.parameters);
    const Eigen::VectorXd precision = fit.prior_std.array().square().inverse();
    const Normal normal = accumulate(recording, rows, options, fit.parameters, fit.variance);
    Eigen::MatrixXd information = normal.information;
    information.diagonal() += precision;
    fit.inverse = positive_inverse(information);
    Eigen::VectorXd pull = normal.gradient;
    // The responses and drifts have no prior mean; the others have 0.
    pull -= precision.cwiseProduct(fit.parameters);
    const Eigen::VectorXd step = fit.inverse * pull;
    fit.parameters += step;
    fit.type_a = scatter_of_blocks(normal, fit.inverse);
    for (std::size_t axis = 0; axis < axes; ++axis)
      if (normal.counts[axis] > 0)
        fit.variance[axis] = std::max(
            normal.squares[axis] / static_cast<double>(normal.counts[axis]), 1e-18);
    const auto errors = step.segment<encoder_parameters>(at::errors);
    fit.converged = fit.iterations > 2 && errors.norm() < 1e-9;
  }
  return fit;
}

EncoderOffsets offsets_of(const EncoderRecording& recording,
                          const EncoderRows& rows,
                          const EncoderFit& fit,
                          double gravity_mps2) {
  constexpr double width_rad = rad_per_turn / 16.0;
  EncoderOffsets out;
  double start_rad = 0.0, weight = 0.0, sum = 0.0, fitted = 0.0, time = 0.0, angle = 0.0;
  std::size_t count = 0;
  const auto close = [&] {
    if (count == 0 || !(weight > 0.0)) return;
    const double n = static_cast<double>(count);
    out.time_s.push_back(time / n);
    out.angle_rad.push_back(angle / n);
    out.offset_rad.push_back(sum / weight + fitted / n);
    out.fitted_rad.push_back(fitted / n);
  };
  for (std::size_t k = 0; k < rows.row.size(); ++k) {
    const WheelPoint wheel = true_point(fit.parameters, rows.shown.angle_rad[k],
                                        rows.shown.speed_radps[k], rows.shown.accel_radps2[k]);
    if (count == 0 || std::abs(wheel.angle - start_rad) > width_rad) {
      close();
      start_rad = wheel.angle;
      weight = sum = fitted = time = angle = 0.0;
      count = 0;
    }
    for (std::size_t axis = 0; axis < recording.axes.size(); ++axis) {
      const double value = recording.axes[axis][rows.row[k]];
      if (std::isnan(value)) continue;
      const AxisPrediction predicted =
          predict_axis(fit.parameters, wheel, axis, rows.phase[k], gravity_mps2);
      // θ by the accelerometers is larger by (z − prediction)/(∂z/∂θ), ψ − θ smaller.
      sum -= predicted.by_angle * (value - predicted.value) / fit.variance[axis];
      weight += square(predicted.by_angle) / fit.variance[axis];
    }
    fitted += error_at(fit.parameters, wheel.angle).value;
    time += rows.time_s[k];
    angle += wheel.angle;
    ++count;
  }
  close();
  return out;
}

}  // namespace proofmass::calibrate
