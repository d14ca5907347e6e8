#include "noise/streaming.hpp"

#include <cmath>
#include <fmt/format.h>
#include <utility>

#include "cli/exit_status.hpp"
#include "input/block_reader.hpp"
#include "input/channel_selection.hpp"
#include "input/input.hpp"
#include "proofmass/characterise/noise_stream.hpp"
#include "proofmass/report/wording.hpp"
#include "proofmass/signal/running_audit.hpp"
#include "proofmass/signal/running_grid.hpp"

namespace proofmass::app {
namespace {

using characterise::NoiseAnalysis;
using characterise::NoiseOptions;
using characterise::NoiseStream;

// State of one channel.
struct Stream {
  std::size_t place;  // index in the recording
  Unit from, to;      // units of the values and of the series
  NoiseStream noise;
  std::vector<double> series;  // the current piece
};

std::vector<Stream> start(const PieceSource& source,
                          const std::vector<std::size_t>& chosen,
                          NoiseOptions options) {
  options.rate_hz = source.head().time.rate_hz;
  std::vector<Stream> streams;
  for (const std::size_t place : chosen) {
    const Unit& unit = source.head().channels[place].unit;
    Result<NoiseStream> started = NoiseStream::start(
        options, static_cast<std::size_t>(source.expected_samples().value_or(0)));
    if (!started) throw Failure(usage, started.error().at(source.head().source));
    streams.push_back({place, unit, si_unit(unit), std::move(started).value(), {}});
  }
  return streams;
}

void hold(const Status& status, const std::string& file) {
  if (status) return;
  const Error error = status.error().at(file);
  throw Failure(status_of(error, Stage::reading), error);
}

Block part_of(const Block& block, const std::vector<Stream>& streams) {
  Block part;
  part.first = block.first;
  part.stamps_s = block.stamps_s;
  for (const Stream& stream : streams) part.channels.push_back(block.channels[stream.place]);
  return part;
}

void add(std::vector<Stream>& streams, std::span<const View<double>> places) {
  for (std::size_t k = 0; k < streams.size(); ++k) {
    Stream& stream = streams[k];
    if (stream.from == stream.to) {
      stream.noise.add(places[k]);
      continue;
    }
    stream.series.assign(places[k].begin(), places[k].end());
    for (double& value : stream.series) value = stream.from.si(value);
    stream.noise.add(stream.series);
  }
}

NoiseChannel finished(Stream& stream,
                      const signal::ChannelAudit& audit,
                      const signal::EvenGrid& grid,
                      std::size_t samples) {
  NoiseChannel channel;
  channel.rest.name = audit.name;
  channel.rest.rate_hz = grid.rate_hz;
  channel.rest.unit = series_unit(stream.to, false);
  channel.rest.refused = clipping(audit, samples);
  if (audit.lsb) channel.rest.lsb = *audit.lsb * stream.from.to_si / stream.to.to_si;
  channel.shown.unit = channel.rest.unit;
  channel.shown.refused = channel.rest.refused;
  if (!channel.shown.refused.empty()) return channel;
  Result<NoiseAnalysis> found =
      stream.noise.finish({.rate_hz = grid.rate_hz, .lsb = channel.rest.lsb});
  if (found)
    channel.shown.analysis = std::move(found).value();
  else
    channel.shown.refused = found.error().message;
  return channel;
}

}  // namespace

std::vector<NoiseChannel> analyse_pieces(io::RecordingStream stream,
                                         const RestOptions& options,
                                         const NoiseOptions& noise,
                                         std::vector<Note>& notes) {
  const std::string file = stream.head().source;
  const std::string prefix = file_prefix(file, options);
  if (!options.temperature.empty()) {
    throw Failure(usage, file +
                             ": --temperature needs the whole recording in memory, and it is "
                             "larger than --memory: give more, or cut it with --from and --to");
  }
  const std::vector<sensor::SensorModel> models = load_sensors(options.input, notes);
  PieceSource source(std::move(stream), options.input, models);
  const RestChoice choice = choose_rest(source.head(), {}, !options.input.channels.empty());
  if (choice.channels.empty()) throw Failure(usage, file + ": no channel to analyse");
  std::vector<Stream> streams = start(source, choice.channels, noise);
  Recording head = source.head();
  head.channels.clear();
  for (const Stream& one : streams) head.channels.push_back(source.head().channels[one.place]);
  signal::RunningAudit audit(head);
  signal::RunningEvenGrid grid(head.time, streams.size(),
                               static_cast<std::size_t>(source.expected_samples().value_or(0)));
  const auto sink = [&](std::span<const View<double>> places) { add(streams, places); };
  for (Block block = source.next(); block.rows() > 0; block = source.next()) {
    const Block part = part_of(block, streams);
    audit.add(part);
    hold(grid.add(part, sink), file);
  }
  const auto laid = grid.finish(sink);
  if (!laid) hold(laid.error(), file);
  head.notes = source.head().notes;
  head.first_line = source.head().first_line;
  head.time = source.head().time;
  const signal::RecordingAudit found = audit.finish(head);
  for (const Note& note : found.notes) notes.push_back({note.severity, prefix + note.text});
  note_grid(*laid, grid.hole_count(), prefix, notes);
  std::vector<NoiseChannel> channels;
  for (std::size_t k = 0; k < streams.size(); ++k) {
    channels.push_back(finished(streams[k], found.channels[k], *laid, found.samples));
    RestChannel& rest = channels.back().rest;
    rest.axis = choice.axes[k];
    rest.title = prefix + rest.name;
    rest.file = file;
    channels.back().shown.name = rest.title;
    if (options.for_sensor_file) expect_axis(rest, options);
  }
  return channels;
}

}  // namespace proofmass::app
