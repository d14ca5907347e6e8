#include "proofmass/calibrate/uncertainty/redrawn_fit.hpp"

#include "proofmass/core/contract.hpp"

namespace proofmass::calibrate {

RedrawnFit::RedrawnFit(const DrawnFrom& from,
                       const MultiPositionOptions& options,
                       const MultiPosition& fit)
    : options_(options),
      by_norm_(fit.model == PoseModel::norm_9 || fit.model == PoseModel::norm_6) {
  options_.model = fit.model;
  options_.keep_suspects = true;
  options_.between = from.between;
  if (!by_norm_) return;
  free_ = fit.model == PoseModel::norm_9 ? NormParameters::nine : NormParameters::six;
  const Weighable weighed = weighable(from.poses, options.noise_dof);
  const auto scale = reading_scale(weighed.poses, options.gravity_mps2);
  PM_EXPECTS(scale.has_value());  // the calibration had one
  scale_ = *scale;
  data_ = norm_data(weighed, scale_, options_);
  start_ = scale_.to_normalised(Eigen::Map<const Parameters>(fit.estimate.data()));
  weights_ = residual_weights(data_, terms_of(data_.poses, start_),
                              std::vector<bool>(data_.poses.size(), true));
}

std::optional<Parameters> RedrawnFit::operator()(View<Pose> drawn, double gravity_mps2) const {
  if (!by_norm_) {
    MultiPositionOptions options = options_;
    options.gravity_mps2 = gravity_mps2;
    const Result<MultiPosition> one = calibrate_positions(drawn, options);
    if (!one) return std::nullopt;
    return Parameters(Eigen::Map<const Parameters>(one->estimate.data()));
  }
  std::vector<NormalisedPose> poses = data_.poses;
  for (std::size_t k = 0; k < drawn.size(); ++k) poses[k].u = scale_.normalised(drawn[k].mean);
  const std::optional<Parameters> p = refit_norm(poses, weights_, free_, start_);
  if (!p) return std::nullopt;
  return ReadingScale{scale_.center, scale_.half, gravity_mps2}.to_reading(*p);
}

}  // namespace proofmass::calibrate
