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
}

std::optional<Parameters> RedrawnFit::operator()(View<Pose> drawn, double gravity_mps2) const {
  if (!by_norm_) {
    MultiPositionOptions options = options_;
    options.gravity_mps2 = gravity_mps2;
    const Result<MultiPosition> one = calibrate_positions(drawn, options);
    if (!one) return std::nullopt;
    return Parameters(Eigen::Map<const Parameters>(one->estimate.data()));
  }
  NormData data = data_;
  for (std::size_t k = 0; k < drawn.size(); ++k) data.poses[k].u = scale_.normalised(drawn[k].mean);
  std::optional<Parameters> p;
  if (data.independent()) p = refit_norm(data.poses, free_, start_);
  if (!p) {
    const Result<NormFit> one =
        fit_norm(data, std::vector<bool>(drawn.size(), true), free_, start_);
    if (!one || !one->converged) return std::nullopt;
    p = one->p;
  }
  return ReadingScale{scale_.center, scale_.half, gravity_mps2}.to_reading(*p);
}

}  // namespace proofmass::calibrate
