#include "proofmass/report/calibrate/certificate.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <utility>

#include "proofmass/report/wording.hpp"

namespace proofmass::report {
namespace {

using calibrate::BudgetLine;
using calibrate::UncertaintyBudget;

// SI units in which the figures of an accelerometer have leading zeros, and the units printed
// instead.
struct PrintedUnit {
  std::string_view si, printed;
  double factor;
};
constexpr PrintedUnit printed_units[] = {{"rad", "mrad", 1e3},
                                         {"V", "mV", 1e3},
                                         {"V/(m/s^2)", "mV/(m/s^2)", 1e3},
                                         {"rad/s", "mrad/s", 1e3},
                                         {"rad/s/(m/s^2)", "mrad/s/(m/s^2)", 1e3}};

PrintedUnit printed(std::string_view si) {
  for (const PrintedUnit& unit : printed_units)
    if (unit.si == si) return unit;
  return {si, si, 1.0};
}

std::string with_printed_unit(std::string number, std::string_view unit) {
  if (unit != "1") number += " " + print_unit(unit);
  return number;
}

// Decimals that give an uncertainty two significant digits.
int decimals_of(double uncertainty) {
  constexpr int most = 9, of_certain = 6;
  if (!(uncertainty > 0.0)) return of_certain;
  int decimals = 1 - static_cast<int>(std::floor(std::log10(uncertainty)));
  if (std::round(uncertainty * std::pow(10.0, decimals)) >= 100.0) --decimals;
  return std::min(decimals, most);
}

std::string dof_words(double dof) {
  if (dof == 0.0 || dof >= 1e4) return "∞";
  return dof < 1.0 ? fixed(dof, 1) : fixed(std::floor(dof), 0);
}

std::string stated(const std::string& text) {
  return text.empty() ? "not stated" : text;
}

std::string all_file_names(const std::vector<std::string>& items) {
  std::string text;
  for (const std::string& item : items) text += (text.empty() ? "" : ", ") + file_name(item);
  return text;
}

std::string lines(const std::vector<std::string>& items) {
  std::string text;
  for (const std::string& item : items) text += (text.empty() ? "" : ";  ") + item;
  return text;
}

std::string temperature_words(const std::optional<Uncertain>& temperature_k) {
  if (!temperature_k) return "not stated";
  constexpr double celsius_zero_k = 273.15;
  return with_std(Uncertain{temperature_k->value - celsius_zero_k, temperature_k->std}, "°C");
}

Table object_table(const CertificateData& data) {
  return {"",
          {},
          {{"Object", "Accelerometer " + stated(data.name)},
           {"Serial number", stated(data.serial)},
           {"Date of measurement", stated(data.date)},
           {"Method", stated(data.method)},
           {"Recordings", stated(all_file_names(data.files))}}};
}

Table conditions_table(const CertificateData& data) {
  return {
      "Conditions, ± one standard uncertainty",
      {"Local gravity", "Temperature", "Supply", "Positions at rest"},
      {{with_std(data.gravity_mps2, "m/s²", "not stated"), temperature_words(data.temperature_k),
        with_std(data.supply_v, "V", "not stated"), std::to_string(data.positions)}}};
}

std::vector<std::string> result_row(const UncertaintyBudget& budget) {
  const auto& [quantity, unit, value] = budget.measurand;
  const PrintedUnit in = printed(unit);
  const double U = in.factor * budget.expanded_95;
  const int decimals = decimals_of(U);
  return {quantity,
          fixed(in.factor * value, decimals),
          U > 0.0 ? fixed(U, decimals) : "0",
          unit == "1" ? "" : print_unit(in.printed),
          fixed(budget.coverage_factor_95, 2),
          dof_words(budget.effective_dof)};
}

Table results_table(const CertificateData& data) {
  Table table{"", {"Quantity", "Value", "U (95 %)", "Unit", "k", "ν eff"}, {}};
  for (const UncertaintyBudget& budget : data.budgets) table.rows.push_back(result_row(budget));
  return table;
}

// For a relative contribution u(x) is printed in per cent.
PrintedUnit printed_input(const std::string& si) {
  return si == "1" ? PrintedUnit{"1", "%", 100.0} : printed(si);
}

std::vector<std::string> line_row(const BudgetLine& line, double share, const PrintedUnit& result) {
  const bool relative = line.unit == "1" && result.si != "1";
  const PrintedUnit input = relative ? printed_input(line.unit) : printed(line.unit);
  std::string sensitivity = significant(line.sensitivity * result.factor / input.factor, 3);
  if (line.unit != result.si)
    sensitivity += fmt::format(" {} per {}", print_unit(result.printed), print_unit(input.printed));
  return {line.source,
          line.type_a ? "A" : "B",
          std::string(name_of(line.distribution)),
          with_printed_unit(significant(input.factor * line.std, 2), input.printed),
          dof_words(line.dof),
          std::move(sensitivity),
          significant(result.factor * std::abs(line.contribution()), 2),
          fixed(100.0 * share, 1)};
}

Table budget_table(const UncertaintyBudget& budget) {
  const PrintedUnit unit = printed(budget.measurand.unit);
  const std::string symbol = unit.si == "1" ? "" : ", " + print_unit(unit.printed);
  const auto figure = [&](double value) {
    return with_printed_unit(significant(unit.factor * value, 2), unit.printed);
  };
  Table table{fmt::format("{}: u_c = {}, ν eff = {}, k = {}, U = {}", budget.measurand.quantity,
                          figure(budget.combined_std), dof_words(budget.effective_dof),
                          fixed(budget.coverage_factor_95, 2), figure(budget.expanded_95)),
              {"Source", "Type", "Distribution", "u(x)", "ν", "Sensitivity c", "|c| u(x)" + symbol,
               "Share, %"},
              {}};
  for (std::size_t k = 0; k < budget.lines.size(); ++k)
    table.rows.push_back(line_row(budget.lines[k], budget.shares[k], unit));
  return table;
}

Section head_section(const CertificateData& data) {
  return {.heading = "Calibration certificate",
          .tables = {object_table(data), conditions_table(data)},
          .new_sheet = true};
}

// Source: JCGM 100:2008, 7.2.4.
Section results_section(const CertificateData& data) {
  Section section{.heading = "Results"};
  section.tables = {results_table(data)};
  section.paragraphs = {
      "Each result is value ± U, where U = k u_c is an expanded uncertainty, determined from the "
      "combined standard uncertainty u_c of its budget and the coverage factor k, based on the "
      "t-distribution for ν eff degrees of freedom, and defines an interval estimated to have a "
      "level of confidence of 95 percent. Evaluated after JCGM 100:2008 (GUM)."};
  section.points = data.not_determined;
  return section;
}

Section limits_section(const CertificateData& data) {
  Section section{.heading = "What this certificate does not cover"};
  section.points = {
      "Other temperatures and supplies than those stated; drift and ageing since the day of "
      "measurement, beyond a line of the budget on stability between sessions.",
      "The angle between the sensor's axes and its case, which gravity alone does not determine.",
      "Forces beyond ± 1 g, vibration, and the response to frequency: the sensor was at rest.",
      "Traceability of local gravity, of the reference of the outputs and of the type B "
      "contributions, for which the signatory is responsible."};
  section.points.insert(section.points.end(), data.limits.begin(), data.limits.end());
  section.signatures = {"Certificate number", "Laboratory", "Place and date", "Measured by",
                        "Approved by"};
  return section;
}

Section budgets_section(const CertificateData& data) {
  Section section{.heading = "Uncertainty budgets"};
  section.paragraphs = {
      "u(x) is the standard uncertainty of each source, c the sensitivity coefficient, ν the "
      "degrees of freedom. Type A is evaluated by statistics, type B by other means."};
  if (!data.equations.empty()) section.paragraphs.emplace_back("Model: " + lines(data.equations));
  if (!data.monte_carlo.empty())
    section.paragraphs.push_back("Check by Monte Carlo, after JCGM 101:2008: " + data.monte_carlo);
  for (const UncertaintyBudget& budget : data.budgets)
    section.tables.push_back(budget_table(budget));
  return section;
}

}  // namespace

std::vector<Section> certificate_sections(const CertificateData& data) {
  std::vector<Section> sections{head_section(data), results_section(data), limits_section(data)};
  if (!data.budgets.empty()) sections.push_back(budgets_section(data));
  return sections;
}

}  // namespace proofmass::report
