#include <fmt/format.h>

#include "proofmass/report/json.hpp"
#include "proofmass/report/rotation_report.hpp"

namespace proofmass::report {
namespace {

using calibrate::RotationAxis;
using calibrate::RotationCoefficient;
using calibrate::RotationFit;
using Q = calibrate::RotationQuantity;

// K0, K1 … by name, as `tumble` has them.
void add_by_name(const RotationReport& report, const RotationAxis& axis, Object& into) {
  for (const RotationCoefficient& one : axis.coefficients) {
    into.push_back({std::string(name_of(one.quantity)),
                    quantity(one.value, rotation_unit(one.quantity, report.unit))});
  }
}

Value axis(const RotationReport& report, std::size_t at) {
  const RotationAxis& axis = report.fit.axes[at];
  Object body{{"name", report.axis_names[at]}};
  add_by_name(report, axis, body);
  Object intervals;
  for (const RotationCoefficient& one : axis.coefficients) {
    if (!one.value) continue;
    const double middle = one.value->value, half = one.half_width_95;
    intervals.push_back({std::string(name_of(one.quantity)), Array{middle - half, middle + half}});
  }
  body.push_back({"interval_95", std::move(intervals)});
  body.push_back({"delay_s", quantity(axis.delay_s, "s")});
  body.push_back({"residual_rms", axis.residual_rms});
  body.push_back({"fold", Object{{"angle_rad", array_of(axis.fold.angle_rad)},
                                 {"mean", array_of(axis.fold.mean)},
                                 {"residual", array_of(axis.fold.residual)}}});
  return body;
}

Array sections(const RotationFit& fit) {
  Array items;
  for (const calibrate::RotationSection& one : fit.sections) {
    items.push_back(Object{{"recording", one.recording},
                           {"start_s", one.start_s},
                           {"end_s", one.end_s},
                           {"turns", one.turns},
                           {"speed_radps", one.speed_radps}});
  }
  return items;
}

Array ripples(const RotationFit& fit) {
  Array items;
  for (const calibrate::SpeedRipple& one : fit.ripples) {
    items.push_back(Object{{"per_turn", one.per_turn},
                           {"amplitude", quantity(one.amplitude, "1")},
                           {"chance_p", one.chance_p},
                           {"accepted", one.accepted}});
  }
  return items;
}

Value per_percent(const calibrate::RippleEffect& effect) {
  return Object{{"once_a_turn", Object{{"bias_mps2", effect.bias_mps2},
                                       {"second_order_s2pm", effect.second_order_s2pm}}},
                {"twice_a_turn", Object{{"scale_relative", effect.scale_relative},
                                        {"misalignment_rad", effect.misalignment_rad},
                                        {"third_order_s4pm2", effect.third_order_s4pm2}}}};
}

// Every null has its reason here.
std::vector<std::string> warnings(const RotationReport& report) {
  std::vector<std::string> all = texts(report.notes, Severity::warning);
  const RotationFit& fit = report.fit;
  for (std::size_t at = 0; at < fit.axes.size(); ++at) {
    for (const RotationCoefficient& one : fit.axes[at].coefficients) {
      if (one.value) continue;
      all.push_back(fmt::format("{}: {}: null: {}", report.axis_names[at], name_of(one.quantity),
                                one.reason));
    }
  }
  for (std::size_t at = 0; at < fit.axes.size(); ++at) {
    if (fit.axes[at].delay_s) continue;
    all.push_back(fmt::format("{}: delay_s: null: {}", report.axis_names[at],
                              fit.angle_given ? "one speed does not distinguish it from a "
                                                "misalignment, and no bandwidth is stated"
                                              : "without an encoder there is no angle that the "
                                                "readings could be late to"));
  }
  if (!fit.radius.value) all.push_back("radius_m: null: " + fit.radius.reason);
  if (!fit.direction) all.push_back("direction: null: one axis alone does not show it");
  for (const calibrate::SpeedRipple& one : fit.ripples) {
    if (!one.amplitude) {
      all.push_back(
          fmt::format("ripples: amplitude at {} per turn: null: the harmonics may be chance or the "
                      "sensor's",
                      one.per_turn));
    }
  }
  return all;
}

}  // namespace

std::string rotation_json(const RotationReport& report) {
  const RotationFit& fit = report.fit;
  Object body{{"mode", "rotating"}};
  add_by_name(report, fit.axes.front(), body);
  for (Member& member : body) {  // the radius is that of both axes together
    if (member.key == name_of(Q::radius)) member.value = quantity(fit.radius.value, "m");
  }
  Array axes;
  for (std::size_t at = 0; at < fit.axes.size(); ++at) axes.push_back(axis(report, at));
  const Object rest{{"unit", report.unit},
                    {"gravity_mps2", report.gravity_mps2},
                    {"angle_given", fit.angle_given},
                    {"direction", fit.direction ? Value(*fit.direction) : Value(nullptr)},
                    {"axes", std::move(axes)},
                    {"sections", sections(fit)},
                    {"turns", fit.turns},
                    {"samples", fit.samples},
                    {"steady_fraction", fit.steady_fraction},
                    {"blocks", fit.blocks},
                    {"dof", fit.dof},
                    {"iterations", fit.iterations},
                    {"converged", fit.converged},
                    {"ripples", ripples(fit)},
                    {"per_percent_of_ripple", per_percent(fit.per_percent)},
                    {"notes", array_of(texts(report.notes, Severity::info))}};
  body.insert(body.end(), rest.begin(), rest.end());
  return to_json({"tumble", report.inputs, warnings(report)}, body);
}

}  // namespace proofmass::report
