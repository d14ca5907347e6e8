#pragma once

#include <Eigen/Core>
#include <string>
#include <string_view>
#include <vector>

#include "proofmass/core/result.hpp"

// Combined uncertainty of a result from those of its inputs. Source: JCGM 100:2008, Guide to the
// Expression of Uncertainty in Measurement (GUM).
namespace proofmass::calibrate {

enum class Distribution { normal, uniform, triangular, arcsine, student_t };

/// "normal", "uniform", "triangular", "arcsine", "Student t".
[[nodiscard]] std::string_view name_of(Distribution distribution);

/// Standard deviation of a quantity within ± half_width: over √3 uniform, √6 triangular, √2
/// arcsine. For normal and student_t, which have no width, half_width is the standard deviation.
/// Source: GUM, 4.3.7 and 4.3.9; for the arcsine distribution JCGM 101, 6.4.6.
[[nodiscard]] double std_of_half_width(double half_width, Distribution distribution);

/// One input x of a result y.
struct BudgetLine {
  std::string source;  ///< "gravity"
  bool type_a = false;
  Distribution distribution = Distribution::normal;
  double std = 0.0;          ///< u(x), standard uncertainty
  std::string unit;          ///< unit of std
  double sensitivity = 1.0;  ///< c = ∂y/∂x
  double dof = 0.0;          ///< of u(x); 0: infinite

  [[nodiscard]] double contribution() const { return sensitivity * std; }  ///< c u(x), with sign
};

/// The measurand.
struct Measurand {
  std::string quantity;  ///< "bias x"
  std::string unit;
  double value = 0.0;
};

struct UncertaintyBudget {
  Measurand measurand;
  std::vector<BudgetLine> lines;
  std::vector<double> shares;       ///< of each line in the variance; their sum is 1
  double combined_std = 0.0;        ///< u_c
  double effective_dof = 0.0;       ///< 0: infinite
  double coverage_factor_95 = 0.0;  ///< k
  double expanded_95 = 0.0;         ///< U = k u_c
};

/// Coverage factor of a standard uncertainty with `dof` degrees of freedom (0: infinite) at this
/// confidence level: Student's t, with dof truncated to an integer. Source: GUM, G.3 and G.4. level
/// in (0, 1).
[[nodiscard]] double coverage_factor(double level, double dof);

/// Combines the lines,
///
///     u_c² = Σᵢ Σⱼ cᵢ uᵢ rᵢⱼ cⱼ uⱼ,     ν_eff = u_c⁴ / Σ_g (u_g⁴ / ν_g),     U = t₉₅(ν_eff) u_c,
///     share of line i = cᵢ uᵢ Σⱼ rᵢⱼ cⱼ uⱼ / u_c²,
///
/// with the correlation matrix r (empty: none are correlated). In ν_eff a group g is one line, or
/// all mutually correlated lines: they count as one, with the smallest of their degrees of freedom
/// (exact if all were observed together).
///
/// Source: GUM, 5.1.2, 5.2.2, G.4.1 (Welch–Satterthwaite); for groups R. Willink, Metrologia 44
/// (2007) 340. Errors: not_finite, invalid_argument (a std or dof below 0; a correlation matrix of
/// wrong size, not symmetric, with a diagonal other than 1 or not positive semi-definite).
[[nodiscard]] Result<UncertaintyBudget> combine(Measurand measurand,
                                                std::vector<BudgetLine> lines,
                                                const Eigen::MatrixXd& correlation = {});

}  // namespace proofmass::calibrate
