#include "proofmass/thesis/servo_items.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <utility>

#include "proofmass/report/servo_report.hpp"
#include "proofmass/servo/study.hpp"
#include "proofmass/thesis/wheel_words.hpp"

namespace proofmass::thesis {
namespace {

using servo::Feedback;
using servo::ServoRun;
using servo::ServoStudy;

const ServoRun& loop_of(const ServoStudy& study, Feedback feedback, bool compensated) {
  return *std::ranges::find_if(study.worst, [&](const ServoRun& run) {
    return run.feedback == feedback && run.compensated == compensated;
  });
}

std::optional<Uncertain> counted(const std::optional<double>& value) {
  return value ? std::optional(Uncertain{*value, 0.0}) : std::nullopt;
}

Item feedback_item(const ServoStudy& study) {
  Item item{.id = "section 6.2",
            .title = "The filter's output as feedback to the motor",
            .thesis =
                "The smoothed output obtained by the Kalman filter may be used to control the DC "
                "motor's speed; backlash and friction can be modelled in the extended Kalman "
                "filter.",
            .ours = {},
            .note =
                "On the drive's digital twin, with the controller designed from the figures that "
                "the verb motor identifies; worst of five runs. A smoothed value needs later "
                "measurements, so the "
                "feedback is the filter's. The remaining error of the angle is that of the "
                "accelerometers' biases, which the filter estimates as the wheel turns."};
  Findings findings;
  findings.why("It does not settle.");
  for (const Feedback feedback : servo::feedbacks) {
    const ServoRun& run = loop_of(study, feedback, true);
    const std::string key(servo::name_of(feedback));
    const std::string label = feedback == Feedback::live_estimate
                                  ? "filter with friction and backlash"
                              : feedback == Feedback::double_integration ? "double integration"
                              : feedback == Feedback::atan2              ? "atan2"
                                                                         : "encoder";
    findings.add(key + "_settling", "Settling at 11 rpm, " + label, kind::seconds, {},
                 counted(run.speed_settling_s));
    findings.add(key + "_ripple", "Ripple at 11 rpm, " + label, kind::rpm, {},
                 run.speed_settling_s ? counted(run.speed_ripple_radps) : std::nullopt);
    findings.add(key + "_limit_cycle", "Limit cycle about a position, " + label, kind::degrees, {},
                 run.position_settling_s ? counted(run.limit_cycle_rad) : std::nullopt);
  }
  item.findings = std::move(findings).all();
  const ServoRun& live = loop_of(study, Feedback::live_estimate, true);
  const ServoRun& gravity = loop_of(study, Feedback::atan2, true);
  item.ours =
      live.speed_settling_s
          ? fmt::format(
                "Yes, by the filter's output: the speed settles in {} with a ripple of {}, where "
                "atan2 leaves {}. Plain double integration does not hold a speed at all.",
                said(counted(live.speed_settling_s), kind::seconds),
                said(counted(live.speed_ripple_radps), kind::rpm),
                said(counted(gravity.speed_ripple_radps), kind::rpm))
          : "No: the loop does not settle in every run.";
  item.figures = {report::servo_speed_figure(study)};
  return item;
}

}  // namespace

Result<std::vector<Item>> servo_items(std::uint64_t seed, const Progress& report_progress) {
  servo::ServoOptions options;
  options.seed = seed;
  options.progress = report_progress;
  const Result<ServoStudy> study = servo::study_servo(options);
  if (!study) return study.error();
  return std::vector<Item>{feedback_item(*study)};
}

}  // namespace proofmass::thesis
