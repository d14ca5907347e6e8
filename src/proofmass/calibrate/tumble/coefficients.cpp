#include "proofmass/calibrate/tumble/coefficients.hpp"

#include <algorithm>
#include <cmath>

#include "proofmass/calibrate/tumble/words.hpp"
#include "proofmass/calibrate/uncertainty_budget.hpp"

namespace proofmass::calibrate {
namespace {

// One coefficient, with its numerator as a linear form in β.
struct Form {
  TumbleCoefficient coefficient;
  std::vector<std::pair<std::size_t, double>> parts;  // column, factor
  double factor = 1.0;                                // besides the power of g
  bool whole = true;                                  // all columns were fitted
};

// One term of a numerator.
struct Part {
  TumbleTerm term;
  int plane;
  double factor;
};

Form make_form(const TumbleDesign& design,
               TumbleQuantity quantity,
               int plane,
               std::initializer_list<Part> parts) {
  Form form;
  form.coefficient.quantity = quantity;
  form.coefficient.plane = plane;
  for (const Part& part : parts) {
    const auto column = design.find(part.term, part.plane);
    if (column)
      form.parts.emplace_back(*column, part.factor);
    else if (form.whole)
      form.coefficient.reason = why_missing(design, part.term, part.plane);
    form.whole = form.whole && column.has_value();
  }
  return form;
}

Form misalignment(const TumbleDesign& design, std::size_t mounting) {
  const TumbleMounting& m = design.mountings[mounting];
  Form form;
  form.coefficient.quantity =
      m.plane == 2 ? TumbleQuantity::misalignment_p : TumbleQuantity::misalignment;
  form.coefficient.plane = m.plane;
  form.coefficient.mount_rad = m.mount_rad;
  const auto column = design.find(TumbleTerm::cosine, m.plane, mounting);
  form.whole = column.has_value();
  // In the model equation, δo multiplies + aₚ and δp multiplies − aₒ.
  if (column) form.parts.emplace_back(*column, m.plane == 2 ? -1.0 : 1.0);
  if (!column) form.coefficient.reason = why_missing(design, TumbleTerm::cosine, m.plane);
  return form;
}

void add_plane(const TumbleDesign& design, int plane, std::vector<Form>& forms) {
  using Q = TumbleQuantity;
  using T = TumbleTerm;
  const bool second = plane == 2;
  for (std::size_t m = 0; m < design.mountings.size(); ++m)
    if (design.mountings[m].plane == plane) forms.push_back(misalignment(design, m));
  forms.push_back(make_form(design, second ? Q::K0_second : Q::K0, plane,
                            {{T::up_down, 0, 1.0}, {T::square, plane, 2.0}}));
  forms.push_back(make_form(design, second ? Q::K2_minus_Koo : Q::K2_minus_Kpp, plane,
                            {{T::square, plane, -2.0}}));
  forms.push_back(make_form(design, second ? Q::Kio : Q::Kip, plane, {{T::product, plane, 2.0}}));
  forms.push_back(make_form(design, Q::third_cosine, plane, {{T::third_cosine, plane, 1.0}}));
}

std::vector<Form> forms_of(const TumbleDesign& design) {
  using Q = TumbleQuantity;
  using T = TumbleTerm;
  std::vector<Form> forms;
  forms.push_back(make_form(design, Q::K1, 0, {{T::sine, 0, 1.0}}));
  forms.push_back(make_form(design, Q::K0_up_down, 0, {{T::up_down, 0, 1.0}}));
  for (const int plane : {1, 2}) {
    const bool there = std::any_of(design.mountings.begin(), design.mountings.end(),
                                   [&](const TumbleMounting& m) { return m.plane == plane; });
    if (there) add_plane(design, plane, forms);
  }
  forms.push_back(make_form(design, Q::K3, 0, {{T::cube, 0, -4.0}}));
  forms.push_back(make_form(design, Q::drift, 0, {{T::drift, 0, 1.0}}));
  if (design.span > 0.0) forms.back().factor = 1.0 / design.span;
  forms.push_back(make_form(design, Q::temperature, 0, {{T::temperature, 0, 1.0}}));
  if (design.kelvin_span > 0.0) forms.back().factor = 1.0 / design.kelvin_span;
  forms.push_back(make_form(design, Q::hysteresis, 0, {{T::hysteresis, 0, 1.0}}));
  forms.push_back(make_form(design, Q::backlash, 0, {{T::backlash, 0, 1.0}}));
  forms.push_back(make_form(design, Q::indexing_cos, 0, {{T::indexing_cos, 0, 1.0}}));
  forms.push_back(make_form(design, Q::indexing_sin, 0, {{T::indexing_sin, 0, 1.0}}));
  forms.push_back(make_form(design, Q::indexing_cos2, 0, {{T::indexing_cos2, 0, 1.0}}));
  forms.push_back(make_form(design, Q::indexing_sin2, 0, {{T::indexing_sin2, 0, 1.0}}));
  return forms;
}

Eigen::VectorXd amplitude_form(const TumbleDesign& design) {
  Eigen::VectorXd s = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(design.columns.size()));
  if (const auto sine = design.find(TumbleTerm::sine)) s(static_cast<Eigen::Index>(*sine)) = 1.0;
  if (const auto cube = design.find(TumbleTerm::cube)) s(static_cast<Eigen::Index>(*cube)) = 3.0;
  return s;
}

Eigen::VectorXd vector_of(const Form& form, Eigen::Index size) {
  Eigen::VectorXd L = Eigen::VectorXd::Zero(size);
  for (const auto& [column, factor] : form.parts) L(static_cast<Eigen::Index>(column)) += factor;
  return L;
}

// Jacobian of all coefficients: one row each, with the columns β and finally g.
Eigen::MatrixXd differentiate(const TumbleSolution& solution, std::vector<Form>& forms) {
  const Eigen::VectorXd& beta = solution.regression.beta;
  const Eigen::VectorXd s = amplitude_form(solution.design);
  const double amplitude = s.dot(beta), g = solution.options.gravity_mps2;
  Eigen::VectorXd whole = beta;  // including the offset subtracted from the outputs
  if (const auto U = solution.design.find(TumbleTerm::up_down))
    whole(static_cast<Eigen::Index>(*U)) += solution.output_offset;
  Eigen::MatrixXd J =
      Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(forms.size()), beta.size() + 1);
  for (std::size_t k = 0; k < forms.size(); ++k) {
    Form& form = forms[k];
    if (!form.whole) continue;
    const auto row = static_cast<Eigen::Index>(k);
    if (form.coefficient.quantity == TumbleQuantity::K1) {
      form.coefficient.value = amplitude / g;
      J.row(row).head(beta.size()) = s.transpose() / g;
      J(row, beta.size()) = -amplitude / (g * g);
      continue;
    }
    const int power = acceleration_power(form.coefficient.quantity);
    const double unit = form.factor * std::pow(g, power);
    const Eigen::VectorXd L = vector_of(form, beta.size());
    const double ratio = L.dot(whole) / amplitude;
    form.coefficient.value = unit * ratio;
    J.row(row).head(beta.size()) = unit / amplitude * (L - ratio * s).transpose();
    J(row, beta.size()) = power * *form.coefficient.value / g;
  }
  return J;
}

