#include "proofmass/characterise/drift/step_search.hpp"

#include "proofmass/core/linalg.hpp"

namespace proofmass::characterise {

FoundStep find_step(const DriftEvidence& evidence,
                    const Eigen::MatrixXd& fitted,
                    const Eigen::VectorXd& density) {
  const Eigen::Index rows = evidence.blocks() - 1;
  const Eigen::VectorXd weight = density.cwiseInverse();
  const Eigen::MatrixXd WX = weight.asDiagonal() * fitted;
  Eigen::VectorXd residual = evidence.contrasts();
  Eigen::MatrixXd inverse;
  if (fitted.cols() > 0) {
    inverse = positive_inverse(fitted.transpose() * WX);
    residual -= fitted * (inverse * (WX.transpose() * residual));
  }
  const Eigen::VectorXd weighted = weight.cwiseProduct(residual);
  FoundStep best;
  for (std::size_t block = 2; block + 2 <= static_cast<std::size_t>(evidence.blocks()); ++block) {
    const Eigen::VectorXd s = evidence.step(block).tail(rows);
    double information = s.cwiseAbs2().dot(weight);
    const double whole = information;
    if (fitted.cols() > 0) {
      const Eigen::VectorXd shared = WX.transpose() * s;
      information -= shared.dot(inverse * shared);
    }
    // The fitted columns already span this step: a missing block, or the same step.
    constexpr double least_share = 1e-6;
    if (information < least_share * whole) continue;
    const double score = s.dot(weighted);
    const double gain = score * score / information;
    if (gain > best.gain) best = {block, gain};
  }
  return best;
}

}  // namespace proofmass::characterise
