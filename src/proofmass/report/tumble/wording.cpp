#include "proofmass/report/tumble/wording.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <utility>

#include "proofmass/report/wording.hpp"

namespace proofmass::report {
namespace {

using calibrate::TumbleCoefficient;
using calibrate::TumbleFit;
using Q = calibrate::TumbleQuantity;

constexpr double g = standard_gravity_mps2;
constexpr double arcsec_per_rad = 3600.0 / rad_per_deg;

bool is_table_angle(Q quantity) {
  return quantity == Q::backlash || quantity == Q::indexing_cos || quantity == Q::indexing_sin ||
         quantity == Q::indexing_cos2 || quantity == Q::indexing_sin2;
}

constexpr std::array<std::pair<Q, const char*>, 20> symbols{{
    {Q::K1, "K1"},
    {Q::K0, "K0 + Kpp g²"},
    {Q::K0_up_down, "K0 + K2 g²"},
    {Q::misalignment, "δo"},
    {Q::K2_minus_Kpp, "K2 − Kpp"},
    {Q::Kip, "Kip"},
    {Q::K3, "K3"},
    {Q::third_cosine, "cos 3φ"},
    {Q::K0_second, "K0 + Koo g²"},
    {Q::misalignment_p, "δp"},
    {Q::K2_minus_Koo, "K2 − Koo"},
    {Q::Kio, "Kio"},
    {Q::drift, "drift"},
    {Q::temperature, "bias per kelvin"},
    {Q::hysteresis, "hysteresis"},
    {Q::backlash, "backlash"},
    {Q::indexing_cos, "indexing, cos θ"},
    {Q::indexing_sin, "indexing, sin θ"},
    {Q::indexing_cos2, "indexing, cos 2θ"},
    {Q::indexing_sin2, "indexing, sin 2θ"},
}};

std::string mounted(const TumbleCoefficient& coefficient) {
  constexpr double some = 0.5 * rad_per_deg;
  if (coefficient.mount_rad < some) return "";
  return fmt::format(" (mounted at {}°)", compact(coefficient.mount_rad / rad_per_deg, 4));
}

std::string lack_of_fit_words(const calibrate::TumbleLackOfFit& found) {
  constexpr double chance = 0.05;
  // A drift or an angle error with the period of the turn leaves no residual, so the test cannot
  // confirm the model.
  const char* verdict =
      found.p < chance ? "exceed what chance explains" : "are consistent with chance";
  return fmt::format("Lack of fit against the {}: F = {}, p = {}: the residuals {}.", found.against,
                     significant(found.statistic, 3), significant(found.p, 2), verdict);
}

std::string capital(std::string text) {
  if (!text.empty() && text[0] >= 'a' && text[0] <= 'z') text[0] = static_cast<char>(text[0] - 32);
  return text;
}

std::string scale_words(const ChannelTumble& channel) {
  const TumbleCoefficient* scale = channel.fit->find(Q::K1);
  return scale == nullptr ? "" : "scale factor " + coefficient_words(*scale, channel.unit);
}

std::string bias_words(const ChannelTumble& channel) {
  for (const auto& [quantity, where] :
       {std::pair{Q::K0, " at 0 g"}, {Q::K0_second, " at 0 g"}, {Q::K0_up_down, " between ±1 g"}}) {
    const TumbleCoefficient* bias = channel.fit->find(quantity);
    if (bias != nullptr && bias->value)
      return "bias " + coefficient_words(*bias, channel.unit) + where;
  }
  return "bias not determined";
}

}  // namespace

InG in_g(const TumbleCoefficient& coefficient, const Unit& output) {
  if (coefficient.quantity == Q::K1) {
    if (output.symbol == "m/s^2") return {1.0, "1"};
    return {g, (output.symbol.empty() ? std::string("1") : output.symbol) + "/g"};
  }
  if (coefficient.quantity == Q::drift) {
    constexpr double s_per_h = 3600.0;
    if (coefficient.unit == "m/s^3") return {1e3 / g * s_per_h, "mg/h"};
    return {1e3 / g, "mg per position"};
  }
  if (coefficient.quantity == Q::temperature) return {1e3 / g, "mg/K"};
  switch (calibrate::acceleration_power(coefficient.quantity)) {
    case 1:
      return {1e3 / g, "mg"};
    case -1:
      return {1e6 * g, "ug/g^2"};
    case -2:
      return {1e6 * g * g, "ug/g^3"};
    default:
      break;
  }
  if (is_table_angle(coefficient.quantity)) return {arcsec_per_rad, "arcsec"};
  return {1e3, "mrad"};
}

std::string printed(const InG& unit) {
  if (unit.unit == "1") return {};
  const bool micro = unit.unit.starts_with("ug/");
  return print_unit(micro ? "µ" + unit.unit.substr(1) : unit.unit);
}

std::string symbol_words(const TumbleCoefficient& coefficient) {
  const auto found =
      std::ranges::find(symbols, coefficient.quantity, &std::pair<Q, const char*>::first);
  return (found == symbols.end() ? "" : found->second) + mounted(coefficient);
}

std::string coefficient_words(const TumbleCoefficient& coefficient, const Unit& output) {
  if (!coefficient.value) return std::string(absent);
  const InG unit = in_g(coefficient, output);
  const double value = *coefficient.value * unit.factor;
  const std::string symbol = printed(unit);
  if (coefficient.std) return with_std(Uncertain{value, *coefficient.std * unit.factor}, symbol);
  return significant(value, 5) + (symbol.empty() ? "" : " ") + symbol;
}

std::string key_words(const TumbleCoefficient& coefficient) {
  return std::string(calibrate::name_of(coefficient.quantity)) + mounted(coefficient);
}

bool is_shown(const TumbleCoefficient& coefficient) {
  switch (coefficient.quantity) {
    case Q::K1:
    case Q::K0:
    case Q::K0_up_down:
    case Q::misalignment:
    case Q::K2_minus_Kpp:
    case Q::Kip:
    case Q::K3:
      return true;
    default:
      return coefficient.value.has_value();
  }
}

std::vector<std::vector<std::string>> coefficient_rows(const ChannelTumble& channel) {
  std::vector<std::vector<std::string>> rows;
  for (const TumbleCoefficient& c : channel.fit->coefficients) {
    if (!is_shown(c)) continue;
    const double factor = in_g(c, channel.unit).factor;
    const std::string band =
        c.half_width_95 ? "± " + significant(*c.half_width_95 * factor, 2) : "";
    rows.push_back({symbol_words(c), coefficient_words(c, channel.unit), band,
                    c.value ? c.meaning : c.reason});
  }
  return rows;
}

std::vector<std::string> tumble_sentences(const ChannelTumble& channel) {
  const TumbleFit& fit = *channel.fit;
  std::vector<std::string> out;
  out.push_back(fmt::format("The output {}.", channel.axis.words));
  out.push_back(fmt::format("{}, {}; residuals {} {} rms.",
                            count_words(fit.positions.size(), "position"),
                            count_words(fit.parameters, "parameter"),
                            significant(fit.residual_rms, 3), print_unit(channel.unit.symbol)));
  out.push_back(fit.noise_known ? "Standard deviations from the stated noise of the outputs."
                : fit.dof > 0   ? "Standard deviations from the residuals."
                                : "No standard deviations: there is no redundant position.");
  if (fit.lack_of_fit) out.push_back(lack_of_fit_words(*fit.lack_of_fit));
  out.push_back(capital(fit.drift.words) + ".");
  return out;
}

std::vector<std::string> table_sentences(const TumbleReport& report) {
  std::vector<std::string> out;
  if (report.main >= report.channels.size() || !report.channels[report.main].fit) return out;
  for (const std::string& words : report.channels[report.main].fit->indexing.words)
    if (!words.empty()) out.push_back(capital(words) + ".");
  return out;
}

std::string tumble_conclusion(const TumbleReport& report) {
  std::string text;
  for (const ChannelTumble& channel : report.channels) {
    if (!channel.fit) continue;
    const std::string name = report.channels.size() > 1 ? channel.name + ": " : "";
    const std::string words = name + scale_words(channel) + ", " + bias_words(channel) + ". ";
    text += words;
  }
  if (text.empty()) return "No channel follows the angle: no coefficient is determined.";
  text.pop_back();
  if (report.channels.size() == 1 || text[0] == 's') text[0] = 'S';
  return text;
}

}  // namespace proofmass::report
