#include "proofmass/calibrate/model_equation/identifiability.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <utility>

#include "proofmass/core/linalg.hpp"
#include "proofmass/core/units.hpp"

namespace proofmass::calibrate {
namespace {

using Eigen::Index;
using sensor::Coefficient;

// Motion is seldom known better: a shorter combination of unit columns is not significant.
constexpr double negligible = 1e-4;
// A smaller weight in a relation is rounding.
constexpr double negligible_weight = 1e-3;

// From the least to the most important coefficient.
constexpr std::array priority{
    Coefficient::Koo,     Coefficient::Kpp,  Coefficient::Kpo, Coefficient::Kio,
    Coefficient::Kspin,   Coefficient::Kang, Coefficient::Koq, Coefficient::K1_asym,
    Coefficient::K0_asym, Coefficient::K3,   Coefficient::Kip, Coefficient::delta_p,
    Coefficient::delta_o, Coefficient::K2,   Coefficient::K0,  Coefficient::K1};
static_assert(priority.size() == sensor::coefficient_count);

// Null vectors of unit columns, one a row, in echelon form: a 1 in the pivot's column and 0 there
// in the other rows.
struct Echelon {
  Eigen::MatrixXd rows;
  std::vector<Index> pivots;
};

// Makes a row the next of the form, and clears the pivot's column in the others.
void reduce_by(Eigen::MatrixXd& null, Index done, Index row, Index column) {
  null.row(done).swap(null.row(row));
  null.row(done) /= null(done, column);
  for (Index r = 0; r < null.rows(); ++r) {
    if (r != done) null.row(r) -= null(r, column) * null.row(done);
  }
}

Echelon echelon(Eigen::MatrixXd null, const std::vector<Index>& order) {
  constexpr double least_pivot = 0.05;
  Echelon result;
  for (const double least : {least_pivot, 0.0}) {
    for (const Index column : order) {
      const Index done = std::ssize(result.pivots);
      const bool used = std::ranges::find(result.pivots, column) != result.pivots.end();
      if (done == null.rows() || used) continue;
      Index row = 0;
      const double largest = null.col(column).tail(null.rows() - done).cwiseAbs().maxCoeff(&row);
      if (largest <= least) continue;
      reduce_by(null, done, done + row, column);
      result.pivots.push_back(column);
    }
  }
  result.rows = std::move(null);
  return result;
}

// Rows of the echelon form that share a coefficient are one group.
std::vector<std::vector<Index>> connected_rows(const Echelon& form) {
  std::vector<std::vector<Index>> groups;
  for (Index row = 0; row < form.rows.rows(); ++row) {
    std::vector<Index> joined{row};
    std::erase_if(groups, [&](const std::vector<Index>& group) {
      const bool touches = std::ranges::any_of(group, [&](Index other) {
        return ((form.rows.row(row).array().abs() > negligible_weight) &&
                (form.rows.row(other).array().abs() > negligible_weight))
            .any();
      });
      if (touches) joined.insert(joined.end(), group.begin(), group.end());
      return touches;
    });
    std::ranges::sort(joined);
    groups.push_back(std::move(joined));
  }
  return groups;
}

TiedTerms tied_terms(const Echelon& form,
                     const std::vector<Index>& group,
                     const std::vector<Index>& columns,
                     const Eigen::VectorXd& length) {
  TiedTerms tied;
  std::vector<Index> retained;
  for (Index c = 0; c < form.rows.cols(); ++c) {
    if (std::ranges::find(form.pivots, c) != form.pivots.end()) continue;
    const bool part = std::ranges::any_of(
        group, [&](Index row) { return std::abs(form.rows(row, c)) > negligible_weight; });
    if (part) retained.push_back(c);
  }
  tied.weight.resize(std::ssize(group), std::ssize(retained));
  for (Index k = 0; k < std::ssize(group); ++k) {
    const Index row = group[static_cast<std::size_t>(k)];
    const Index pivot = form.pivots[static_cast<std::size_t>(row)];
    tied.left_out.push_back(static_cast<std::size_t>(columns[static_cast<std::size_t>(pivot)]));
    for (Index r = 0; r < std::ssize(retained); ++r) {
      const Index c = retained[static_cast<std::size_t>(r)];
      const double entry = form.rows(row, c);
      tied.weight(k, r) =
          std::abs(entry) > negligible_weight ? -entry * length(pivot) / length(c) : 0.0;
    }
  }
  for (const Index c : retained) {
    tied.retained.push_back(static_cast<std::size_t>(columns[static_cast<std::size_t>(c)]));
  }
  return tied;
}

// Degree of the term in accelerations.
int degree_in_accel(Coefficient c) {
  return c == Coefficient::K1 ? 1 : sensor::info(c).power_of_g + 1;
}

// Columns of the design that are not zero within rounding.
std::vector<Index> excited_columns(const Eigen::MatrixXd& design,
                                   const std::vector<Coefficient>& coefficients,
                                   double unit_length) {
  constexpr double rounding = 1e-6;
  double accel = 0.0;
  for (Index c = 0; c < design.cols(); ++c) {
    const int power = degree_in_accel(coefficients[static_cast<std::size_t>(c)]);
    if (power > 0) {
      accel = std::max(accel, std::pow(design.col(c).norm() / unit_length, 1.0 / power));
    }
  }
  std::vector<Index> excited;
  for (Index c = 0; c < design.cols(); ++c) {
    const int power = degree_in_accel(coefficients[static_cast<std::size_t>(c)]);
    const double natural = power > 0 ? unit_length * std::pow(accel, power) : 0.0;
    if (design.col(c).norm() > rounding * natural) excited.push_back(c);
  }
  return excited;
}

std::string_view term_text(Coefficient coefficient) {
  constexpr std::array<std::string_view, sensor::coefficient_count> text{
      "a_i",    "1",       "½ sgn a_i", "½ |a_i|", "a_i |a_i|", "a_i²", "a_i³",    "a_p",
      "(−a_o)", "a_i a_p", "a_i a_o",   "a_p a_o", "a_p²",      "a_o²", "ω_i ω_p", "ω̇_o"};
  return text[static_cast<std::size_t>(coefficient)];
}

// "0.25 a_i": a term with its factor, which is omitted where it is 1.
std::string product_words(double factor, Coefficient coefficient) {
  const bool one = std::abs(factor - 1.0) < negligible_weight;
  const std::string figure = fmt::format("{:.4g}", one ? 1.0 : factor);
  if (coefficient == Coefficient::K0) return figure;
  return (one ? "" : figure + " ") + std::string(term_text(coefficient));
}

}  // namespace

Identifiability identifiability(const Eigen::MatrixXd& design,
                                const std::vector<Coefficient>& coefficients,
                                double unit_length) {
  Identifiability result;
  result.excited.assign(coefficients.size(), false);
  const std::vector<Index> columns = excited_columns(design, coefficients, unit_length);
  for (const Index c : columns) result.excited[static_cast<std::size_t>(c)] = true;
  const auto count = std::ssize(columns);
  if (count == 0) return result;
  Eigen::VectorXd length(count);
  Eigen::MatrixXd unit(design.rows(), count);
  for (Index k = 0; k < count; ++k) {
    const auto column = design.col(columns[static_cast<std::size_t>(k)]);
    length(k) = column.norm();
    unit.col(k) = column / length(k);
  }
  const SymmetricEigen eigen = symmetric_eigen(unit.transpose() * unit);
  const Index null_count = (eigen.values.array() < negligible * negligible).count();
  result.condition = null_count > 0 ? std::numeric_limits<double>::infinity()
                                    : std::sqrt(eigen.values(count - 1) / eigen.values(0));
  if (null_count == 0) return result;
  std::vector<Index> order;
  for (const Coefficient one : priority) {
    for (Index k = 0; k < count; ++k) {
      const auto column = static_cast<std::size_t>(columns[static_cast<std::size_t>(k)]);
      if (coefficients[column] == one) order.push_back(k);
    }
  }
  const Echelon form = echelon(eigen.vectors.leftCols(null_count).transpose(), order);
  for (const auto& group : connected_rows(form)) {
    result.tied.push_back(tied_terms(form, group, columns, length));
  }
  return result;
}

std::string relation_words(const TiedTerms& group,
                           std::size_t left_out,
                           const std::vector<Coefficient>& coefficients) {
  const Coefficient left = coefficients[group.left_out[left_out]];
  std::string sum;
  for (std::size_t r = 0; r < group.retained.size(); ++r) {
    const Coefficient right = coefficients[group.retained[r]];
    const double weight =
        group.weight(static_cast<Index>(left_out), static_cast<Index>(r)) *
        std::pow(standard_gravity_mps2, degree_in_accel(right) - degree_in_accel(left));
    if (weight == 0.0) continue;
    const std::string_view first = weight < 0.0 ? "−" : "", later = weight < 0.0 ? " − " : " + ";
    sum += sum.empty() ? first : later;
    sum += product_words(std::abs(weight), right);
  }
  return fmt::format("{} = {}", term_text(left), sum.empty() ? "0" : sum);
}

std::string unexcited_words(Coefficient coefficient) {
  switch (coefficient) {
    case Coefficient::delta_o:
    case Coefficient::Kpp:
      return "no row has acceleration along the pendulous axis";
    case Coefficient::delta_p:
    case Coefficient::Koo:
      return "no row has acceleration along the output axis";
    case Coefficient::Kip:
      return "no row has acceleration along the input and the pendulous axis at once";
    case Coefficient::Kio:
      return "no row has acceleration along the input and the output axis at once";
    case Coefficient::Kpo:
      return "no row has acceleration along the pendulous and the output axis at once";
    case Coefficient::Kspin:
      return "no row turns about the input and the pendulous axis at once";
    case Coefficient::Kang:
      return "no row has angular acceleration about the output axis";
    default:
      return "no row has acceleration along the input axis";
  }
}

}  // namespace proofmass::calibrate
