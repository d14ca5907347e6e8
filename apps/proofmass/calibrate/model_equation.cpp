#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <optional>

#include "cli/console.hpp"
#include "cli/exit_status.hpp"
#include "cli/output.hpp"
#include "input/input.hpp"
#include "proofmass/calibrate/cross_axis.hpp"
#include "proofmass/io/names.hpp"
#include "proofmass/report/model_equation_report.hpp"
#include "tumble/modes.hpp"

namespace proofmass::app {
namespace {

using calibrate::ModelRow;
using sensor::Coefficient;

struct MotionColumn {
  std::string_view name;  ///< without axis or unit
  double sensor::Motion::* member;
  Quantity quantity;  ///< unknown for rad/s², which has no Quantity
};
constexpr std::array motion_columns = std::to_array<MotionColumn>({
    {"ai", &sensor::Motion::ai_mps2, Quantity::acceleration},
    {"ap", &sensor::Motion::ap_mps2, Quantity::acceleration},
    {"ao", &sensor::Motion::ao_mps2, Quantity::acceleration},
    {"omegai", &sensor::Motion::omega_i_radps, Quantity::angular_rate},
    {"omegap", &sensor::Motion::omega_p_radps, Quantity::angular_rate},
    {"omegadoto", &sensor::Motion::omega_dot_o_radps2, Quantity::unknown},
});

std::vector<Coefficient> asked_for(const TumbleCommand& command) {
  std::vector<Coefficient> asked;
  for (const std::string& name : command.coefficients) {
    const auto found = sensor::coefficient_named(name);
    if (!found) {
      std::string known;
      for (const auto& one : sensor::coefficients()) {
        known += (known.empty() ? "" : ", ") + std::string(one.name);
      }
      throw Failure(usage, fmt::format("--coefficients: \"{}\" is not one of {}", name, known));
    }
    if (std::ranges::find(asked, *found) != asked.end()) {
      throw Failure(usage, fmt::format("--coefficients: {} is named twice", name));
    }
    asked.push_back(*found);
  }
  return asked;
}

const Channel* column(const Recording& table, std::string_view name) {
  const auto found = std::ranges::find_if(
      table.channels, [&](const Channel& channel) { return io::bare_name(channel.name) == name; });
  return found == table.channels.end() ? nullptr : &*found;
}

// Unit of a motion column: from its header, or --unit for accelerations.
Unit column_unit(const Channel& channel, const MotionColumn& column, const InputFlags& flags) {
  if (column.quantity == Quantity::unknown) return {};  // rad/s², which Unit cannot represent
  if (channel.unit.quantity == column.quantity) return channel.unit;
  if (column.quantity == Quantity::acceleration && !flags.unit.empty()) {
    const auto unit = parse_unit(flags.unit);
    if (unit && unit->quantity == Quantity::acceleration) return *unit;
  }
  const bool rate = column.quantity == Quantity::angular_rate;
  throw Failure(
      usage, fmt::format("column {}: expected {}: write its unit in the header, \"{} ({})\"{}",
                         channel.name, name_of(column.quantity), channel.name, rate ? "rad/s" : "g",
                         rate ? "" : ", or give --unit"));
}

// Accelerations at rest that follow from a column of angles: g sin φ along the input axis, g cos φ
// along the pendulous axis (plane 1) or the output axis (plane 2).
void add_gravity(const Recording& table,
                 const Channel& angle,
                 const TumbleCommand& command,
                 std::vector<sensor::Motion>& motions) {
  const Channel* planes = column(table, "plane");
  const bool in_rad = angle.unit.quantity == Quantity::angle;
  const double g = gravity_mps2(command.input);
  const int everywhere = command.planes.empty() ? 1 : command.planes.front();
  for (std::size_t k = 0; k < motions.size(); ++k) {
    const double theta = in_rad ? angle.unit.si(angle.values[k]) : angle.values[k] * rad_per_deg;
    const double plane = planes ? planes->values[k] : everywhere;
    if (plane != 1.0 && plane != 2.0) {
      throw Failure(bad_input, fmt::format("row {}: plane {}: expected 1 or 2", k + 1, plane));
    }
    motions[k].ai_mps2 = g * std::sin(theta);
    (plane == 1.0 ? motions[k].ap_mps2 : motions[k].ao_mps2) = g * std::cos(theta);
  }
}

std::vector<sensor::Motion> read_motions(const Recording& table, const TumbleCommand& command) {
  std::vector<sensor::Motion> motions(table.samples());
  bool any = false;
  for (const MotionColumn& one : motion_columns) {
    const Channel* found = column(table, one.name);
    if (found == nullptr) continue;
    any = true;
    const Unit unit = column_unit(*found, one, command.input);
    for (std::size_t k = 0; k < motions.size(); ++k) {
      motions[k].*one.member = unit.si(found->values[k]);
    }
  }
  const Channel* angle =
      command.angle_channel.empty() ? column(table, "angle") : table.find(command.angle_channel);
  if (angle == nullptr && !command.angle_channel.empty()) {
    throw Failure(usage, fmt::format("--angle: no column {}", command.angle_channel));
  }
  const bool accelerations = column(table, "ai") || column(table, "ap") || column(table, "ao");
  if (angle != nullptr && !accelerations) {
    add_gravity(table, *angle, command, motions);
  } else if (!any) {
    throw Failure(usage, table.source +
                             ": no column a_i, a_p or a_o, and no column angle: the motion of the "
                             "accelerometer is not known");
  }
  return motions;
}

bool is_output(const Channel& channel, const TumbleCommand& command) {
  if (!command.input.channels.empty()) {
    return std::ranges::find(command.input.channels, channel.name) != command.input.channels.end();
  }
  const std::string name = io::bare_name(channel.name);
  constexpr std::array others{"angle", "plane",  "mount", "position", "row", "n",
                              "index", "number", "time",  "t",        "std"};
  const bool motion =
      std::ranges::any_of(motion_columns, [&](const auto& one) { return one.name == name; });
  return !motion && !name.ends_with("std") && channel.name != command.angle_channel &&
         std::ranges::find(others, name) == others.end();
}

// The column NAME_std or std with the standard deviations of the measurements, if any.
const Channel* std_column(const Recording& table, const Channel& output) {
  const Channel* own = column(table, io::bare_name(output.name) + "std");
  return own != nullptr ? own : column(table, "std");
}

// √(δ_o² + δ_p²), if both were fitted.
std::optional<calibrate::CrossAxis> cross_axis_of(const calibrate::ModelFit& fit) {
  const auto *o = fit.find(Coefficient::delta_o), *p = fit.find(Coefficient::delta_p);
  if (o == nullptr || p == nullptr || !o->value || !p->value) return std::nullopt;
  const Eigen::Index at[] = {o - fit.coefficients.data(), p - fit.coefficients.data()};
  Eigen::Matrix2d covariance;
  for (int a = 0; a < 2; ++a) {
    for (int b = 0; b < 2; ++b) covariance(a, b) = fit.covariance(at[a], at[b]);
  }
  const double dof = fit.std_stated ? 0.0 : static_cast<double>(fit.dof);
  return need(
      calibrate::cross_axis_sensitivity({o->value->value, p->value->value}, covariance, dof),
      Stage::computing);
}

report::ModelOutput fit_output(const Recording& table,
                               const Channel& channel,
                               const std::vector<sensor::Motion>& motions,
                               const std::vector<Coefficient>& asked) {
  report::ModelOutput output{
      .name = channel.name, .unit = {}, .rows = {}, .fit = {}, .cross_axis = {}};
  Unit unit = channel.unit;
  if (unit.quantity == Quantity::acceleration) {
    output.unit = "m/s^2";
  } else if (unit.quantity == Quantity::voltage) {
    output.unit = "V";
  } else {
    unit = {};
    output.unit = channel.unit.symbol;
  }
  const Channel* std = std_column(table, channel);
  for (std::size_t k = 0; k < motions.size(); ++k) {
    output.rows.push_back(
        {motions[k], unit.si(channel.values[k]), std ? std->values[k] * unit.to_si : 0.0});
  }
  Result<calibrate::ModelFit> fit = calibrate::fit_model_equation(output.rows, {asked, {}});
  if (!fit) {
    const Error error = fit.error().at(channel.name).at(table.source);
    const bool of_file = error.code == Errc::not_finite || error.code == Errc::invalid_argument;
    throw Failure(of_file ? bad_input : status_of(error, Stage::computing), error);
  }
  output.fit = std::move(fit).value();
  output.cross_axis = cross_axis_of(output.fit);
  return output;
}

}  // namespace

void run_model_equation(const TumbleCommand& command) {
  const std::vector<Coefficient> asked = asked_for(command);
  if (command.files.size() != 1) {
    throw Failure(usage, "--coefficients takes one file: a table of rows");
  }
  if (!command.update_sensor.empty()) {
    throw Failure(usage,
                  "--update-sensor does not go with --coefficients: a sensor file cannot store "
                  "them");
  }
  InputFlags as_table = command.input;  // all columns, in the units of their headers
  as_table.channels.clear();
  as_table.unit.clear();
  if (!as_table.rate_hz && as_table.time.empty()) as_table.rate_hz = 1.0;  // rows have no time
  const Recording table = load(command.files.front(), as_table, progress_bar(command.output));
  report::ModelEquationReport report;
  report.inputs = command.files;
  report.notes = table.notes;
  const std::vector<sensor::Motion> motions = read_motions(table, command);
  if (!column(table, "ai") && !column(table, "ap") && !column(table, "ao")) {
    report.gravity_mps2 = gravity_mps2(command.input);
  }
  for (const Channel& channel : table.channels) {
    if (is_output(channel, command)) {
      report.outputs.push_back(fit_output(table, channel, motions, asked));
    }
  }
  if (report.outputs.empty()) {
    throw Failure(usage, table.source + ": no output column: name it with --channel");
  }
  finish(report::describe(report), {}, command.output);
}

}  // namespace proofmass::app
