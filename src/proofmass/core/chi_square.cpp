#include "proofmass/core/chi_square.hpp"

#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/fisher_f.hpp>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>

#include "proofmass/core/contract.hpp"

namespace proofmass {

double chi_square_quantile(double p, double degrees_of_freedom) {
  PM_EXPECTS(p > 0.0 && p < 1.0 && degrees_of_freedom > 0.0);
  return boost::math::quantile(boost::math::chi_squared(degrees_of_freedom), p);
}

double chi_square_p(double statistic, double degrees_of_freedom) {
  PM_EXPECTS(statistic >= 0.0 && degrees_of_freedom > 0.0);
  const boost::math::chi_squared distribution(degrees_of_freedom);
  return boost::math::cdf(boost::math::complement(distribution, statistic));
}

double normal_quantile(double p) {
  PM_EXPECTS(p > 0.0 && p < 1.0);
  return boost::math::quantile(boost::math::normal(), p);
}

double student_t_quantile(double p, double degrees_of_freedom) {
  return boost::math::quantile(boost::math::students_t(degrees_of_freedom), p);
}

double student_t_p(double t, double degrees_of_freedom) {
  PM_EXPECTS(degrees_of_freedom > 0.0);
  const boost::math::students_t distribution(degrees_of_freedom);
  return 2.0 * boost::math::cdf(boost::math::complement(distribution, std::abs(t)));
}

double fisher_f_p(double statistic, double dof_above, double dof_below) {
  PM_EXPECTS(statistic >= 0.0 && dof_above > 0.0 && dof_below > 0.0);
  const boost::math::fisher_f distribution(dof_above, dof_below);
  return boost::math::cdf(boost::math::complement(distribution, statistic));
}

Bounds mean_chi_square_95(std::size_t count) {
  const auto n = static_cast<double>(count);
  return {chi_square_quantile(0.025, n) / n, chi_square_quantile(0.975, n) / n};
}

}  // namespace proofmass
