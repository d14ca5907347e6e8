#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <limits>
#include <optional>
#include <utility>

#include "proofmass/core/units.hpp"
#include "proofmass/report/servo_report.hpp"
#include "proofmass/report/wording.hpp"

namespace proofmass::report {
namespace {

using servo::ServoRun;
using servo::ServoStudy;
using servo::ServoTrace;

const char* const never_settles = "it does not settle in every run";

// "live_estimate" for people.
std::string feedback_words(servo::Feedback feedback) {
  switch (feedback) {
    case servo::Feedback::live_estimate:
      return "live estimate";
    case servo::Feedback::double_integration:
      return "double integration";
    case servo::Feedback::atan2:
      return "atan2";
    case servo::Feedback::encoder:
      return "encoder";
  }
  return {};
}

Fields loop_fields(const ServoRun& run) {
  return {field::choice("feedback", std::string(servo::name_of(run.feedback)),
                        {"live_estimate", "double_integration", "atan2", "encoder"}),
          field::flag("friction_compensated", run.compensated),
          field::object(
              "speed",
              {field::number("settling_s", run.speed_settling_s,
                             {.meaning = "until within 5 % of 11 rpm", .why_null = never_settles}),
               field::magnitude("ripple_radps", run.speed_ripple_radps,
                                {.meaning = "standard deviation at the end of a step"}),
               field::magnitude("error_radps", run.speed_error_radps)}),
          field::object(
              "position",
              {field::number("settling_s", run.position_settling_s,
                             {.meaning = "until within 2 degrees", .why_null = never_settles}),
               field::magnitude("error_rad", run.position_error_rad),
               field::magnitude("limit_cycle_rad", run.limit_cycle_rad,
                                {.meaning = "peak to peak at the end of a step"})})};
}

Fields model_fields(const servo::MotorModel& model) {
  return {field::number("resistance", model.resistance_ohm, {.meaning = "ohm"}),
          field::number("torque_constant", model.torque_constant_nmpa, {.meaning = "N*m/A"}),
          field::number("inertia", model.inertia_kgm2, {.meaning = "kg*m^2"}),
          field::number("viscous_friction", model.viscous_nmspr, {.meaning = "N*m*s/rad"}),
          field::number("coulomb_friction", model.coulomb_nm, {.meaning = "N*m"}),
          field::number("breakaway_friction", model.breakaway_nm, {.meaning = "N*m"}),
          field::number("backlash", model.backlash_rad, {.meaning = "rad"})};
}

Fields servo_fields(const ServoReport& report) {
  const servo::ServoOptions& options = report.study.options;
  return {field::choice("procedure", "servo", {"servo"}),
          field::text_or_null("output", report.output, {.why_null = "no --output"}),
          field::count("seed", options.seed),
          field::count("runs", static_cast<std::size_t>(options.seeds),
                       {.meaning = "of each loop; its figures are the worst of them"}),
          field::number("rate_hz", options.rate_hz),
          field::number("delay_s", options.delay_samples / options.rate_hz,
                        {.meaning = "from a sample to the voltage that it causes"}),
          field::object("model", model_fields(report.study.model),
                        {.meaning = "as identified from a recording of the drive"}),
          field::records("loops", report.study.worst, loop_fields)};
}

std::string seconds_words(const std::optional<double>& settling_s) {
  return settling_s ? significant(*settling_s, 3) + " s" : "does not settle";
}

std::string in_unit(double value, double unit, const char* symbol) {
  return significant(value / unit, 2) + symbol;
}

Table loops_table(const ServoStudy& study) {
  Table table{fmt::format("Worst of {} each",
                          count_words(static_cast<std::size_t>(study.options.seeds), "run")),
              {"Feedback", "Friction", "Speed settles", "Ripple", "Error", "Position settles",
               "Error", "Limit cycle"},
              {}};
  for (const ServoRun& run : study.worst)
    table.rows.push_back({feedback_words(run.feedback), run.compensated ? "compensated" : "not",
                          seconds_words(run.speed_settling_s),
                          in_unit(run.speed_ripple_radps, radps_per_rpm, " rpm"),
                          in_unit(run.speed_error_radps, radps_per_rpm, " rpm"),
                          seconds_words(run.position_settling_s),
                          in_unit(run.position_error_rad, rad_per_deg, "°"),
                          in_unit(run.limit_cycle_rad, rad_per_deg, "°")});
  return table;
}

const ServoRun& compensated(const ServoStudy& study, servo::Feedback feedback) {
  return *std::ranges::find_if(study.worst, [&](const ServoRun& run) {
    return run.feedback == feedback && run.compensated;
  });
}

std::string servo_conclusion(const ServoStudy& study) {
  const ServoRun& live = compensated(study, servo::Feedback::live_estimate);
  const ServoRun& gravity = compensated(study, servo::Feedback::atan2);
  const ServoRun& integrated = compensated(study, servo::Feedback::double_integration);
  std::string words = live.speed_settling_s
                          ? fmt::format(
                                "The live estimate drives the motor: 11 rpm settle in {} with a "
                                "ripple of {}; atan2 "
                                "alone leaves {}",
                                seconds_words(live.speed_settling_s),
                                in_unit(live.speed_ripple_radps, radps_per_rpm, " rpm"),
                                in_unit(gravity.speed_ripple_radps, radps_per_rpm, " rpm"))
                          : "The live estimate does not hold the speed";
  return words + (integrated.speed_settling_s ? "." : ", and double integration does not settle.");
}

std::vector<const ServoTrace*> compensated_traces(const std::vector<ServoTrace>& traces) {
  std::vector<const ServoTrace*> out;
  for (const ServoTrace& trace : traces)
    if (trace.compensated) out.push_back(&trace);
  return out;
}

}  // namespace

Document describe(const ServoReport& report) {
  Document document{.page = {.verb = "simulate",
                             .title = "closed loop",
                             .inputs = {},
                             .conclusion = servo_conclusion(report.study),
                             .notes = {}},
                    .fields = servo_fields(report)};
  document.page.sections = {
      {.heading = "Closed loops", .tables = {loops_table(report.study)}, .on_terminal = true}};
  return document;
}

Recording servo_series(const ServoStudy& study) {
  Recording out;
  out.source = "closed loop";
  const Unit rad = *parse_unit("rad"), radps = *parse_unit("rad/s");
  const auto add = [&](const std::vector<ServoTrace>& traces, const std::string& what,
                       const Unit& unit) {
    for (const ServoTrace* trace : compensated_traces(traces)) {
      if (trace == compensated_traces(traces).front())
        out.channels.push_back({what + "_reference", unit, trace->reference});
      out.channels.push_back(
          {what + "_" + std::string(servo::name_of(trace->feedback)), unit, trace->truth});
    }
  };
  add(study.position_traces, "angle", rad);
  add(study.speed_traces, "speed", radps);
  // The position steps last longer.
  out.time.source = TimeSource::stamps;
  out.time.stamps_s = study.position_traces.front().time_s;
  for (Channel& channel : out.channels)
    channel.values.edit().resize(out.time.stamps_s.size(),
                                 std::numeric_limits<double>::quiet_NaN());
  return out;
}

Figure servo_speed_figure(const ServoStudy& study) {
  Figure figure{.title = "Speed steps in a closed loop",
                .description = "True speed of the wheel with each feedback, friction compensated.",
                .x = {.label = "Time (s)"},
                .y = {.label = "Speed (rpm)", .min = -20.0, .max = 20.0}};
  constexpr std::array inks{Ink::blue, Ink::red, Ink::orange, Ink::green};
  for (const ServoTrace* trace : compensated_traces(study.speed_traces)) {
    Curve curve{.label = feedback_words(trace->feedback),
                .x = trace->time_s,
                .y = {},
                .ink = inks[static_cast<std::size_t>(trace->feedback)]};
    for (const double speed : trace->truth) curve.y.push_back(speed / radps_per_rpm);
    figure.curves.push_back(std::move(curve));
  }
  return figure;
}

}  // namespace proofmass::report
