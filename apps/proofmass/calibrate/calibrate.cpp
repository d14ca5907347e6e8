#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fmt/format.h>
#include <numbers>

#include "calibrate/command.hpp"
#include "calibrate/encoder.hpp"
#include "calibrate/flags.hpp"
#include "calibrate/gyroscope.hpp"
#include "calibrate/poses.hpp"
#include "cli/console.hpp"
#include "cli/exit_status.hpp"
#include "cli/output.hpp"
#include "input/input.hpp"
#include "proofmass/calibrate/multi_position/cross_axis.hpp"
#include "proofmass/calibrate/multi_position_budget.hpp"
#include "proofmass/calibrate/multi_position_check.hpp"
#include "proofmass/calibrate/session_noise.hpp"
#include "proofmass/calibrate/validation.hpp"
#include "proofmass/report/calibrate/report.hpp"
#include "proofmass/report/wording.hpp"
#include "proofmass/sensor/calibration_update.hpp"
#include "proofmass/sensor/sensor_file.hpp"
#include "verb.hpp"

namespace proofmass::app {
namespace {

using calibrate::MultiPosition;
using calibrate::MultiPositionOptions;
using calibrate::PoseModel;
using calibrate::TypeB;

std::optional<PoseModel> model_of(const CalibrateCommand& command) {
  if (command.six_position) return PoseModel::six_position;
  if (!command.parameters) return std::nullopt;
  if (*command.parameters == 12) return PoseModel::given_12;
  return *command.parameters == 9 ? PoseModel::norm_9 : PoseModel::norm_6;
}

std::vector<TypeB> type_b_of(const CalibrateCommand& command) {
  std::vector<TypeB> lines;
  for (const std::string& text : command.type_b) {
    const Result<TypeB> line = calibrate::parse_type_b(text);
    if (!line) throw Failure(usage, line.error().at("--type-b"));
    lines.push_back(*line);
  }
  return lines;
}

// Poses that do not determine the model are a fault of the input; the message names the files.
MultiPosition fitted(const PoseSet& set, MultiPositionOptions options) {
  options.noise_dof = set.noise_dof;
  options.between = set.between;
  const Result<MultiPosition> fit = calibrate::calibrate_positions(set.poses, options);
  if (fit) return *fit;
  std::string files;
  for (const report::PoseFile& file : set.files) files += (files.empty() ? "" : ", ") + file.file;
  throw Failure(status_of(fit.error(), Stage::computing), fit.error().at(files));
}

// Noise of the means over the session, if the recordings determine it.
void settle_noise(const MultiPositionOptions& model, PoseSet& set) {
  MultiPositionOptions options = model;
  options.noise_dof = set.noise_dof;
  set.slow_noise = calibrate::session_noise(set.poses, set.sessions, options);
  if (!set.slow_noise) return;
  set.poses = set.slow_noise->poses;
  set.between = set.slow_noise->between;
}

// Flicker and random walk of the sensor file to be updated, if it has them for all three axes.
std::optional<calibrate::SlowNoiseStrengths> filed_slow_noise(const CalibrateCommand& command,
                                                              const MultiPosition& fit,
                                                              const Unit& unit) {
  if (command.update_sensor.empty() || !std::filesystem::exists(command.update_sensor)) return {};
  const sensor::SensorFile file =
      need(sensor::read_sensor_file(command.update_sensor), Stage::reading);
  const sensor::NoiseModel& noise = file.model.noise;
  calibrate::SlowNoiseStrengths out;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (!noise.flicker[axis]) return {};
    const double scale = unit.quantity == Quantity::acceleration ? 1.0 : fit.estimate[3 + axis];
    const double flicker = scale * noise.flicker[axis]->si();
    out.flicker[axis] = flicker * flicker / std::numbers::pi;
    if (!noise.random_walk[axis]) continue;
    const double walk = scale * noise.random_walk[axis]->si();
    out.random_walk[axis] = walk * walk;
  }
  return out;
}

// Repeatability of the biases between sessions: as stated, from the sensor file, or from the noise
// of this recording.
std::optional<calibrate::BiasStability> stability_of(const CalibrateCommand& command,
                                                     const PoseSet& set,
                                                     const MultiPosition& fit) {
  if (command.bias_stability_mg) {
    calibrate::BiasStability out{.std = {}, .source = "--bias-stability"};
    for (std::size_t axis = 0; axis < 3; ++axis)
      out.std[axis] =
          *command.bias_stability_mg * 1e-3 * standard_gravity_mps2 *
          (set.unit.quantity == Quantity::acceleration ? 1.0 : std::abs(fit.estimate[3 + axis]));
    return out;
  }
  double session_s = 0.0, samples = 0.0;
  for (const report::PoseFile& file : set.files) {
    session_s = std::max(session_s, file.duration_s);
    samples = std::max(samples, static_cast<double>(file.samples));
  }
  if (const auto filed = filed_slow_noise(command, fit, set.unit))
    return calibrate::stability_of(*filed, session_s,
                                   "the noise in " + report::file_name(command.update_sensor));
  if (!set.slow_noise || !(session_s > 0.0)) return std::nullopt;
  calibrate::SlowNoiseStrengths own;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    own.flicker[axis] = set.slow_noise->flicker[axis] / (2.0 * std::numbers::ln2);
    own.random_walk[axis] = 3.0 * set.slow_noise->random_walk[axis] * samples / session_s;
  }
  return calibrate::stability_of(own, session_s,
                                 "the flicker noise and random walk that it allows");
}

