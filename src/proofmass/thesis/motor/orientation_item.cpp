#include <array>
#include <cmath>
#include <fmt/format.h>
#include <string>
#include <utility>

#include "proofmass/core/units.hpp"
#include "proofmass/report/wording.hpp"
#include "proofmass/sensor/datasheet.hpp"
#include "proofmass/thesis/bias/tumble_parts.hpp"

namespace proofmass::thesis {
namespace {

using report::fixed;
using sensor::adxl335;
using sensor::Limits;

constexpr double supply_v = 3.3, supply_part = supply_v / adxl335.reference_supply_v;

// What the maker's figures at 3 V come to at 3.3 V: zero and sensitivity go with the supply.
Limits at_supply(const Limits& limits, double per) {
  const double factor = supply_part * per;
  return {.min = factor * *limits.min, .typ = factor * *limits.typ, .max = factor * *limits.max};
}

Limits output_v(std::size_t axis, double force_g) {
  const Limits zero = at_supply(adxl335.zero_g_v[axis], 1.0),
               sense = at_supply(adxl335.sensitivity_v_per_mps2, standard_gravity_mps2);
  const double low = force_g < 0.0 ? *sense.max : *sense.min;
  const double high = force_g < 0.0 ? *sense.min : *sense.max;
  return {.min = *zero.min + low * force_g,
          .typ = *zero.typ + *sense.typ * force_g,
          .max = *zero.max + high * force_g};
}

report::Table orientation_table() {
  report::Table table{
      .caption = "Output at 3.3 V in the six orientations, in V, with the maker's limits",
      .head = {"Up", "x", "y", "z"},
      .rows = {}};
  constexpr std::array<const char*, 3> names{"x", "y", "z"};
  for (std::size_t up = 0; up < 3; ++up)
    for (const double sign : {1.0, -1.0}) {
      std::vector<std::string> row{fmt::format("{}{}", sign < 0.0 ? "−" : "", names[up])};
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const Limits v = output_v(axis, axis == up ? sign : 0.0);
        row.push_back(
            fmt::format("{} ({} to {})", fixed(*v.typ, 2), fixed(*v.min, 3), fixed(*v.max, 3)));
      }
      table.rows.push_back(std::move(row));
    }
  return table;
}

struct OutputCurve {
  report::Curve curve;
  report::Band band;
};

// Over a turn in the plane of x and y: x is level at 0°, y points up there.
OutputCurve output_curve(std::size_t axis, double phase_rad, report::Ink ink) {
  const std::string name(1, "xyz"[axis]);
  OutputCurve out{.curve = {.label = name, .x = {}, .y = {}, .ink = ink},
                  .band = {.label = name + ", within the maker's limits",
                           .x = {},
                           .lower = {},
                           .upper = {},
                           .ink = ink}};
  for (int deg = 0; deg <= 360; deg += 5) {
    const Limits v = output_v(axis, axis == 2 ? 0.0 : std::sin(deg * rad_per_deg + phase_rad));
    out.curve.x.push_back(deg);
    out.curve.y.push_back(*v.typ);
    out.band.x.push_back(deg);
    out.band.lower.push_back(*v.min);
    out.band.upper.push_back(*v.max);
  }
  return out;
}

report::Figure orientation_figure() {
  const OutputCurve x = output_curve(0, 0.0, report::Ink::blue),
                    y = output_curve(1, 90.0 * rad_per_deg, report::Ink::orange),
                    z = output_curve(2, 0.0, report::Ink::grey);
  return {.title = "Output against orientation, 3.3 V",
          .description =
              "Outputs of the three axes over a turn about z, which stays level. The bands are "
              "what the maker allows from one sensor to the next.",
          .x = {.label = "Angle (°)", .min = 0.0, .max = 360.0},
          .y = {.label = "Output (V)"},
          .bands = {x.band, y.band},
          .curves = {x.curve, y.curve, z.curve},
          .callouts = {{.text = "y at +1 g: 1.98 V",
                        .x = 0.0,
                        .y = *output_v(1, 1.0).typ,
                        .ink = report::Ink::orange},
                       {.text = "y at −1 g: 1.32 V",
                        .x = 180.0,
                        .y = *output_v(1, -1.0).typ,
                        .ink = report::Ink::orange,
                        .below = true}}};
}

Finding volts(const char* key, const char* label, std::optional<double> printed, double ours) {
  return {.key = key,
          .label = label,
          .si_unit = "V",
          .shown = {"V"},
          .thesis = printed,
          .ours = Uncertain{.value = ours}};
}

}  // namespace

Item orientation_item() {
  const double per_g = supply_part * *adxl335.sensitivity_v_per_mps2.typ;
  const Limits zero = output_v(0, 0.0), up = output_v(0, 1.0), down = output_v(0, -1.0);
  return {
      .id = "figure 5.4",
      .title = "Output response against orientation",
      .thesis =
          "At 3.3 V the output is 1.65 V at 0 g and changes by 0.33 V for 1 g. At 0° x stands at "
          "0 g, 1.65 V, and y at −1 g, 1.65 + 0.33 = 1.98 V.",
      .ours = fmt::format("0 g gives {} V, +1 g {} V and −1 g {} V. That is the typical sensor; of "
                          "x and y the maker allows {} to {} V at 0 g and {} to {} V at +1 g.",
                          fixed(*zero.typ, 2), fixed(*up.typ, 2), fixed(*down.typ, 2),
                          fixed(*zero.min, 3), fixed(*zero.max, 3), fixed(*up.min, 3),
                          fixed(*up.max, 3)),
      .note =
          "1.98 V is +1 g. The thesis's own readings of y, 0.585 g at 0° and −1.033 g at 180°, "
          "have it pointing up at 0°, so the voltage is right and the sign is not. The figures "
          "of the datasheet hold at 3 V: zero and sensitivity go with the supply, the noise does "
          "not. From one sensor to the next the zero may differ by ±0.5 g, which is why each one "
          "is tumbled.",
      .findings = {volts("zero_g", "Output at 0 g", 1.65, *zero.typ),
                   {.key = "sensitivity",
                    .label = "Change for 1 g",
                    .si_unit = "V/(m/s^2)",
                    .shown = {.symbol = "V/g", .to_si = 1.0 / standard_gravity_mps2},
                    .thesis = 0.33 / standard_gravity_mps2,
                    .ours = Uncertain{.value = per_g}},
                   volts("minus_1_g", "Output at −1 g", 1.98, *down.typ),
                   volts("plus_1_g", "Output at +1 g", std::nullopt, *up.typ)},
      .tables = {orientation_table()},
      .figures = {orientation_figure()}};
}

}  // namespace proofmass::thesis
