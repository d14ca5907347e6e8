#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "proofmass/core/chi_square.hpp"
#include "proofmass/core/quantity.hpp"

// What a type of sensor is like, and how much its specimens differ.
namespace proofmass::fleet {

/// One sensor's values of a figure, with their standard deviations where known.
struct SensorValues {
  std::vector<double> values;
  std::vector<double> stds;  ///< standard deviation of each value; empty: unknown
};

/// The model y_ij = μ + b_i + e_ij with b_i ~ N(0, τ²) between sensors and e_ij ~ N(0, σ²) within.
struct RandomEffects {
  std::size_t sensors = 0, values = 0;
  Uncertain mean;  ///< μ
  Bounds mean_95;
  double between_std = 0.0;  ///< τ
  Bounds between_95;
  std::optional<double> within_std;  ///< σ; nullopt where no sensor was measured twice
  Bounds within_95;                  ///< where there is a σ
};

/// Fits it. Where sensors were measured more than once: μ as the mean of the sensors' means, with
/// Student's t of k − 1 degrees of freedom; τ² by the analysis of variance of these means, its
/// interval by the modified large-sample method; σ² pooled. Both are exact in probability or nearly
/// so where all sensors have as many values, and take the harmonic mean of their number where not.
/// Where each has one value with a known standard deviation: τ by the generalised Q statistic, its
/// interval by inverting it, μ by inverse variances with the interval of Hartung and Knapp. Where
/// nothing is known of the values, τ holds their own scatter.
/// Source: R. K. Burdick, F. A. Graybill, Confidence Intervals on Variance Components (1992),
/// section 3.3.2 (Ting et al.), 3.5 (unbalanced); W. Viechtbauer, Statistics in Medicine 26 (2007)
/// 37; J. Hartung, G. Knapp, Statistics in Medicine 20 (2001) 3875. nullopt with fewer than three
/// sensors.
[[nodiscard]] std::optional<RandomEffects> fit_random_effects(
    const std::vector<SensorValues>& sensors);

}  // namespace proofmass::fleet
