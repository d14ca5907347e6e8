#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "proofmass/report/page.hpp"
#include "proofmass/report/tumble_figures.hpp"
#include "proofmass/report/tumble_report.hpp"
#include "proofmass/report/tumble_wording.hpp"
#include "proofmass/report/wording.hpp"

namespace proofmass::report {
namespace {

using calibrate::TumbleCoefficient;
using calibrate::TumbleFit;
using Q = calibrate::TumbleQuantity;

std::string joined(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : " and ") + file_name(name);
  return text;
}

std::vector<KeyFigure> key_figures(const TumbleReport& report) {
  std::vector<KeyFigure> figures;
  if (report.main >= report.channels.size()) return figures;
  const ChannelTumble& channel = report.channels[report.main];
  if (!channel.fit) return figures;
  const std::string name = report.channels.size() > 1 ? " of " + channel.name : "";
  const auto add = [&](const char* label, Q quantity) {
    const TumbleCoefficient* c = channel.fit->find(quantity);
    if (c != nullptr && c->value)
      figures.push_back({label + name, coefficient_words(*c, channel.unit)});
  };
  add("Scale factor", Q::K1);
  add("Bias at 0 g", Q::K0);
  add("Bias, up and down", Q::K0_up_down);
  add("Misalignment", Q::misalignment);
  return figures;
}

Table coefficient_table(const ChannelTumble& channel) {
  Table table{"Coefficients", {"Coefficient", "Value", "95 %", "What it is"}, {}};
  table.rows = coefficient_rows(channel);
  return table;
}

Table share_table(const ChannelTumble& channel) {
  const TumbleFit& fit = *channel.fit;
  Table table{"Where the standard deviations come from", {"Share", "Type"}, {}};
  std::vector<std::size_t> shown;
  for (std::size_t k = 0; k < fit.coefficients.size(); ++k) {
    const TumbleCoefficient& c = fit.coefficients[k];
    if (!c.std || !is_shown(c)) continue;
    shown.push_back(k);
    const std::string unit = printed(in_g(c, channel.unit));
    table.head.push_back(symbol_words(c) + (unit.empty() ? "" : ", " + unit));
  }
  for (const calibrate::TumbleShare& share : fit.shares) {
    std::vector<std::string> row{share.source, share.type_a ? "A" : "B"};
    for (const std::size_t k : shown) {
      const auto i = static_cast<Eigen::Index>(k);
      const double std = std::sqrt(std::max(share.covariance(i, i), 0.0));
      row.push_back(significant(std * in_g(fit.coefficients[k], channel.unit).factor, 2));
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

Table position_table(const ChannelTumble& channel) {
  Table table{"Positions", {"Position", "Angle", "Output", "Residual", "Std", ""}, {}};
  constexpr std::size_t most_rows = 80;
  const std::size_t n = std::min(channel.positions.size(), most_rows);
  for (std::size_t k = 0; k < n; ++k) {
    const calibrate::TumblePosition& p = channel.positions[k];
    const calibrate::TumbleResidual& r = channel.fit->positions[k];
    table.rows.push_back({p.label.empty() ? std::to_string(k + 1) : p.label,
                          compact(p.angle_rad / rad_per_deg, 7) + "°", significant(p.output, 7),
                          significant(r.residual, 3), r.std ? significant(*r.std, 2) : "",
                          r.suspect ? "suspect" : ""});
  }
  if (channel.positions.size() > n)
    table.caption +=
        fmt::format(": the first {} of {}; the JSON document has all", n, channel.positions.size());
  return table;
}

Section channel_section(const ChannelTumble& channel) {
  Section section{.heading = channel.name};
  if (!channel.fit) {
    section.paragraphs = {"Refused: " + channel.refused};
    return section;
  }
  section.points = tumble_sentences(channel);
  section.tables = {coefficient_table(channel)};
  const bool judged = channel.fit->find(Q::K1) != nullptr && channel.fit->find(Q::K1)->std;
  if (judged) section.tables.push_back(share_table(channel));
  section.tables.push_back(position_table(channel));
  section.figures = {tumble_output_figure(channel), tumble_residual_figure(channel)};
  return section;
}

// What a certificate states of the test.
Section conditions_section(const TumbleReport& report) {
  Table table{"Conditions", {"Condition", ""}, {}};
  const auto add = [&](const char* name, std::string value) {
    table.rows.push_back({name, std::move(value)});
  };
  add("Positions", report.source);
  add("Gravity", fixed(report.gravity_mps2, 5) + " m/s²" +
                     (report.gravity_std_mps2 > 0.0
                          ? ", std " + significant(report.gravity_std_mps2, 2) + " m/s²"
                          : ", its own uncertainty not stated"));
  add("Indexing of the table",
      report.indexing_std_rad
          ? "std " + significant(*report.indexing_std_rad / rad_per_deg * 3600.0, 3) + " arcsec"
          : "not stated");
  add("Convention", "input axis upwards at 90°: aᵢ = g sin φ, aₚ = g cos φ");
  return {.heading = "Conditions of the test",
          .paragraphs = {"Model: E = K1 [K0 + aᵢ + K2 aᵢ² + K3 aᵢ³ + δo aₚ + Kip aᵢ aₚ + Kpp aₚ²], "
                         "in a second plane with aₒ in place of aₚ. A tumble tells the sums and "
                         "differences in the table, not each term by itself."},
          .tables = {std::move(table)}};
}

}  // namespace

std::string tumble_html(const TumbleReport& report) {
  Page page{.verb = "tumble",
            .title = joined(report.inputs),
            .inputs = report.inputs,
            .conclusion = tumble_conclusion(report),
            .key_figures = key_figures(report),
            .notes = tumble_notes(report)};
  for (const ChannelTumble& channel : report.channels)
    page.sections.push_back(channel_section(channel));
  if (const std::vector<std::string> words = table_sentences(report); !words.empty())
    page.sections.push_back({.heading = "The table's own errors", .points = words});
  page.sections.push_back(conditions_section(report));
  return html(page);
}

}  // namespace proofmass::report
