#include "proofmass/calibrate/model_equation/confounded_words.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <string>

namespace proofmass::calibrate {
namespace {

using Eigen::Index;
using sensor::Coefficient;

std::string_view name(Coefficient coefficient) {
  return sensor::info(coefficient).name;
}

std::string listed(const std::vector<Coefficient>& coefficients) {
  std::string text;
  for (std::size_t k = 0; k < coefficients.size(); ++k) {
    const bool last = k + 1 == coefficients.size();
    text += k == 0 ? "" : last ? " and " : ", ";
    text += name(coefficients[k]);
  }
  return text;
}

std::string_view number_word(std::size_t n) {
  constexpr std::string_view words[] = {"none", "one", "two", "three", "four", "five", "six"};
  return n < std::size(words) ? words[n] : "some";
}

// "K2 − Kpp", "K1 (1 + 96.17 K3)"
Combination combination(const TiedTerms& group,
                        std::size_t retained,
                        const std::vector<Coefficient>& coefficients,
                        const FittedValues& fitted) {
  const std::size_t at = group.retained[retained];
  const bool of_k1 = coefficients[at] == Coefficient::K1;
  Combination result;
  result.parts.emplace_back(coefficients[at], 1.0);
  result.name = of_k1 ? "K1 (1" : std::string(name(coefficients[at]));
  for (std::size_t l = 0; l < group.left_out.size(); ++l) {
    const double weight = group.weight(static_cast<Index>(l), static_cast<Index>(retained));
    if (weight == 0.0) continue;
    const Coefficient part = coefficients[group.left_out[l]];
    result.parts.emplace_back(part, weight);
    const double size = std::abs(weight);
    const bool one = std::abs(size - 1.0) < 1e-3;
    result.name += weight < 0.0 ? " − " : " + ";
    result.name += one ? "" : fmt::format("{:.4g} ", size);
    result.name += name(part);
  }
  if (of_k1) result.name += ")";
  const auto c = static_cast<Index>(at);
  result.value = {fitted.value(c), std::sqrt(fitted.covariance(c, c))};
  return result;
}

bool is_square(Coefficient c) {
  return c == Coefficient::K2 || c == Coefficient::Kpp || c == Coefficient::Koo;
}

// Whether a relation states that |a|² is constant: K0 with squares of weight −1 and nothing else.
bool says_size_is_constant(const TiedTerms& group,
                           std::size_t left_out,
                           const std::vector<Coefficient>& coefficients) {
  if (!is_square(coefficients[group.left_out[left_out]])) return false;
  bool constant = false;
  for (std::size_t r = 0; r < group.retained.size(); ++r) {
    const double weight = group.weight(static_cast<Index>(left_out), static_cast<Index>(r));
    if (weight == 0.0) continue;
    const Coefficient one = coefficients[group.retained[r]];
    if (one == Coefficient::K0)
      constant = true;
    else if (!is_square(one) || std::abs(weight + 1.0) > 0.01)
      return false;
  }
  return constant;
}

// Whether a relation involves functions of a_i alone, which holds if a_i has few values.
bool is_of_input_axis(Coefficient c) {
  constexpr Coefficient functions[] = {Coefficient::K1,      Coefficient::K0,  Coefficient::K0_asym,
                                       Coefficient::K1_asym, Coefficient::Koq, Coefficient::K2,
                                       Coefficient::K3};
  return std::ranges::find(functions, c) != std::end(functions);
}

bool is_between_functions_of_input(const TiedTerms& group,
                                   const std::vector<Coefficient>& coefficients) {
  const auto of_input = [&](std::size_t at) { return is_of_input_axis(coefficients[at]); };
  return std::ranges::all_of(group.left_out, of_input) &&
         std::ranges::all_of(group.retained, of_input);
}

// "K2, Kpp and Koo only by their differences while |a| is constant: choose two of the three, or …"
std::string constant_size_words(const Confounded& found) {
  std::vector<Coefficient> squares;
  std::ranges::copy_if(found.coefficients, std::back_inserter(squares), is_square);
  const std::size_t count = squares.size();
  if (count == 1) {
    return fmt::format(
        "{} only together with K0 while |a| is the same in every row: leave {} out, or change |a| "
        "(a centrifuge)",
        listed(squares), listed(squares));
  }
  return fmt::format(
      "{} only by their difference{}, and K0 only with one of them, while |a| is the same in every "
      "row: choose {} of the {}, or change |a| (a centrifuge)",
      listed(squares), count == 2 ? "" : "s", number_word(count - 1), number_word(count));
}

std::string words(const Confounded& found,
                  const TiedTerms& group,
                  const std::vector<Coefficient>& coefficients) {
  if (group.left_out.size() == 1 && says_size_is_constant(group, 0, coefficients)) {
    return constant_size_words(found);
  }
  std::string relations;
  for (const std::string& one : found.relations) relations += (relations.empty() ? "" : ", ") + one;
  return fmt::format(
      "{} are not separable: in every row {} (accelerations in g); choose {} of them, or add {}",
      listed(found.coefficients), relations, number_word(found.determined),
      is_between_functions_of_input(group, coefficients) ? "rows with other values of a_i"
                                                         : "rows in which that does not hold");
}

}  // namespace

Confounded describe_confounded(const TiedTerms& group,
                               const std::vector<Coefficient>& coefficients,
                               const FittedValues& fitted) {
  Confounded found;
  for (const auto& part : {group.retained, group.left_out}) {
    for (const std::size_t at : part) found.coefficients.push_back(coefficients[at]);
  }
  std::ranges::sort(found.coefficients);
  found.determined = group.retained.size();
  for (std::size_t l = 0; l < group.left_out.size(); ++l) {
    found.relations.push_back(relation_words(group, l, coefficients));
  }
  for (std::size_t r = 0; r < group.retained.size(); ++r) {
    found.combinations.push_back(combination(group, r, coefficients, fitted));
  }
  found.words = words(found, group, coefficients);
  return found;
}

}  // namespace proofmass::calibrate
