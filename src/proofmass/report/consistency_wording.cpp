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

/// Of the stretches whose sums go furthest, or least far.
const StretchScatter* furthest_stretch(const ChannelConsistency& one) {
  if (one.stretches.empty()) return nullptr;
  return &*std::ranges::max_element(one.stretches, {}, [](const StretchScatter& s) {
    return std::abs(std::log(std::max(s.factor, 1e-9)));
  });
}

std::string scatter_words(const ChannelConsistency& one) {
  if (!one.std_factor) return "the gate leaves out most of the readings";
  return fmt::format("the innovations scatter {} times as far as the filter says",
                     significant(*one.std_factor, 2));
}

std::string colour_words(const ChannelConsistency& one) {
  const StretchScatter* stretch = furthest_stretch(one);
  if (stretch == nullptr) return "the innovations hang together";
  return fmt::format("over {} the innovations add up {} times as far as independent ones would",
                     duration_words(stretch->length_s), significant(stretch->factor, 2));
}

std::string remedy_words(const ChannelConsistency& one, const NoiseNames& names) {
  const double factor = one.remedy_factor;
  switch (one.remedy) {
    case Remedy::measurement_noise:
      return move_words(names.measurement, factor);
    case Remedy::process_noise:
      return (factor > 1.0 ? "it follows too slowly; " : "it follows the noise; ") +
             move_words(names.process, factor);
    case Remedy::both_noises:
      return move_words(names.measurement + " and " + names.process, factor);
    case Remedy::slow_noise:
      return "something slow is not in the model; " + move_words(names.slow, factor) +
             ", or model what drifts";
    case Remedy::outliers:
      return one.gated > 0 ? "look at what disturbed the readings that were left out"
                           : "a few readings lie far off; leave them out by a gate";
    case Remedy::none:
      break;
  }
  return "";
}

std::string finding(const ChannelConsistency& one, const NoiseNames& names) {
  const std::string remedy = remedy_words(one, names);
  switch (one.verdict) {
    case Verdict::undetermined:
      return fmt::format("{} are too few to judge the filter by",
                         count_words(one.innovations, "innovation"));
    case Verdict::consistent:
      return "the filter errs as far as it says";
    case Verdict::coloured:
      return colour_words(one) + ": " + remedy;
    case Verdict::cautious:
    case Verdict::overconfident:
      break;
  }
  if (one.remedy == Remedy::outliers && one.gated > 0)
    return fmt::format("{} of {} were left out: {}", grouped(one.gated),
                       count_words(one.gated + one.innovations, "reading"), remedy);
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
  Section section{.heading = "Does the filter err as far as it says?"};
  section.paragraphs = {
      consistency_conclusion(consistency, names),
      fmt::format(
          "Normalised innovations squared: {}, the bounds being those of 95 % of recordings "
          "if the noise figures were exactly true.",
          nis_words(consistency))};
  if (consistency.all.inside_95)
    section.paragraphs.back() += fmt::format(
        " Innovations should be independent, and 95 % of them within 1.96 standard deviations: {} "
        "% are.",
        fixed(100.0 * *consistency.all.inside_95, 1));
  Table channels{
      "By channel", {"Channel", "Mean NIS", "95 % bounds", "Within 95 %", "Left out", "Lag 1"}, {}};
  const auto add = [&](const std::string& name, const ChannelConsistency& one) {
    channels.rows.push_back(
        {name, fixed(one.nis, 3), fixed(one.nis_lower, 3) + " … " + fixed(one.nis_upper, 3),
         one.inside_95 ? fixed(100.0 * *one.inside_95, 1) + " %" : "", grouped(one.gated),
         one.lag_one ? fixed(*one.lag_one, 3) + " (± " + fixed(one.lag_one_bound, 3) + ")" : ""});
  };
  for (const ChannelConsistency& one : consistency.channels) add(file_name(one.name), one);
  if (consistency.channels.size() != 1) add("together", consistency.all);
  section.tables.push_back(std::move(channels));
  if (consistency.all.stretches.empty()) return section;
  Table stretches{"How far the innovations of a stretch add up, 1 where they are independent",
                  {"Stretch", "Factor", "95 % of white noise", "Stretches"},
                  {}};
  for (const StretchScatter& one : consistency.all.stretches)
    stretches.rows.push_back({duration_words(one.length_s), fixed(one.factor, 3),
                              fixed(one.lower, 3) + " … " + fixed(one.upper, 3),
                              grouped(one.stretches)});
  section.tables.push_back(std::move(stretches));
  return section;
}

}  // namespace proofmass::report
