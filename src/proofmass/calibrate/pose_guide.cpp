#include "proofmass/calibrate/pose_guide.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "proofmass/calibrate/guide/plan.hpp"
#include "proofmass/core/contract.hpp"

namespace proofmass::calibrate {
namespace {

using signal::RestPhase;
using signal::RestState;

Eigen::Vector3d vector_of(const std::array<double, 3>& values) {
  return Eigen::Vector3d(values.data());
}

std::unique_ptr<GuidePlan> plan_of(const GuideOptions& options) {
  switch (options.procedure) {
    case GuideProcedure::tumble:
      return tumble_plan(options);
    case GuideProcedure::still:
      return still_plan(options);
    case GuideProcedure::multi_position:
      break;
  }
  PM_EXPECTS(options.channels.size() == 3);
  return multi_position_plan(options);
}

std::string seconds_words(double seconds) {
  const double whole = std::ceil(seconds);
  return whole < 120.0 ? fmt::format("{:.0f} s", whole)
                       : fmt::format("{:.0f} min", std::ceil(whole / 60.0));
}

std::string after(const std::string& words, const char* separator) {
  return words.empty() ? "" : separator + words;
}

}  // namespace

struct PoseGuide::State {
  explicit State(const GuideOptions& given)
      : options(given),
        rests(given.channels.size(), {.rate_hz = given.rate_hz}),
        plan(plan_of(given)) {}

  void look(std::vector<GuideStep>& steps);
  void begin_rest(const RestState& now, std::vector<GuideStep>& steps);
  void capture(const RestState& now, std::vector<GuideStep>& steps);
  void lose(std::vector<GuideStep>& steps);
  void say(GuideKind kind, std::string text, std::vector<GuideStep>& steps) const {
    steps.push_back({kind, std::move(text), now_s});
  }
  void say_next(std::vector<GuideStep>& steps) const {
    if (plan->done())
      say(GuideKind::done, "That is all.", steps);
    else
      say(GuideKind::prompt, plan->prompt(), steps);
  }

