#include <fmt/format.h>

#include "proofmass/report/drift/fields.hpp"
#include "proofmass/report/drift/wording.hpp"

namespace proofmass::report {
namespace {

using characterise::DriftFit;
using characterise::RunSet;

Field scatter(const char* key,
              const characterise::RunScatter& found,
              const std::string& unit,
              std::string meaning) {
  return field::object(
      key,
      {field::measured("mean", Uncertain{found.mean, found.mean_std}, unit),
       field::magnitude("observed_std", found.observed_std),
       field::magnitude("within_std", found.within_std,
                        {.meaning = "uncertainty of the runs themselves"}),
       interval_estimate("between_std", found.between_std, unit,
                         {.meaning = "not explained by noise within the runs"}),
       interval_ends("interval_95", found.between_std, {}, "of between_std"),
       field::probability(
           "p", found.p, {.meaning = "probability of so much scatter if the runs did not differ"})},
      {.meaning = std::move(meaning)});
}

Field level_curve(const RunSet& set, const std::string& unit) {
  std::optional<Fields> fields;
  if (set.level_curve) {
    const DriftFit& fit = *set.level_curve;
    const std::string why = "no warm-up over the runs is identified: " + fit.reason;
    fields =
        Fields{verdict_field(fit.identified),
               field::text("reason", fit.reason),
               reason_field(reason_code(fit.why)),
               shape_field(fit.curve.shape),
               interval_estimate("a1", fit.a1, unit, {.why_null = why}),
               interval_estimate("a2", fit.a2, unit, {}),
               interval_estimate("time_constant_runs", fit.time_constant_s, "1", {.why_null = why}),
               field::object("interval_95",
                             {interval_ends("a1", fit.a1, why), interval_ends("a2", fit.a2, {}),
                              interval_ends("time_constant_runs", fit.time_constant_s, why)})};
  }
  return field::object_or_null(
      "level_curve", std::move(fields),
      {.meaning =
           "warm-up of the means over the runs, a2 + a1 (1 - exp(-n/T)), n = 0 for the first "
           "run, in the order of levels; of 12 runs or more",
       .why_null = "too few runs, or they do not differ"});
}

Fields level_fields(const characterise::RunLevel& run, const std::string& unit) {
  return {field::text("name", run.name), field::measured("turn_on", run.turn_on, unit),
          field::measured("mean", run.mean, unit), field::measured("change", run.change, unit)};
}

Fields set_fields(const RunSet& set, const std::string& unit) {
  return {field::magnitude("window_s", set.window_s, {.meaning = "of the turn-on value"}),
          field::magnitude("duration_s", set.duration_s, {.meaning = "common to all runs"}),
          scatter("turn_on", set.turn_on, unit, "turn-on repeatability"),
          scatter("level", set.level, unit, "of the means of the runs"),
          field::measured("trend_per_run", set.trend_per_run, unit,
                          {.meaning = "of the means against the number of the run",
                           .why_null = "too few runs for a trend"}),
          field::probability("trend_p", set.trend_p),
          level_curve(set, unit)};
}

}  // namespace

ChannelDrift common_warm_up(const ChannelRuns& runs) {
  ChannelDrift common;
  common.name = runs.name;
  common.unit = runs.unit;
  common.analysis = runs.set->warm_up;
  return common;
}

Fields runs_fields(const ChannelRuns& runs) {
  const std::string unit = level_unit(runs.unit);
  Fields fields{field::text("name", runs.name), field::text("unit", unit),
                field::count("count", runs.set ? runs.set->runs.size() : 0)};
  const RunSet none;
  const RunSet& set = runs.set ? *runs.set : none;
  const std::string why = "not compared: " + runs.refused;
  if (!runs.set)
    fields.push_back(
        field::text("reason", runs.refused, {.meaning = "why they were not compared"}));
  for (Field& one : set_fields(set, unit))
    fields.push_back(runs.set ? std::move(one) : field::without_value(std::move(one), why));
  Field levels =
      field::records("levels", set.runs,
                     [&](const characterise::RunLevel& run) { return level_fields(run, unit); },
                     {.meaning = "by run"});
  std::optional<Fields> warm_up;
  if (runs.set) warm_up = drift_fields(common_warm_up(runs));
  Field common = field::object_or_null(
      "warm_up", std::move(warm_up),
      {.meaning = "of the mean over all runs, each less its own level", .why_null = why});
  // What was not compared has its levels last.
  if (!runs.set) std::swap(levels, common);
  fields.push_back(std::move(levels));
  fields.push_back(std::move(common));
  return fields;
}

}  // namespace proofmass::report
