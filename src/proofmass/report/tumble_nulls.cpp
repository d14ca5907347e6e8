#include "proofmass/report/tumble_nulls.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <functional>

#include "proofmass/report/json.hpp"
#include "proofmass/report/tumble_wording.hpp"

namespace proofmass::report {
namespace {

using calibrate::TumbleCoefficient;
using calibrate::TumbleFit;
using Q = calibrate::TumbleQuantity;

using Reasons = std::function<void(const std::string& key, const std::string& why)>;

void add_residual_reasons(const TumbleFit& fit, const Reasons& add) {
  const auto& rows = fit.positions;
  if (std::any_of(rows.begin(), rows.end(), [](const auto& r) { return !r.std; }))
    add("positions[].std, residual_std",
        "no position is over to judge by and the noise of the outputs is not stated");
  else if (!fit.residual_std)
    add("residual_std", "no position is over to judge by");
  if (std::any_of(rows.begin(), rows.end(), [](const auto& r) { return !r.studentised; }))
    add("positions[].studentised",
        "the other positions alone do not carry the fit, or there is no scatter to judge by");
  if (!fit.lack_of_fit)
    add("lack_of_fit",
        fit.dof == 0 ? "no position is over to judge by"
                     : "there is neither the noise of the outputs nor, beside errors of indexing, "
                       "the scatter of repeated positions to compare with");
}

void add_drift_reasons(const TumbleFit& fit, const Reasons& add) {
  const TumbleCoefficient* c = fit.find(Q::drift);
  if (!fit.drift.rate_mps2) add("drift.value", fit.drift.words);
  if (!fit.drift.p || c == nullptr || !c->std) add("drift.std, drift.p", fit.drift.words);
}

void add_coefficient_reasons(const TumbleFit& fit, const Reasons& add) {
  for (const TumbleCoefficient& c : fit.coefficients) {
    if (!c.value) add(key_words(c), c.reason);
    // Where no residual judges, one line says so for all.
    if (c.value && !c.std && fit.residual_std) add(key_words(c) + ".std", c.reason);
  }
  const TumbleCoefficient& first = fit.coefficients.front();
  if (!first.std && !fit.residual_std) add("every std", first.reason);
  for (const Q quantity : tumble_keys) {
    if (fit.find(quantity) == nullptr)
      add(std::string(calibrate::name_of(quantity)), "no position lies in the first plane");
  }
}

void add_null_reasons(const ChannelTumble& channel, std::vector<std::string>& all) {
  const Reasons add = [&](const std::string& key, const std::string& why) {
    all.push_back(fmt::format("{}: {}: null: {}", channel.name, key, why));
  };
  if (channel.unit.symbol.empty()) add("unit", "neither the file nor --unit says");
  if (channel.fit) {
    add_coefficient_reasons(*channel.fit, add);
    add_residual_reasons(*channel.fit, add);
    add_drift_reasons(*channel.fit, add);
    return;
  }
  std::string keys;
  for (const Q quantity : tumble_keys)
    keys += (keys.empty() ? "" : ", ") + std::string(calibrate::name_of(quantity));
  add(keys, channel.refused);
}

}  // namespace

std::vector<std::string> tumble_warnings(const TumbleReport& report) {
  std::vector<std::string> all = texts(tumble_notes(report), Severity::warning);
  for (const ChannelTumble& channel : report.channels) add_null_reasons(channel, all);
  return all;
}

}  // namespace proofmass::report
