#include "proofmass/report/rest_share.hpp"

#include <fmt/format.h>

#include "proofmass/report/wording.hpp"

namespace proofmass::report {
namespace {

bool has_rest(const RestShare& rest) {
  return rest.longest_end_s > rest.longest_start_s;
}

}  // namespace

std::string motion_sentence(const std::optional<RestShare>& rest, std::string_view what) {
  if (!rest || rest->is_at_rest()) return {};
  if (!has_rest(*rest)) {
    return fmt::format(
        "Not at rest at any time in this recording: the figures describe the motion, not the "
        "sensor's {}.",
        what);
  }
  return fmt::format(
      "Not at rest: only {} % of this recording is. The figures describe the motion, not the "
      "sensor's {}; the longest rest is --from {} --to {}.",
      significant(100.0 * rest->share, 2), what, fixed(rest->longest_start_s, 2),
      fixed(rest->longest_end_s, 2));
}

std::string motion_sentence_of_channels(const std::string& names) {
  return "Not at rest (" + names + "): the figures describe the motion.";
}

Field rest_field(const std::optional<RestShare>& rest) {
  std::optional<Fields> fields;
  if (rest) {
    std::optional<Fields> longest;
    if (has_rest(*rest))
      longest = Fields{field::number("start_s", rest->longest_start_s),
                       field::number("end_s", rest->longest_end_s)};
    fields =
        Fields{field::probability("share", rest->share, {.meaning = "at rest, 0 to 1"}),
               field::flag("at_rest", rest->is_at_rest()),
               field::object_or_null("longest", std::move(longest),
                                     {.why_null = "the recording is not at rest at any time"})};
  }
  return field::object_or_null(
      "rest", std::move(fields),
      {.meaning = "how much of the recording is at rest",
       .why_null = "not determined: the quantity does not show motion, or the recording is too "
                   "short or was analysed in pieces"});
}

}  // namespace proofmass::report