// Bias in units of the output: K1 (K0 + Kpp g²) of the first plane that has it, or U.
void find_bias(const TumbleSolution& solution, TumbleFit& fit) {
  const TumbleDesign& design = solution.design;
  const TumbleRegression& regression = solution.regression;
  const auto U = design.find(TumbleTerm::up_down);
  if (!U) return;
  Eigen::VectorXd L = Eigen::VectorXd::Zero(regression.beta.size());
  L(static_cast<Eigen::Index>(*U)) = 1.0;
  if (const auto Q = design.find(TumbleTerm::square)) L(static_cast<Eigen::Index>(*Q)) = 2.0;
  fit.bias_output = L.dot(regression.beta) + solution.output_offset;
  if (!regression.has_scale) return;
  const Eigen::MatrixXd covariance =
      regression.noise_covariance + regression.indexing_covariance + regression.drift_covariance;
  fit.bias_output_std = std::sqrt(std::max(L.dot(covariance * L), 0.0));
}

// Welch–Satterthwaite for a sum of contributions, one of which has finite degrees of freedom.
void judge(TumbleCoefficient& coefficient, double variance, double noise, double dof) {
  coefficient.std = std::sqrt(std::max(variance, 0.0));
  if (dof > 0.0 && noise > 0.0) coefficient.dof = dof * variance * variance / (noise * noise);
  // The half width combines the contributions' own coverage factors: the effective degrees of
  // freedom alone would make it too narrow if the estimated scatter is small by chance.
  const double rest = std::max(variance - noise, 0.0);
  coefficient.half_width_95 =
      std::hypot(coverage_factor(0.95, dof) * std::sqrt(std::max(noise, 0.0)),
                 coverage_factor(0.95, 0.0) * std::sqrt(rest));
}

}  // namespace

