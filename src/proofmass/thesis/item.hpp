#pragma once

#include <optional>
#include <string>
#include <vector>

#include "proofmass/core/quantity.hpp"
#include "proofmass/core/units.hpp"
#include "proofmass/report/page/figure.hpp"
#include "proofmass/report/page/page.hpp"

// One table or figure of the thesis compared with ours.
namespace proofmass::thesis {

inline constexpr double mg_mps2 = 1e-3 * standard_gravity_mps2;

/// Display unit: shown = SI / to_si.
struct ShownUnit {
  std::string symbol;  ///< "mg", "°", "mm"; empty: a number
  double to_si = 1.0;
};

/// One value: as printed in the thesis, if at all, and as recomputed.
struct Finding {
  std::string key;                     ///< in the document: "bias_x"; never changes
  std::string label;                   ///< for people: "Bias of x"
  std::string si_unit;                 ///< of both values, "m/s^2"; empty: a number
  ShownUnit shown;                     ///< display unit of the same quantity
  std::optional<double> thesis = {};   ///< as printed, in SI
  std::optional<Uncertain> ours = {};  ///< std 0 if exact or a count
  std::string reason = {};             ///< a sentence if `ours` is absent, else empty
};

/// A table, figure or section of the thesis, with its values recomputed.
struct Item {
  std::string id;      ///< as in the thesis: "table 2.1", "figure 5.17", "section A.2"
  std::string title;   ///< close to its caption
  std::string thesis;  ///< the thesis's statement, in a sentence or two
  std::string ours;    ///< our result, with its values
  std::string note;    ///< why they differ, or that they agree; which of our results to use instead
  std::vector<Finding> findings = {};
  std::vector<report::Table> tables = {};    ///< in addition to that of the findings
  std::vector<report::Figure> figures = {};  ///< our figures
};

}  // namespace proofmass::thesis
