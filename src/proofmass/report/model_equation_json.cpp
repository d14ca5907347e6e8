#include <fmt/format.h>

#include "proofmass/report/json.hpp"
#include "proofmass/report/model_equation_report.hpp"

namespace proofmass::report {
namespace {

using calibrate::Confounded;
using calibrate::FittedCoefficient;
using calibrate::ModelFit;

std::string unit_of(sensor::Coefficient coefficient, std::string_view of, const std::string& out) {
  std::string unit(of);
  const auto place = unit.find("{}");
  if (place != std::string::npos) unit.replace(place, 2, out.empty() ? "output" : out);
  return coefficient == sensor::Coefficient::K1 && out == "m/s^2" && unit == "m/s^2/(m/s^2)" ? "1"
                                                                                             : unit;
}

Value in_standard(const FittedCoefficient& one, const std::string& out) {
  if (!one.value) return nullptr;
  const auto convert = [&](double x) { return sensor::in_standard_unit(one.coefficient, x); };
  const sensor::CoefficientInfo& about = sensor::info(one.coefficient);
  return quantity(Uncertain{convert(one.value->value), convert(one.value->std)},
                  unit_of(one.coefficient, about.standard_unit, out));
}

Value si(const FittedCoefficient& one, const std::string& out) {
  return quantity(one.value, unit_of(one.coefficient, sensor::info(one.coefficient).unit, out));
}

Value interval(const FittedCoefficient& one) {
  if (!one.value) return nullptr;
  return Array{one.value->value - one.half_width_95, one.value->value + one.half_width_95};
}

Value coefficient(const FittedCoefficient& one, const std::string& out) {
  const sensor::CoefficientInfo& about = sensor::info(one.coefficient);
  return Object{{"name", about.name},
                {"meaning", about.description},
                {"value", si(one, out)},
                {"value_standard", in_standard(one, out)},
                {"interval_95", interval(one)},
                {"variance_inflation", one.value ? Value(one.variance_inflation) : Value(nullptr)},
                {"reason", one.reason}};
}

Value confounded(const Confounded& group, const std::string& out) {
  Array names, combinations;
  for (const sensor::Coefficient one : group.coefficients) {
    names.push_back(sensor::info(one).name);
  }
  for (const calibrate::Combination& one : group.combinations) {
    const sensor::Coefficient first = one.parts.front().first;
    combinations.push_back(
        Object{{"name", one.name},
               {"value", quantity(one.value, unit_of(first, sensor::info(first).unit, out))}});
  }
  return Object{{"coefficients", std::move(names)},
                {"determined", group.determined},
                {"relations", array_of(group.relations)},
                {"combinations", std::move(combinations)},
                {"words", group.words}};
}

Array matrix(const Eigen::MatrixXd& values) {
  Array rows;
  for (Eigen::Index r = 0; r < values.rows(); ++r) {
    Array row;
    for (Eigen::Index c = 0; c < values.cols(); ++c) row.push_back(values(r, c));
    rows.push_back(std::move(row));
  }
  return rows;
}

Value cross_axis(const ModelOutput& output) {
  if (!output.cross_axis) return nullptr;
  return Object{{"value", quantity(output.cross_axis->value, "1")},
                {"upper_95", output.cross_axis->upper_95},
                {"p", output.cross_axis->p}};
}

Value residual_test(const ModelFit& fit) {
  if (!fit.test) return nullptr;
  return Object{{"chi_square", fit.test->chi_square}, {"p", fit.test->p}};
}

// K0, K1 … by name, as `tumble` has them.
void add_by_name(const ModelOutput& output, Object& into) {
  for (const FittedCoefficient& one : output.fit.coefficients) {
    into.push_back({std::string(sensor::info(one.coefficient).name), si(one, output.unit)});
  }
}

Value output(const ModelOutput& output) {
  const ModelFit& fit = output.fit;
  Array coefficients, groups;
  for (const auto& one : fit.coefficients) coefficients.push_back(coefficient(one, output.unit));
  for (const Confounded& one : fit.confounded) groups.push_back(confounded(one, output.unit));
  return Object{{"name", output.name},
                {"unit", output.unit},
                {"rows", output.rows.size()},
                {"coefficients", std::move(coefficients)},
                {"covariance", matrix(fit.covariance)},
                {"confounded", std::move(groups)},
                {"cross_axis_sensitivity", cross_axis(output)},
                {"dof", fit.dof},
                {"residual_rms", fit.residual_rms},
                {"residual_test", residual_test(fit)},
                {"std_stated", fit.std_stated},
                {"scatter", fit.scatter},
                {"condition", fit.condition},
                {"residuals", array_of(fit.residuals)},
                {"notes", array_of(fit.notes)}};
}

// Every null has its reason here.
std::vector<std::string> warnings(const ModelEquationReport& report) {
  std::vector<std::string> all = texts(report.notes, Severity::warning);
  for (const ModelOutput& output : report.outputs) {
    const auto add = [&](const std::string& text) { all.push_back(output.name + ": " + text); };
    for (const std::string& note : output.fit.notes) add(note);
    for (const FittedCoefficient& one : output.fit.coefficients) {
      if (one.value) continue;
      add(fmt::format("{}: value, value_standard, interval_95 and variance_inflation are null: {}",
                      sensor::info(one.coefficient).name, one.reason));
    }
    if (!output.cross_axis) {
      add("cross_axis_sensitivity: null: it needs delta_o and delta_p, both determined");
    } else if (!output.cross_axis->value) {
      add("cross_axis_sensitivity.value: null: " + output.cross_axis->reason);
    }
    if (!output.fit.confounded.empty()) {
      add("condition: null: some coefficients cannot be told apart at all");
    }
    if (!output.fit.test) {
      add("residual_test: null: it needs stated standard deviations (a column NAME_std) and more "
          "rows than coefficients");
    }
  }
  return all;
}

}  // namespace

std::string model_equation_json(const ModelEquationReport& report) {
  Object body{{"mode", "coefficients"}};
  if (report.gravity_mps2) body.push_back({"gravity_mps2", *report.gravity_mps2});
  if (report.outputs.size() == 1) add_by_name(report.outputs.front(), body);
  Array outputs;
  for (const ModelOutput& one : report.outputs) outputs.push_back(output(one));
  body.push_back({"outputs", std::move(outputs)});
  body.push_back({"notes", array_of(texts(report.notes, Severity::info))});
  return to_json({"tumble", report.inputs, warnings(report)}, body);
}

}  // namespace proofmass::report
