#include "proofmass/simulate/procedure/pose_plan.hpp"

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <utility>

#include "proofmass/core/directions.hpp"
#include "proofmass/core/random.hpp"
#include "proofmass/simulate/procedure/slide_motion.hpp"

namespace proofmass::simulate {
namespace {

/// The table's scale: its error at each position, in the order of setting.
class IndexedTable {
 public:
  explicit IndexedTable(const ProcedureOptions& options)
      : table_(options.table), setting_(session_seed(options), "setting of the table") {
    Random random(options.seed, "positions of the table");
    for (int k = 0; k < table_.positions; ++k)
      position_error_rad_.push_back(table_.position_std_rad * random.normal());
  }

  double commanded_rad(int k) const {
    return rad_per_turn * static_cast<double>(k) / static_cast<double>(table_.positions);
  }
  double true_rad(int k, bool forward) {
    const double c = commanded_rad(k);
    const int position = k % table_.positions;
    return c + table_.zero_error_rad + table_.once_rad * std::cos(c - table_.once_phase_rad) +
           table_.twice_rad * std::cos(2.0 * c - table_.twice_phase_rad) +
           position_error_rad_[static_cast<std::size_t>(position)] +
           table_.setting_std_rad * setting_.normal() +
           (forward ? -0.5 : 0.5) * table_.backlash_rad;
  }