// With several supplies, the one for the main results: the closest to their mean.
std::optional<double> main_supply_v(const CalibrateCommand& command) {
  const std::vector<double>& supplies = command.supplies_v;
  if (supplies.empty()) return std::nullopt;
  double mean = 0.0;
  for (const double supply_v : supplies) mean += supply_v / static_cast<double>(supplies.size());
  return *std::min_element(supplies.begin(), supplies.end(), [mean](double a, double b) {
    return std::abs(a - mean) < std::abs(b - mean);
  });
}

// Positions at different supplies do not belong to one calibration: only the files at the main
// supply are combined.
std::vector<std::string> main_files(const CalibrateCommand& command) {
  const std::optional<double> supply_v = main_supply_v(command);
  if (!supply_v) return command.files;
  std::vector<std::string> files;
  for (std::size_t k = 0; k < command.files.size(); ++k)
    if (command.supplies_v[k] == *supply_v) files.push_back(command.files[k]);
  return files;
}

// One calibration per file, at its own supply, and the dependence on the supply.
void calibrate_supplies(const CalibrateCommand& command,
                        const MultiPositionOptions& options,
                        report::CalibrateReport& report) {
  std::vector<calibrate::SupplyPoint> points;
  for (std::size_t k = 0; k < command.files.size(); ++k) {
    std::vector<Note> notes;
    PoseSet set = read_poses({command.files[k]}, command, notes);
    settle_noise(options, set);
    // Notes of the main supply's files have been reported already.
    if (command.supplies_v[k] != main_supply_v(command)) {
      for (const Note& note : notes) report.notes.push_back(note.at(command.files[k]));
    }
    MultiPositionOptions own = options;
    // Gravity is common to all supplies and does not affect their difference.
    own.gravity_std_mps2 = 0.0;
    report::SuppliedFit& one = report.supplies.emplace_back();
    one = {command.supplies_v[k], command.files[k], fitted(set, own)};
    points.push_back({{one.supply_v, 0.0}, one.fit.bias, one.fit.scale});
  }
  const Result<calibrate::SupplyDependence> found =
      calibrate::fit_supply(points, {.reading_unit = report.unit.symbol});
  if (!found) throw Failure(status_of(found.error(), Stage::computing), found.error());
  report.supply = *found;
}

