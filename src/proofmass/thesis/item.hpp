#pragma once

#include <optional>
#include <string>
#include <vector>

#include "proofmass/core/quantity.hpp"
#include "proofmass/core/units.hpp"
#include "proofmass/report/figure.hpp"
#include "proofmass/report/page.hpp"

// One table or figure of the thesis beside ours.
namespace proofmass::thesis {

inline constexpr double mg_mps2 = 1e-3 * standard_gravity_mps2;

/// In which a figure is shown to people: shown = SI / to_si.
struct ShownUnit {
  std::string symbol;  ///< "mg", "°", "mm"; empty: a number
  double to_si = 1.0;
};

/// One number: what the thesis prints, where it prints one, and what we find.
struct Finding {
  std::string key;                     ///< in the document: "bias_x"; the same for ever
  std::string label;                   ///< for people: "Bias of x"
  std::string si_unit;                 ///< of both, "m/s^2"; empty: a number
  ShownUnit shown;                     ///< the same quantity
  std::optional<double> thesis = {};   ///< as printed, in SI
  std::optional<Uncertain> ours = {};  ///< std 0 where it is exact or a count
  std::string reason = {};             ///< why ours is absent: a sentence, else empty
};

/// A table, figure or section of the thesis, its figures recomputed.
struct Item {
  std::string id;      ///< as in the thesis: "table 2.1", "figure 5.17", "section A.2"
  std::string title;   ///< what it is, close to its caption
  std::string thesis;  ///< what it says, in a sentence or two
  std::string ours;    ///< what we find, with its figures
  std::string note;    ///< why they differ, or that they agree; what of ours to take instead
  std::vector<Finding> findings = {};
  std::vector<report::Table> tables = {};    ///< beyond that of the findings
  std::vector<report::Figure> figures = {};  ///< ours, drawn
};

}  // namespace proofmass::thesis
