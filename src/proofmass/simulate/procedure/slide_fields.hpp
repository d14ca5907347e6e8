#pragma once

#include "proofmass/core/units.hpp"
#include "proofmass/simulate/slide.hpp"

// Every key of [slide] in a procedure's description: see procedure/fields.hpp.
namespace proofmass::simulate {

template <class Slide, class Visit>
void visit_slide(Slide& s, Visit&& visit) {
  visit("strokes", s.strokes, 1.0, "or sets of them, each followed by a rest");
  visit("repetitions", s.repetitions, 1.0, "0: a stroke is one way; n: there and back n times");
  visit("returning", s.returning, 1.0, "one-way strokes go there and back in turn");
  visit("length_m", s.length_m, 1.0, "of a stroke; its time is timing.move_s");
  visit("length_jitter", s.length_jitter, 1.0, "uniform within ± this fraction");
  visit("turn_pause_s", s.turn_pause_s, 1.0, "between there and back");
  visit("initial_rest_s", s.initial_rest_s, 1.0, "before all; those between are timing.dwell_s");
  visit("final_rest_s", s.final_rest_s, 1.0, "after all");
  visit("profile", s.profile, 1.0, "\"minimum-jerk\" or \"harmonic\"");
  visit("elevation_deg", s.elevation_rad, rad_per_deg, "of the line above the horizontal");
  visit("roll_deg", s.roll_rad, rad_per_deg, "how the sensor stands on the carriage ...");
  visit("pitch_deg", s.pitch_rad, rad_per_deg, "...");
  visit("yaw_deg", s.yaw_rad, rad_per_deg, "... of which x points along the line's ground track");
  visit("any_mounting", s.any_mounting, 1.0, "the seed draws it instead");
  visit("turn_std_deg", s.turn_std_rad, rad_per_deg, "of each rest, about each axis");
  visit("wobble_rms_deg", s.wobble_rms_rad, rad_per_deg, "while it moves, up to 2 Hz");
  visit("vibration_mps2", s.vibration_mps2, 1.0, "rms while it moves, 8 to 12 Hz");
  visit("gravity_removed", s.gravity_removed, 1.0, "from the recording, as phones do");
  visit("gyro", s.gyro, 1.0, "channels gyro_x, gyro_y, gyro_z");
  visit("gyro_bias_degps", s.gyro_bias_radps, rad_per_deg, "x, y, z");
  visit("gyro_bias_spread_degps", s.gyro_bias_spread_radps, rad_per_deg,
        "adds a uniform draw within ± this to each");
  visit("gyro_noise_rms_degps", s.gyro_noise_rms_radps, rad_per_deg, "of each sample");
  visit("gyro_walk_degps_rts", s.gyro_walk_radps_rts, rad_per_deg,
        "random walk of the bias in one second");
  visit("second_sensor", s.second_sensor, 1.0, "channels acc2_x, acc2_y, acc2_z");
  visit("second_place_m", s.second_place_m, 1.0, "of it, in the first one's axes");
}

}  // namespace proofmass::simulate
