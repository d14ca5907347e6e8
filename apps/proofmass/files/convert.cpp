#include <fmt/format.h>
#include <fstream>
#include <iterator>

#include "cli/console.hpp"
#include "cli/exit_status.hpp"
#include "cli/flags.hpp"
#include "cli/output.hpp"
#include "input/block_reader.hpp"
#include "input/input.hpp"
#include "proofmass/core/version.hpp"
#include "proofmass/io/write_recording.hpp"
#include "proofmass/report/convert_report.hpp"
#include "proofmass/report/json.hpp"
#include "verb.hpp"

namespace proofmass::app {
namespace {

struct ConvertCommand {
  std::string file;
  InputFlags input;
  OutputFlags output;
};

void add_convert_flags(CLI::App& verb, ConvertCommand& command) {
  verb.add_option("FILE", command.file, "a recording: a file or a folder; - is standard input")
      ->type_name("")
      ->required();
  add_output_file(
      verb, command.output,
      "the new file: .csv, .csv.gz, .npy, .mat, .tdms, .h5, .mcap or .parquet; - is CSV")
      ->required();
  add_input_flags(verb, command.input);
  add_output_flags(verb, command.output);
  add_memory_flag(verb, command.input);
  verb.footer("Example:\n  proofmass convert log.csv.xz --unit mg -o log.npy");
}

// Result of a conversion: its channels, without values.
struct Converted {
  Recording head;
  std::size_t samples = 0;
  std::vector<Note> notes;
};

// Metadata on the origin of the samples, for formats that can store it.
io::WriteOptions write_options(const ConvertCommand& command) {
  io::WriteOptions options;
  options.metadata = {{"software", fmt::format("proofmass {}", version())},
                      {"source", command.file}};
  for (const std::string& path : command.input.sensors) {
    std::ifstream file(path, std::ios::binary);
    options.sensor_file.append(std::istreambuf_iterator<char>(file), {});
  }
  options.duckdb_library = duckdb_library();
  return options;
}

// Labels that the new format cannot store.
void note_lost_labels(const std::string& output, bool in_pieces, Converted& converted) {
  const Recording& head = converted.head;
  if (head.labels.empty() || io::keeps_labels(output, in_pieces)) return;
  converted.notes.push_back(
      {Severity::warning,
       fmt::format("the labels of column {} are not written: {}", head.label_channel,
                   in_pieces && io::keeps_labels(output, false)
                       ? "they are known only when all is read: give more --memory"
                       : "this format cannot store them")});
}

Converted convert(Recording recording,
                  const ConvertCommand& command,
                  const std::vector<sensor::SensorModel>& models) {
  std::vector<Recording> recordings{std::move(recording)};
  if (!models.empty()) calibrate(models, accelerometers(recordings), recordings);
  Recording& calibrated = recordings.front();
  write_series(calibrated, command.output, write_options(command));
  const std::size_t samples = calibrated.samples();
  std::vector<Note> notes = calibrated.notes;
  Converted out{std::move(calibrated), samples, std::move(notes)};
  note_lost_labels(command.output.output, false, out);
  return out;
}

void hold(const Status& status) {
  if (!status) throw Failure(status_of(status.error(), Stage::writing), status.error());
}

Converted convert(io::RecordingStream stream,
                  const ConvertCommand& command,
                  const std::vector<sensor::SensorModel>& models) {
  PieceSource source(std::move(stream), command.input, models);
  Converted out;
  const auto write = [&] {
    auto writer =
        need(io::open_writer(command.output.output,
                             {.recording = source.head(), .has_stamps = source.has_stamps()},
                             write_options(command)),
             Stage::writing);
    for (Block block = source.next(); block.rows() > 0; block = source.next()) {
      hold(writer->write(block));
      out.samples += block.rows();
    }
    hold(writer->finish(source.head()));
  };
  command.output.output == "-" ? write() : without_interruption(write);
  out.head = source.head();
  out.notes = source.head().notes;
  note_lost_labels(command.output.output, true, out);
  return out;
}

void run_convert(const ConvertCommand& command) {
  std::vector<Note> sensor_notes;
  const auto models = load_sensors(command.input, sensor_notes);
  auto opened = open_input(command.file, command.input, progress_bar(command.output));
  Converted converted =
      std::visit([&](auto& input) { return convert(std::move(input), command, models); }, opened);
  std::vector<Note>& notes = converted.notes;
  notes.insert(notes.end(), sensor_notes.begin(), sensor_notes.end());
  show_notes(notes, "", command.output);
  const report::ConvertReport result{command.file, command.output.output, converted.head,
                                     converted.samples, notes};
  publish(report::describe(result), command.output);
  hold_to_strict(command.output, !report::texts(notes, Severity::bad).empty());
}

}  // namespace

Verb convert_verb() {
  return make_verb<ConvertCommand>(
      {.name = "convert", .group = "Look", .help = "convert recordings between formats"},
      add_convert_flags, run_convert);
}

}  // namespace proofmass::app