 private:
  const ProcedureTable& table_;
  Random setting_;
  std::vector<double> position_error_rad_;
};

/// Mounting of the sensor on the table: see ProcedureTable; then a small rotation about its own
/// axes.
Eigen::Matrix3d mounted(const ProcedureTable& table,
                        int plane,
                        double mount_rad,
                        const Eigen::Vector3d& error_rad) {
  const auto i = static_cast<Eigen::Index>(table.input_axis);
  const Eigen::Index p = (i + 1) % 3, o = (i + 2) % 3;
  Eigen::Matrix3d R = Eigen::Matrix3d::Zero();
  R(i, 0) = 1.0;
  R(plane == 1 ? p : o, 1) = 1.0;
  R(plane == 1 ? o : p, 2) = plane == 1 ? 1.0 : -1.0;
  if (mount_rad != 0.0) R = R * Eigen::Vector3d(-1.0, -1.0, 1.0).asDiagonal();
  const double angle = error_rad.norm();
  if (angle == 0.0) return R;
  return Eigen::AngleAxisd(angle, error_rad / angle).toRotationMatrix() * R;
}

std::vector<PlannedPose> table_poses(const ProcedureOptions& options) {
  const ProcedureTable& table = options.table;
  IndexedTable indexed(options);
  Random mounting(session_seed(options), "mounting on the table");
  std::vector<PlannedPose> poses;
  const int last = table.closing ? table.positions : table.positions - 1;
  const auto tumble = [&](int plane, double mount_rad) {
    const Eigen::Vector3d error(mounting.normal(), mounting.normal(), mounting.normal());
    PlannedPose pose{
        .force_mps2 = options.gravity_mps2,
        .plane = plane,
        .mount_rad = mount_rad,
        .R_sensor_table = mounted(table, plane, mount_rad, table.mounting_std_rad * error)};
    const auto set = [&](int k, bool forward) {
      pose.commanded_rad = indexed.commanded_rad(k);
      pose.angle_rad = indexed.true_rad(k, forward);
      pose.up = pose.R_sensor_table * up_on_table(pose.angle_rad, table.axis_tilt_rad);
      poses.push_back(pose);
      pose.turned_here = true;
    };
    for (int k = 0; k <= last; ++k) set(k, true);
    for (int k = last - 1; table.backward && k >= 0; --k) set(k, false);
  };
  constexpr double half_turn = std::numbers::pi;
  for (int plane = table.first_plane; plane <= table.planes; ++plane) {
    tumble(plane, table.turned ? half_turn : 0.0);
    if (table.remounted) tumble(plane, table.turned ? 0.0 : half_turn);
  }
  return poses;
}

/// A direction as positioned by hand: with a normal error about each of the two axes perpendicular
/// to it.
Eigen::Vector3d placed(const Eigen::Vector3d& direction, double std_rad, Random& random) {
  const Eigen::Vector3d across = direction.unitOrthogonal();
  const double first = random.normal(), second = random.normal();
  return (direction + std_rad * (first * across + second * direction.cross(across))).normalized();
}

std::vector<Eigen::Vector3d> directions_of(const ProcedureOptions& options) {
  if (options.procedure == Procedure::six_position) {
    const Eigen::Vector3d x = Eigen::Vector3d::UnitX(), y = Eigen::Vector3d::UnitY(),
                          z = Eigen::Vector3d::UnitZ();
    return {x, -x, y, -y, z, -z};
  }
  auto directions = spread_directions(static_cast<std::size_t>(options.hand.poses));
  Random random(session_seed(options), "order of the positions");
  for (std::size_t left = directions.size(); left > 1; --left) {
    const double share = 0.5 * (random.uniform() + 1.0);
    const auto k = static_cast<std::size_t>(share * static_cast<double>(left));
    std::swap(directions[k], directions[left - 1]);
  }
  return directions;
}

std::vector<PlannedPose> hand_poses(const ProcedureOptions& options) {
  const ProcedureHand& hand = options.hand;
  std::vector<Eigen::Vector3d> directions = directions_of(options);
  if (hand.initial_rest_s > 0.0) directions.insert(directions.begin(), Eigen::Vector3d::UnitZ());
  Random random(session_seed(options), "placing by hand");
  std::vector<PlannedPose> poses;
  for (const Eigen::Vector3d& direction : directions) {
    const bool is_bad = static_cast<int>(poses.size()) + 1 == hand.bad_pose;
    poses.push_back(
        {.up = placed(direction, hand.placement_std_rad, random),
         .force_mps2 = options.gravity_mps2 + (is_bad ? hand.bad_pose_push_mps2 : 0.0)});
  }
  return poses;
}

void set_times(const ProcedureOptions& options, std::vector<PlannedPose>& poses) {
  const ProcedureTiming& timing = options.timing;
  Random dwell(session_seed(options), "dwell"), move(session_seed(options), "move");
  double now_s = 0.0;
  for (std::size_t k = 0; k < poses.size(); ++k) {
    PlannedPose& pose = poses[k];
    const double move_s = timing.move_s * (1.0 + timing.move_jitter * move.uniform());
    const double dwell_s = timing.dwell_s * (1.0 + timing.dwell_jitter * dwell.uniform());
    if (k > 0) {
      const bool remounted = is_on_table(options.procedure) && !pose.turned_here;
      now_s += remounted ? options.table.remount_s : move_s;
    }
    pose.stand_s = now_s;
    pose.rest_s = k == 0 ? now_s : now_s + timing.settle_s;
    const bool is_long =
        k == 0 && !is_on_table(options.procedure) && options.hand.initial_rest_s > 0.0;
    now_s += is_long ? options.hand.initial_rest_s : dwell_s;
    pose.end_s = now_s;
  }
}

}  // namespace

std::uint64_t session_seed(const ProcedureOptions& options) {
  // Random mixes its seed, so any increment gives a different stream.
  return options.seed + 0x9E3779B97F4A7C15U * options.session;
}

bool is_on_table(Procedure procedure) {
  return procedure == Procedure::tumble || procedure == Procedure::four_position;
}

Eigen::Vector3d up_on_table(double angle_rad, double axis_tilt_rad) {
  const double level = std::cos(axis_tilt_rad);
  return {std::sin(angle_rad) * level, std::cos(angle_rad) * level, std::sin(axis_tilt_rad)};
}

std::vector<PlannedPose> plan_poses(const ProcedureOptions& options) {
  if (options.procedure == Procedure::slide) return SlideMotion(options).rests();
  std::vector<PlannedPose> poses =
      is_on_table(options.procedure) ? table_poses(options) : hand_poses(options);
  set_times(options, poses);
  return poses;
}

std::vector<TruePose> true_poses(const std::vector<PlannedPose>& plan) {
  std::vector<TruePose> poses;
  poses.reserve(plan.size());
  for (const PlannedPose& p : plan)
    poses.push_back({.number = poses.size() + 1,
                     .start_s = p.rest_s,
                     .end_s = p.end_s,
                     .force_mps2 = p.force_mps2 * p.up,
                     .plane = p.plane,
                     .mount_rad = p.mount_rad,
                     .commanded_rad = p.commanded_rad,
                     .angle_rad = p.angle_rad});
  return poses;
}

}  // namespace proofmass::simulate
