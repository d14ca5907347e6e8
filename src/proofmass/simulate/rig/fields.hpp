#pragma once

#include "proofmass/core/units.hpp"
#include "proofmass/simulate/rig.hpp"

// Every key of a rig's description, once: visit(key, member, unit of the file in SI, comment). To
// add a key, add a line here; reading, writing and the check for finite numbers follow.
namespace proofmass::simulate {

template <class Options, class Visit>
void visit_general(Options& o, Visit&& visit) {
  visit("seed", o.seed, 1.0, "same seed, same numbers");
  visit("rate_hz", o.rate_hz, 1.0, "scans a second");
  visit("gravity_mps2", o.gravity_mps2, 1.0, "at the rig");
  visit("axes", o.axes, 1.0, "recorded of each sensor: 2 or 3");
  visit("output", o.output, 1.0, "\"acceleration\" (m/s²), \"voltage\" or \"counts\"");
  visit("bias_spread_mps2", o.bias_spread_mps2, 1.0,
        "adds a uniform draw within ± this to every bias");
  visit("datasheet_errors", o.datasheet_errors, 1.0,
        "draws misalignment, cross-axis, scale, nonlinearity within the ADXL335's limits");
}

template <class Wheel, class Visit>
void visit_wheel(Wheel& w, Visit&& visit) {
  visit("start_angle_deg", w.start_angle_rad, rad_per_deg,
        "of the mark on the wheel; 0 = horizontal");
  visit("axle_tilt_deg", w.axle_tilt_rad, rad_per_deg, "of the spin axis above the horizontal");
  visit("rolling_radius_m", w.rolling_radius_m, 1.0,
        "of a wheel that rolls on the ground; 0 = hub at rest");
  visit("shake_horizontal_rms_mps2", w.shake_horizontal_rms_mps2, 1.0, "of the hub");
  visit("shake_vertical_rms_mps2", w.shake_vertical_rms_mps2, 1.0, "of the hub");
  visit("shake_bandwidth_hz", w.shake_bandwidth_hz, 1.0, "even spectrum up to here");
}

template <class Ripple, class Visit>
void visit_ripple(Ripple& r, Visit&& visit) {
  visit("fraction", r.fraction, 1.0, "of the speed, at the crest of one sine ...");
  visit("order", r.order, 1.0, "... of so many cycles per revolution, phase by the seed");
  visit("random_fraction_rms", r.random_fraction_rms, 1.0, "of the speed, as noise ...");
  visit("random_max_order", r.random_max_order, 1.0, "... up to so many cycles per revolution");
}

template <class Supply, class Visit>
void visit_supply(Supply& s, Visit&& visit) {
  visit("nominal_v", s.nominal_v, 1.0, "of the ratiometric sensors");
  visit("ripple_rms_v", s.ripple_rms_v, 1.0, "as one sine ...");
  visit("ripple_hz", s.ripple_hz, 1.0, "... of this frequency, phase by the seed");
  visit("recorded", s.recorded, 1.0, "as a channel \"supply\"");
}

template <class Daq, class Visit>
void visit_daq(Daq& d, Visit&& visit) {
  visit("bits", d.bits, 1.0, "0 = neither steps nor limits; the USB-6009 has 14");
  visit("min_v", d.min_v, 1.0, "lower end of its range");
  visit("max_v", d.max_v, 1.0, "upper end");
  visit("skew_s", d.skew_s, 1.0, "from one channel of a scan to the next; the USB-6009: 2.0833e-5");
}

template <class Segment, class Visit>
void visit_segment(Segment& s, Visit&& visit) {
  visit("duration_s", s.duration_s, 1.0, "with its ramp");
  visit("speed_rpm", s.speed_radps, radps_per_rpm, "0 = rest, negative = the other way");
  visit("ramp_s", s.ramp_s, 1.0, "from the speed before (at first: from rest); 0 = a step");
}

template <class Sensor, class Visit>
void visit_sensor(Sensor& s, Visit&& visit) {
  visit("radius_m", s.radius_m, 1.0, "from the axle");
  visit("position_deg", s.position_rad, rad_per_deg, "about the axle, from the mark");
  visit("mounting_deg", s.mounting_rad, rad_per_deg, "of its x axis from the mark's spoke");
  visit("tilt_y_deg", s.tilt_y_rad, rad_per_deg,
        "of its z axis against the axle, about its y axis ...");
  visit("tilt_x_deg", s.tilt_x_rad, rad_per_deg, "... and about its x axis");
  visit("bias_mps2", s.bias_mps2, 1.0, "x, y, z");
  visit("scale", s.scale, 1.0, "reading per force");
  visit("misalignment_deg", s.misalignment_rad, rad_per_deg, "of the axes yz, zy, zx from square");
  visit("cross_axis", s.cross_axis, 1.0, "xy, xz, yx, yz, zx, zy: of the second in the first");
  visit("nonlinearity", s.nonlinearity, 1.0, "fraction of full scale, at full scale");
  visit("full_scale_mps2", s.full_scale_mps2, 1.0, "either way; it clips here");
  visit("warm_up_mps2", s.warm_up_mps2, 1.0, "exponential rise of the bias ...");
  visit("warm_up_time_s", s.warm_up_time_s, 1.0, "... with this time constant");
  visit("noise_rms_mps2", s.noise_rms_mps2, 1.0, "of each sample, independent");
  visit("noise_density_mps2_rthz", s.noise_density_mps2_rthz, 1.0,
        "one-sided, before the filter; adds to the above");
  visit("bandwidth_hz", s.bandwidth_hz, 1.0, "-3 dB of the one-pole RC filter");
  visit("filter_signal", s.filter_signal, 1.0,
        "the filter delays the signal too, not the noise alone");
  visit("bias_walk_mps2_rts", s.bias_walk_mps2_rts, 1.0, "random walk of the bias in one second");
  visit("sensitivity_v_per_mps2", s.sensitivity_v_per_mps2, 1.0, "at the nominal supply");
  visit("zero_g_fraction", s.zero_g_fraction, 1.0, "of the supply");
}

}  // namespace proofmass::simulate
