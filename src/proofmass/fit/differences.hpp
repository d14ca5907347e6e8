#pragma once

#include <Eigen/Core>
#include <functional>
#include <limits>

namespace proofmass::fit {

/// A vector along a line; false where it is not finite.
using Along = std::function<bool(double t, Eigen::VectorXd& f)>;

struct DifferenceRange {
  double scale;  ///< natural scale of a change in t
  double lower = -std::numeric_limits<double>::infinity();
  double upper = std::numeric_limits<double>::infinity();
};

/// df/dt by differences at steps h, h/2, h/4 …, extrapolated to h = 0: central, or one-sided near a
/// bound. Starts at a hundredth of the scale, and repeats with shorter steps while the
/// extrapolation does not converge. f must have as many values as t's; zero if no step gives finite
/// values.
///
/// Source: C. J. F. Ridders, Accurate computation of F'(x) and F'(x)F''(x) (1982).
/// Cost: 8 to 20 values of f where it is smooth.
[[nodiscard]] Eigen::VectorXd derivative(const Along& f,
                                         double t,
                                         const DifferenceRange& range,
                                         Eigen::Index values);

}  // namespace proofmass::fit
