#include "proofmass/estimate/motor/identify.hpp"

#include <algorithm>
#include <utility>

#include "proofmass/estimate/motor/prepare.hpp"

namespace proofmass::estimate::motor {
namespace {

constexpr int rounds = 3;
constexpr std::size_t least_moving = 100;

/// The motor's speed by its back-EMF, through the local cubic over 25 ms.
MotorSpeed speed_by_back_emf(const Series& series, const ElectricalFit& electrical) {
  constexpr double window_s = 0.025;
  const Eigen::VectorXd speed = electrical.speed_terms * electrical.value;
  const std::vector<double> raw{speed.data(), speed.data() + speed.size()};
  const std::size_t half = half_window(window_s, series.step_s);
  return {smoothed(raw, series.step_s, window_s), slope_noise(half) * sample_noise(raw), half};
}

Status enough(const Motion& motion, const char* why_not) {
  if (moving_samples(motion) >= least_moving) return Done{};
  return Error{Errc::not_observable, why_not};
}

}  // namespace

std::size_t moving_samples(const Motion& motion) {
  return motion.contact.size() -
         static_cast<std::size_t>(std::ranges::count(motion.contact, std::int8_t{0}));
}

Result<Identified> identify(const MotorRecord& record,
                            const MotorOptions& options,
                            ElectricalStart start) {
  Result<Series> prepared = prepare(record, options);
  if (!prepared) return prepared.error();
  Series series = std::move(prepared).value();
  Motion motion = motion_of_load(series);
  const Status moves = enough(motion, "the load hardly moves: nothing shows the drive");
  if (!moves) return moves.error();
  if (!series.has_current()) {
    Result<MechanicalFit> mechanical = fit_without_current(series, motion);
    if (!mechanical) return mechanical.error();
    return Identified{std::move(series), std::move(motion), std::nullopt,
                      std::move(mechanical).value()};
  }
  subtract_current_offset(motion, series);
  std::optional<ElectricalFit> electrical;
  start.resistance_per_constant = resistance_per_constant(series, motion);
  for (int round = 0; round < rounds; ++round) {
    electrical = fit_electrical(series, motion, start);
    start = electrical->next;
    const double gap_rad =
        2.0 *
        std::max(electrical->half_backlash_rad + 2.0 * electrical->half_backlash_std_rad, 0.0);
    motion = motion_of_motor(series, electrical->motor_angle_rad, electrical->load_angle_rad,
                             speed_by_back_emf(series, *electrical), gap_rad);
    const Status bears = enough(motion,
                                "the flank that the gear bears on is hardly ever known: "
                                "change the voltage gradually, and brake gently");
    if (!bears) return bears.error();
  }
  Result<MechanicalFit> mechanical = fit_with_current(series, motion, *electrical);
  if (!mechanical) return mechanical.error();
  return Identified{std::move(series), std::move(motion), std::move(electrical),
                    std::move(mechanical).value()};
}

}  // namespace proofmass::estimate::motor