void validate(const CalibrateCommand& command, report::CalibrateReport& report) {
  const PoseSet set = read_poses(command.validate, command, report.notes);
  if (set.unit.symbol != report.unit.symbol) {
    throw Failure(usage,
                  fmt::format("--validate: {} is in {}, the calibration in {}",
                              command.validate.front(), set.unit.symbol, report.unit.symbol));
  }
  report.validation = calibrate::validate(report.fit, set.poses);
  report.validation_files = command.validate;
}

sensor::MeasuredCalibration measured(const CalibrateCommand& command,
                                     const report::CalibrateReport& report,
                                     const std::optional<double>& reference_supply_v) {
  const MultiPosition& fit = report.fit;
  const std::string unit = report.unit.symbol;
  sensor::MeasuredCalibration out;
  out.bias = fit.bias;
  out.scale = fit.scale;
  out.misalignment = fit.misalignment_rad;
  out.bias_unit = unit;
  out.scale_unit = unit == "m/s^2" ? "1" : unit + "/(m/s^2)";
  out.std_known = fit.dof > 0.0;
  if (fit.misalignment_rad[0] && out.std_known) {
    auto& covariance = out.covariance.emplace();
    for (Eigen::Index i = 0; i < 9; ++i) {
      for (Eigen::Index j = 0; j < 9; ++j)
        covariance[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)] = fit.covariance(i, j);
    }
  }
  if (fit.dof > 0.0) out.dof = fit.dof;
  if (report.stability)
    for (std::size_t axis = 0; axis < 3; ++axis) out.stability[axis] = report.stability->std[axis];
  out.gravity_mps2 = report.certificate.gravity_mps2;
  if (command.temperature_c) out.temperature_k = *command.temperature_c + 273.15;
  out.supply_v = reference_supply_v;
  if (unit == "V") out.supply_v = main_supply_v(command);
  out.origin = fmt::format("proofmass calibrate {}, {} positions",
                           report::file_name(report.files.front().file), fit.poses.size());
  out.name = command.name;
  out.serial = command.serial;
  out.date = command.date;
  return out;
}

void update_sensor(const CalibrateCommand& command,
                   const std::optional<double>& reference_supply_v,
                   report::CalibrateReport& report) {
  const Result<std::vector<Note>> updated = sensor::update_calibration(
      command.update_sensor, measured(command, report, reference_supply_v));
  if (!updated) throw Failure(status_of(updated.error(), Stage::writing), updated.error());
  report.notes.insert(report.notes.end(), updated->begin(), updated->end());
}

void fill_certificate(const CalibrateCommand& command,
                      const Uncertain& gravity,
                      report::CalibrateReport& report) {
  report::CertificateData& data = report.certificate;
  data.name = command.name;
  data.serial = command.serial;
  data.date = command.date;
  data.files = main_files(command);
  data.gravity_mps2 = gravity;
  if (command.temperature_c) data.temperature_k = Uncertain{*command.temperature_c + 273.15, 0.0};
  if (const auto supply_v = main_supply_v(command)) data.supply_v = Uncertain{*supply_v, 0.0};
  data.positions = report.fit.poses.size();
}

// A certificate states that its draws were enough; elsewhere 200 show a budget that is wrong.
void check_by_draws(const CalibrateCommand& command,
                    const std::vector<TypeB>& lines,
                    MultiPositionOptions options,
                    const PoseSet& set,
                    report::CalibrateReport& report) {
  if (command.monte_carlo == std::size_t{0}) return;
  constexpr std::size_t quick = 200;
  std::optional<std::size_t> draws = command.monte_carlo;
  if (!draws && command.output.report.empty()) draws = quick;
  options.noise_dof = set.noise_dof;
  options.between = set.between;
  Result<calibrate::MonteCarloCheck> check =
      calibrate::check_by_monte_carlo(set.poses, options, report.fit,
                                      {.lines = lines,
                                       .reading_unit = report.unit.symbol,
                                       .draws = draws,
                                       .progress = progress_bar(command.output)});
  if (check)
    report.check = std::move(check).value();
  else
    report.why_no_check = check.error().message;
}

