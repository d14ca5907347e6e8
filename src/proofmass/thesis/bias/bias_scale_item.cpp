#include <array>
#include <cmath>
#include <fmt/format.h>
#include <string>
#include <utility>

#include "proofmass/report/wording.hpp"
#include "proofmass/sensor/datasheet.hpp"
#include "proofmass/thesis/bias/bias_scale_limits.hpp"
#include "proofmass/thesis/bias/tumble_parts.hpp"

namespace proofmass::thesis {
namespace {

using calibrate::TumbleCoefficient;
using calibrate::TumbleQuantity;
using report::fixed;

const ShownUnit mg{"mg", mg_mps2}, percent{"%", 0.01}, degrees{"°", rad_per_deg};

// How a coefficient is shown, and what it is the deviation from.
struct Shown {
  ShownUnit unit;
  double less = 0.0;
};

Shown shown(TumbleQuantity quantity) {
  constexpr double g = standard_gravity_mps2;
  switch (quantity) {
    case TumbleQuantity::K1:
      return {.unit = percent, .less = 1.0};
    case TumbleQuantity::misalignment:
    case TumbleQuantity::misalignment_p:
      return {.unit = {"mrad", 1e-3}};
    case TumbleQuantity::K2_minus_Kpp:
    case TumbleQuantity::K2_minus_Koo:
      return {.unit = {"µg/g²", 1e-6 / g}};
    case TumbleQuantity::K0:
    case TumbleQuantity::K0_up_down:
    case TumbleQuantity::K0_second:
      return {.unit = mg};
    default:
      return {.unit = {}};
  }
}

// The thesis's table has the bias from the outputs at 0° and 180°, where x is level and y is not.
TumbleQuantity bias_quantity(const TumbledAxis& axis) {
  const bool level_at_0 = std::abs(std::sin(axis.phi_rad({}))) < 0.5;
  return level_at_0 ? TumbleQuantity::K0 : TumbleQuantity::K0_up_down;
}

// A coefficient as a finding, or the reason for its absence.
void put(const TumbledAxis& axis, TumbleQuantity quantity, Finding& finding) {
  const TumbleCoefficient* found = axis.fit.find(quantity);
  const Shown as = shown(quantity);
  if (!axis.ideal)
    finding.reason = "The outputs are in a unit of which no nominal zero and scale are known.";
  else if (found == nullptr || !found->value)
    finding.reason = found == nullptr ? "The positions do not determine it." : found->reason;
  else if (!found->std)
    finding.reason = fmt::format("{} {}, but without a standard deviation: {}",
                                 report::significant((*found->value - as.less) / as.unit.to_si, 4),
                                 as.unit.symbol, found->reason);
  else
    finding.ours = Uncertain{*found->value - as.less, *found->std};
}

void add_axis(const TumbledAxes& axes, const PrintedAxis& printed, std::vector<Finding>& all) {
  const std::optional<TumbledAxis>& axis = axes.*printed.place;
  Finding bias{.key = "bias_" + printed.name,
               .label = fmt::format("Bias of {}, from 0° and 180°", printed.name),
               .si_unit = "m/s^2",
               .shown = mg,
               .thesis = printed.bias_mps2};
  Finding scale{.key = "scale_error_" + printed.name,
                .label = fmt::format("Scale-factor error of {}", printed.name),
                .si_unit = "",
                .shown = percent,
                .thesis = printed.scale_error};
  Finding other{.key = "bias_other_" + printed.name,
                .label = fmt::format("Bias of {}, from 90° and 270°", printed.name),
                .si_unit = "m/s^2",
                .shown = mg};
  if (axis) {
    const TumbleQuantity here = bias_quantity(*axis);
    put(*axis, here, bias);
    put(*axis, TumbleQuantity::K1, scale);
    put(*axis, here == TumbleQuantity::K0 ? TumbleQuantity::K0_up_down : TumbleQuantity::K0, other);
  } else {
    bias.reason = scale.reason = other.reason = absent_words(printed, axes);
  }
  for (Finding* finding : {&bias, &scale, &other}) all.push_back(std::move(*finding));
}

// Results from the thesis's own measurements: half their sum and half their difference.
void add_worked(std::vector<Finding>& all) {
  const PrintedAxis &x = printed_x(), &y = printed_y();
  const auto half_sum = [](const PrintedAxis& a) { return 0.5 * (a.at_0_mps2 + a.at_180_mps2); };
  const auto half_difference_g = [](const PrintedAxis& a) {
    return 0.5 * (a.at_0_mps2 - a.at_180_mps2) / standard_gravity_mps2;
  };
  all.push_back({.key = "worked_bias_x",
                 .label = "Half the sum of the worked readings of x",
                 .si_unit = "m/s^2",
                 .shown = mg,
                 .thesis = x.worked_mps2,
                 .ours = Uncertain{half_sum(x)}});
  all.push_back({.key = "worked_bias_y",
                 .label = "Half the sum of the worked readings of y",
                 .si_unit = "m/s^2",
                 .shown = mg,
                 .thesis = y.worked_mps2,
                 .ours = Uncertain{half_sum(y)}});
  all.push_back({.key = "worked_scale_error_y",
                 .label = "Scale-factor error by half the difference of the same readings of y",
                 .si_unit = "",
                 .shown = percent,
                 .thesis = y.scale_error,
                 .ours = Uncertain{half_difference_g(y) - 1.0}});
  all.push_back({.key = "worked_misalignment_x",
                 .label = "Misalignment by half the difference of the readings of x",
                 .si_unit = "rad",
                 .shown = degrees,
                 .ours = Uncertain{half_difference_g(x)}});
  all.push_back({.key = "bias_second_sensor",
                 .label = "Bias of sensor A2",
                 .si_unit = "m/s^2",
                 .shown = mg,
                 .thesis = 19.56 * mg_mps2,
                 .reason = "No reading of A2 is printed."});
}

void add_coefficients(const TumbledAxis& axis, report::Table& table) {
  for (const TumbleCoefficient& c : axis.fit.coefficients) {
    const Shown as = shown(c.quantity);
    if (!c.value || as.unit.symbol.empty()) continue;
    const double value = (*c.value - as.less) / as.unit.to_si;
    table.rows.push_back(
        {axis.name,
         c.quantity == TumbleQuantity::K1 ? "error of K1" : std::string(name_of(c.quantity)),
         c.std ? report::with_std(Uncertain{value, *c.std / as.unit.to_si}, as.unit.symbol)
               : report::significant(value, 4) + " " + as.unit.symbol,
         c.half_width_95 ? report::significant(*c.half_width_95 / as.unit.to_si, 2) : "not known",
         c.meaning});
  }
}

report::Table coefficient_table(const TumbledAxes& axes) {
  report::Table table{.caption = "What the positions determine, and what it is exactly",
                      .head = {"Axis", "Quantity", "Found", "95 %: ±", "It is"},
                      .rows = {}};
  for (const PrintedAxis* printed : {&printed_x(), &printed_y()})
    if (const auto& axis = axes.*printed->place; axis && axis->ideal)
      add_coefficients(*axis, table);
  return table;
}

std::string half_width_words(const TumbledAxis& axis, TumbleQuantity quantity) {
  const TumbleCoefficient* found = axis.fit.find(quantity);
  if (found == nullptr || !found->value) return "not determined";
  const Shown as = shown(quantity);
  const double value = (*found->value - as.less) / as.unit.to_si;
  if (!found->half_width_95)
    return report::significant(value, 4) + " " + as.unit.symbol + " without an uncertainty";
  return report::with_std(Uncertain{value, *found->half_width_95 / as.unit.to_si}, as.unit.symbol);
}

std::string found_words(const TumbledAxes& axes, const TumbleRecord& record, double gravity_mps2) {
  std::string words =
      record.simulated
          ? "From a simulated sensor with the table's figures, five positions of "
            "60 s give back (with 95 % intervals) "
          : fmt::format("{} positions give (with 95 % intervals) ", record.positions.size());
  std::string axes_words;
  for (const PrintedAxis* printed : {&printed_x(), &printed_y()}) {
    const auto& axis = axes.*printed->place;
    if (!axis || !axis->ideal) continue;
    axes_words += fmt::format("{}for {} a bias of {} and a scale-factor error of {}",
                              axes_words.empty() ? "" : ", ", axis->name,
                              half_width_words(*axis, bias_quantity(*axis)),
                              half_width_words(*axis, TumbleQuantity::K1));
  }
  words = axes_words.empty() ? "No channel gives a bias." : words + axes_words + ".";
  if (!record.simulated)
    words += fmt::format(
        " In them is the gravity, {}; errors of the table's angles are not.",
        report::with_std(Uncertain{gravity_mps2, gravity_std_mps2(record, gravity_mps2)}, "m/s²"));
  return words +
         " The readings that the text works with give −197.9 mg for x, and −223.8 mg with a "
         "scale-factor error of −19.1 % for y.";
}

std::string note_words() {
  return fmt::format(
      "The worked figures are ten times too small, one with the wrong sign, and none of them "
      "gives the table; a scale factor of 0.81 shows that y did not point up at 0°, or was not "
      "read in g. Four positions determine four sums: K1 (1 + K3 g²), the bias where the axis is "
      "level, K0 + Kpp g², that where it points up and down, K0 + K2 g², and a misalignment, "
      "which is of sensor and wheel together. At 0° and 180° x is level and y is not: (5.1) "
      "gives two different biases. (5.2) taken with the same angles for y gives its "
      "misalignment; its scale factor is (E0 − E180)/(2g). A scale-factor error of 0.0041 % "
      "stands out of the noise of 150 µg/√Hz after {} s at each position, but standard gravity "
      "in place of that of Halifax alone is {} %, 1 mV of the supply 0.03 %: without gravity and "
      "supply measured it is meaningless. Nor is a bias constant: it drifts and warms up, which "
      "means over several days hide. Give each figure its interval, repeat the first position, "
      "and turn through more than four.",
      fixed(white_dwell_s(printed_x().scale_error), 0),
      fixed(100.0 * standard_gravity_scale_error(), 4));
}

}  // namespace

Item bias_scale_item(const TumbledAxes& axes, const TumbleRecord& record, double gravity_mps2) {
  Item item{.id = "table 5.1",
            .title = "Bias and scale-factor error of x and y",
            .thesis =
                "x: 19.68 mg and 0.0041 %, y: 22.29 mg and 0.0869 %, without uncertainty. The "
                "text works out −19.78 mg from −0.17517 and −0.22057, 22.38 mg from 0.58541 and "
                "−1.0330, and names 19.56 mg for sensor A2.",
            .ours = found_words(axes, record, gravity_mps2),
            .note = note_words(),
            .tables = {coefficient_table(axes), limits_table(gravity_mps2)}};
  for (const PrintedAxis* printed : {&printed_x(), &printed_y()})
    add_axis(axes, *printed, item.findings);
  add_worked(item.findings);
  for (Finding& finding : limit_findings()) item.findings.push_back(std::move(finding));
  return item;
}

}  // namespace proofmass::thesis