double amplitude_of(const TumbleDesign& design, const Eigen::VectorXd& beta) {
  return amplitude_form(design).dot(beta);
}

void find_coefficients(const TumbleSolution& solution, TumbleFit& fit) {
  const TumbleRegression& regression = solution.regression;
  std::vector<Form> forms = forms_of(solution.design);
  const Eigen::MatrixXd J = differentiate(solution, forms);
  const Eigen::MatrixXd J_b = J.leftCols(regression.beta.size());
  const Eigen::VectorXd J_g = J.rightCols(1);
  const double u = solution.options.gravity_std_mps2;
  fit.shares = {{"scatter of the positions", true,
                 J_b * regression.noise_covariance * J_b.transpose(), regression.dof}};
  if (regression.indexing_covariance.cwiseAbs().maxCoeff() > 0.0)
    fit.shares.push_back({"indexing of the table", false,
                          J_b * regression.indexing_covariance * J_b.transpose(), 0.0});
  if (regression.drift_covariance.cwiseAbs().maxCoeff() > 0.0)
    fit.shares.push_back({"drift that is not straight", false,
                          J_b * regression.drift_covariance * J_b.transpose(), 0.0});
  if (u > 0.0) fit.shares.push_back({"gravity", false, u * u * J_g * J_g.transpose(), 0.0});
  if (fit.noise_known && fit.scatter == 1.0) fit.shares.front().source = "noise of the means";
  fit.covariance = Eigen::MatrixXd::Zero(J.rows(), J.rows());
  for (const TumbleShare& share : fit.shares) fit.covariance += share.covariance;
  // With stated errors of indexing the residuals may contain too little information on the scatter.
  const bool scatter_unseen = !fit.noise_known &&
                              solution.options.indexing_std_rad.value_or(0.0) > 0.0 &&
                              regression.dof < 2.0;
  for (std::size_t k = 0; k < forms.size(); ++k) {
    TumbleCoefficient& coefficient = forms[k].coefficient;
    const auto row = static_cast<Eigen::Index>(k);
    const double variance = fit.covariance(row, row);
    const double scatter = fit.shares.front().covariance(row, row);
    if (coefficient.value && !regression.has_scale)
      coefficient.reason = no_std_words(solution.design);
    else if (coefficient.value && scatter_unseen && scatter > 0.5 * variance)
      coefficient.reason = unseen_scatter_words();
    else if (coefficient.value)
      judge(coefficient, variance, scatter, regression.dof);
    coefficient.unit = unit_words(coefficient.quantity, solution);
    coefficient.meaning = meaning_words(coefficient, solution.design);
    fit.coefficients.push_back(std::move(coefficient));
  }
  find_bias(solution, fit);
}

}  // namespace proofmass::calibrate
