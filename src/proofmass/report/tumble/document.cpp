#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "proofmass/report/tumble/figures.hpp"
#include "proofmass/report/tumble/report.hpp"
#include "proofmass/report/tumble/wording.hpp"
#include "proofmass/report/wording.hpp"

namespace proofmass::report {
namespace {

using calibrate::TumbleCoefficient;
using calibrate::TumbleFit;
using Q = calibrate::TumbleQuantity;

// The keys of every document, whether or not the test determines them.
constexpr std::array standard_keys{Q::K1, Q::K0,  Q::K2_minus_Kpp, Q::misalignment,
                                   Q::K3, Q::Kip, Q::K0_up_down};

std::string key_of(Q quantity) {
  return std::string(calibrate::name_of(quantity));
}

constexpr const char* no_redundancy = "there is no redundant position";

Field figure(std::string key, const TumbleCoefficient& c, const InG& unit, About about = {}) {
  const auto shown = [&](const std::optional<double>& value) {
    return value ? std::optional(*value * unit.factor) : std::nullopt;
  };
  about.why_null = about.why_no_std = c.reason;
  return field::measured(std::move(key), shown(c.value), shown(c.std), unit.unit, std::move(about));
}

Field figure(Q quantity, const TumbleCoefficient& c) {
  return figure(key_of(quantity), c, {1.0, c.unit});
}

Field absent_figure(Q quantity, const std::string& why) {
  return field::measured(key_of(quantity), std::nullopt, std::nullopt, "", {.why_null = why});
}

// Drift and indexing errors have objects of their own.
bool is_listed(Q quantity) {
  return quantity != Q::drift && quantity != Q::indexing_cos && quantity != Q::indexing_sin &&
         quantity != Q::indexing_cos2 && quantity != Q::indexing_sin2;
}

// The first coefficient of each quantity, since there may be a misalignment for each mounting.
std::vector<const TumbleCoefficient*> listed(const TumbleFit& fit) {
  std::vector<const TumbleCoefficient*> out;
  for (const TumbleCoefficient& c : fit.coefficients)
    if (is_listed(c.quantity) && fit.find(c.quantity) == &c) out.push_back(&c);
  return out;
}

Fields coefficient_fields(const ChannelTumble& channel) {
  Fields out;
  for (const Q quantity : standard_keys) {
    const TumbleCoefficient* c = channel.fit ? channel.fit->find(quantity) : nullptr;
    const std::string why = channel.fit ? "no position is in the first plane" : channel.refused;
    out.push_back(c != nullptr ? figure(quantity, *c) : absent_figure(quantity, why));
  }
  if (!channel.fit) return out;
  for (const TumbleCoefficient* c : listed(*channel.fit))
    if (std::ranges::find(standard_keys, c->quantity) == standard_keys.end())
      out.push_back(figure(c->quantity, *c));
  return out;
}

Field figures_in_g(const ChannelTumble& channel) {
  Fields entries;
  for (const TumbleCoefficient* c : listed(*channel.fit)) {
    if (!c->value) continue;
    std::string key = key_of(c->quantity);
    if (key.ends_with("_rad")) key.resize(key.size() - 4);
    entries.push_back(figure(std::move(key), *c, in_g(*c, channel.unit)));
  }
  return field::map("in_g", std::move(entries),
                    {.meaning = "values in the units of the standard: mg, ug/g^2, ug/g^3, mrad, "
                                "V/g"});
}

Field intervals(const TumbleFit& fit) {
  Fields entries;
  for (const TumbleCoefficient* c : listed(fit))
    if (c->half_width_95)
      entries.push_back(field::interval(
          key_of(c->quantity),
          std::array{*c->value - *c->half_width_95, *c->value + *c->half_width_95}));
  return field::map("interval_95", std::move(entries),
                    {.meaning = "by Student's t, of what has a standard deviation"});
}

Field meanings(const TumbleFit& fit) {
  Fields entries;
  for (const TumbleCoefficient* c : listed(fit))
    entries.push_back(field::text(key_of(c->quantity), c->meaning));
  return field::map("meanings", std::move(entries),
                    {.meaning = "definition of each coefficient in this test"});
}

Field mountings(const TumbleFit& fit) {
  Fields items;
  for (const TumbleCoefficient& c : fit.coefficients) {
    if (c.quantity != Q::misalignment && c.quantity != Q::misalignment_p) continue;
    items.push_back(
        field::object({}, {field::count("plane", static_cast<std::size_t>(c.plane)),
                           field::number("mount_rad", c.mount_rad,
                                         {.meaning = "rotation of the sensor on the table"}),
                           figure("misalignment_rad", c, {1.0, c.unit})}));
  }
  return field::list("mountings", std::move(items));
}

Field drift(const TumbleFit& fit) {
  const calibrate::TumbleDrift& found = fit.drift;
  const TumbleCoefficient* c = fit.find(Q::drift);
  const std::optional<double> std = c != nullptr && c->value ? c->std : std::nullopt;
  return field::object(
      "drift",
      {field::number("value", found.rate_mps2,
                     {.meaning = "linear change of the bias", .why_null = found.words}),
       field::magnitude("std", std, {.why_null = found.words}),
       field::choice("unit", found.in_time ? "m/s^3" : "m/s^2", {"m/s^3", "m/s^2"}),
       field::choice("per", found.in_time ? "second" : "position", {"second", "position"}),
       field::flag("known", found.known, {.meaning = "a position was revisited late enough"}),
       field::flag("removed", found.removed,
                   {.meaning = "fitted with the coefficients; else it is part of the residuals"}),
       field::probability(
           "p", found.p,
           {.meaning = "probability of this drift or more by chance", .why_null = found.words}),
       field::magnitude("wander_std_mps2", found.nonlinear_std_mps2,
                        {.meaning = "standard deviation of the bias drift about a straight line, "
                                    "as used"}),
       field::flag("wander_assumed", found.nonlinear_assumed, {.meaning = "not stated"}),
       field::text("words", found.words)});
}

Field indexing(const TumbleFit& fit) {
  std::vector<std::string> words;
  std::ranges::copy_if(fit.indexing.words, std::back_inserter(words),
                       [](const std::string& text) { return !text.empty(); });
  const auto amplitude = [&](const char* key, Q quantity) {
    const TumbleCoefficient* c = fit.find(quantity);
    if (c != nullptr) return figure(key, *c, {1.0, c->unit});
    return field::measured(key, std::nullopt, std::nullopt, "",
                           {.why_null = "no position is in the first plane"});
  };
  return field::object(
      "indexing",
      {field::flag("once_separated", fit.indexing.once_separated,
                   {.meaning = "errors once a turn are separable from the bias"}),
       field::flag("twice_separated", fit.indexing.twice_separated,
                   {.meaning = "errors twice a turn are separable from the scale factor"}),
       field::magnitude("std_rad", fit.indexing.std_rad,
                        {.meaning = "standard deviation of the table's angle at each setting, as "
                                    "used: stated, assumed or from the residuals"}),
       field::flag("assumed", fit.indexing.assumed, {.meaning = "not stated"}),
       amplitude("cos_rad", Q::indexing_cos), amplitude("sin_rad", Q::indexing_sin),
       amplitude("cos2_rad", Q::indexing_cos2), amplitude("sin2_rad", Q::indexing_sin2),
       field::texts("words", words)},
      {.meaning = "true less indicated angle of the table, where a second mounting separates it"});
}

Field lack_of_fit(const TumbleFit& fit) {
  std::optional<Fields> fields;
  if (fit.lack_of_fit) {
    const calibrate::TumbleLackOfFit& found = *fit.lack_of_fit;
    fields = Fields{
        field::magnitude("statistic", found.statistic,
                         {.meaning = "F: mean square of the lack of fit over that of "
                                     "the noise"}),
        field::probability("p", found.p, {.meaning = "probability of this or more by chance"}),
        field::count("dof", found.dof), field::text("against", found.against)};
    if (found.noise_dof > 0.0)
      fields->push_back(
          field::magnitude("noise_dof", found.noise_dof, {.meaning = "omitted where infinite"}));
  }
  return field::object_or_null(
      "lack_of_fit", std::move(fields),
      {.why_null = fit.dof == 0 ? no_redundancy
                                : "needs the noise of the outputs or, beside indexing errors, "
                                  "repeated positions"});
}

Fields position_fields(const calibrate::TumblePosition& p, const calibrate::TumbleResidual& r) {
  Fields out{
      field::number("angle_rad", p.angle_rad, {.meaning = "of the table"}),
      field::number("output", p.output),
      field::number("fitted", r.fitted),
      field::number("residual", r.residual, {.meaning = "output less fitted"}),
      field::magnitude("std", r.std,
                       {.meaning = "expected standard deviation of the residual",
                        .why_null = "there is no redundant position, and the noise of the outputs "
                                    "is not stated"}),
      field::number("studentised", r.studentised,
                    {.meaning = "by a fit to the other positions",
                     .why_null = "the other positions alone do not determine the fit, or there is "
                                 "no scatter"}),
      field::flag("suspect", r.suspect,
                  {.meaning = "it contradicts the others; it stays in the fit"}),
      field::integer("direction", p.direction, {.meaning = "of the last move: 1, -1, or 0"}),
      field::number("mount_rad", p.mount_rad),
      field::count("plane", static_cast<std::size_t>(p.plane))};
  if (p.time_s) out.push_back(field::number("time_s", *p.time_s, {.meaning = "where known"}));
  if (p.temperature)
    out.push_back(
        field::number("temperature", *p.temperature, {.meaning = "in the unit of the input"}));
  if (!p.label.empty())
    out.push_back(field::text("label", p.label,
                              {.meaning = "line of the file, or start of the "
                                          "rest"}));
  return out;
}

Fields share_fields(const TumbleFit& fit, const calibrate::TumbleShare& share) {
  Fields stds;
  for (const TumbleCoefficient* c : listed(fit)) {
    const auto row = static_cast<Eigen::Index>(c - fit.coefficients.data());
    if (c->std)
      stds.push_back(field::magnitude(key_of(c->quantity),
                                      std::sqrt(std::max(share.covariance(row, row), 0.0))));
  }
  Fields out{field::text("source", share.source),
             field::choice("type", share.type_a ? "A" : "B", {"A", "B"})};
  if (share.dof > 0.0)
    out.push_back(field::magnitude("dof", share.dof, {.meaning = "omitted where infinite"}));
  out.push_back(field::map("std", std::move(stds)));
  return out;
}

Field covariance(const TumbleFit& fit) {
  std::vector<Eigen::Index> there;
  std::vector<std::string> names;
  for (std::size_t k = 0; k < fit.coefficients.size(); ++k) {
    if (!fit.coefficients[k].std) continue;
    there.push_back(static_cast<Eigen::Index>(k));
    names.push_back(key_words(fit.coefficients[k]));
  }
  Fields rows;
  for (const Eigen::Index i : there) {
    Fields row;
    for (const Eigen::Index j : there) row.push_back(field::number({}, fit.covariance(i, j)));
    rows.push_back(field::list({}, std::move(row)));
  }
  return field::object("covariance",
                       {field::texts("of", names), field::list("matrix", std::move(rows))},
                       {.meaning = "SI, of the coefficients that have a standard deviation"});
}

Fields body(const ChannelTumble& channel) {
  Fields out = coefficient_fields(channel);
  Fields positions;
  if (channel.fit) {
    const TumbleFit& fit = *channel.fit;
    for (std::size_t k = 0; k < channel.positions.size(); ++k)
      positions.push_back(
          field::object({}, position_fields(channel.positions[k], fit.positions[k])));
    append(
        out,
        {field::measured("bias_output", fit.bias_output, fit.bias_output_std, channel.unit.symbol,
                         {.meaning = "bias in the unit of the output",
                          .why_null = "the bias is not determined",
                          .why_no_std = fit.coefficients.front().reason}),
         figures_in_g(channel), intervals(fit), meanings(fit), mountings(fit), drift(fit),
         indexing(fit), lack_of_fit(fit),
         field::magnitude("residual_rms", fit.residual_rms, {.meaning = "unit of the output"}),
         field::magnitude("residual_std", fit.residual_std,
                          {.meaning = "root of the sum of squared residuals over dof",
                           .why_null = no_redundancy}),
         field::count("parameters", fit.parameters),
         field::count("dof", fit.dof, {.meaning = "positions less parameters"}),
         field::flag("noise_known", fit.noise_known,
                     {.meaning = "standard deviations come from the stated noise of the "
                                 "outputs, not from the residuals"}),
         field::magnitude("scatter", fit.scatter,
                          {.meaning = "factor on the stated noise where the residuals exceed "
                                      "it"}),
         field::records(
             "shares", fit.shares,
             [&](const calibrate::TumbleShare& share) { return share_fields(fit, share); },
             {.meaning = "contributions to the standard deviations"}),
         covariance(fit)});
  }
  out.push_back(field::list("positions", std::move(positions)));
  return out;
}

Fields channel_fields(const ChannelTumble& channel) {
  Fields planes;
  for (std::size_t p = 0; p < 2; ++p)
    if (const auto& phase = channel.axis.phase_rad[p])
      planes.push_back(field::object(
          {}, {field::count("plane", p + 1),
               field::number("phase_rad", *phase,
                             {.meaning = "the output follows sin(angle + mount + phase)"})}));
  Fields out{field::text("name", channel.name),
             field::text_or_null("unit", channel.unit.symbol,
                                 {.meaning = "of the outputs: SI, or counts",
                                  .why_null = "neither the file nor --unit states it"}),
             field::object("axis", {field::list("planes", std::move(planes)),
                                    field::text("words", channel.axis.words)})};
  if (!channel.refused.empty())
    out.push_back(
        field::text("refused", channel.refused, {.meaning = "why there are no coefficients"}));
  append(out, body(channel));
  return out;
}

Fields tumble_fields(const TumbleReport& report) {
  Fields out;
  if (report.main < report.channels.size()) {
    const ChannelTumble& main = report.channels[report.main];
    out.push_back(field::text("channel", main.name, {.meaning = "whose coefficients follow"}));
    append(out, body(main));
  }
  append(out, {field::records("channels", report.channels, channel_fields),
               field::text("source", report.source, {.meaning = "of the positions"}),
               field::magnitude("gravity_mps2", report.gravity_mps2),
               field::magnitude("gravity_std_mps2", report.gravity_std_mps2),
               field::magnitude(
                   "indexing_std_rad",
                   report.indexing_std_rad.value_or(calibrate::assumed_indexing_std_rad),
                   {.meaning = "standard deviation of the table's angle at each setting, stated or "
                               "assumed; indexing.std_rad is what was used"}),
               field::notes(tumble_notes(report))});
  return out;
}

std::vector<KeyFigure> figures_of(const TumbleReport& report) {
  std::vector<KeyFigure> figures;
  if (report.main >= report.channels.size()) return figures;
  const ChannelTumble& channel = report.channels[report.main];
  if (!channel.fit) return figures;
  const std::string name = report.channels.size() > 1 ? " of " + channel.name : "";
  for (const auto& [label, quantity] : {std::pair{"Scale factor", Q::K1},
                                        {"Bias at 0 g", Q::K0},
                                        {"Bias, up and down", Q::K0_up_down},
                                        {"Misalignment", Q::misalignment}}) {
    const TumbleCoefficient* c = channel.fit->find(quantity);
    if (c != nullptr && c->value)
      figures.push_back({label + name, coefficient_words(*c, channel.unit), true});
  }
  return figures;
}

Table share_table(const ChannelTumble& channel) {
  const TumbleFit& fit = *channel.fit;
  Table table{"Contributions to the standard deviations", {"Source", "Type"}, {}};
  table.page_only = true;
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
  table.page_only = table.long_list = true;
  for (std::size_t k = 0; k < channel.positions.size(); ++k) {
    const calibrate::TumblePosition& p = channel.positions[k];
    const calibrate::TumbleResidual& r = channel.fit->positions[k];
    table.rows.push_back({p.label.empty() ? std::to_string(k + 1) : p.label,
                          compact(p.angle_rad / rad_per_deg, 7) + "°", significant(p.output, 7),
                          significant(r.residual, 3), r.std ? significant(*r.std, 2) : "",
                          r.suspect ? "suspect" : ""});
  }
  return table;
}

Section channel_section(const ChannelTumble& channel) {
  if (!channel.fit)
    return {.heading = channel.name,
            .paragraphs = {"Refused: " + channel.refused},
            .on_terminal = true};
  Section section{.heading = channel.name,
                  .points = tumble_sentences(channel),
                  .tables = {{"Coefficients",
                              {"Coefficient", "Value", "95 %", "Meaning"},
                              coefficient_rows(channel)}},
                  .figures = {[&] { return tumble_output_figure(channel); },
                              [&] { return tumble_residual_figure(channel); }},
                  .on_terminal = true};
  const TumbleCoefficient* scale = channel.fit->find(Q::K1);
  if (scale != nullptr && scale->std) section.tables.push_back(share_table(channel));
  section.tables.push_back(position_table(channel));
  return section;
}

// Conditions of the test, as a certificate states them.
Section conditions_section(const TumbleReport& report) {
  const std::string gravity_std = report.gravity_std_mps2 > 0.0
                                      ? ", std " + significant(report.gravity_std_mps2, 2) + " m/s²"
                                      : ", uncertainty not stated";
  const std::string indexing_std =
      report.indexing_std_rad
          ? "std " + significant(*report.indexing_std_rad / rad_per_deg * 3600.0, 3) + " arcsec"
          : "not stated";
  return {.heading = "Conditions of the test",
          .paragraphs = {"Model: E = K1 [K0 + aᵢ + K2 aᵢ² + K3 aᵢ³ + δo aₚ + Kip aᵢ aₚ + Kpp aₚ²], "
                         "in a second plane with aₒ in place of aₚ. A tumble determines the sums "
                         "and differences in the table, not each term by itself."},
          .tables = {{"Conditions",
                      {"Condition", ""},
                      {{"Positions", report.source},
                       {"Gravity", fixed(report.gravity_mps2, 5) + " m/s²" + gravity_std},
                       {"Indexing of the table", indexing_std},
                       {"Convention", "input axis upwards at 90°: aᵢ = g sin φ, aₚ = g cos φ"}}}}};
}

}  // namespace

Document describe(const TumbleReport& report) {
  Document document{.page = {.verb = "tumble",
                             .title = file_names(report.inputs),
                             .inputs = report.inputs,
                             .conclusion = tumble_conclusion(report),
                             .key_figures = figures_of(report),
                             .notes = tumble_notes(report)},
                    .fields = tumble_fields(report)};
  std::vector<Section>& sections = document.page.sections;
  for (const ChannelTumble& channel : report.channels) sections.push_back(channel_section(channel));
  if (std::vector<std::string> words = table_sentences(report); !words.empty())
    sections.push_back({.heading = "Indexing errors of the table",
                        .points = std::move(words),
                        .on_terminal = true});
  sections.push_back(conditions_section(report));
  return document;
}

}  // namespace proofmass::report