void fill_measurements(const PoseSet& set, report::CalibrateReport& report) {
  report.files = set.files;
  report.sensor = set.sensor;
  report.unit = set.unit;
  report.pose_file = set.pose_file;
  report.sample_std = set.sample_std;
}

// The budget of the certificate has the stability as a further contribution.
void budget_with_stability(const std::vector<TypeB>& lines, report::CalibrateReport& report) {
  if (!report.stability) return;
  std::vector<TypeB> all = lines;
  for (TypeB& line : calibrate::type_b_of(*report.stability, report.unit.symbol))
    all.push_back(std::move(line));
  report.certificate.budgets = calibrate::budget_of(report.fit, all, report.unit.symbol).value();
}

}  // namespace

void run_calibrate(const CalibrateCommand& given) {
  if (given.encoder.wanted) return run_calibrate_encoder(given);
  CalibrateCommand command = given;
  command.gyro |= !command.gyro_file.empty();
  expect_sense(command);
  const std::vector<TypeB> lines = type_b_of(command);
  report::CalibrateReport report;
  report.inputs = command.files;
  const Uncertain gravity =
      uncertain_gravity_mps2(command.input, command.gravity_std_mps2, report.notes);
  PoseSet set = read_poses(main_files(command), command, report.notes);
  if (set.unit.quantity == Quantity::acceleration) {
    const Status plausible = calibrate::check_acceleration_unit(set.poses, gravity.value);
    if (!plausible) throw Failure(bad_input, plausible.error().at(set.files.front().file));
  }
  fill_measurements(set, report);
  const MultiPositionOptions options{
      .model = model_of(command),
      .gravity_mps2 = gravity.value,
      .gravity_std_mps2 = gravity.std,
      .orthogonality_std_rad = command.orthogonality_std_deg * rad_per_deg,
      .placement_std_rad = command.placement_std_deg * rad_per_deg,
      .keep_suspects = command.keep_suspects};
  if (command.supplies_v.size() > 1) {
    calibrate_supplies(command, options, report);
    report.notes.push_back(
        {Severity::info,
         fmt::format("the figures at the top are those at {:g} V", *main_supply_v(command))});
  }
  settle_noise(options, set);
  report.fit = fitted(set, options);
  auto budgets = calibrate::budget_of(report.fit, lines, report.unit.symbol);
  if (!budgets) throw Failure(usage, budgets.error().at("--type-b"));
  report.budgets = std::move(budgets).value();
  report.stability = stability_of(command, set, report.fit);
  fill_certificate(command, gravity, report);
  budget_with_stability(lines, report);
  check_by_draws(command, lines, options, set, report);
  const Status added = calibrate::add_type_b(report.fit, lines, report.unit.symbol);
  if (!added) throw Failure(usage, added.error().at("--type-b"));
  if (command.gyro) calibrate_gyroscope(command, set, report);
  report.poses = std::move(set.poses);
  report.cross_axis = calibrate::cross_axis_of(report.fit);
  if (!command.validate.empty()) validate(command, report);
  if (!command.update_sensor.empty())
    without_interruption([&] {
      update_sensor(command, set.reference_supply_v, report);
      if (report.gyroscope) update_gyroscope(command, report);
    });
  finish(
      report::describe(report), [&] { return report::calibrate_series(report); }, command.output);
}

Verb calibrate_verb() {
  return make_verb<CalibrateCommand>(
      {.name = "calibrate",
       .group = "Characterise",
       .help = "bias, scale factor and misalignment from static positions"},
      add_calibrate_flags, run_calibrate);
}

}  // namespace proofmass::app
