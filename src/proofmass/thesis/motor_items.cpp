#include "proofmass/thesis/motor_items.hpp"

#include <array>
#include <fmt/format.h>
#include <numbers>
#include <optional>
#include <string>
#include <utility>

#include "proofmass/core/units.hpp"
#include "proofmass/report/wording.hpp"

namespace proofmass::thesis {
namespace {

using report::fixed;
using report::significant;

// As the thesis prints them.
constexpr double wheel_diameter_m = 0.30, printed_torque_nm = 0.32;
constexpr double slow_radps = 11.0 * radps_per_rpm;
constexpr double sensor_radius_m = 0.1;  // 3.1.2
constexpr std::array speeds_rpm{8.0, 11.0, 14.0, 16.0, 18.0, 21.0};

// Exact, but for the horsepower, which is 550 ft lbf/s to eight digits.
constexpr double inch_pound_nm = 4.4482216152605 * 0.0254, horsepower_w = 745.69987;

// The motor's plate, A.2.1: at full load, and what goes in there.
constexpr double rated_torque_nm = 220.0 * inch_pound_nm, rated_radps = 31.0 * radps_per_rpm;
constexpr double rated_v = 90.0, rated_a = 1.27, plate_w = horsepower_w / 8.0;
constexpr double rated_w = rated_torque_nm * rated_radps, electric_w = rated_v * rated_a;

// Maximum power loss in the winding: the electric power that does not reach the gear; the rest of
// the 90 V is the back-EMF, which is proportional to the speed.
constexpr double back_emf_v = plate_w / rated_a;
constexpr double no_load_rpm = 31.0 * rated_v / back_emf_v;

// A bare disc of plywood of the wheel's diameter: the thesis does not say its thickness.
constexpr double board_m = 0.012, board_kgpm3 = 600.0, board_relative_std = 0.3;

constexpr double bare_disc_kgm2() {
  constexpr double r = 0.5 * wheel_diameter_m;
  return 0.5 * std::numbers::pi * r * r * board_m * board_kgpm3 * r * r;
}

struct Measure {
  const char* si_unit;
  ShownUnit shown;
};

const Measure length{"m", {"cm", 0.01}}, speed{"m/s", {"cm/s", 0.01}}, plain{"", {}},
    torque{"N*m", {"N m"}}, power{"W", {"W"}};

Finding exact(const char* key,
              const char* label,
              const Measure& measure,
              std::optional<double> printed,
              double ours) {
  return {.key = key,
          .label = label,
          .si_unit = measure.si_unit,
          .shown = measure.shown,
          .thesis = printed,
          .ours = Uncertain{ours}};
}

Finding absent(const char* key,
               const char* label,
               const Measure& measure,
               double printed,
               const char* reason) {
  return {.key = key,
          .label = label,
          .si_unit = measure.si_unit,
          .shown = measure.shown,
          .thesis = printed,
          .reason = reason};
}

std::vector<Finding> findings() {
  constexpr double rim_m = 0.5 * wheel_diameter_m, rim_mps = slow_radps * rim_m;
  constexpr double spin_up_nm = bare_disc_kgm2() * slow_radps / 1.0;
  return {
      exact("perimeter", "Way of the rim in one turn", length, 0.942, rad_per_turn * rim_m),
      exact("sensor_path", "Way of a sensor in one turn, at 0.1 m", length, {},
            rad_per_turn * sensor_radius_m),
      exact("rim_speed", "Speed of the rim at 11 rpm, which the thesis calls angular velocity",
            speed, 0.1726, rim_mps),
      exact("angular_velocity", "Angular velocity at 11 rpm", {"rad/s", {"rad/s"}}, {}, slow_radps),
      exact("degrees_in_a_radian", "Degrees in a radian", plain, 57.29578, 1.0 / rad_per_deg),
      exact("rpm_in_a_radian_per_second", "Turns per minute in 1 rad/s", plain, 9.55,
            1.0 / radps_per_rpm),
      exact("turns_in_a_radian", "Turns per second in 1 rad/s", plain, 0.159, 1.0 / rad_per_turn),
      absent("torque", "Torque of the motor", torque, printed_torque_nm,
             "Neither the mass of the wheel nor its friction is stated."),
      exact("imbalance_held",
            "Mass at the rim, at the height of the axle, that 0.32 N m would hold",
            {"kg", {"g", 1e-3}}, {}, printed_torque_nm / (standard_gravity_mps2 * rim_m)),
      {.key = "spin_up_torque",
       .label = "Torque that brings a bare disc of 12 mm plywood to 11 rpm in 1 s",
       .si_unit = "N*m",
       .shown = {"mN m", 1e-3},
       .ours = Uncertain{.value = spin_up_nm, .std = board_relative_std * spin_up_nm}},
      exact("expected_speed", "Speed with which the power is reckoned; ours: the rim at 11 rpm",
            speed, 0.066, rim_mps),
      absent("expected_speed_as_stated", "The same as first stated", speed, 3.0,
             "3 m/s is not 0.066 m/s: at the rim it is 191 rpm, six times what the motor does."),
      exact("power", "Power at 11 rpm with 0.32 N m", power, 0.0211,
            printed_torque_nm * slow_radps),
      exact("input_power", "Input of the motor at full load; ours: 90 V times 1.27 A", power,
            plate_w, electric_w),
      exact("rated_power", "Power at the shaft at full load, 220 in·lb at 31 rpm", power, {},
            rated_w)};
}

report::Table speeds() {
  report::Table table{.caption = "The wheel at the speeds of table A.1",
                      .head = {"rpm", "rad/s", "One turn (s)", "Rim (cm/s)", "Sensor (cm/s)",
                               "Rω² at the sensor (mg)", "Power with 0.32 N m (W)"},
                      .rows = {}};
  for (const double rpm : speeds_rpm) {
    const double w = rpm * radps_per_rpm;
    table.rows.push_back({fixed(rpm, 0), fixed(w, 3), fixed(rad_per_turn / w, 2),
                          fixed(100.0 * w * 0.5 * wheel_diameter_m, 1),
                          fixed(100.0 * w * sensor_radius_m, 1),
                          fixed(1e3 * w * w * sensor_radius_m / standard_gravity_mps2, 1),
                          fixed(printed_torque_nm * w, 2)});
  }
  return table;
}

// The speed falls by the same number of turns for each newton metre, whatever the voltage.
report::Curve motor_line(double no_load, report::Ink ink, report::Mark mark, std::string label) {
  const double fall = (no_load_rpm - 31.0) / rated_torque_nm;
  return {.label = std::move(label),
          .x = {0.0, rated_torque_nm},
          .y = {no_load, no_load - fall * rated_torque_nm},
          .ink = ink,
          .mark = mark};
}

report::Figure torque_figure() {
  const double fall = (no_load_rpm - 31.0) / rated_torque_nm;
  report::Figure figure{
      .title = "Torque and speed of the gear motor",
      .description = fmt::format(
          "A motor with a permanent magnet slows down along a straight line: from at most {} rpm "
          "without load to 31 rpm at full load. A lower voltage shifts the line. Were torque and "
          "speed inversely proportional, they would follow the dashed curve.",
          fixed(no_load_rpm, 0)),
      .x = {.label = "Torque (N m)", .min = 0.0, .max = 27.0},
      .y = {.label = "Speed (rpm)", .min = 0.0, .max = 45.0}};
  report::Curve inverse{.label = "Inversely proportional: 81 W",
                        .x = {},
                        .y = {},
                        .ink = report::Ink::orange,
                        .mark = report::Mark::dashes};
  for (double torque_nm = 18.0; torque_nm <= 27.0; torque_nm += 0.25) {
    inverse.x.push_back(torque_nm);
    inverse.y.push_back(rated_w / torque_nm / radps_per_rpm);
  }
  figure.curves = {motor_line(no_load_rpm, report::Ink::blue, report::Mark::line, "At 90 V"),
                   motor_line(21.0 + fall * printed_torque_nm, report::Ink::green,
                              report::Mark::line, "At the voltage for 21 rpm"),
                   motor_line(11.0 + fall * printed_torque_nm, report::Ink::purple,
                              report::Mark::line, "At the voltage for 11 rpm"),
                   std::move(inverse)};
  figure.callouts = {
      {.text = "full load",
       .x = rated_torque_nm,
       .y = 31.0,
       .ink = report::Ink::blue,
       .below = true,
       .left = true},
      {.text = "the wheel at 21 rpm", .x = printed_torque_nm, .y = 21.0, .ink = report::Ink::green},
      {.text = "the wheel at 11 rpm",
       .x = printed_torque_nm,
       .y = 11.0,
       .ink = report::Ink::purple}};
  return figure;
}

std::string note_words() {
  return fmt::format(
      "A radian has no length: revolutions times perimeter is the speed of the rim, and the "
      "sensors, at 0.1 m, go two thirds of that. Power is torque times angular velocity; 0.32 N "
      "m times a speed along the rim is no power, and 0.066 m/s would be {} rpm. Torque and "
      "speed of a motor with a permanent magnet are not inversely proportional: the speed falls "
      "along a straight line, from no load to standstill. 0.32 N m is {} % of the motor's full "
      "load: on this wheel it runs as good as unloaded, and the voltage alone sets the speed "
      "(full load would cost at most {} rpm, the wheel {}). The plate fits together: 114 W go "
      "in, 1/8 hp (93 W) reaches the gear, {} W the shaft. It draws 1.27 A at full load, so that "
      "the 2 to 7 A of table A.1 cannot be currents of this motor: they are settings of the "
      "controller. Use ω = 2π · rpm/60.",
      significant(0.066 / (0.5 * wheel_diameter_m) / radps_per_rpm, 2),
      fixed(100.0 * printed_torque_nm / rated_torque_nm, 1), fixed(no_load_rpm - 31.0, 0),
      fixed((no_load_rpm - 31.0) * printed_torque_nm / rated_torque_nm, 2), fixed(rated_w, 0));
}

}  // namespace

std::vector<Item> motor_items() {
  Item item{
      .id = "section A.2",
      .title = "Speed, torque and power of motor and wheel",
      .thesis =
          "The wheel of 30 cm has a perimeter of 94.2 cm; at 11 rpm its “angular velocity” is "
          "17.26 cm/s. “Torque and rotational speed is inversely proportional”. With 0.32 N m "
          "and an expected “3 m/sec = 0.066 m/sec” the power is 0.0211 W.",
      .ours = fmt::format(
          "At 11 rpm the wheel turns at {} rad/s and its rim moves at {} cm/s. With 0.32 N m "
          "that takes {} W, {} times the printed figure. The motor gives {} N m at 31 rpm, {} W.",
          fixed(slow_radps, 3), fixed(100.0 * slow_radps * 0.5 * wheel_diameter_m, 2),
          fixed(printed_torque_nm * slow_radps, 3),
          significant(printed_torque_nm * slow_radps / 0.0211, 2), fixed(rated_torque_nm, 2),
          fixed(rated_w, 1)),
      .note = note_words(),
      .findings = findings(),
      .tables = {speeds()},
      .figures = {torque_figure()}};
  return {std::move(item)};
}

}  // namespace proofmass::thesis
