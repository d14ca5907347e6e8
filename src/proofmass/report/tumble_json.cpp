#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "proofmass/report/json.hpp"
#include "proofmass/report/tumble_nulls.hpp"
#include "proofmass/report/tumble_report.hpp"
#include "proofmass/report/tumble_wording.hpp"

namespace proofmass::report {
namespace {

using calibrate::TumbleCoefficient;
using calibrate::TumbleFit;
using Q = calibrate::TumbleQuantity;

// A std that nobody can tell is null.
Value figure(const TumbleCoefficient& c, const InG& unit) {
  if (!c.value) return nullptr;
  return Object{{"value", *c.value * unit.factor},
                {"std", c.std ? Value(*c.std * unit.factor) : Value()},
                {"unit", unit.unit}};
}

Value figure(const TumbleCoefficient* c) {
  return c == nullptr ? Value() : figure(*c, {1.0, c->unit});
}

bool has_place_of_its_own(Q quantity) {
  return quantity == Q::drift || quantity == Q::indexing_cos || quantity == Q::indexing_sin ||
         quantity == Q::indexing_cos2 || quantity == Q::indexing_sin2;
}

// The list without doubles: of a misalignment and a cos 3φ the first.
std::vector<const TumbleCoefficient*> listed(const TumbleFit& fit) {
  std::vector<const TumbleCoefficient*> out;
  for (const TumbleCoefficient& c : fit.coefficients)
    if (!has_place_of_its_own(c.quantity) && fit.find(c.quantity) == &c) out.push_back(&c);
  return out;
}

Object figures(const TumbleFit* fit) {
  Object out;
  for (const Q quantity : tumble_keys)
    out.push_back({std::string(calibrate::name_of(quantity)),
                   fit == nullptr ? Value() : figure(fit->find(quantity))});
  if (fit == nullptr) return out;
  for (const TumbleCoefficient* c : listed(*fit)) {
    if (std::find(tumble_keys.begin(), tumble_keys.end(), c->quantity) == tumble_keys.end())
      out.push_back({std::string(calibrate::name_of(c->quantity)), figure(c)});
  }
  return out;
}

Object in_g_object(const TumbleFit& fit, const Unit& unit) {
  Object out;
  for (const TumbleCoefficient* c : listed(fit)) {
    if (!c->value) continue;
    std::string name(calibrate::name_of(c->quantity));
    if (name.ends_with("_rad")) name.resize(name.size() - 4);
    out.push_back({std::move(name), figure(*c, in_g(*c, unit))});
  }
  return out;
}

Object intervals(const TumbleFit& fit) {
  Object out;
  for (const TumbleCoefficient* c : listed(fit)) {
    if (!c->half_width_95) continue;
    out.push_back({std::string(calibrate::name_of(c->quantity)),
                   Array{*c->value - *c->half_width_95, *c->value + *c->half_width_95}});
  }
  return out;
}

Object meanings(const TumbleFit& fit) {
  Object out;
  for (const TumbleCoefficient* c : listed(fit))
    out.push_back({std::string(calibrate::name_of(c->quantity)), c->meaning});
  return out;
}

Array mountings(const TumbleFit& fit) {
  Array out;
  for (const TumbleCoefficient& c : fit.coefficients) {
    if (c.quantity != Q::misalignment && c.quantity != Q::misalignment_p) continue;
    out.push_back(
        Object{{"plane", c.plane}, {"mount_rad", c.mount_rad}, {"misalignment_rad", figure(&c)}});
  }
  return out;
}

Object drift(const TumbleFit& fit) {
  const calibrate::TumbleDrift& found = fit.drift;
  const TumbleCoefficient* c = fit.find(Q::drift);
  const bool std = c != nullptr && c->value && c->std;
  return {{"value", or_null(found.rate_mps2)},
          {"std", std ? Value(*c->std) : Value()},
          {"unit", found.in_time ? "m/s^3" : "m/s^2"},
          {"per", found.in_time ? "second" : "position"},
          {"known", found.known},
          {"removed", found.removed},
          {"p", or_null(found.p)},
          {"wander_std_mps2", found.wander_std_mps2},
          {"wander_assumed", found.wander_assumed},
          {"words", found.words}};
}

Object indexing(const TumbleFit& fit) {
  Array words;
  for (const std::string& text : fit.indexing.words)
    if (!text.empty()) words.push_back(text);
  return {{"once_separated", fit.indexing.once_separated},
          {"twice_separated", fit.indexing.twice_separated},
          {"std_rad", fit.indexing.std_rad},
          {"assumed", fit.indexing.assumed},
          {"cos_rad", figure(fit.find(Q::indexing_cos))},
          {"sin_rad", figure(fit.find(Q::indexing_sin))},
          {"cos2_rad", figure(fit.find(Q::indexing_cos2))},
          {"sin2_rad", figure(fit.find(Q::indexing_sin2))},
          {"words", std::move(words)}};
}

// Degrees of freedom that are infinitely many are left away.
void add_dof(Object& object, const char* key, double dof) {
  if (dof > 0.0) object.push_back({key, dof});
}

Value lack_of_fit(const TumbleFit& fit) {
  if (!fit.lack_of_fit) return nullptr;
  const calibrate::TumbleLackOfFit& found = *fit.lack_of_fit;
  Object out{{"statistic", found.statistic},
             {"p", found.p},
             {"dof", found.dof},
             {"against", found.against}};
  add_dof(out, "noise_dof", found.noise_dof);
  return out;
}

Array positions(const ChannelTumble& channel) {
  Array out;
  for (std::size_t k = 0; k < channel.positions.size(); ++k) {
    const calibrate::TumblePosition& p = channel.positions[k];
    const calibrate::TumbleResidual& r = channel.fit->positions[k];
    Object one{{"angle_rad", p.angle_rad}, {"output", p.output},
               {"fitted", r.fitted},       {"residual", r.residual},
               {"std", or_null(r.std)},    {"studentised", or_null(r.studentised)},
               {"suspect", r.suspect},     {"direction", p.direction},
               {"mount_rad", p.mount_rad}, {"plane", p.plane}};
    if (p.time_s) one.push_back({"time_s", *p.time_s});
    if (p.temperature) one.push_back({"temperature", *p.temperature});
    if (!p.label.empty()) one.push_back({"label", p.label});
    out.push_back(std::move(one));
  }
  return out;
}

Array shares(const TumbleFit& fit) {
  Array out;
  for (const calibrate::TumbleShare& share : fit.shares) {
    Object stds;
    for (const TumbleCoefficient* c : listed(fit)) {
      const auto row = static_cast<Eigen::Index>(c - fit.coefficients.data());
      if (c->std)
        stds.push_back({std::string(calibrate::name_of(c->quantity)),
                        std::sqrt(std::max(share.covariance(row, row), 0.0))});
    }
    Object one{{"source", share.source}, {"type", share.type_a ? "A" : "B"}};
    add_dof(one, "dof", share.dof);
    one.push_back({"std", std::move(stds)});
    out.push_back(std::move(one));
  }
  return out;
}

// Of the coefficients that have a value, in SI.
Object covariance(const TumbleFit& fit) {
  std::vector<Eigen::Index> there;
  Array names, rows;
  for (std::size_t k = 0; k < fit.coefficients.size(); ++k) {
    if (!fit.coefficients[k].std) continue;
    there.push_back(static_cast<Eigen::Index>(k));
    names.push_back(key_words(fit.coefficients[k]));
  }
  for (const Eigen::Index i : there) {
    Array row;
    for (const Eigen::Index j : there) row.push_back(fit.covariance(i, j));
    rows.push_back(std::move(row));
  }
  return {{"of", std::move(names)}, {"matrix", std::move(rows)}};
}

Value bias_output(const ChannelTumble& channel) {
  const TumbleFit& fit = *channel.fit;
  if (!fit.bias_output) return nullptr;
  return Object{{"value", *fit.bias_output},
                {"std", or_null(fit.bias_output_std)},
                {"unit", channel.unit.symbol}};
}

Object body(const ChannelTumble& channel) {
  const TumbleFit* fit = channel.fit ? &*channel.fit : nullptr;
  Object out = figures(fit);
  if (fit == nullptr) {
    out.push_back({"positions", Array{}});
    return out;
  }
  const auto add = [&](const char* key, Value value) { out.push_back({key, std::move(value)}); };
  add("bias_output", bias_output(channel));
  add("in_g", in_g_object(*fit, channel.unit));
  add("interval_95", intervals(*fit));
  add("meanings", meanings(*fit));
  add("mountings", mountings(*fit));
  add("drift", drift(*fit));
  add("indexing", indexing(*fit));
  add("lack_of_fit", lack_of_fit(*fit));
  add("residual_rms", fit->residual_rms);
  add("residual_std", or_null(fit->residual_std));
  add("parameters", fit->parameters);
  add("dof", fit->dof);
  add("noise_known", fit->noise_known);
  add("scatter", fit->scatter);
  add("shares", shares(*fit));
  add("covariance", covariance(*fit));
  add("positions", positions(channel));
  return out;
}

Object channel_object(const ChannelTumble& channel) {
  Array planes;
  for (std::size_t p = 0; p < 2; ++p) {
    if (const auto& phase = channel.axis.phase_rad[p])
      planes.push_back(Object{{"plane", p + 1}, {"phase_rad", *phase}});
  }
  Object out{{"name", channel.name},
             {"unit", channel.unit.symbol.empty() ? Value() : Value(channel.unit.symbol)},
             {"axis", Object{{"planes", std::move(planes)}, {"words", channel.axis.words}}}};
  if (!channel.refused.empty()) out.push_back({"refused", channel.refused});
  for (Member& member : body(channel)) out.push_back(std::move(member));
  return out;
}

}  // namespace

std::string tumble_json(const TumbleReport& report) {
  Object out;
  if (report.main < report.channels.size()) {
    const ChannelTumble& main = report.channels[report.main];
    out = body(main);
    out.insert(out.begin(), {"channel", main.name});
  }
  Array channels;
  for (const ChannelTumble& channel : report.channels) channels.push_back(channel_object(channel));
  out.push_back({"channels", std::move(channels)});
  out.push_back({"source", report.source});
  out.push_back({"gravity_mps2", report.gravity_mps2});
  out.push_back({"gravity_std_mps2", report.gravity_std_mps2});
  out.push_back(
      {"indexing_std_rad", report.indexing_std_rad.value_or(calibrate::assumed_indexing_std_rad)});
  out.push_back({"notes", array_of(texts(tumble_notes(report), Severity::info))});
  return to_json({"tumble", report.inputs, tumble_warnings(report)}, out);
}

}  // namespace proofmass::report
