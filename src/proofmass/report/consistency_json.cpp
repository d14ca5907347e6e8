#include "proofmass/report/consistency_report.hpp"

namespace proofmass::report {
namespace {

using estimate::ChannelConsistency;
using estimate::Consistency;

Value optional(const std::optional<double>& figure) {
  return figure ? Value(*figure) : Value();
}

Value known(const ChannelConsistency& one, double figure) {
  return one.innovations > 0 ? Value(figure) : Value();
}

Array stretches(const ChannelConsistency& one) {
  Array array;
  for (const estimate::StretchScatter& stretch : one.stretches)
    array.push_back(Object{{"length_s", stretch.length_s},
                           {"stretches", stretch.stretches},
                           {"factor", stretch.factor},
                           {"lower", stretch.lower},
                           {"upper", stretch.upper}});
  return array;
}

Array whiteness(const std::vector<signal::WhitenessTest>& tests) {
  Array array;
  for (const signal::WhitenessTest& test : tests)
    array.push_back(Object{{"scale_s", test.scale_s},
                           {"ljung_box_p", test.ljung_box_p},
                           {"periodogram_p", test.periodogram_p},
                           {"runs_p", test.runs_p},
                           {"inside_bounds", test.inside_bounds},
                           {"white", test.white}});
  return array;
}

Object figures(const ChannelConsistency& one) {
  Object object{{"nis", known(one, one.nis)},
                {"nis_lower", known(one, one.nis_lower)},
                {"nis_upper", known(one, one.nis_upper)},
                {"innovations", one.innovations},
                {"gated", one.gated},
                {"std_factor", optional(one.std_factor)},
                {"inside_95", optional(one.inside_95)},
                {"lag_one", optional(one.lag_one)},
                {"lag_one_bound", one.lag_one ? Value(one.lag_one_bound) : Value()},
                {"stretches", stretches(one)},
                {"verdict", name_of(one.verdict)}};
  if (one.remedy != estimate::Remedy::none)
    object.push_back(
        {"move", Object{{"what", name_of(one.remedy)}, {"factor", one.remedy_factor}}});
  return object;
}

// The names of the figures that are null for want of innovations.
std::string lacking(const ChannelConsistency& one) {
  std::string names;
  const auto add = [&](bool lacks, const char* name) {
    if (lacks) names += (names.empty() ? "" : ", ") + std::string(name);
  };
  add(one.innovations == 0, "nis, nis_lower, nis_upper");
  add(!one.std_factor, "std_factor");
  add(!one.inside_95, "inside_95");
  add(!one.lag_one, "lag_one, lag_one_bound");
  return names;
}

}  // namespace

Value consistency_json(const Consistency& consistency, const NoiseNames& names) {
  Object object = figures(consistency.all);
  // The verdict of the document is the gravest of all, its figures those of all together.
  std::erase_if(object, [](const Member& m) { return m.key == "verdict" || m.key == "move"; });
  object.push_back({"verdict", name_of(consistency.verdict)});
  if (consistency.remedy != estimate::Remedy::none)
    object.push_back({"move", Object{{"what", name_of(consistency.remedy)},
                                     {"factor", consistency.remedy_factor}}});
  if (consistency.worst_channel)
    object.push_back({"verdict_of", consistency.channels[*consistency.worst_channel].name});
  object.push_back({"conclusion", consistency_conclusion(consistency, names)});
  Array channels;
  for (std::size_t i = 0; i < consistency.channels.size(); ++i) {
    Object one{{"name", consistency.channels[i].name}};
    for (Member& member : figures(consistency.channels[i])) one.push_back(std::move(member));
    if (i < consistency.whiteness.size())
      one.push_back({"whiteness", whiteness(consistency.whiteness[i])});
    channels.push_back(std::move(one));
  }
  object.push_back({"channels", std::move(channels)});
  if (consistency.smoothed_readings)
    object.push_back({"smoothed_readings", quantity(consistency.smoothed_readings, "1")});
  if (consistency.smoothed_motion)
    object.push_back({"smoothed_motion", quantity(consistency.smoothed_motion, "1")});
  return object;
}

std::vector<std::string> consistency_nulls(const Consistency& consistency) {
  std::vector<std::string> reasons;
  const auto look = [&](const std::string& where, const ChannelConsistency& one) {
    const std::string names = lacking(one);
    if (names.empty()) return;
    reasons.push_back(where + ": null for " + names + ": " +
                      (one.innovations == 0 && one.gated == 0 ? "there is no innovation"
                       : !one.std_factor                      ? "the gate left out what would tell"
                                         : "no two innovations follow each other"));
  };
  look("consistency", consistency.all);
  for (const ChannelConsistency& one : consistency.channels)
    look("consistency of " + one.name, one);
  return reasons;
}

}  // namespace proofmass::report
