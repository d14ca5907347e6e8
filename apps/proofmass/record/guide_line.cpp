#include "record/guide_line.hpp"

#include <cmath>
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

Array numbers(const Eigen::Vector3d& values) {
  return {values[0], values[1], values[2]};
}

Value figures_of(const std::optional<calibrate::GuideFigures>& figures) {
  if (!figures) return {};
  return Object{{"bias_g", numbers(figures->bias_g)},
                {"bias_std_g", numbers(figures->bias_std_g)},
                {"scale", numbers(figures->scale)},
                {"scale_std", numbers(figures->scale_std)},
                {"angles_rad", numbers(figures->angles_rad)},
                {"angles_std_rad", numbers(figures->angle_std_rad)}};
}

// To three digits, enough for a picture that is sent five times a second.
double rounded(double value) {
  if (!(value > 0.0)) return value;
  const double unit = std::pow(10.0, 2.0 - std::floor(std::log10(value)));
  return std::round(value * unit) / unit;
}

Array rows_of(const Eigen::MatrixXd& map) {
  Array rows;
  for (Eigen::Index i = 0; i < map.rows(); ++i) {
    Array row;
    for (Eigen::Index k = 0; k < map.cols(); ++k) row.push_back(rounded(map(i, k)));
    rows.push_back(std::move(row));
  }
  return rows;
}

Value maps_of(const std::optional<calibrate::GuideMaps>& maps) {
  if (!maps) return {};
  return Object{{"plus_z_g", rows_of(maps->plus_z_g)},
                {"minus_z_g", rows_of(maps->minus_z_g)},
                {"largest_g", maps->largest_g}};
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
                                  {"next_gain", or_null(picture.next_gain)},
                                  {"figures", figures_of(picture.figures)},
                                  {"maps", maps_of(picture.maps)},
                                  {"can_repeat", live.can_repeat},
                                  {"errors_g", report::array_of(context.errors_g)},
                                  {"pose_count", std::uint64_t{guide.poses().size()}},
                                  {"poses", poses_of(picture)},
                                  {"is_done", context.is_done}});
}

}  // namespace proofmass::app
