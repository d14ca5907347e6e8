#include "proofmass/report/consistency_report.hpp"

namespace proofmass::report {
namespace {

using estimate::ChannelConsistency;
using estimate::Consistency;

std::optional<double> known(const ChannelConsistency& one, double figure) {
  return one.innovations > 0 ? std::optional(figure) : std::nullopt;
}

std::string why_no_figure(const ChannelConsistency& one) {
  if (one.innovations == 0 && one.gated == 0) return "there is no innovation";
  if (!one.std_factor) return "the gate rejected the measurements that would determine it";
  return "no two innovations follow each other";
}

Fields stretch_fields(const estimate::StretchScatter& stretch) {
  return {field::number("length_s", stretch.length_s), field::count("stretches", stretch.stretches),
          field::number("factor", stretch.factor), field::number("lower", stretch.lower),
          field::number("upper", stretch.upper)};
}

Fields whiteness_fields(const signal::WhitenessTest& test) {
  return {field::number("scale_s", test.scale_s),
          field::probability("ljung_box_p", test.ljung_box_p),
          field::probability("periodogram_p", test.periodogram_p),
          field::probability("runs_p", test.runs_p),
          field::probability("inside_bounds", test.inside_bounds),
          field::flag("white", test.white)};
}

Fields figures(const ChannelConsistency& one) {
  const std::string why = why_no_figure(one);
  return {
      field::number("nis", known(one, one.nis),
                    {.meaning = "mean of the normalised innovations squared, per channel; 1 "
                                "expected",
                     .why_null = why}),
      field::number("nis_lower", known(one, one.nis_lower), {.why_null = why}),
      field::number("nis_upper", known(one, one.nis_upper),
                    {.meaning = "between these in 95 % of recordings if the noise model is true",
                     .why_null = why}),
      field::count("innovations", one.innovations,
                   {.meaning = "accepted, over the channels present"}),
      field::count("gated", one.gated, {.meaning = "rejected"}),
      field::number("std_factor", one.std_factor,
                    {.meaning = "actual over predicted standard deviation of the innovations",
                     .why_null = why}),
      field::number("inside_95", one.inside_95,
                    {.meaning = "share within 1.96 standard deviations", .why_null = why}),
      field::number("lag_one", one.lag_one,
                    {.meaning = "correlation of successive innovations", .why_null = why}),
      field::number("lag_one_bound", one.lag_one ? std::optional(one.lag_one_bound) : std::nullopt,
                    {.why_null = why}),
      field::records(
          "stretches", one.stretches, stretch_fields,
          {.meaning = "std of the sum of innovations over a stretch, relative to that of "
                      "white innovations"})};
}

Field verdict(estimate::Verdict verdict) {
  return field::choice("verdict", name_of(verdict),
                       {"undetermined", "consistent", "cautious", "coloured", "overconfident"});
}

void add_move(Fields& fields, estimate::Remedy remedy, double factor) {
  if (remedy == estimate::Remedy::none) return;
  fields.push_back(field::object(
      "move",
      {field::choice(
           "what", name_of(remedy),
           {"measurement_noise", "process_noise", "both_noises", "slow_noise", "outliers"}),
       field::magnitude("factor", factor)},
      {.meaning = "the noise figure to change, and the factor of its standard deviation; absent "
                  "where none is to be changed"}));
}

}  // namespace

Field consistency_field(const Consistency& consistency, const NoiseNames& names) {
  Fields fields = figures(consistency.all);
  // The verdict is the most severe of the channels' verdicts; the figures are those of all channels
  // pooled.
  fields.push_back(verdict(consistency.verdict));
  add_move(fields, consistency.remedy, consistency.remedy_factor);
  if (consistency.worst_channel)
    fields.push_back(
        field::text("verdict_of", consistency.channels[*consistency.worst_channel].name,
                    {.meaning = "the channel with that verdict; absent: all together"}));
  fields.push_back(field::text("conclusion", consistency_conclusion(consistency, names)));
  Fields channels;
  for (std::size_t i = 0; i < consistency.channels.size(); ++i) {
    const ChannelConsistency& channel = consistency.channels[i];
    Fields one{field::text("name", channel.name)};
    for (Field& figure : figures(channel)) one.push_back(std::move(figure));
    one.push_back(verdict(channel.verdict));
    add_move(one, channel.remedy, channel.remedy_factor);
    if (i < consistency.whiteness.size())
      one.push_back(field::records("whiteness", consistency.whiteness[i], whiteness_fields));
    channels.push_back(field::object({}, std::move(one)));
  }
  fields.push_back(field::list("channels", std::move(channels)));
  if (consistency.smoothed_readings)
    fields.push_back(field::measured("smoothed_readings", consistency.smoothed_readings, "1"));
  if (consistency.smoothed_motion)
    fields.push_back(field::measured("smoothed_motion", consistency.smoothed_motion, "1"));
  return field::object(
      "consistency", std::move(fields),
      {.meaning = "whether the innovations agree with their predicted covariance"});
}

}  // namespace proofmass::report