  GuideOptions options;
  signal::RunningRests rests;
  std::unique_ptr<GuidePlan> plan;
  std::vector<Pose> poses;
  bool prompted = false;
  double now_s = 0.0;
  /// Last known end of the current rest; absent while the sensor moves.
  std::optional<double> seen_until_s;
  bool open = false;  ///< that rest is accepted, but not long enough yet
  double open_since_s = 0.0;
  RestVerdict verdict;
};

void PoseGuide::State::look(std::vector<GuideStep>& steps) {
  const RestState& now = rests.state();
  now_s = now.newest_s;
  if (now.phase == RestPhase::settling) return;
  if (now.phase != RestPhase::resting) {
    seen_until_s.reset();
    lose(steps);
    return;
  }
  const bool same = seen_until_s && now.since_s <= *seen_until_s;
  if (!same) begin_rest(now, steps);
  seen_until_s = now.until_s;
  if (!open) return;
  open_since_s = now.since_s;
  verdict = plan->judge(rests);
  if (verdict.enough) capture(now, steps);
}

void PoseGuide::State::begin_rest(const RestState& now, std::vector<GuideStep>& steps) {
  lose(steps);
  const Eigen::Vector3d mean = vector_of(now.mean);
  if (const std::optional<std::string> why = plan->refusal(mean)) {
    if (!why->empty()) say(GuideKind::redo, *why, steps);
    return;
  }
  open = true;
  say(GuideKind::hold_still,
      fmt::format("At rest{}: hold still.", after(plan->place_words(mean), ", ")), steps);
}

void PoseGuide::State::lose(std::vector<GuideStep>& steps) {
  if (!open) return;
  open = false;
  say(GuideKind::redo, plan->lost_words(*seen_until_s - open_since_s), steps);
}

void PoseGuide::State::capture(const RestState& now, std::vector<GuideStep>& steps) {
  open = false;
  Pose pose;
  pose.label = fmt::format("pose {}", poses.size() + 1);
  pose.start_s = now.since_s;
  pose.end_s = now.until_s;
  pose.samples = now.samples;
  pose.mean = vector_of(now.mean);
  pose.mean_covariance.diagonal() = verdict.variance;
  poses.push_back(std::move(pose));
  const std::size_t number = poses.size();
  std::vector<GuideStep> more = plan->take(poses);
  say(GuideKind::captured,
      fmt::format("Pose {} taken{} ({:.1f} s).", number,
                  after(plan->place_words(vector_of(now.mean)), ": "), now.until_s - now.since_s),
      steps);
  for (GuideStep& step : more) say(step.kind, std::move(step.text), steps);
  say_next(steps);
}

PoseGuide::PoseGuide(const GuideOptions& options) {
  PM_EXPECTS(!options.channels.empty() && options.channels.size() <= 3);
  PM_EXPECTS(options.target_std_g > 0.0 && (!options.one_g || *options.one_g > 0.0));
  PM_EXPECTS(!options.positions || *options.positions >= 4);
  state_ = std::make_unique<State>(options);
}
PoseGuide::PoseGuide(PoseGuide&&) noexcept = default;
PoseGuide& PoseGuide::operator=(PoseGuide&&) noexcept = default;
PoseGuide::~PoseGuide() = default;

std::vector<GuideStep> PoseGuide::add(const Block& block) {
  State& s = *state_;
  std::vector<GuideStep> steps;
  if (!s.prompted) s.say_next(steps);
  s.prompted = true;
  PM_EXPECTS(!block.stamps_s.empty() || s.options.rate_hz > 0.0);
  std::array<double, 3> row{};
  const View<double> values(row.data(), s.options.channels.size());
  for (std::size_t k = 0; k < block.rows() && !s.plan->done(); ++k) {
    for (std::size_t a = 0; a < values.size(); ++a)
      row[a] = block.channels[s.options.channels[a]][k];
    const double time_s = block.stamps_s.empty()
                              ? static_cast<double>(block.first + k) / s.options.rate_hz
                              : block.stamps_s[k];
    if (s.rests.add(time_s, values)) s.look(steps);
  }
  return steps;
}

std::vector<GuideStep> PoseGuide::skip() {
  std::vector<GuideStep> steps;
  if (state_->plan->done()) return steps;
  state_->open = false;
  state_->plan->skip();
  state_->say_next(steps);
  return steps;
}

std::vector<GuideStep> PoseGuide::repeat() {
  std::vector<GuideStep> steps;
  if (state_->plan->done()) return steps;
  if (!state_->plan->repeat()) {
    state_->say(GuideKind::redo, "No position contradicts the others.", steps);
    return steps;
  }
  state_->open = false;
  state_->say_next(steps);
  return steps;
}

GuideLive PoseGuide::live() const {
  const State& s = *state_;
  const RestState& now = s.rests.state();
  GuideLive live{.phase = now.phase,
                 .seconds_left = {},
                 .words = {},
                 .can_repeat = !s.plan->done() && s.plan->can_repeat()};
  const std::string off = now.newest_there ? s.plan->off_words(vector_of(now.newest_mean)) : "";
  switch (now.phase) {
    case RestPhase::listening:
      live.words = "measuring the noise: leave it at rest for some seconds";
      break;
    case RestPhase::moving:
      live.words = off.empty() ? "moving" : off;
      break;
    case RestPhase::settling:
      live.words = "settling" + after(off, ", ");
      break;
    case RestPhase::stuck:
      live.words = "the output does not change: is the sensor connected?";
      break;
    case RestPhase::resting:
      live.words = off.empty() ? "at rest, go on" : off;
      if (!s.open) break;
      live.seconds_left = s.verdict.seconds_left;
      live.words = fmt::format("hold still: {} more", seconds_words(s.verdict.seconds_left));
  }
  return live;
}

GuidePicture PoseGuide::picture() const {
  const State& s = *state_;
  const RestState& now = s.rests.state();
  GuidePicture picture;
  picture.prompt = s.plan->done() ? "" : s.plan->prompt();
  if (now.newest_there) picture.now = vector_of(now.newest_mean);
  s.plan->draw(picture);
  if (!s.open || now.phase != RestPhase::resting) return picture;
  const double over_s = now.until_s - now.since_s, left_s = s.verdict.seconds_left;
  picture.held = over_s > 0.0 ? over_s / (over_s + std::max(0.0, left_s)) : 0.0;
  return picture;
}

bool PoseGuide::done() const {
  return state_->plan->done();
}
const std::vector<Pose>& PoseGuide::poses() const {
  return state_->poses;
}
std::vector<double> PoseGuide::angles_deg() const {
  return state_->plan->angles_deg();
}

}  // namespace proofmass::calibrate
