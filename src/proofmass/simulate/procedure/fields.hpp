#pragma once

#include <array>
#include <cmath>
#include <string>

#include "proofmass/core/units.hpp"
#include "proofmass/simulate/procedure.hpp"

// Every key of a procedure's description, once: visit(key, member, unit of the file in SI,
// comment). To add a key, add a line here; reading, writing and the check for finite numbers
// follow. Sections that rig/fields.hpp has too ([daq]) are visited by its functions.
namespace proofmass::simulate {

template <class Options, class Visit>
void visit_procedure(Options& o, Visit&& visit) {
  visit("procedure", o.procedure, 1.0,
        "\"tumble\", \"four-position\", \"six-position\", \"multi-position\" or \"slide\"");
  visit("seed", o.seed, 1.0, "same seed, same numbers");
  visit("session", o.session, 1.0, "another one: same sensor and table, other noise and hand");
  visit("rate_hz", o.rate_hz, 1.0, "samples a second");
  visit("gravity_mps2", o.gravity_mps2, 1.0, "of the place");
  visit("output", o.output, 1.0, "\"acceleration\" (m/s²), \"voltage\" or \"counts\"");
  visit("labelled", o.labelled, 1.0, "a column of words that names the rests");
}

template <class Timing, class Visit>
void visit_timing(Timing& t, Visit&& visit) {
  visit("dwell_s", t.dwell_s, 1.0, "from standing to the next move");
  visit("move_s", t.move_s, 1.0, "from one position to the next");
  visit("dwell_jitter", t.dwell_jitter, 1.0, "uniform within ± this fraction");
  visit("move_jitter", t.move_jitter, 1.0, "uniform within ± this fraction");
  visit("settle_s", t.settle_s, 1.0, "of the dwell: a decaying oscillation, then exact rest");
  visit("settle_mps2", t.settle_mps2, 1.0, "largest oscillation");
  visit("settle_hz", t.settle_hz, 1.0, "of the oscillation");
}

template <class Table, class Visit>
void visit_table(Table& t, Visit&& visit) {
  visit("input_axis", t.input_axis, 1.0, "of the sensor, which sees g sin(angle): x, y or z");
  visit("positions", t.positions, 1.0, "evenly over a turn");
  visit("closing", t.closing, 1.0, "the first position once more at the end of a turn");
  visit("planes", t.planes, 1.0, "up to this: 1, or 2 with the output axis in the plane");
  visit("first_plane", t.first_plane, 1.0, "1 or 2");
  visit("backward", t.backward, 1.0, "each turn is followed by one the other way");
  visit("turned", t.turned, 1.0, "the sensor is mounted turned by 180 degrees on the table");
  visit("remounted", t.remounted, 1.0, "and each plane again, mounted the other way");
  visit("remount_s", t.remount_s, 1.0, "that this takes, and a change of plane");
  visit("zero_error_deg", t.zero_error_rad, rad_per_deg, "of its scale ...");
  visit("once_deg", t.once_rad, rad_per_deg, "... once per turn, amplitude ...");
  visit("once_phase_deg", t.once_phase_rad, rad_per_deg, "... where it is greatest ...");
  visit("twice_deg", t.twice_rad, rad_per_deg, "... twice per turn, amplitude ...");
  visit("twice_phase_deg", t.twice_phase_rad, rad_per_deg, "... twice where it is greatest ...");
  visit("position_std_deg", t.position_std_rad, rad_per_deg,
        "... of each position, repeatable ...");
  visit("setting_std_deg", t.setting_std_rad, rad_per_deg, "... of each setting, not ...");
  visit("backlash_deg", t.backlash_rad, rad_per_deg, "... between forward and backward");
  visit("axis_tilt_deg", t.axis_tilt_rad, rad_per_deg, "of its axis above the horizontal");
  visit("mounting_std_deg", t.mounting_std_rad, rad_per_deg, "of each mounting, about each axis");
  visit("radius_m", t.radius_m, 1.0, "of the sensor from the table's axis");
  visit("vibration_mps2", t.vibration_mps2, 1.0, "rms while it moves");
  visit("angle_recorded", t.angle_recorded, 1.0, "the commanded angle, as a channel \"angle\" ...");
  visit("angle_follows", t.angle_follows, 1.0,
        "... which moves with the table; else it steps ahead of it");
}

template <class Hand, class Visit>
void visit_hand(Hand& h, Visit&& visit) {
  visit("poses", h.poses, 1.0, "of multi-position, well spread");
  visit("initial_rest_s", h.initial_rest_s, 1.0, "lying with z up before them; 0 = none");
  visit("placement_std_deg", h.placement_std_rad, rad_per_deg, "about two axes");
  visit("lift_m", h.lift_m, 1.0, "up and down again in each move");
  visit("sway_rms_mps2", h.sway_rms_mps2, 1.0, "up to 3 Hz");
  visit("tremor_rms_mps2", h.tremor_rms_mps2, 1.0, "8 to 12 Hz");
  visit("wobble_rms_deg", h.wobble_rms_rad, rad_per_deg, "about the shortest turn, up to 2 Hz");
  visit("bump_mps2", h.bump_mps2, 1.0, "of setting it down, and of some shocks");
  visit("bad_pose", h.bad_pose, 1.0, "number of a position that is disturbed; 0 = none");
  visit("bad_pose_push_mg", h.bad_pose_push_mps2, 1e-3 * standard_gravity_mps2,
        "by which the force is then too large");
}

template <class Supply, class Visit>
void visit_bench_supply(Supply& s, Visit&& visit) {
  visit("reference_v", s.reference_v, 1.0, "by which an output in m/s² is computed");
  visit("actual_v", s.actual_v, 1.0, "of the ratiometric sensor");
  visit("recorded", s.recorded, 1.0, "as a channel \"supply\"");
}

/// The coefficients of the model equation, in the standard's units; K1 and K0 are scale and bias.
template <class Sensor, class Visit>
void visit_coefficients(Sensor& s, Visit&& visit) {
  for (const sensor::CoefficientInfo& info : sensor::coefficients()) {
    if (info.coefficient == sensor::Coefficient::K1 || info.coefficient == sensor::Coefficient::K0)
      continue;
    Axes values{s.equation[0].*info.member, s.equation[1].*info.member, s.equation[2].*info.member};
    const std::string why =
        std::string(info.description) + " [" + std::string(info.standard_unit) + "]";
    visit(info.name, values, std::pow(standard_gravity_mps2, -info.power_of_g), why);
    if constexpr (!std::is_const_v<Sensor>)
      for (std::size_t axis = 0; axis < 3; ++axis) s.equation[axis].*info.member = values[axis];
  }
}

template <class Sensor, class Visit>
void visit_bench_sensor(Sensor& s, Visit&& visit) {
  visit("bias_mps2", s.bias_mps2, 1.0, "x, y, z");
  visit("scale", s.scale, 1.0, "reading per force");
  visit("misalignment_deg", s.misalignment_rad, rad_per_deg, "of the axes yz, zy, zx from square");
  visit("bias_spread_mps2", s.bias_spread_mps2, 1.0,
        "adds a uniform draw within ± this to each bias");
  visit("scale_spread", s.scale_spread, 1.0, "... and within ± this fraction to each scale");
  visit("misalignment_spread_deg", s.misalignment_spread_rad, rad_per_deg, "... and to each angle");
  visit_coefficients(s, visit);
  visit("full_scale_mps2", s.full_scale_mps2, 1.0, "either way; it clips here");
  visit("noise_rms_mps2", s.noise_rms_mps2, 1.0, "of each sample, independent");
  visit("flicker_mps2", s.flicker_mps2, 1.0, "bias instability B");
  visit("bias_walk_mps2_rts", s.bias_walk_mps2_rts, 1.0, "random walk of the bias in one second");
  visit("warm_up_mps2", s.warm_up_mps2, 1.0, "exponential rise of the bias ...");
  visit("warm_up_time_s", s.warm_up_time_s, 1.0, "... with this time constant");
  visit("ramp_mps2ps", s.ramp_mps2ps, 1.0, "steady drift of the bias");
  visit("sensitivity_v_per_mps2", s.sensitivity_v_per_mps2, 1.0, "at the reference supply");
  visit("zero_g_fraction", s.zero_g_fraction, 1.0, "of the supply");
  visit("scale_per_v", s.scale_per_v, 1.0, "change beyond the ratiometric one ...");
  visit("bias_per_v_mps2pv", s.bias_per_v_mps2pv, 1.0, "... per volt above the reference");
}

}  // namespace proofmass::simulate
