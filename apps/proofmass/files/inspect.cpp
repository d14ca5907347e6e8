#include <deque>
#include <optional>

#include "cli/console.hpp"
#include "cli/exit_status.hpp"
#include "cli/flags.hpp"
#include "cli/output.hpp"
#include "input/block_reader.hpp"
#include "input/input.hpp"
#include "proofmass/io/pyramid.hpp"
#include "proofmass/io/write_recording.hpp"
#include "proofmass/report/inspect_report.hpp"
#include "proofmass/signal/running_audit.hpp"
#include "proofmass/signal/running_overview.hpp"
#include "verb.hpp"

namespace proofmass::app {
namespace {

struct InspectCommand {
  std::vector<std::string> files;
  bool pyramid = false;
  InputFlags input;
  OutputFlags output;
};

void add_inspect_flags(CLI::App& verb, InspectCommand& command) {
  verb.add_option("FILE", command.files, "recordings: files or folders; - is standard input")
      ->type_name("")
      ->required();
  add_input_flags(verb, command.input);
  verb.add_flag("--pyramid", command.pyramid,
                "store minima and maxima at every scale beside each file, as FILE.pyramid.npz, for "
                "plots at any zoom without reading it again");
  add_report_flag(verb, command.output);
  add_page_flag(verb, command.output);
  add_output_flags(verb, command.output);
  add_memory_flag(verb, command.input);
  verb.footer("Example:\n  proofmass inspect wheel.csv --report wheel.html");
}

// An audited file; the recording is an overview if it is too large for memory.
struct Inspected {
  Recording recording;
  signal::RecordingAudit audit;
  std::size_t overview_span = 0;
};

using Models = std::vector<sensor::SensorModel>;

// A pyramid describes the whole unmodified file; a part of it or calibrated values would need
// another.
void check_pyramid(const InspectCommand& command) {
  const InputFlags& input = command.input;
  const bool as_it_is = !input.from_s && !input.to_s && input.sensors.empty() &&
                        input.channels.empty() && !input.resample_hz && !input.skew_s;
  if (command.pyramid && !as_it_is) {
    throw Failure(usage,
                  "--pyramid is of a file as it is: leave out --from, --to, --channel, "
                  "--sensor, --resample and --skew");
  }
}

void store(io::PyramidBuilder& builder, const std::string& file) {
  const Status stored = io::store_pyramid(builder.finish(), file);
  if (!stored) throw Failure(status_of(stored.error(), Stage::writing), stored.error());
}

// Audit of the file in its own units; in m/s^2 only with a sensor file.
Inspected inspect(Recording recording, const InspectCommand& command, const Models& models) {
  std::vector<Recording> recordings{std::move(recording)};
  if (!models.empty()) calibrate(models, accelerometers(recordings), recordings);
  signal::RecordingAudit audit = signal::audit(recordings.front());
  if (command.pyramid) {
    io::PyramidBuilder pyramid(recordings.front());
    pyramid.add(io::whole_of(recordings.front()));
    store(pyramid, recordings.front().source);
  }
  return {std::move(recordings.front()), std::move(audit)};
}

Inspected inspect(io::RecordingStream stream, const InspectCommand& command, const Models& models) {
  PieceSource source(std::move(stream), command.input, models);
  signal::RunningAudit audit(source.head());
  signal::RunningOverview overview(source.head().channels.size());
  std::optional<io::PyramidBuilder> pyramid;
  if (command.pyramid) pyramid.emplace(source.head());
  for (Block block = source.next(); block.rows() > 0; block = source.next()) {
    audit.add(block);
    overview.add(block);
    if (pyramid) pyramid->add(block);
  }
  if (pyramid) store(*pyramid, source.head().source);
  return {overview.finish(source.head()), audit.finish(source.head()), overview.span()};
}

// The sensor files of one file's accelerometers, if there is one for each; `used` counts those used
// so far.
Models models_of(const Models& models, const Recording& recording, std::size_t& used) {
  if (models.size() < 2) return models;
  Recording head;
  head.source = recording.source;
  for (const Channel& channel : recording.channels)
    head.channels.push_back({channel.name, channel.unit, {}});
  const std::size_t count = accelerometers({head}).size();
  if (used + count > models.size()) {
    throw Failure(usage,
                  "--sensor: more accelerometers than files: give one for all or one for each");
  }
  used += count;
  const auto first = models.begin() + static_cast<std::ptrdiff_t>(used - count);
  return {first, first + static_cast<std::ptrdiff_t>(count)};
}

const Recording& head_of(const std::variant<Recording, io::RecordingStream>& opened) {
  const auto* recording = std::get_if<Recording>(&opened);
  return recording != nullptr ? *recording : std::get<io::RecordingStream>(opened).head();
}

void run_inspect(const InspectCommand& command) {
  check_pyramid(command);
  std::vector<Note> sensor_notes;
  const Models models = load_sensors(command.input, sensor_notes);
  std::deque<Inspected> all;
  std::size_t used = 0;
  for (const std::string& file : command.files) {
    auto opened = open_input(file, command.input, progress_bar(command.output));
    const Models own = models_of(models, head_of(opened), used);
    all.push_back(
        std::visit([&](auto& input) { return inspect(std::move(input), command, own); }, opened));
  }
  if (models.size() > 1 && used < models.size()) {
    throw Failure(usage,
                  "--sensor: fewer accelerometers than files: give one for all or one for each");
  }
  show_notes(sensor_notes, "", command.output);
  std::vector<report::InspectedFile> files;
  for (std::size_t k = 0; k < all.size(); ++k)
    files.push_back({command.files[k], all[k].recording, all[k].audit, all[k].overview_span});
  finish(report::describe(files), {}, command.output);
}

}  // namespace

Verb inspect_verb() {
  return make_verb<InspectCommand>(
      {.name = "inspect", .group = "Look", .help = "contents and data quality of a recording"},
      add_inspect_flags, run_inspect);
}

}  // namespace proofmass::app
