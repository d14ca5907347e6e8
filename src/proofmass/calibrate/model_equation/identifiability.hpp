#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "proofmass/sensor/model_equation.hpp"

// Which coefficients of the model equation are identifiable from a set of rows.
namespace proofmass::calibrate {

/// Coefficients tied by exact relations between their terms: with L the omitted and R the retained
/// ones, t_l = Σ_r weight(l, r) t_r in every row, so that only c_r + Σ_l weight(l, r) c_l is
/// determined.
struct TiedTerms {
  std::vector<std::size_t> left_out, retained;  ///< indices of the coefficients given
  Eigen::MatrixXd weight;                       ///< left_out × retained, SI
};

struct Identifiability {
  std::vector<bool> excited;    ///< the term is not zero in all rows
  std::vector<TiedTerms> tied;  ///< groups without a coefficient in common
  double condition = 1.0;       ///< of the excited columns, brought to unit length; ∞ if tied
};

/// From the columns of the design (rows × coefficients), weighted or not, with the norm of a column
/// of ones. The least important of tied coefficients is omitted: cross terms first, K0 and K1 last.
[[nodiscard]] Identifiability identifiability(const Eigen::MatrixXd& design,
                                              const std::vector<sensor::Coefficient>& coefficients,
                                              double unit_length);

/// "a_p² = 1 g² − a_i²": the omitted term by the retained ones, accelerations in g.
[[nodiscard]] std::string relation_words(const TiedTerms& group,
                                         std::size_t left_out,
                                         const std::vector<sensor::Coefficient>& coefficients);

/// Why a term may be zero in every row: "no row has acceleration along the output axis".
[[nodiscard]] std::string unexcited_words(sensor::Coefficient coefficient);

}  // namespace proofmass::calibrate
