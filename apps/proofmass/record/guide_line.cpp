#include "record/guide_line.hpp"

#include <optional>

#include "proofmass/report/json.hpp"

namespace proofmass::app {
namespace {

using report::Array;
using report::Object;
using report::or_null;
using report::Value;

Value direction(const std::optional<Eigen::Vector3d>& up) {
  if (!up) return {};
  return Array{(*up)[0], (*up)[1], (*up)[2]};
}

const char* word_of(signal::RestPhase phase) {
  switch (phase) {
    case signal::RestPhase::listening:
      return "listening";
    case signal::RestPhase::moving:
      return "moving";
    case signal::RestPhase::settling:
      return "settling";
    case signal::RestPhase::stuck:
      return "stuck";
    case signal::RestPhase::resting:
      break;
  }
  return "resting";
}

Array poses_of(const calibrate::GuidePicture& picture) {
  Array out;
  std::int64_t number = 0;
  for (const calibrate::PlacedPose& pose : picture.poses)
    out.push_back(Object{{"number", ++number},
                         {"words", pose.words},
                         {"up", direction(pose.up)},
                         {"residual_g", or_null(pose.residual_g)},
                         {"residual_std_g", or_null(pose.residual_std_g)},
                         {"is_suspect", pose.suspect}});
  return out;
}

}  // namespace

std::string guide_line(const calibrate::PoseGuide& guide, const GuideContext& context) {
  constexpr double g_per_mg = 1e-3;
  const calibrate::GuidePicture picture = guide.picture();
  const calibrate::GuideLive live = guide.live();
  return report::json_text(Object{{"procedure", context.procedure},
                                  {"prompt", picture.prompt},
                                  {"said", context.said},
                                  {"live", live.words},
                                  {"phase", word_of(live.phase)},
                                  {"hold_fraction", or_null(picture.held)},
                                  {"now", direction(picture.now)},
                                  {"next", direction(picture.next)},
                                  {"error_g", or_null(picture.error_g)},
                                  {"target_g", g_per_mg * context.target_mg},
                                  {"errors_g", report::array_of(context.errors_g)},
                                  {"pose_count", std::uint64_t{guide.poses().size()}},
                                  {"poses", poses_of(picture)},
                                  {"is_done", context.is_done}});
}

}  // namespace proofmass::app
