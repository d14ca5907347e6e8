#include "proofmass/calibrate/encoder/results.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "proofmass/core/chi_square.hpp"
#include "proofmass/core/linalg.hpp"
#include "proofmass/core/statistics.hpp"

namespace proofmass::calibrate {
namespace {

namespace at = encoder;
using Eigen::Index;

/// Variance that the priors of these parameters contribute to the encoder's errors.
Eigen::VectorXd prior_share(const EncoderFit& fit, const std::vector<Index>& of) {
  Eigen::VectorXd variance = Eigen::VectorXd::Zero(encoder_parameters);
  for (const Index i : of)
    variance += fit.inverse.col(i).head<encoder_parameters>().array().square().matrix() /
                square(fit.prior_std(i));
  return variance;
}

std::vector<Index> nonlinear_ones(const at::Layout& layout) {
  std::vector<Index> out;
  for (std::size_t axis = 0; axis < layout.axes; ++axis)
    for (Index i = 0; i < at::nonlinear_terms; ++i)
      out.push_back(layout.axis(axis) + at::nonlinear + i);
  return out;
}

std::vector<Index> levers(const at::Layout& layout) {
  std::vector<Index> out;
  for (Index i = layout.lever(0); i < layout.lever(layout.sensors); ++i) out.push_back(i);
  return out;
}

EncoderShare share(std::string source, bool type_a, const Eigen::VectorXd& variance) {
  EncoderShare out{std::move(source), type_a, {}};
  for (std::size_t order = 0; order < 2; ++order)
    out.std_rad[order] = std::sqrt(0.5 * variance.segment<2>(2 * static_cast<Index>(order)).sum());
  return out;
}

/// Welch–Satterthwaite, with type B of infinite degrees of freedom.
double effective_dof(double type_a, double total, double dof) {
  return type_a > 0.0 ? dof * square(total / type_a) : 1e6;
}

void add_polar(const Eigen::Matrix2d& cov, double factor, EncoderHarmonic& harmonic) {
  const Eigen::Vector2d v(harmonic.cos_rad.value, harmonic.sin_rad.value);
  const double length = v.norm();
  const Eigen::Vector2d out =
      length > 0.0 ? Eigen::Vector2d(v / length) : Eigen::Vector2d(1.0, 0.0);
  const Eigen::Vector2d along(-out(1), out(0));
  const double radial = std::sqrt(out.dot(cov * out)), across = std::sqrt(along.dot(cov * along));
  if (!(harmonic.chance_p < 0.01)) {
    harmonic.amplitude_95_rad = {0.0, length + factor * std::max(radial, across)};
    return;
  }
  // The length of an uncertain vector is too long by the variance across it.
  const double amplitude = length - square(across) / (2.0 * length);
  harmonic.amplitude_rad = Uncertain{amplitude, radial};
  harmonic.amplitude_95_rad = {std::max(0.0, amplitude - factor * radial),
                               amplitude + factor * radial};
  const double phase = std::atan2(-v(1), v(0)), std = across / length;
  harmonic.phase_rad = Uncertain{phase, std};
  harmonic.phase_95_rad = {phase - factor * std, phase + factor * std};
}

}  // namespace

void add_encoder_results(const EncoderRecording& recording,
                         const EncoderFit& fit,
                         double dof,
                         EncoderCalibration& out) {
  const at::Layout layout = at::layout_of(recording);
  const Eigen::VectorXd noise = fit.type_a.diagonal().head<encoder_parameters>();
  out.shares = {
      share("noise and quantisation", true, noise),
      share("accelerometers' nonlinearity", false, prior_share(fit, nonlinear_ones(layout))),
      share("run-out of the axle", false,
            prior_share(fit, {at::runout, at::runout + 1, at::runout + 2, at::runout + 3})),
      share("accelerometers' distance from the axle", false, prior_share(fit, levers(layout))),
      share("accelerometers' delay", false, prior_share(fit, {at::delay}))};
  const Eigen::VectorXd precision = fit.prior_std.array().square().inverse();
  const Eigen::MatrixXd cov =
      fit.type_a + fit.inverse * precision.asDiagonal() * fit.inverse.transpose();
  for (std::size_t order = 0; order < encoder_orders; ++order) {
    EncoderHarmonic& harmonic = out.harmonics[order];
    const Index c = at::errors + 2 * static_cast<Index>(order);
    harmonic.per_turn = static_cast<int>(order) + 1;
    const Eigen::Matrix2d own = cov.block<2, 2>(c, c);
    harmonic.cos_rad = {fit.parameters(c), std::sqrt(own(0, 0))};
    harmonic.sin_rad = {fit.parameters(c + 1), std::sqrt(own(1, 1))};
    const double nu = effective_dof(noise.segment<2>(c).sum(), own.trace(), dof);
    const double factor = student_t_quantile(0.975, nu);
    harmonic.half_width_95_rad = factor * std::max(harmonic.cos_rad.std, harmonic.sin_rad.std);
    const Eigen::Vector2d v(harmonic.cos_rad.value, harmonic.sin_rad.value);
    const double statistic = 0.5 * v.dot(positive_inverse(own) * v);
    harmonic.chance_p = fisher_f_p(statistic, 2.0, std::max(nu - 1.0, 1.0));
    add_polar(own, factor, harmonic);
  }
  out.covariance = cov.topLeftCorner<4, 4>();
  out.delay_s = {fit.parameters(at::delay), std::sqrt(cov(at::delay, at::delay))};
  for (const double variance : fit.variance) out.residual_rms_mps2.push_back(std::sqrt(variance));
  out.axis_names = recording.axis_names;
}

}  // namespace proofmass::calibrate
