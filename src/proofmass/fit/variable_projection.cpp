#include "proofmass/fit/variable_projection.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>

#include "proofmass/core/contract.hpp"
#include "proofmass/fit/differences.hpp"
#include "proofmass/fit/factored_columns.hpp"

namespace proofmass::fit {
namespace {

using Index = Eigen::Index;

constexpr double infinity = std::numeric_limits<double>::infinity();

// z minus its projection onto the span of Q; applied twice to remove rounding errors.
template <class Dense>
void project_out(const Eigen::MatrixXd& Q, Dense& z) {
  for (int pass = 0; pass < 2 && Q.cols() > 0; ++pass) z -= Q * (Q.transpose() * z).eval();
}

// The linear problem for one α.
struct Projected {
  std::vector<double> alpha;
  bool defined = false;
  Eigen::MatrixXd V_in_Q;  // projection of the varying columns onto the constant ones
  FactoredColumns extra;   // their component orthogonal to the constant ones
  Eigen::VectorXd c;       // coefficients of the varying columns
  Eigen::VectorXd e;       // y − Φ c
};

class Separable {
 public:
  Separable(View<double> y, const SeparableProblem& problem)
      : problem_(problem),
        constant_(problem.constant
                      ? * problem.constant
                      : none_ = {Eigen::MatrixXd(static_cast<Index>(y.size()), 0), {}, {}, {}}),
        y_(Eigen::VectorXd::Map(y.data(), static_cast<Index>(y.size()))),
        y_left_(y_) {
    project_out(constant_.Q, y_left_);
  }

  [[nodiscard]] Index columns() const { return constant_.length.size() + problem_.varying_columns; }

  const Projected& at(View<double> alpha) {
    if (std::ranges::equal(alpha, now_.alpha)) return now_;
    now_.alpha.assign(alpha.begin(), alpha.end());
    Eigen::MatrixXd V;
    now_.defined = fill(alpha, V);
    if (!now_.defined) return now_;
    const Eigen::VectorXd length = V.colwise().stableNorm();
    now_.V_in_Q = constant_.Q.transpose() * V;
    project_out(constant_.Q, V);
    now_.extra = factored(V, length);
    const Eigen::VectorXd seen = now_.extra.Q.transpose() * y_left_;
    now_.c = now_.extra.R_inverse * seen;
    now_.e = y_left_ - now_.extra.Q * seen;
    return now_;
  }

  // (∂Φ/∂αₖ) c, one column for each k.
  Eigen::MatrixXd moved(View<double> alpha, View<double> scale) {
    const Eigen::VectorXd c = at(alpha).c;
    Eigen::MatrixXd slopes(y_.size(), static_cast<Index>(alpha.size()));
    std::vector<double> a(alpha.begin(), alpha.end());
    Eigen::MatrixXd V;
    for (std::size_t k = 0; k < a.size(); ++k) {
      const double here = a[k];
      DifferenceRange range{std::max(std::abs(here), 1e-4 * scale[k])};
      if (!problem_.lower.empty()) range.lower = problem_.lower[k];
      if (!problem_.upper.empty()) range.upper = problem_.upper[k];
      const auto along = [&](double t, Eigen::VectorXd& f) {
        a[k] = t;
        if (!fill(a, V)) return false;
        f.noalias() = V * c;
        return true;
      };
      slopes.col(static_cast<Index>(k)) = derivative(along, here, range, y_.size());
      a[k] = here;
    }
    return slopes;
  }

  // Kaufman's approximation: −P (∂Φ/∂α) c.
  Eigen::MatrixXd jacobian(View<double> alpha, View<double> scale) {
    Eigen::MatrixXd J = -moved(alpha, scale);
    project_out(constant_.Q, J);
    project_out(at(alpha).extra.Q, J);
    return J;
  }

  // Φ⁺ z.
  [[nodiscard]] Eigen::MatrixXd coefficients(const Eigen::MatrixXd& z) const {
    Eigen::MatrixXd common = constant_.Q.transpose() * z;
    const Eigen::MatrixXd varying = now_.extra.R_inverse * (now_.extra.Q.transpose() * z);
    common -= now_.V_in_Q * varying;
    Eigen::MatrixXd all(columns(), z.cols());
    all << constant_.R_inverse * common, varying;
    return all;
  }

  [[nodiscard]] Eigen::VectorXd coefficients() const { return coefficients(y_); }

  // (ΦᵀΦ)⁻¹ = F Fᵀ, F = [R⁻¹, −R⁻¹ QᵀV R₂⁻¹; 0, R₂⁻¹].
  [[nodiscard]] Eigen::MatrixXd inverse_product() const {
    const Eigen::MatrixXd& lower = now_.extra.R_inverse;
    const Eigen::MatrixXd upper = -constant_.R_inverse * (now_.V_in_Q * lower);
    const Index m = constant_.length.size(), v = problem_.varying_columns;
    Eigen::MatrixXd product(m + v, m + v);
    product.bottomRightCorner(v, v) = lower * lower.transpose();
    product.topRightCorner(m, v) = upper * lower.transpose();
    product.bottomLeftCorner(v, m) = product.topRightCorner(m, v).transpose();
    product.topLeftCorner(m, m) = upper * upper.transpose();
    if (m > 0) product.topLeftCorner(m, m) += constant_.inverse_product;
    for (Index i = 0; i < m + v; ++i)
      if (product(i, i) == 0.0) product(i, i) = infinity;
    return product;
  }

