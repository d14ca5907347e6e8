#include "calibrate/gyroscope.hpp"

#include <cctype>
#include <charconv>
#include <cmath>
#include <fmt/format.h>
#include <fstream>

#include "cli/console.hpp"
#include "cli/exit_status.hpp"
#include "input/gyroscope.hpp"
#include "input/input.hpp"
#include "proofmass/calibrate/gyroscope_budget.hpp"
#include "proofmass/report/wording.hpp"
#include "proofmass/sensor/gyroscope_update.hpp"
#include "proofmass/signal/channel_audit.hpp"
#include "proofmass/signal/unusable.hpp"

namespace proofmass::app {
namespace {

using calibrate::GyroscopeSession;
using calibrate::TurntableRate;

// The file of --gyro-file, whose flags are its own.
Recording gyroscope_recording(const CalibrateCommand& command) {
  InputFlags flags = command.input;
  flags.channels.clear();
  flags.sensors.clear();
  flags.unit = command.rate_unit;
  return load(command.gyro_file, flags, progress_bar(command.output));
}

GyroscopeChannels channels_in(const Recording& recording, const Triad& accelerometer, bool own) {
  if (own && recording.channels.size() == 3) return {0, 1, 2};
  if (const auto found = find_gyroscope(recording, own ? Triad{} : accelerometer)) return *found;
  throw Failure(usage,
                recording.source +
                    ": no gyroscope with three axes found: name the channels of both sensors with "
                    "--channel, or give the gyroscope's file with --gyro-file");
}

// rad/s; of volts and counts as recorded.
Unit reading_unit_of(const Unit& unit) {
  if (unit.quantity == Quantity::angular_rate) return *parse_unit("rad/s");
  if (unit.quantity == Quantity::voltage) return *parse_unit("V");
  return unit;
}

// The rows of two files belong together if there are as many, at the same times.
void expect_one_clock(const Recording& gyroscope, const Recording& accelerometer) {
  const std::size_t n = accelerometer.samples();
  const double half_step_s =
      accelerometer.time.rate_hz > 0.0 ? 0.5 / accelerometer.time.rate_hz : 0.5;
  if (gyroscope.samples() == n &&
      std::abs(gyroscope.duration_s() - accelerometer.duration_s()) < half_step_s)
    return;
  throw Failure(
      bad_input,
      fmt::format("{} has {} samples in {:g} s, {} has {} in {:g} s: both sensors must be "
                  "sampled together",
                  gyroscope.source, gyroscope.samples(), gyroscope.duration_s(),
                  accelerometer.source, n, accelerometer.duration_s()));
}

std::vector<double> in_unit(const Channel& channel, const Unit& unit) {
  std::vector<double> values = channel.values.copy();
  if (unit.quantity != Quantity::counts)
    for (double& value : values) value = unit.si(value);
  return values;
}

// START,END,DEG_PER_S[,STD] of --turntable.
TurntableRate parse_rate(const std::string& text) {
  std::array<double, 4> numbers{0.0, 0.0, 0.0, 0.0};
  std::size_t count = 0;
  const char *at = text.data(), *end = text.data() + text.size();
  while (at != end && count < numbers.size()) {
    if (*at == '+') ++at;
    const auto [next, error] = std::from_chars(at, end, numbers[count]);
    if (error != std::errc{} || !std::isfinite(numbers[count])) break;
    ++count;
    at = next;
    if (at == end || *at != ',') break;
    ++at;
  }
  const auto [start_s, end_s, rate, std] = numbers;
  if (at != end || count < 3 || !(start_s < end_s) || std < 0.0)
    throw Failure(usage, fmt::format("--turntable: expected START,END,DEG_PER_S or "
                                     "START,END,DEG_PER_S,STD, not '{}'",
                                     text));
  return {.session = 0,
          .start_s = start_s,
          .end_s = end_s,
          .rate_radps = rate * rad_per_deg,
          .std_radps = std * rad_per_deg};
}

// The rates of --turntable: one, or a table of one a line. Lines that begin with a letter or # are
// headings.
std::vector<TurntableRate> rates_in(const std::string& text) {
  if (text.find(',') != std::string::npos) return {parse_rate(text)};
  std::ifstream file(text);
  if (!file)
    throw Failure(bad_input, fmt::format("--turntable: {}: cannot be read; expected "
                                         "START,END,DEG_PER_S[,STD] or a file of such lines",
                                         text));
  std::vector<TurntableRate> rates;
  std::size_t number = 0;
  for (std::string line; std::getline(file, line);) {
    ++number;
    std::erase_if(line, [](char c) { return c == ' ' || c == '\t' || c == '\r'; });
    const bool heading = !line.empty() && (std::isalpha(static_cast<unsigned char>(line[0])) != 0 ||
                                           line[0] == '#' || line[0] == '"');
    if (line.empty() || heading) continue;
    try {
      rates.push_back(parse_rate(line));
    } catch (const Failure& failure) {
      throw Failure(bad_input, fmt::format("{}: line {}: {}", text, number, failure.what()));
    }
  }
  if (rates.empty())
    throw Failure(bad_input,
                  fmt::format("--turntable: {}: no line START,END,DEG_PER_S[,STD]", text));
  return rates;
}

// With the poses as the accelerometer's calibration took them.
std::vector<GyroscopeSession> sessions_of(const PoseSet& set) {
  std::vector<GyroscopeSession> sessions;
  for (const RateSession& one : set.rates) {
    GyroscopeSession& session = sessions.emplace_back(one.session);
    session.poses.clear();
    for (std::size_t k = 0; k < set.poses.size(); ++k)
      if (set.pose_file[k] == one.file) session.poses.push_back(set.poses[k]);
  }
  return sessions;
}

}  // namespace

RateSession rate_session(const Recording& recording,
                         const calibrate::RecordingPoses& found,
                         const CalibrateCommand& command,
                         std::vector<Note>& notes) {
  const bool own = !command.gyro_file.empty();
  Recording rates = own ? gyroscope_recording(command) : recording;
  if (own) expect_one_clock(rates, recording);
  const GyroscopeChannels channels = channels_in(rates, found.triad, own);
  const std::vector<std::size_t> axes(channels.begin(), channels.end());
  for (const std::vector<Note>& dropped :
       {signal::drop_stuck({axes}, rates), signal::drop_saturated(axes, rates)})
    notes.insert(notes.end(), dropped.begin(), dropped.end());
  RateSession out;
  const std::array places{*found.triad.x, *found.triad.y, *found.triad.z};
  for (std::size_t k = 0; k < 3; ++k) {
    const Channel& channel = rates.channels[channels[k]];
    const bool known = channel.unit.quantity == Quantity::angular_rate ||
                       channel.unit.quantity == Quantity::voltage ||
                       channel.unit.quantity == Quantity::counts;
    const Unit unit = known ? channel.unit : *parse_unit(command.rate_unit);
    if (!known && k == 0)
      notes.push_back({Severity::warning,
                       fmt::format("{} and its like: no unit: taken to be {}; --rate-unit says "
                                   "otherwise",
                                   channel.name, command.rate_unit)});
    out.unit = reading_unit_of(unit);
    out.session.rate[k] = in_unit(channel, unit);
    out.session.rate_lsb[k] = signal::find_lsb(out.session.rate[k]).value_or(0.0);
    const Channel& accel = recording.channels[places[k]];
    out.session.accel[k] = in_unit(accel, accel.unit);
  }
  out.session.time_s.reserve(recording.samples());
  for (std::size_t n = 0; n < recording.samples(); ++n)
    out.session.time_s.push_back(recording.time.at(n));
  out.session.rests = found.dwells;
  out.session.pose_noise_dof = found.means.noise_dof;
  return out;
}

void calibrate_gyroscope(const CalibrateCommand& command,
                         const PoseSet& set,
                         report::CalibrateReport& report) {
  if (set.rates.empty())
    throw Failure(usage, "--gyro: needs a recording of both sensors, not a table of means");
  calibrate::GyroscopeOptions options{.in_radps = set.rates.front().unit.quantity ==
                                                  Quantity::angular_rate};
  if (command.input.latitude_deg) options.latitude_rad = *command.input.latitude_deg * rad_per_deg;
  for (const std::string& text : command.turntable)
    for (const TurntableRate& rate : rates_in(text)) options.table.push_back(rate);
  if (!options.table.empty() && set.rates.size() > 1)
    throw Failure(usage, "--turntable goes with one recording");
  auto fit = calibrate::calibrate_gyroscope(sessions_of(set), report.fit, options);
  if (!fit) {
    throw Failure(status_of(fit.error(), Stage::computing), fit.error().at(report.inputs.front()));
  }
  report::GyroscopeReport& out = report.gyroscope.emplace();
  out.unit = set.rates.front().unit;
  out.fit = std::move(fit).value();
  out.budgets = calibrate::budget_of(out.fit, out.unit.symbol);
}

void update_gyroscope(const CalibrateCommand& command, const report::CalibrateReport& report) {
  const report::GyroscopeReport& found = *report.gyroscope;
  sensor::MeasuredGyroscope measured{
      .figures = {},
      .reading_unit = found.unit.symbol,
      .covariance = {},
      .origin =
          fmt::format("proofmass calibrate {} --gyro, {} motions",
                      report::file_name(report.files.front().file), found.fit.motions.size())};
  auto& covariance = measured.covariance.emplace();
  for (std::size_t i = 0; i < calibrate::gyroscope_parameters; ++i) {
    measured.figures[i] = found.fit.parameter(i);
    for (std::size_t j = 0; j < calibrate::gyroscope_parameters; ++j)
      covariance[i][j] =
          found.fit.covariance(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
  }
  const Status done = sensor::update_gyroscope(command.update_sensor, measured);
  if (!done) throw Failure(status_of(done.error(), Stage::writing), done.error());
}

}  // namespace proofmass::app
