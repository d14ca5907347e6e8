#include "record/guide.hpp"

#include <algorithm>
#include <array>
#include <filesystem>
#include <fmt/format.h>
#include <limits>
#include <poll.h>
#include <string_view>
#include <unistd.h>

#include "calibrate/command.hpp"
#include "cli/exit_status.hpp"
#include "cli/output.hpp"
#include "cli/provenance.hpp"
#include "noise/command.hpp"
#include "record/guide_line.hpp"
#include "tumble/command.hpp"

namespace proofmass::app {
namespace {

using calibrate::GuideKind;
using calibrate::GuideOptions;
using calibrate::GuideProcedure;

GuideProcedure procedure_of(const GuideFlags& flags) {
  if (flags.procedure == "tumble") return GuideProcedure::tumble;
  return flags.procedure == "static" ? GuideProcedure::still : GuideProcedure::multi_position;
}

// The channels named by --channel; else those of the only accelerometer.
std::vector<std::size_t> axes_of(const Recording& head, const std::vector<std::string>& named) {
  std::vector<std::size_t> out;
  for (const std::string& name : named) {
    const Channel* channel = head.find(name);
    if (channel == nullptr) throw Failure(usage, "--channel: no channel '" + name + "'");
    out.push_back(static_cast<std::size_t>(channel - head.channels.data()));
  }
  if (!out.empty()) return out;
  const std::vector<Triad> triads = accelerometer_triads(head);
  if (triads.size() != 1)
    throw Failure(usage, fmt::format("--procedure: {} accelerometers among the channels, expected "
                                     "one: name its channels with --channel",
                                     triads.empty() ? "no" : std::to_string(triads.size())));
  for (const auto& axis : {triads[0].x, triads[0].y, triads[0].z})
    if (axis) out.push_back(*axis);
  return out;
}

GuideOptions guide_options(const RecordCommand& command, const Recording& head) {
  const GuideFlags& flags = command.guide;
  GuideOptions options;
  options.procedure = procedure_of(flags);
  options.channels = axes_of(head, command.input.channels);
  const bool three = options.procedure == GuideProcedure::multi_position;
  const std::size_t count = options.channels.size();
  if (count > 3 || (three && count != 3))
    throw Failure(usage, fmt::format("--procedure {}: {} axes, expected {}", flags.procedure, count,
                                     three ? "three" : "one to three"));
  options.rate_hz = head.time.rate_hz;
  const Unit& unit = head.channels[options.channels.front()].unit;
  if (unit.quantity == Quantity::acceleration) options.one_g = standard_gravity_mps2 / unit.to_si;
  constexpr double g_per_mg = 1e-3, s_per_minute = 60.0;
  if (flags.target_std_mg) options.target_std_g = g_per_mg * *flags.target_std_mg;
  options.positions = flags.positions;
  if (flags.minutes) options.still_s = s_per_minute * *flags.minutes;
  return options;
}

std::string rests_path(const std::string& file) {
  return std::filesystem::path(file).replace_extension("rests.csv").string();
}

std::string verb_of(const GuideFlags& flags) {
  switch (procedure_of(flags)) {
    case GuideProcedure::tumble:
      return "tumble";
    case GuideProcedure::still:
      return "noise";
    case GuideProcedure::multi_position:
      break;
  }
  return "calibrate";
}

// Half-open, a microsecond to either side: the file's stamps are rounded to nanoseconds.
constexpr double margin_s = 1e-6;

double start_of(const calibrate::Pose& pose) {
  return std::max(0.0, *pose.start_s - margin_s);
}
double end_of(const calibrate::Pose& pose) {
  return *pose.end_s + margin_s;
}

}  // namespace

RecordGuide::RecordGuide(const RecordCommand& command) : command_(command) {
  if (command.rotate_s || command.rotate_mb || !command.trigger.empty())
    throw Failure(usage,
                  "--procedure: all of it is needed in one file: leave out --rotate and "
                  "--trigger");
  const GuideFlags& flags = command.guide;
  const bool still = procedure_of(flags) == GuideProcedure::still;
  if (flags.minutes && !still) throw Failure(usage, "--minutes goes with --procedure static");
  if (flags.positions && still)
    throw Failure(usage, "--positions goes with --procedure tumble or multi-position");
}

void RecordGuide::opened(const Recording& head) {
  if (guide_ || !why_not_.empty()) return;
  try {
    guide_.emplace(guide_options(command_, head));
  } catch (const Failure& failure) {
    // Reported after the end of the recording.
    why_not_ = failure.what();
  }
}

void RecordGuide::report(const calibrate::GuideStep& step, std::vector<std::string>& lines) {
  const bool is_prompt = step.kind == GuideKind::prompt;
  lines.push_back((is_prompt ? "→ " : "  ") + step.text);
  if (!is_prompt) said_ = step.text;
}

std::vector<std::string> RecordGuide::samples(const Block& block) {
  if (!guide_) return {};
  std::vector<std::string> lines = keys();
  for (const calibrate::GuideStep& step : guide_->add(block)) report(step, lines);
  while (errors_g_.size() < guide_->poses().size())
    errors_g_.push_back(
        guide_->picture().error_g.value_or(std::numeric_limits<double>::quiet_NaN()));
  return lines;
}

// Enter: skip this position; p: repeat the one that contradicts the others; q: end the procedure.
// With --stream the words "skip", "repeat" and "quit".
std::vector<std::string> RecordGuide::keys() {
  std::vector<std::string> lines;
  pollfd input{STDIN_FILENO, POLLIN, 0};
  const bool is_asked = command_.stream || isatty(STDIN_FILENO) == 1;
  if (command_.source == "-" || !is_asked || poll(&input, 1, 0) <= 0) return lines;
  std::array<char, 64> typed{};
  const ssize_t count = read(STDIN_FILENO, typed.data(), typed.size());
  typed_.append(typed.data(), static_cast<std::size_t>(std::max<ssize_t>(count, 0)));
  constexpr std::size_t longest_word = 256;
  if (typed_.size() > longest_word) typed_.clear();
  for (std::size_t end = 0; (end = typed_.find('\n')) != std::string::npos;) {
    const std::string word = typed_.substr(0, end);
    typed_.erase(0, end + 1);
    ended_ |= word.find_first_of("qQ") != std::string::npos;
    if (ended_) return lines;
    const bool again = word.starts_with('p') || word.starts_with('P') || word == "repeat";
    for (const calibrate::GuideStep& step : again ? guide_->repeat() : guide_->skip())
      report(step, lines);
  }
  return lines;
}

std::string RecordGuide::live() const {
  if (!guide_) return "";
  const calibrate::GuideLive live = guide_->live();
  return fmt::format("{}   (Enter: leave it out, {}q Enter: that will do)", live.words,
                     live.can_repeat ? "p Enter: repeat what contradicts, " : "");
}

std::string RecordGuide::picture() const {
  if (!guide_) return "null";
  constexpr double default_target_mg = 1.0;
  return guide_line(*guide_, {.procedure = command_.guide.procedure,
                              .said = said_,
                              .target_mg = command_.guide.target_std_mg.value_or(default_target_mg),
                              .errors_g = errors_g_,
                              .is_done = done()});
}

bool RecordGuide::done() const {
  return ended_ || !why_not_.empty() || (guide_ && guide_->done());
}

std::string RecordGuide::write_rests(const std::string& file) const {
  if (!why_not_.empty()) throw Failure(usage, why_not_);
  if (!guide_ || guide_->poses().empty())
    throw Failure(bad_input, file + ": no rest was taken: there is nothing to work on");
  const std::vector<calibrate::Pose>& poses = guide_->poses();
  if (procedure_of(command_.guide) == GuideProcedure::still)
    return fmt::format("proofmass noise {} --from {:.6f} --to {:.6f}", file, start_of(poses.back()),
                       end_of(poses.back()));
  const std::vector<double> angles = guide_->angles_deg();
  std::string text =
      angles.empty() ? "start (s),end (s),label\n" : "start (s),end (s),label,angle (deg)\n";
  for (std::size_t k = 0; k < poses.size(); ++k) {
    text += fmt::format("{:.6f},{:.6f},{}", start_of(poses[k]), end_of(poses[k]), poses[k].label);
    text += angles.empty() ? "\n" : fmt::format(",{}\n", angles[k]);
  }
  write_text(rests_path(file), text, command_.output);
  return fmt::format("proofmass {} {} --rests {}", verb_of(command_.guide), file, rests_path(file));
}

void RecordGuide::run_verb(const std::string& file) const {
  InputFlags input;
  input.gravity_mps2 = command_.input.gravity_mps2;
  input.latitude_deg = command_.input.latitude_deg;
  input.height_m = command_.input.height_m;
  input.channels = command_.input.channels;
  OutputFlags output = command_.output;
  output.output.clear();
  // The input of the evaluation is the recording, not the source.
  if (output.invocation) {
    const report::Provenance& asked = output.invocation->provenance();
    output.invocation = std::make_shared<Invocation>(
        asked.command, asked.options, std::vector<std::string>{file, rests_path(file)});
  }
  const auto fill = [&](auto command) {
    command.files = {file};
    command.input = input;
    command.output = output;
    command.update_sensor = command_.guide.update_sensor;
    return command;
  };
  switch (procedure_of(command_.guide)) {
    case GuideProcedure::multi_position: {
      CalibrateCommand command = fill(CalibrateCommand{});
      command.rests = rests_path(file);
      return run_calibrate(command);
    }
    case GuideProcedure::tumble: {
      TumbleCommand command = fill(TumbleCommand{});
      command.rests = rests_path(file);
      return run_tumble(command);
    }
    case GuideProcedure::still: {
      NoiseCommand command = fill(NoiseCommand{});
      command.input.from_s = start_of(guide_->poses().back());
      command.input.to_s = end_of(guide_->poses().back());
      return run_noise(command);
    }
  }
}

}  // namespace proofmass::app
