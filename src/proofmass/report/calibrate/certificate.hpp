#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "proofmass/calibrate/uncertainty_budget.hpp"
#include "proofmass/core/quantity.hpp"
#include "proofmass/report/page/page.hpp"

// A calibration certificate: results with their expanded uncertainty and its budget.
namespace proofmass::report {

struct CertificateData {
  std::string name, serial;            ///< of the sensor; empty if not stated
  std::string date;                    ///< of the measurement, ISO 8601
  std::vector<std::string> files;      ///< recordings on which it is based
  std::string method;                  ///< "multi-position, nine parameters against gravity"
  std::vector<std::string> equations;  ///< the model, one line each
  std::optional<Uncertain> gravity_mps2, temperature_k, supply_v;
  std::size_t positions = 0;
  /// One for each result; the unit of a scale or an angle is the SI unit of the sensor file.
  std::vector<calibrate::UncertaintyBudget> budgets;
  std::vector<std::string> not_determined;  ///< sentences
  std::string monte_carlo;          ///< verdict of the Monte Carlo check; empty if there was none
  std::vector<std::string> limits;  ///< sentences: limits of validity
};

/// The certificate as sections of a page; in print, the first one begins a new sheet.
[[nodiscard]] std::vector<Section> certificate_sections(const CertificateData& data);

}  // namespace proofmass::report
