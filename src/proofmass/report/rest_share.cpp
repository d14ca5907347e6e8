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
        "Not at rest at any time in this recording: the figures are of the motion, not of the "
        "sensor's {}.",
        what);
  }
  return fmt::format(
      "Not at rest: {} % of this recording is. The figures are of the motion, not of the sensor's "
      "{}; its longest rest is --from {} --to {}.",
      significant(100.0 * rest->share, 2), what, fixed(rest->longest_start_s, 2),
      fixed(rest->longest_end_s, 2));
}

std::string motion_sentence_of_channels(const std::string& names) {
  return "Not at rest (" + names + "): the figures are of the motion.";
}

Value rest_value(const std::optional<RestShare>& rest) {
  if (!rest) return nullptr;
  return Object{{"share", rest->share},
                {"at_rest", rest->is_at_rest()},
                {"longest", has_rest(*rest) ? Value(Object{{"start_s", rest->longest_start_s},
                                                           {"end_s", rest->longest_end_s}})
                                            : Value()}};
}

std::string rest_null_reason(const std::optional<RestShare>& rest) {
  if (!rest) return "rest: null: a quantity that shows no motion, too short, or analysed in pieces";
  if (!has_rest(*rest)) return "rest: longest: null: the recording is not at rest at any time";
  return {};
}

}  // namespace proofmass::report
