#include "noise/sums.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <iterator>
#include <limits>
#include <utility>

#include "cli/exit_status.hpp"
#include "cli/output.hpp"
#include "cli/provenance.hpp"
#include "input/rest_channels.hpp"
#include "noise/joined.hpp"
#include "proofmass/characterise/noise_stream.hpp"
#include "proofmass/core/state_bytes.hpp"
#include "proofmass/fleet/noise_sums.hpp"
#include "proofmass/report/wording.hpp"

namespace proofmass::app {
namespace {

using characterise::NoiseAnalysis;
using characterise::NoiseOptions;
using characterise::NoiseStream;
using fleet::RecordingSums;
using fleet::SummedChannel;
using fleet::SumsPlace;

// What the sums depend on; the other flags matter only when they are joined.
std::string options_of_sums(const NoiseCommand& command) {
  return fmt::format("--statistic {} --taus {}", command.statistic,
                     command.taus.empty() ? "16-per-decade" : command.taus);
}

NoiseStream stream_at(const NoiseOptions& options, const SumsPlace& place, std::size_t channel) {
  Result<NoiseStream> stream = NoiseStream::start_part(options, place.of_channel(channel));
  if (!stream) throw Failure(usage, stream.error());
  return std::move(stream).value();
}

std::string sums_of(const RestChannel& channel,
                    NoiseOptions options,
                    const SumsPlace& place,
                    std::size_t number) {
  StateBytes bytes;
  if (place.as_samples) {
    std::vector<double> samples = channel.series.copy();
    bytes(samples);
    return std::move(bytes).bytes();
  }
  options.rate_hz = channel.rate_hz;
  NoiseStream stream = stream_at(options, place, number);
  stream.add(channel.series);
  stream.exchange(bytes);
  return std::move(bytes).bytes();
}

SummedChannel card_of(const RestChannel& channel) {
  SummedChannel card{.name = channel.name,
                     .unit = channel.unit,
                     .refused = channel.refused,
                     .lsb = channel.lsb,
                     .first_valid = {},
                     .sums = {}};
  const auto valid =
      std::ranges::find_if(channel.series, [](double x) { return std::isfinite(x); });
  if (valid != channel.series.end())
    card.first_valid = static_cast<std::size_t>(valid - channel.series.begin());
  return card;
}

struct SumsFlag {
  std::string key;
  std::optional<SumsPlace> place;
};

SumsFlag parse_sums_flag(const std::string& text) {
  const std::size_t slash = text.find('/');
  const std::string place = slash == std::string::npos ? "" : text.substr(slash + 1);
  SumsFlag flag{text.substr(0, slash), SumsPlace::parse(place)};
  if (flag.key.empty() || flag.key.find(' ') != std::string::npos ||
      (!flag.place && place != "none"))
    throw Failure(usage, "--sums: expected KEY/PLACE, not '" + text + "'");
  return flag;
}

RecordingSums read_sums(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  if (!file && text.empty()) throw Failure(bad_input, path + ": cannot be read");
  Result<RecordingSums> sums = fleet::sums_of_text(text);
  if (!sums) throw Failure(bad_input, sums.error().at(path));
  return std::move(sums).value();
}

/// All files in the order of time, and what they have in common.
struct AllSums {
  std::vector<RecordingSums> parts;  ///< without the sums themselves
  std::vector<std::string> paths;
  std::vector<std::size_t> missing;  ///< samples before each
  std::size_t total = 0, gaps = 0;
  double rate_hz = 0.0;  ///< mean over all
};

[[noreturn]] void refuse_sums(const std::string& path, const std::string& why) {
  throw Failure(bad_input, path + ": " + why);
}

using SumsOfFile = std::pair<RecordingSums, std::string>;

// In the order of time.
std::vector<SumsOfFile> read_in_order(const NoiseCommand& command) {
  std::vector<SumsOfFile> read;
  for (const std::string& path : command.files) {
    read.emplace_back(read_sums(path), path);
    RecordingSums& one = read.back().first;
    for (SummedChannel& channel : one.channels) channel.sums.clear();
    if (!one.place) refuse_sums(path, "it has no sums yet: run the fleet again");
    if (one.channels.empty()) refuse_sums(path, "it has no channel");
    if (one.options != options_of_sums(command))
      refuse_sums(path, "its sums were made with " + one.options + ": give the same");
  }
  std::ranges::sort(read, {}, [](const auto& one) { return one.first.place->first; });
  return read;
}

// Whether the first and the last recording of the series are there, too.
void expect_ends(const AllSums& all) {
  const SumsPlace& first = *all.parts.front().place;
  if (first.first != 0)
    refuse_sums(all.paths.front(), "the sums of the recordings before it are not there");
  if (!first.as_samples && static_cast<std::size_t>(std::bit_width(all.total)) != first.digits)
    refuse_sums(all.paths.back(), "the sums of the recordings after it are not there");
}

AllSums read_all(const NoiseCommand& command) {
  std::vector<SumsOfFile> read = read_in_order(command);
  AllSums all;
  double duration_s = 0.0, samples = 0.0;
  for (auto& [part, path] : read) {
    const SumsPlace &place = *part.place, &first = *read.front().first.place;
    if (place.first < all.total)
      refuse_sums(path, "it overlaps " + all.parts.back().file + ": run the fleet again");
    if (place.as_samples != first.as_samples || place.digits != first.digits)
      refuse_sums(path, "its sums are of another set of recordings: run the fleet again");
    all.missing.push_back(all.parts.empty() ? 0 : place.first - all.total);
    all.gaps += all.missing.back() > 0 ? 1 : 0;
    all.total = place.first + part.samples;
    samples += static_cast<double>(part.samples);
    duration_s += static_cast<double>(part.samples) / part.rate_hz;
    all.parts.push_back(std::move(part));
    all.paths.push_back(path);
  }
  all.rate_hz = samples / duration_s;
  expect_ends(all);
  return all;
}

/// A channel over all files.
struct JoinedSums {
  NoiseChannel channel;
  NoiseOptions options;
  std::vector<std::size_t> places;  ///< of the channel in each file
  std::optional<NoiseStream> stream;
};

void add_sums(JoinedSums& joined, const AllSums& all, std::size_t k, const RecordingSums& part) {
  NoiseStream& stream = *joined.stream;
  const std::size_t place = joined.places[k];
  StateBytes bytes(part.channels[place].sums);
  add_gap(stream, all.missing[k]);
  if (part.place->as_samples) {
    std::vector<double> samples;
    bytes(samples);
    if (!bytes.complete() || samples.size() != part.samples)
      refuse_sums(all.paths[k], "sums of noise: its samples are not those of its recording");
    return stream.add(samples);
  }
  NoiseStream read = stream_at(joined.options, *part.place, place);
  read.exchange(bytes);
  if (!bytes.complete() || read.samples() != part.samples)
    refuse_sums(all.paths[k], "sums of noise: its content does not fit its head line");
  if (k == 0)
    stream = std::move(read);
  else
    stream.append(std::move(read));
}

NoiseStream start_all(const NoiseOptions& options, const AllSums& all, std::size_t channel) {
  const SumsPlace& first = *all.parts.front().place;
  if (!first.as_samples) return stream_at(options, first, channel);
  Result<NoiseStream> stream = NoiseStream::start(options, all.total);
  if (!stream) throw Failure(usage, stream.error());
  return std::move(stream).value();
}

JoinedSums start_channel(NoiseOptions options, const AllSums& all, std::size_t number) {
  const RecordingSums& first = all.parts.front();
  options.rate_hz = first.rate_hz;
  JoinedSums joined{.channel = {}, .options = options, .places = {}, .stream = {}};
  RestChannel& rest = joined.channel.rest;
  rest.name = rest.title = joined.channel.shown.name = first.channels[number].name;
  rest.unit = joined.channel.shown.unit = first.channels[number].unit;
  rest.rate_hz = all.rate_hz;
  for (const RecordingSums& part : all.parts) {
    const auto place = fleet::matching_channel(part, first, number);
    if (!place) throw Failure(usage, place.error());
    joined.places.push_back(*place);
    const SummedChannel& one = part.channels[*place];
    if (rest.refused.empty() && !one.refused.empty())
      rest.refused = report::file_name(part.file) + ": " + one.refused;
    if (one.lsb) rest.lsb = rest.lsb ? std::min(*rest.lsb, *one.lsb) : *one.lsb;
  }
  joined.channel.shown.refused = rest.refused;
  if (rest.refused.empty()) joined.stream = start_all(options, all, number);
  return joined;
}

void finish_channel(JoinedSums& joined) {
  if (!joined.stream) return;
  NoiseChannel& channel = joined.channel;
  Result<NoiseAnalysis> found =
      joined.stream->finish({.rate_hz = channel.rest.rate_hz, .lsb = channel.rest.lsb});
  if (found)
    channel.shown.analysis = std::move(found).value();
  else
    channel.shown.refused = found.error().message;
}

// The recordings in the place of the files of sums; a sensor file stays.
void name_recordings(const NoiseCommand& command, const AllSums& all) {
  if (!command.output.invocation) return;
  std::vector<report::ProvenanceInput> inputs;
  for (const RecordingSums& part : all.parts) {
    report::ProvenanceInput& input = inputs.emplace_back();
    input.path = part.file;
    if (part.sha256.empty())
      input.reason = "it is not a regular file";
    else
      input.bytes = part.bytes;
    input.sha256 = part.sha256;
  }
  for (const report::ProvenanceInput& input : command.output.invocation->provenance().inputs)
    if (std::ranges::find(command.files, input.path) == command.files.end())
      inputs.push_back(input);
  command.output.invocation->set_inputs(std::move(inputs));
}

}  // namespace

void check_joined_flags(const NoiseCommand& command) {
  if (!command.temperature.empty() || !command.update_sensor.empty() || command.input.from_s ||
      command.input.to_s)
    throw Failure(usage, "--as-one: without --temperature, --update-sensor, --from and --to");
}

void print_sums(const NoiseCommand& command, const NoiseOptions& noise) {
  check_joined_flags(command);
  const SumsFlag flag = parse_sums_flag(command.sums);
  if (command.files.size() != 1) throw Failure(usage, "--sums: of one file");
  RestOptions options;
  options.files = {command.files.front(), command.files.front()};  // notes name it, one of several
  options.input = command.input;
  options.output = command.output;
  options.input.memory_mb = std::numeric_limits<double>::infinity();
  options.leave_rest = true;  // the share at rest is not shown
  const std::string& file = command.files.front();
  RecordingSums sums;
  sums.key = flag.key;
  sums.place = flag.place;
  sums.sha256 = sha256_of(file);
  std::error_code problem;
  const std::uintmax_t bytes = std::filesystem::file_size(file, problem);
  if (!problem) sums.bytes = bytes;
  sums.file = file;
  sums.options = options_of_sums(command);
  Recording recording = std::get<Recording>(open_rest(file, options));
  const RestRecording rest = rest_recording(std::move(recording), options, sums.notes);
  if (rest.start_ns) sums.clock_s = static_cast<double>(*rest.start_ns) * 1e-9;
  sums.rate_hz = rest.channels.front().rate_hz;
  for (const RestChannel& channel : rest.channels) {
    sums.samples = std::max(sums.samples, channel.series.size());
    SummedChannel& one = sums.channels.emplace_back(card_of(channel));
    if (!flag.place || !one.refused.empty()) continue;
    const std::size_t number = sums.channels.size() - 1;
    if (one.first_valid &&
        flag.place->first + *one.first_valid < flag.place->of_channel(number).origin)
      throw Failure(failed, file + ": changed while the fleet ran: run it again");
    one.sums = sums_of(channel, noise, *flag.place, number);
  }
  print_out(fleet::text_of(std::move(sums)));
}

bool holds_sums(const NoiseCommand& command) {
  if (command.input.host || command.files.empty() || command.files.front() == "-") return false;
  std::array<char, 32> beginning{};
  std::ifstream file(command.files.front(), std::ios::binary);
  file.read(beginning.data(), beginning.size());
  return fleet::is_sums({beginning.data(), static_cast<std::size_t>(file.gcount())});
}

std::vector<NoiseChannel> join_sums(const NoiseCommand& command,
                                    const NoiseOptions& noise,
                                    std::vector<std::string>& inputs,
                                    std::vector<Note>& notes) {
  check_joined_flags(command);
  const AllSums all = read_all(command);
  std::vector<JoinedSums> joined;
  for (std::size_t k = 0; k < all.parts.front().channels.size(); ++k)
    joined.push_back(start_channel(noise, all, k));
  // One after the other, so that only one is in memory.
  for (std::size_t k = 0; k < all.parts.size(); ++k) {
    const RecordingSums part = read_sums(all.paths[k]);
    for (JoinedSums& one : joined)
      if (one.stream) add_sums(one, all, k, part);
  }
  std::vector<NoiseChannel> channels;
  for (JoinedSums& one : joined) {
    finish_channel(one);
    channels.push_back(std::move(one.channel));
  }
  inputs.clear();
  for (const RecordingSums& part : all.parts) {
    inputs.push_back(part.file);
    notes.insert(notes.end(), part.notes.begin(), part.notes.end());
  }
  name_recordings(command, all);
  notes.push_back(
      {Severity::info, fmt::format("{} files analysed as one recording with {} between them",
                                   all.parts.size(), report::count_words(all.gaps, "gap"))});
  return channels;
}

}  // namespace proofmass::app
