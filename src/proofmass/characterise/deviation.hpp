#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "proofmass/characterise/allan/statistic.hpp"

namespace proofmass::characterise {

/// One point of a deviation curve.
struct DeviationPoint {
  std::size_t m = 0;         ///< averaging factor: samples in τ
  double tau_s = 0.0;        ///< averaging time τ
  std::size_t terms = 0;     ///< number of squared differences
  double value = 0.0;        ///< σ(τ) in the unit of the series (times s for tdev and ttotdev)
  double uncorrected = 0.0;  ///< before the correction for the statistic's bias
  double lower = 0.0;        ///< limits of σ at the curve's confidence
  double upper = 0.0;
  double edf = 0.0;               ///< equivalent degrees of freedom of σ²
  int alpha = 0;                  ///< noise type, S_y ∝ f^α: 2 … −4; the one with the largest share
  std::optional<int> alpha_lag1;  ///< noise type by lag-1 autocorrelation, if requested
};

struct DeviationCurve {
  Statistic statistic = Statistic::oadev;
  double confidence = 0.683;
  std::vector<DeviationPoint> points;  ///< ascending in τ
  std::string bias_correction;         ///< bias correction in words; empty: none needed
};

}  // namespace proofmass::characterise
