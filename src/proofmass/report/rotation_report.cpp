#include "proofmass/report/rotation_report.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "proofmass/core/units.hpp"
#include "proofmass/report/json.hpp"
#include "proofmass/report/page.hpp"
#include "proofmass/report/wording.hpp"

namespace proofmass::report {
namespace {

using calibrate::RotationAxis;
using calibrate::RotationCoefficient;
using calibrate::RotationFit;
using Q = calibrate::RotationQuantity;

constexpr double g = standard_gravity_mps2;

std::string label(Q quantity) {
  switch (quantity) {
    case Q::K1:
      return "K1, scale factor";
    case Q::K0:
      return "K0 + Kpp g², bias";
    case Q::K0_radial:
      return "the same less r ω²";
    case Q::misalignment:
      return "misalignment";
    case Q::K2_minus_Kpp:
      return "K2 − Kpp";
    case Q::Kip:
      return "Kip";
    case Q::K3:
      return "K3";
    case Q::radius:
      return "radius along the axis";
  }
  return {};
}

// Biases in mg, angles in mrad, coefficients in the standard's g.
std::string figure(const RotationCoefficient& one, const std::string& unit) {
  const auto in = [&](double factor, const std::string& as) {
    return with_std(scaled(one.value, factor), as, absent);
  };
  switch (one.quantity) {
    case Q::K1: {
      const std::string as = rotation_unit(Q::K1, unit);
      return in(1.0, as == "1" ? "" : print_unit(as));
    }
    case Q::K0:
    case Q::K0_radial:
      return in(1e3 / g, "mg");
    case Q::misalignment:
      return in(1e3, "mrad");
    case Q::K2_minus_Kpp:
    case Q::Kip:
      return in(1e3 * g, "mg/g²");
    case Q::K3:
      return in(1e3 * g * g, "mg/g³");
    case Q::radius:
      return in(1e3, "mm");
  }
  return {};
}

std::vector<std::vector<std::string>> rows_of(const RotationReport& report) {
  std::vector<std::vector<std::string>> rows;
  for (std::size_t q = 0; q < calibrate::rotation_quantities; ++q) {
    std::vector<std::string> row{label(static_cast<Q>(q))};
    for (const RotationAxis& axis : report.fit.axes) {
      row.push_back(figure(axis.coefficients[q], report.unit));
    }
    rows.push_back(std::move(row));
  }
  std::vector<std::string> residual{"residual, rms"};
  for (const RotationAxis& axis : report.fit.axes) {
    residual.push_back(significant(axis.residual_rms, 3) + " " + print_unit(report.unit));
  }
  rows.push_back(std::move(residual));
  return rows;
}

std::vector<std::string> heading(const RotationReport& report) {
  std::vector<std::string> head{"Coefficient"};
  head.insert(head.end(), report.axis_names.begin(), report.axis_names.end());
  return head;
}

std::vector<std::string> reasons(const RotationReport& report) {
  std::vector<std::string> all;
  for (const RotationAxis& axis : report.fit.axes) {
    for (const RotationCoefficient& one : axis.coefficients) {
      if (!one.reason.empty() && std::ranges::find(all, one.reason) == all.end()) {
        all.push_back(one.reason);
      }
    }
  }
  return all;
}

std::string conclusion(const RotationReport& report) {
  const RotationFit& fit = report.fit;
  const std::size_t stretches = fit.sections.size();
  std::string text =
      fmt::format("{} steady turns in {} {}", grouped(static_cast<std::size_t>(fit.turns)),
                  grouped(stretches), stretches == 1 ? "stretch" : "stretches");
  text += fit.angle_given ? ", the angle by the encoder. " : ", the angle by gravity. ";
  text += fmt::format("{}: K1 = {}, ", report.axis_names.front(),
                      figure(fit.axes.front()[Q::K1], report.unit));
  const bool bias = fit.axes.front()[Q::K0].value.has_value();
  text += fmt::format("bias{} {}", bias ? "" : " less r ω²",
                      figure(fit.axes.front()[bias ? Q::K0 : Q::K0_radial], report.unit));
  if (fit.radius.value) {
    text +=
        fmt::format("; {} from the axle", with_std(scaled(fit.radius.value, 1e3), "mm", absent));
  }
  return text + ".";
}

std::vector<double> in_degrees(const std::vector<double>& angle_rad) {
  std::vector<double> angle(angle_rad);
  for (double& a : angle) a *= deg_per_rad;
  return angle;
}

Figure response_figure(const RotationReport& report) {
  Figure figure{.title = "Response against the angle",
                .description =
                    "Mean reading in 72 parts of the turn; zero is where the axis is "
                    "level and turning upwards.",
                .x = {.label = "Angle of the axis (°)", .min = 0.0, .max = 360.0},
                .y = {.label = "Reading (" + print_unit(report.unit) + ")"}};
  constexpr Ink inks[] = {Ink::blue, Ink::orange};
  for (std::size_t at = 0; at < report.fit.axes.size(); ++at) {
    const calibrate::RotationFold& fold = report.fit.axes[at].fold;
    figure.curves.push_back(
        {report.axis_names[at], in_degrees(fold.angle_rad), fold.mean, inks[at % 2], Mark::points});
  }
  return figure;
}

Figure residual_figure(const RotationReport& report, std::size_t at) {
  const calibrate::RotationFold& fold = report.fit.axes[at].fold;
  Band band{"95 % if noise were white", in_degrees(fold.angle_rad), {}, {}};
  for (std::size_t k = 0; k < fold.residual.size(); ++k) {
    band.lower.push_back(-1.959964 * fold.residual_std[k]);
    band.upper.push_back(1.959964 * fold.residual_std[k]);
  }
  return {
      .title = report.axis_names[at] + ": residual against the angle",
      .description =
          "What the fit leaves, folded over the turns. A curve that stands out of "
          "the band is something that comes again every turn and is not in the "
          "equation.",
      .x = {.label = "Angle of the axis (°)", .min = 0.0, .max = 360.0},
      .y = {.label = "Residual (" + print_unit(report.unit) + ")"},
      .bands = {std::move(band)},
      .curves = {{"residual", in_degrees(fold.angle_rad), fold.residual, Ink::blue, Mark::points}},
      .levels = {{"", 0.0}}};
}

Table sections_table(const RotationReport& report) {
  Table table{"Stretches of steady turning", {"Recording", "From", "To", "Turns", "Speed"}, {}};
  for (const calibrate::RotationSection& one : report.fit.sections) {
    table.rows.push_back({report.inputs.at(one.recording), fixed(one.start_s, 2) + " s",
                          fixed(one.end_s, 2) + " s", fixed(one.turns, 0),
                          significant(one.speed_radps / radps_per_rpm, 4) + " rpm"});
  }
  return table;
}

}  // namespace

std::string rotation_unit(Q quantity, const std::string& reading_unit) {
  switch (quantity) {
    case Q::K1:
      if (reading_unit == "m/s^2") return "1";
      return (reading_unit.empty() ? "output" : reading_unit) + "/(m/s^2)";
    case Q::K0:
    case Q::K0_radial:
      return "m/s^2";
    case Q::misalignment:
      return "rad";
    case Q::K2_minus_Kpp:
    case Q::Kip:
      return "1/(m/s^2)";
    case Q::K3:
      return "1/(m/s^2)^2";
    case Q::radius:
      return "m";
  }
  return {};
}

std::string rotation_text(const RotationReport& report) {
  std::vector<std::vector<std::string>> rows{heading(report)};
  for (auto& row : rows_of(report)) rows.push_back(std::move(row));
  std::string text = conclusion(report) + "\n\n" + aligned(rows);
  for (const std::string& reason : reasons(report)) text += "\nNot determined: " + reason + ".";
  return text + "\n";
}

std::string rotation_html(const RotationReport& report) {
  const RotationFit& fit = report.fit;
  Page page{.verb = "tumble",
            .title = "Coefficients from a wheel that turns",
            .inputs = report.inputs,
            .conclusion = conclusion(report),
            .notes = report.notes};
  const Q bias = fit.axes.front()[Q::K0].value ? Q::K0 : Q::K0_radial;
  for (const Q quantity : {Q::K1, bias, Q::K2_minus_Kpp}) {
    page.key_figures.push_back({report.axis_names.front() + ": " + label(quantity),
                                figure(fit.axes.front()[quantity], report.unit)});
  }
  page.key_figures.push_back({"Radius", with_std(scaled(fit.radius.value, 1e3), "mm", absent)});
  page.key_figures.push_back({"Turns", fixed(fit.turns, 0)});
  Section coefficients{.heading = "Coefficients", .points = reasons(report)};
  coefficients.tables = {
      {"Of the model equation, with one standard deviation", heading(report), rows_of(report)},
      sections_table(report)};
  page.sections.push_back(std::move(coefficients));
  Section turns{.heading = "Folded over the turns", .figures = {response_figure(report)}};
  for (std::size_t at = 0; at < fit.axes.size(); ++at) {
    turns.figures.push_back(residual_figure(report, at));
  }
  page.sections.push_back(std::move(turns));
  page.sections.push_back(
      {.heading = "How it was computed",
       .paragraphs = {
           "E = B0 + S1 sin φ + C1 cos φ + S2 sin 2φ + C2 cos 2φ + S3 sin 3φ + C3 cos 3φ − A ω², "
           "fitted to all samples of steady turning; without an encoder φ is a cubic spline of the "
           "time with knots several turns apart. K1 = (S1 + 3 S3)/g, K2 − Kpp = −2 C2/(K1 g²), Kip "
           "= 2 S2/(K1 g²), K3 = −4 S3/(K1 g³), r = A/K1.",
           fmt::format("Standard deviations come from the scatter between {} of whole turns, so "
                       "that noise may have any colour whose memory is shorter than a block.",
                       count_words(fit.blocks, "block")),
           fmt::format("Gravity was taken as {} m/s².", fixed(report.gravity_mps2, 5))}});
  return html(page);
}

}  // namespace proofmass::report