  [[nodiscard]] Index rank() const { return constant_.Q.cols() + now_.extra.Q.cols(); }

  [[nodiscard]] double condition(const Eigen::MatrixXd& product) const {
    if (rank() < columns()) return infinity;
    Eigen::VectorXd length(columns());
    length << constant_.length, now_.extra.length;
    const double inverse = product.diagonal().dot(length.cwiseAbs2());
    return std::sqrt(inverse / static_cast<double>(columns()));
  }

 private:
  bool fill(View<double> alpha, Eigen::MatrixXd& V) const {
    V.resize(y_.size(), problem_.varying_columns);
    problem_.basis(alpha, V);
    return V.allFinite();
  }

  const SeparableProblem& problem_;
  FactoredColumns none_;
  const FactoredColumns& constant_;
  Eigen::VectorXd y_, y_left_;
  Projected now_;
};

// s2 times the covariance for unit variance, with C = (JᵀJ)⁻¹ and B = Φ⁺ (∂Φ/∂α) c. An undetermined
// α makes the c that it is coupled to undetermined too.
Eigen::MatrixXd joint_covariance(Eigen::MatrixXd C,
                                 const Eigen::MatrixXd& B,
                                 const Eigen::MatrixXd& inverse_product,
                                 double s2) {
  const Index a = C.rows(), m = B.rows();
  const Eigen::VectorXd variance = C.diagonal();
  for (Index k = 0; k < a; ++k)
    if (std::isinf(variance(k))) C(k, k) = 0.0;
  Eigen::MatrixXd joint(a + m, a + m);
  joint.topLeftCorner(a, a) = C;
  joint.bottomLeftCorner(m, a) = -B * C;
  joint.topRightCorner(a, m) = joint.bottomLeftCorner(m, a).transpose();
  joint.bottomRightCorner(m, m) = inverse_product + B * C * B.transpose();
  joint *= s2;
  for (Index i = 0; i < m; ++i)
    if (std::isinf(inverse_product(i, i))) joint(a + i, a + i) = infinity;
  for (Index k = 0; k < a; ++k) {
    if (!std::isinf(variance(k))) continue;
    joint(k, k) = infinity;
    for (Index i = 0; i < m; ++i)
      if (B(i, k) != 0.0) joint(a + i, a + i) = infinity;
  }
  return joint;
}

std::optional<Error> input_error(View<double> y, const SeparableProblem& problem) {
  if (problem.varying_columns < 1)
    return Error{Errc::invalid_argument, "no column depends on the nonlinear parameters"};
  if (problem.constant && problem.constant->Q.rows() != static_cast<Index>(y.size()))
    return Error{Errc::invalid_argument, "y and the constant columns differ in length"};
  if (!std::ranges::all_of(y, [](double v) { return std::isfinite(v); }))
    return Error{Errc::not_finite, "y has a NaN or infinite value"};
  const Index columns =
      problem.varying_columns + (problem.constant ? problem.constant->length.size() : 0);
  const auto unknowns = static_cast<std::size_t>(columns) + problem.start.size();
  if (y.size() < unknowns)
    return Error{Errc::too_few_samples, std::to_string(y.size()) + " values cannot determine " +
                                            std::to_string(unknowns) + " parameters"};
  return std::nullopt;
}

}  // namespace

Result<SeparableFit> fit_separable(View<double> y,
                                   const SeparableProblem& problem,
                                   const SeparableOptions& options) {
  PM_EXPECTS(problem.basis != nullptr);
  if (auto error = input_error(y, problem)) return *error;
  Separable separable(y, problem);
  std::vector<double> scale = options.scale.empty() ? problem.start : options.scale;
  for (double& s : scale) s = s == 0.0 ? 1.0 : std::abs(s);
  const auto found = fit_least_squares(
      {.residuals =
           [&](View<double> alpha, std::span<double> residuals) {
             const Projected& at = separable.at(alpha);
             if (at.defined)
               std::ranges::copy(at.e, residuals.begin());
             else
               std::ranges::fill(residuals, std::numeric_limits<double>::quiet_NaN());
           },
       .residual_count = y.size(),
       .start = problem.start,
       .lower = problem.lower,
       .upper = problem.upper,
       .jacobian = [&](View<double> alpha,
                       Eigen::Ref<Eigen::MatrixXd> J) { J = separable.jacobian(alpha, scale); }},
      {.unit_variance = true,
       .search_again = options.search_again,
       .max_iterations = options.max_iterations,
       .scale = options.scale});
  if (!found) return found.error();

  separable.at(found->parameters);
  const Eigen::MatrixXd product = separable.inverse_product();
  const Eigen::MatrixXd B = separable.coefficients(separable.moved(found->parameters, scale));
  const Index dof = static_cast<Index>(found->dof) - separable.rank();
  const double residual_std = dof > 0 ? std::sqrt(found->rss / static_cast<double>(dof))
                                      : std::numeric_limits<double>::quiet_NaN();
  const double variance = options.unit_variance ? 1.0 : residual_std * residual_std;
  return SeparableFit{.alpha = found->parameters,
                      .coefficients = separable.coefficients(),
                      .covariance = joint_covariance(found->covariance, B, product, variance),
                      .rss = found->rss,
                      .residual_std = residual_std,
                      .dof = dof,
                      .iterations = found->iterations,
                      .converged = found->converged,
                      .at_bound = found->at_bound,
                      .condition = found->condition,
                      .basis_condition = separable.condition(product)};
}

}  // namespace proofmass::fit
