#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <fmt/format.h>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "proofmass/core/chi_square.hpp"
#include "proofmass/report/wording.hpp"
#include "proofmass/thesis/bias/tumble_parts.hpp"

namespace proofmass::thesis {
namespace {

using calibrate::TumblePosition;
using calibrate::TumbleQuantity;
using report::fixed;

double table_deg(const TumblePosition& position) {
  return (position.angle_rad + position.mount_rad) / rad_per_deg;
}

// What an ideal sensor reads there.
double ideal_mps2(const TumbledAxis& axis, const TumblePosition& position, double gravity_mps2) {
  return gravity_mps2 * std::sin(axis.phi_rad(position));
}

// E = K1 [K0 cos² φ + K0' sin² φ + g sin φ + δo g cos φ], with K0 where the axis is level and K0'
// where it points up and down.
double fitted_mps2(const TumbledAxis& axis, double phi_rad, double gravity_mps2) {
  const double s = std::sin(phi_rad), c = std::cos(phi_rad);
  const bool level = axis.fit.find(TumbleQuantity::K0)->value.has_value();
  const double up_down = axis.value_of(TumbleQuantity::K0_up_down);
  const double bias = level ? axis.value_of(TumbleQuantity::K0) : up_down;
  return axis.value_of(TumbleQuantity::K1) *
         (bias * c * c + up_down * s * s + gravity_mps2 * s +
          axis.value_of(TumbleQuantity::misalignment) * gravity_mps2 * c);
}

report::Table output_table(const TumbledAxis& axis, double gravity_mps2) {
  report::Table table{
      .caption = fmt::format("Output of {} at each position", axis.name),
      .head = {"Angle (°)", fmt::format("Output ({})", report::print_unit(axis.unit))},
      .rows = {}};
  if (axis.ideal) {
    table.head.push_back(fmt::format("Ideal ({})", report::print_unit(axis.unit)));
    table.head.push_back("Deviation (mg)");
  }
  for (const TumblePosition& p : axis.positions) {
    std::vector<std::string> row{
        fixed(table_deg(p), 0),
        report::with_std(Uncertain{axis.output(p.output), axis.output_size(p.output_std)})};
    if (axis.ideal) {
      const double ideal = ideal_mps2(axis, p, gravity_mps2);
      row.push_back(fixed(axis.output(ideal), 5));
      row.push_back(
          report::with_std(Uncertain{(p.output - ideal) / mg_mps2, p.output_std / mg_mps2}));
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

report::Figure output_figure(const TumbledAxis& axis,
                             const PrintedAxis& printed,
                             double gravity_mps2) {
  report::Figure figure{
      .title = fmt::format("Output of {} over a turn", axis.name),
      .description =
          "Ideal curve and measured means. In this figure a bias of 20 mg is as thick as the "
          "line; the two readings that the thesis works with lie far off.",
      .x = {.label = "Angle (°)", .min = -5.0, .max = 365.0},
      .y = {.label = fmt::format("Output ({})", report::print_unit(axis.unit))}};
  report::Curve ideal{.label = "Ideal", .x = {}, .y = {}, .ink = report::Ink::grey};
  for (int deg = 0; deg <= 360; deg += 5) {
    ideal.x.push_back(deg);
    ideal.y.push_back(
        axis.output(ideal_mps2(axis, {.angle_rad = deg * rad_per_deg}, gravity_mps2)));
  }
  report::Curve measured{.label = "Measured",
                         .x = {},
                         .y = {},
                         .ink = report::Ink::blue,
                         .mark = report::Mark::points};
  for (const TumblePosition& p : axis.positions) {
    measured.x.push_back(table_deg(p));
    measured.y.push_back(axis.output(p.output));
  }
  figure.curves = {std::move(ideal),
                   std::move(measured),
                   {.label = "Readings that the thesis works with",
                    .x = {0.0, 180.0},
                    .y = {axis.output(printed.at_0_mps2), axis.output(printed.at_180_mps2)},
                    .ink = report::Ink::red,
                    .mark = report::Mark::points}};
  return figure;
}

report::Figure deviation_figure(const TumbledAxis& axis,
                                const PrintedAxis& printed,
                                double gravity_mps2) {
  constexpr double gap = std::numeric_limits<double>::quiet_NaN();
  report::Figure figure{
      .title = fmt::format("Deviation of {} from the ideal curve", axis.name),
      .description =
          "What is left of the output less that of an ideal sensor: the bias, and the error of "
          "the scale factor where gravity acts along the axis. Bars: 95 %.",
      .x = {.label = "Angle (°)", .min = -5.0, .max = 365.0},
      .y = {.label = "Deviation (mg)"}};
  report::Curve fitted{.label = "Fitted", .x = {}, .y = {}, .ink = report::Ink::orange};
  for (int deg = 0; deg <= 360; deg += 5) {
    const TumblePosition at{.angle_rad = deg * rad_per_deg};
    fitted.x.push_back(deg);
    fitted.y.push_back(
        (fitted_mps2(axis, axis.phi_rad(at), gravity_mps2) - ideal_mps2(axis, at, gravity_mps2)) /
        mg_mps2);
  }
  const double quantile = axis.noise_dof > 0.0 ? student_t_quantile(0.975, axis.noise_dof) : 1.96;
  report::Curve bars{.label = "", .x = {}, .y = {}, .ink = report::Ink::blue};
  report::Curve means{.label = "Measured",
                      .x = {},
                      .y = {},
                      .ink = report::Ink::blue,
                      .mark = report::Mark::points};
  for (const TumblePosition& p : axis.positions) {
    const double off = (p.output - ideal_mps2(axis, p, gravity_mps2)) / mg_mps2;
    const double half = quantile * p.output_std / mg_mps2, deg = table_deg(p);
    means.x.push_back(deg);
    means.y.push_back(off);
    bars.x.insert(bars.x.end(), {deg, deg, gap});
    bars.y.insert(bars.y.end(), {off - half, off + half, gap});
  }
  figure.curves = {std::move(fitted), std::move(bars), std::move(means)};
  figure.levels = {{.label = fmt::format("table 5.1: {} mg", fixed(printed.bias_mps2 / mg_mps2, 2)),
                    .y = printed.bias_mps2 / mg_mps2}};
  return figure;
}

std::vector<Finding> output_findings(const TumbledAxis& axis, const PrintedAxis& printed) {
  std::vector<Finding> findings;
  const std::array<std::pair<int, double>, 2> readings{
      {{0, printed.at_0_mps2}, {180, printed.at_180_mps2}}};
  for (const auto& [deg, value] : readings) {
    Finding finding{.key = fmt::format("reading_{}", deg),
                    .label = fmt::format("Reading at {}°", deg),
                    .si_unit = "m/s^2",
                    .shown = {.symbol = "g", .to_si = standard_gravity_mps2},
                    .thesis = value};
    if (axis.ideal) finding.ours = axis.mean_at(deg * rad_per_deg);
    if (!axis.ideal)
      finding.reason = "The outputs are in a unit of which no nominal scale is known.";
    else if (!finding.ours)
      finding.reason = fmt::format("No position stands at {}°.", deg);
    findings.push_back(std::move(finding));
  }
  const std::size_t shown = std::min<std::size_t>(axis.positions.size(), 8);
  for (std::size_t k = 0; k < shown; ++k) {
    const TumblePosition& p = axis.positions[k];
    findings.push_back({.key = fmt::format("output_{}", k + 1),
                        .label = fmt::format("Output at {}°", fixed(table_deg(p), 0)),
                        .si_unit = axis.unit,
                        .shown = {.symbol = report::print_unit(axis.unit)},
                        .ours = Uncertain{axis.output(p.output), axis.output_size(p.output_std)}});
  }
  return findings;
}

std::string found_words(const TumbledAxis& axis, double gravity_mps2) {
  const auto [low, high] = std::ranges::minmax(axis.positions, {}, &TumblePosition::output);
  std::string words =
      fmt::format("{} moves between {} and {} {}.", axis.name, fixed(axis.output(low.output), 4),
                  fixed(axis.output(high.output), 4), report::print_unit(axis.unit));
  if (!axis.ideal) return words;
  double least = std::numeric_limits<double>::infinity(), most = -least;
  for (const TumblePosition& p : axis.positions) {
    const double off = (p.output - ideal_mps2(axis, p, gravity_mps2)) / mg_mps2;
    least = std::min(least, off);
    most = std::max(most, off);
  }
  return words + fmt::format(" It deviates from the ideal curve by {} to {} mg, {} to {} m{}.",
                             fixed(least, 2), fixed(most, 2),
                             fixed(1e3 * axis.output_size(least * mg_mps2), 2),
                             fixed(1e3 * axis.output_size(most * mg_mps2), 2),
                             report::print_unit(axis.unit));
}

}  // namespace

Item output_item(const std::string& id,
                 const PrintedAxis& printed,
                 const TumbledAxes& axes,
                 const TumbleRecord& record,
                 double gravity_mps2) {
  Item item{
      .id = id,
      .title = fmt::format("Ideal and measured output of {} at 3.3 V", printed.name),
      .thesis = fmt::format(
          "The output of {} at 0, 90, 180, 270 and 360° beside the ideal curve. The text works "
          "with {} g at 0° and {} g at 180°.",
          printed.name, report::compact(printed.at_0_mps2 / standard_gravity_mps2, 5),
          report::compact(printed.at_180_mps2 / standard_gravity_mps2, 5)),
      .ours = {},
      .note =
          "Nothing of 20 mg is seen in a curve of ±1 g: draw the deviation from it. The two "
          "readings that the thesis works with do not lie on any such curve: its table's bias "
          "and scale "
          "factor do not come from them (see table 5.1)."};
  const std::optional<TumbledAxis>& axis = axes.*printed.place;
  if (!axis) {
    item.ours = absent_words(printed, axes);
    return item;
  }
  item.ours = found_words(*axis, gravity_mps2);
  if (record.simulated)
    item.ours +=
        " The sensor is simulated: bias and scale factor of table 5.1, the ADXL335's noise, a "
        "converter of 14 bits, 60 s at each position, and nothing else.";
  item.findings = output_findings(*axis, printed);
  item.tables = {output_table(*axis, gravity_mps2)};
  if (axis->ideal)
    item.figures = {output_figure(*axis, printed, gravity_mps2),
                    deviation_figure(*axis, printed, gravity_mps2)};
  return item;
}

}  // namespace proofmass::thesis
