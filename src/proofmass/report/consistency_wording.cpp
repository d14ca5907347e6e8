#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "proofmass/report/consistency_report.hpp"
#include "proofmass/report/wording.hpp"

namespace proofmass::report {
namespace {

using estimate::ChannelConsistency;
using estimate::Consistency;
using estimate::Remedy;
using estimate::StretchScatter;
using estimate::Verdict;

const ChannelConsistency& judged(const Consistency& c) {
  return c.worst_channel ? c.channels[*c.worst_channel] : c.all;
}

// "raise accel_std by a factor of 1.6", "lower accel_std by a factor of 2.0".
std::string move_words(const std::string& what, double factor) {
  return fmt::format("{} {} by a factor of {}", factor >= 1.0 ? "raise" : "lower", what,
                     significant(factor >= 1.0 ? factor : 1.0 / factor, 2));
}

/// The interval whose scatter factor differs most from 1.
const StretchScatter* furthest_stretch(const ChannelConsistency& one) {
  if (one.stretches.empty()) return nullptr;
  return &*std::ranges::max_element(one.stretches, {}, [](const StretchScatter& s) {
    return std::abs(std::log(std::max(s.factor, 1e-9)));
  });
}

std::string scatter_words(const ChannelConsistency& one) {
  if (!one.std_factor) return "the gate rejects most of the measurements";
  return fmt::format("the innovations have {} times their predicted standard deviation",
                     significant(*one.std_factor, 2));
}

std::string colour_words(const ChannelConsistency& one) {
  const StretchScatter* stretch = furthest_stretch(one);
  if (stretch == nullptr) return "the innovations are correlated";
  return fmt::format(
      "the innovations are correlated: their sum over {} has {} times the standard deviation of "
      "white innovations",
      duration_words(stretch->length_s), significant(stretch->factor, 2));
}

std::string remedy_words(const ChannelConsistency& one, const NoiseNames& names) {
  const double factor = one.remedy_factor;
  switch (one.remedy) {
    case Remedy::measurement_noise:
      return move_words(names.measurement, factor);
    case Remedy::process_noise:
      return (factor > 1.0 ? "the filter responds too slowly; "
                           : "the filter follows the noise; ") +
             move_words(names.process, factor);
    case Remedy::both_noises:
      return move_words(names.measurement + " and " + names.process, factor);
    case Remedy::slow_noise:
      return "a slow error is not modelled; " + move_words(names.slow, factor) +
             ", or model the drift";
    case Remedy::outliers:
      return one.gated > 0 ? "check what disturbed the rejected measurements"
                           : "a few measurements are outliers; reject them with a gate";
    case Remedy::none:
      break;
  }
  return "";
}

std::string finding(const ChannelConsistency& one, const NoiseNames& names) {
  const std::string remedy = remedy_words(one, names);
  switch (one.verdict) {
    case Verdict::undetermined:
      return fmt::format("{} are too few to judge the consistency of the filter",
                         count_words(one.innovations, "innovation"));
    case Verdict::consistent:
      return "the filter is consistent";
    case Verdict::coloured:
      return colour_words(one) + "; " + remedy;
    case Verdict::cautious:
    case Verdict::overconfident:
      break;
  }
  if (one.remedy == Remedy::outliers && one.gated > 0)
    return fmt::format("{} of {} were rejected: {}", grouped(one.gated),
                       count_words(one.gated + one.innovations, "measurement"), remedy);
  return scatter_words(one) + ": " + remedy;
}

}  // namespace

std::string_view name_of(Verdict verdict) {
  switch (verdict) {
    case Verdict::undetermined:
      return "undetermined";
    case Verdict::consistent:
      return "consistent";
    case Verdict::cautious:
      return "cautious";
    case Verdict::coloured:
      return "coloured";
    case Verdict::overconfident:
      return "overconfident";
  }
  return "";
}

std::string_view name_of(Remedy remedy) {
  switch (remedy) {
    case Remedy::none:
      return "none";
    case Remedy::measurement_noise:
      return "measurement_noise";
    case Remedy::process_noise:
      return "process_noise";
    case Remedy::both_noises:
      return "both_noises";
    case Remedy::slow_noise:
      return "slow_noise";
    case Remedy::outliers:
      return "outliers";
  }
  return "";
}

std::string consistency_conclusion(const Consistency& consistency, const NoiseNames& names) {
  const ChannelConsistency& one = judged(consistency);
  std::string text = finding(one, names) + ".";
  if (consistency.worst_channel) return file_name(one.name) + ": " + text;
  if (text.front() >= 'a' && text.front() <= 'z')
    text.front() = static_cast<char>(text.front() - 'a' + 'A');
  return text;
}

std::string nis_words(const Consistency& consistency) {
  if (consistency.innovations == 0) return "no innovations";
  return fmt::format("mean NIS {}, expected {} … {} over {}", fixed(consistency.nis, 3),
                     fixed(consistency.nis_lower, 3), fixed(consistency.nis_upper, 3),
                     count_words(consistency.innovations, "innovation"));
}

Section consistency_section(const Consistency& consistency, const NoiseNames& names) {
  Section section{.heading = "Consistency of the filter", .on_terminal = true};
  section.paragraphs = {consistency_conclusion(consistency, names),
                        fmt::format("Normalised innovations squared: {}; a filter with the true "
                                    "noise model lies within these "
                                    "bounds in 95 % of recordings.",
                                    nis_words(consistency))};
  if (consistency.all.inside_95)
    section.paragraphs.back() +=
        fmt::format(" {} % of the innovations are within 1.96 standard deviations (95 % expected).",
                    fixed(100.0 * *consistency.all.inside_95, 1));
  Table channels{
      "By channel", {"Channel", "Mean NIS", "95 % bounds", "Within 95 %", "Rejected", "Lag 1"}, {}};
  const auto add = [&](const std::string& name, const ChannelConsistency& one) {
    channels.rows.push_back(
        {name, fixed(one.nis, 3), fixed(one.nis_lower, 3) + " … " + fixed(one.nis_upper, 3),
         one.inside_95 ? fixed(100.0 * *one.inside_95, 1) + " %" : "", grouped(one.gated),
         one.lag_one ? fixed(*one.lag_one, 3) + " (± " + fixed(one.lag_one_bound, 3) + ")" : ""});
  };
  for (const ChannelConsistency& one : consistency.channels) add(file_name(one.name), one);
  if (consistency.channels.size() != 1) add("all", consistency.all);
  channels.page_only = true;
  section.tables.push_back(std::move(channels));
  if (consistency.all.stretches.empty()) return section;
  Table stretches{
      "Standard deviation of the sum of innovations over a stretch, 1 for white innovations",
      {"Stretch", "Factor", "95 % of white noise", "Stretches"},
      {}};
  stretches.page_only = true;
  for (const StretchScatter& one : consistency.all.stretches)
    stretches.rows.push_back({duration_words(one.length_s), fixed(one.factor, 3),
                              fixed(one.lower, 3) + " … " + fixed(one.upper, 3),
                              grouped(one.stretches)});
  section.tables.push_back(std::move(stretches));
  return section;
}

}  // namespace proofmass::report
