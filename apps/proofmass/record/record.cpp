#include <charconv>
#include <cmath>
#include <ctime>
#include <filesystem>
#include <fmt/chrono.h>
#include <fmt/format.h>
#include <fstream>
#include <sstream>

#include "cli/console.hpp"
#include "cli/exit_status.hpp"
#include "cli/flags.hpp"
#include "cli/output.hpp"
#include "proofmass/acquire/recorder.hpp"
#include "proofmass/report/record_report.hpp"
#include "record/command.hpp"
#include "record/estimate_sender.hpp"
#include "record/guide.hpp"
#include "record/live_estimate.hpp"
#include "record/live_source.hpp"
#include "record/live_view.hpp"
#include "record/stream.hpp"
#include "verb.hpp"

namespace proofmass::app {
namespace {

void add_file_flags(CLI::App& verb, RecordCommand& command) {
  const auto add = [&verb](const char* name, auto& into, const char* type, const char* help) {
    return verb.add_option(name, into, help)->type_name(type)->group("Recording");
  };
  add("-o,--output", command.output.output, "FILE.mcap",
      "the recording (default: named by source and time)");
  add("--duration", command.duration_s, "S", "duration of the recording (default: until Ctrl-C)")
      ->check(positive());
  add("--rotate", command.rotate_s, "S", "start a new file every S seconds: run.0001.mcap, …")
      ->check(positive());
  add("--rotate-mb", command.rotate_mb, "MB", "start a new file every MB megabytes")
      ->check(positive());
  CLI::Option* trigger = add("--trigger", command.trigger, "CHANNEL>LEVEL",
                             "keep only the samples around a crossing of this level, in the "
                             "channel's unit; < for a falling edge");
  add("--trigger-before", command.trigger_before_s, "S",
      "duration kept before the trigger (default 1)")
      ->check(not_negative())
      ->needs(trigger);
  add("--trigger-after", command.trigger_after_s, "S",
      "duration kept after the trigger (default 1)")
      ->check(not_negative())
      ->needs(trigger);
  verb.add_flag("--reconnect", command.reconnect,
                "wait for a source that is missing or lost, and continue after a marked gap")
      ->group("Recording");
  CLI::Option* no_file =
      verb.add_flag("--no-file", command.no_file, "record nothing: only show the samples")
          ->group("Recording")
          ->excludes(verb.get_option("--output"));
  verb.add_flag("--stream", command.stream,
                "write samples, estimates and events as lines of JSON on standard output; the "
                "recording ends when nobody reads them")
      ->group("Recording");
  for (const char* one : {"--rotate", "--rotate-mb", "--trigger"})
    no_file->excludes(verb.get_option(one));
  add("--stall", command.stall_s, "S", "report a stall after S seconds without data (default 2)")
      ->check(positive());
  add("--stall-end", command.stall_end_s, "S",
      "consider the source lost after S seconds without data (default 30)")
      ->check(positive());
}

void add_estimate_flags(CLI::App& verb, RecordCommand& command) {
  const auto add = [&verb](const char* name, auto& into, const char* type, const char* help) {
    return verb.add_option(name, into, help)->type_name(type)->group("Estimate");
  };
  CLI::Option* estimate = add("--estimate", command.estimate, "WHAT",
                              "estimate online and record with the samples: wheel (angle and "
                              "speed), tilt (roll and pitch) or track (displacement)");
  estimate->check(CLI::IsMember({"wheel", "tilt", "track"}));
  add("--lag", command.lag_s, "S", "lag of the fixed-lag smoother (default 0.25; 3 for track)")
      ->check(not_negative())
      ->needs(estimate);
  add("--send-to", command.send_to, "ADDRESS",
      "send each estimate as a datagram of JSON, for a controller: udp:HOST:PORT, or unix:PATH of "
      "a datagram socket that it has bound")
      ->needs(estimate);
  add("--radius", command.radius_m, "M", "distance of the wheel's sensors from the axle, if known")
      ->check(positive())
      ->needs(estimate);
  add("--rolling-radius", command.rolling_radius_m, "M",
      "rolling radius of a vehicle's wheel (0: a bench)")
      ->check(not_negative())
      ->needs(estimate);
  add("--bandwidth", command.bandwidth_hz, "HZ",
      "-3 dB bandwidth of the wheel sensors' filter, which delays the angle (default: from the "
      "--sensor file, else unknown)")
      ->check(positive())
      ->needs(estimate);
  add("--axis", command.axis, "AXIS", "axis of the wheel's axle, or of the motion (default: found)")
      ->needs(estimate);
  verb.add_flag("--no-gyro", command.no_gyro, "do not use the gyroscope's channels")
      ->group("Estimate")
      ->needs(estimate);
  add("--rate-unit", command.rate_unit, "UNIT",
      "unit of the gyroscope if the source does not state it: rad/s (default) or deg/s")
      ->check(CLI::IsMember({"rad/s", "deg/s"}))
      ->needs(estimate);
  add("--procedure", command.guide.procedure, "NAME",
      "guided procedure: tumble, multi-position or static, followed by calibration or noise "
      "analysis")
      ->check(CLI::IsMember({"tumble", "multi-position", "static"}))
      ->excludes(estimate);
}

void add_guide_flags(CLI::App& verb, GuideFlags& flags, std::string& report) {
  CLI::Option* procedure = verb.get_option("--procedure");
  const auto add = [&](const char* name, auto& into, const char* type, const char* help) {
    return verb.add_option(name, into, help)->type_name(type)->group("Procedure")->needs(procedure);
  };
  add("--positions", flags.positions, "N",
      "positions per turn of the table, or minimum by hand (default 12)")
      ->check(CLI::Range(4, 360));
  add("--target-std", flags.target_std_mg, "MG",
      "wanted standard deviation of calibrated measurements at 1 g (default 1)")
      ->check(positive());
  add("--minutes", flags.minutes, "MIN",
      "duration of static (default: until the noise floor is reached, 5 to 60)")
      ->check(positive());
  add("--update-sensor", flags.update_sensor, "FILE.toml",
      "write the results into this sensor file");
  add("--report", report, "FILE.html", "write the analysis as one self-contained page")
      ->excludes(verb.get_option("--no-file"));
  procedure->excludes(verb.get_option("--no-file"));
}

// Input flags that apply to live samples.
void add_live_input_flags(CLI::App& verb, InputFlags& flags) {
  const auto add = [&verb](const char* name, auto& into, const char* type, const char* help) {
    return verb.add_option(name, into, help)->type_name(type)->group("Input");
  };
  add("--rate", flags.rate_hz, "HZ",
      "request this sample rate from the source (as rate= in SOURCE)")
      ->check(positive());
  add("--unit", flags.unit, "UNIT",
      "unit of channels if the source does not state it: g, mg, m/s2, V, mV or counts")
      ->check(CLI::IsMember({"g", "mg", "m/s2", "V", "mV", "counts"}))
      ->transform(unit_spelling());
  add("--channel", flags.channels, "NAME",
      "channel for the estimate and the procedure; may be repeated (default: all accelerometers). "
      "All channels are recorded")
      ->allow_extra_args(false);
  add_place_flags(verb, flags);
}

void add_record_flags(CLI::App& verb, RecordCommand& command) {
  CLI::Option* source =
      verb.add_option("SOURCE", command.source,
                      "such as sim:, serial:/dev/ttyACM0, iio:ip:HOST; - is standard input");
  source->type_name("");
  verb.add_flag("--list", command.list, "list the sources found, and all kinds of source")
      ->excludes(source);
  add_file_flags(verb, command);
  add_estimate_flags(verb, command);
  add_guide_flags(verb, command.guide, command.output.report);
  add_live_input_flags(verb, command.input);
  add_output_flags(verb, command.output);
  verb.footer(
      "Examples:\n"
      "  proofmass record --list\n"
      "  proofmass record sim: -o run.mcap --duration 60 --estimate wheel\n"
      "  proofmass record 'serial:/dev/ttyACM0?baud=115200' --unit g --reconnect\n"
      "  proofmass record 'iio:ip:192.168.0.7?rate=1000' --procedure multi-position");
}

void list_sources(const RecordCommand& command) {
  report::SourceList list;
  const acquire::OpenOptions options = open_options();
  for (const acquire::SourceKind& kind : acquire::source_kinds()) {
    list.kinds.emplace_back(kind.grammar, kind.what);
    if (!kind.find) continue;
    const auto found = kind.find(options);
    if (!found) {
      list.notes.push_back({Severity::info, kind.scheme + ": " + found.error().message});
      continue;
    }
    for (const acquire::FoundSource& one : *found) list.found.emplace_back(one.uri, one.what);
  }
  publish(report::describe(list), command.output);
}

// "sim-20261122-123005.mcap"
std::string default_name(const std::string& source) {
  const std::string scheme = source == "-" ? "stdin" : source.substr(0, source.find(':'));
  return fmt::format("{}-{:%Y%m%d-%H%M%S}.mcap", scheme, fmt::localtime(std::time(nullptr)));
}

void expect_sense(const RecordCommand& command) {
  if (command.source.empty())
    throw Failure(usage, "record: no SOURCE: proofmass record --list shows what is there");
  const std::string& file = command.output.output;
  if (!file.empty() && !file.ends_with(".mcap"))
    throw Failure(usage, file +
                             ": a recording is an MCAP file while it is made: name it .mcap; "
                             "proofmass convert makes others of it");
}

// "acc_x>2", "acc_x < -0.5"
acquire::LevelTrigger parse_trigger(const RecordCommand& command) {
  const std::string& text = command.trigger;
  const Failure bad(
      usage, fmt::format("--trigger: expected CHANNEL>LEVEL or CHANNEL<LEVEL, not '{}'", text));
  const std::size_t sign = text.find_first_of("<>");
  if (sign == std::string::npos) throw bad;
  acquire::LevelTrigger out;
  out.channel = text.substr(0, text.find_last_not_of(' ', sign == 0 ? 0 : sign - 1) + 1);
  const std::size_t number = std::min(text.find_first_not_of(' ', sign + 1), text.size());
  const char* const end = text.data() + text.size();
  const auto [stop, problem] = std::from_chars(text.data() + number, end, out.level);
  if (out.channel.empty() || sign == 0 || problem != std::errc{} || stop != end ||
      !std::isfinite(out.level))
    throw bad;
  using Edge = acquire::LevelTrigger::Edge;
  out.edge = text[sign] == '>' ? Edge::rising : Edge::falling;
  out.before_s = command.trigger_before_s;
  out.after_s = command.trigger_after_s;
  return out;
}

std::string text_of(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  if (!in) throw Failure(bad_input, file + ": cannot be read");
  return text.str();
}

acquire::RecordOptions options_of(const RecordCommand& command) {
  constexpr double bytes_per_mb = 1e6;
  acquire::RecordOptions options;
  options.path = command.output.output;
  options.keeps_file = !command.no_file;
  options.duration_s = command.duration_s;
  options.rotate_s = command.rotate_s;
  if (command.rotate_mb)
    options.rotate_bytes = static_cast<std::uint64_t>(*command.rotate_mb * bytes_per_mb);
  if (!command.trigger.empty()) options.trigger = parse_trigger(command);
  options.reconnect = command.reconnect;
  options.stall_s = command.stall_s;
  options.stall_end_s = std::max(command.stall_end_s, command.stall_s);
  options.metadata["command"] = "proofmass record " + acquire::shown_uri(command.source);
  for (const std::string& file : command.input.sensors)
    options.sensor_files.push_back(text_of(file));
  return options;
}

// What follows a recording besides the file; all but the view may be null.
struct Followers {
  LiveView& view;
  RecordGuide* guide;
  RecordStream* stream;
  EstimateSender* sender;
};

void follow_samples(const Followers& to, const Block& block) {
  to.view.samples(block);
  if (to.stream != nullptr) to.stream->samples(block);
  if (to.guide == nullptr) return;
  for (const std::string& line : to.guide->samples(block)) to.view.say(line);
  to.view.guide(to.guide->live());
  if (to.stream != nullptr) to.stream->guide([&to] { return to.guide->picture(); });
}

acquire::RecordWatch watch_by(const Followers& to,
                              const std::string& file,
                              report::RecordReport& report) {
  acquire::RecordWatch watch;
  watch.stopped = [to] {
    to.view.refresh();
    if (to.stream != nullptr) to.stream->refresh();
    return interruption_waits() || (to.guide != nullptr && to.guide->done()) ||
           (to.stream != nullptr && to.stream->is_broken());
  };
  watch.opened = [to, file, &report](const acquire::SourceHead& head) {
    report.settings = head.settings;
    to.view.opened(head.recording.channels);
    if (to.stream != nullptr) to.stream->opened(head.recording, file);
    if (to.guide != nullptr) to.guide->opened(head.recording);
  };
  watch.samples = [to](const Block& block) { follow_samples(to, block); };
  watch.estimates = [to](const Block& rows) {
    if (to.sender != nullptr) to.sender->estimates(rows);
    to.view.estimates(rows);
    if (to.stream != nullptr) to.stream->estimates(rows);
  };
  watch.event = [to](const RecordEvent& event) {
    to.view.event(event);
    if (to.stream != nullptr) to.stream->event(event);
  };
  return watch;
}

// An error before the source was opened concerns the source, a later one the file.
ExitStatus status_of(const Error& error, bool was_open) {
  // The driver of a card or board is missing.
  if (!was_open && error.code == Errc::unsupported) return bad_device;
  return app::status_of(error, was_open ? Stage::writing : Stage::reading);
}

report::RecordReport record(const RecordCommand& command,
                            RecordGuide* guide,
                            RecordStream* stream,
                            EstimateSender* sender) {
  report::RecordReport report;
  report.source = acquire::shown_uri(command.source);
  const acquire::RecordOptions options = options_of(command);
  LiveView view(report.source, command.no_file ? "no file" : options.path, command.output);
  const acquire::RecordWatch watch =
      watch_by({view, guide, stream, sender}, command.no_file ? "" : options.path, report);
  bool was_open = false;
  const acquire::OpenSource open = [&was_open, opener = source_opener(command)] {
    auto source = opener();
    was_open = was_open || source.has_value();
    return source;
  };
  const auto columns = [&](const std::vector<Channel>& made) {
    view.estimating(made);
    if (sender != nullptr) sender->estimating(made);
    if (stream != nullptr) stream->estimating(made);
  };
  auto summary =
      acquire::record(open, options, watch, make_estimate(command, columns, report.notes));
  if (!summary) throw Failure(status_of(summary.error(), was_open), summary.error());
  report.summary = std::move(summary).value();
  if (stream != nullptr && guide != nullptr) stream->guide([&] { return guide->picture(); }, true);
  if (stream != nullptr) stream->ended(report.summary);
  if (sender != nullptr && sender->dropped() > 0)
    report.notes.push_back(
        {Severity::warning,
         fmt::format("{} of {} estimates were dropped by --send-to, as nobody took them",
                     sender->dropped(), sender->sent() + sender->dropped())});
  return report;
}

// Lists the completed rests beside the recording, and runs the procedure's verb on it.
void finish(const RecordGuide& guide, const std::string& file, const OutputFlags& flags) {
  const std::string again = guide.write_rests(file);
  show_line("  To do this again: " + again, flags);
  if (!interruption_waits()) guide.run_verb(file);
}

void expect_no_break(const RecordSummary& summary) {
  if (summary.end == RecordEnd::source_gone) throw Failure(bad_device, summary.end_reason);
  if (summary.end == RecordEnd::disk_failed) throw Failure(failed, summary.end_reason);
}

template <class T>
T* pointer_to(std::optional<T>& value) {
  return value ? &*value : nullptr;
}

// With a procedure, the document is that of its verb.
OutputFlags outputs_of_recording(const OutputFlags& flags, bool guided) {
  OutputFlags own = flags;
  if (guided) {
    own.json.clear();
    own.report.clear();
  }
  return own;
}

void run_record(const RecordCommand& given) {
  if (given.list) return list_sources(given);
  expect_sense(given);
  ignore_broken_pipes();
  RecordCommand command = given;
  if (command.output.output.empty()) command.output.output = default_name(command.source);
  std::optional<RecordGuide> guide;
  if (!command.guide.procedure.empty()) guide.emplace(command);
  std::optional<RecordStream> stream;
  if (command.stream) stream.emplace();
  std::optional<EstimateSender> sender;
  if (!command.send_to.empty()) sender.emplace(command.send_to);
  without_interruption([&] {
    const report::RecordReport report =
        record(command, pointer_to(guide), pointer_to(stream), pointer_to(sender));
    const report::Document document = report::describe(report);
    show_notes(report.notes, "", command.output);
    if (!guide || command.output.json != "-")
      publish(document, outputs_of_recording(command.output, guide.has_value()));
    if (guide && !report.summary.files.empty())
      finish(*guide, report.summary.files.front(), command.output);
    expect_no_break(report.summary);
    hold_to_strict(command.output, document.bad);
    if (report.summary.end == RecordEnd::stopped) interruption_was_awaited();
  });
}

}  // namespace

Verb record_verb() {
  return make_verb<RecordCommand>(
      {.name = "record",
       .group = "Live",
       .help = "record live samples from a device, the network, a pipe or the digital twin"},
      add_record_flags, run_record);
}

}  // namespace proofmass::app
