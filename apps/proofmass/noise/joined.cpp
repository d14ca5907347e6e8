#include "noise/joined.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <utility>

#include "cli/exit_status.hpp"
#include "input/rest_channels.hpp"
#include "noise/sums.hpp"
#include "proofmass/characterise/noise_stream.hpp"
#include "proofmass/fleet/noise_sums.hpp"
#include "proofmass/report/wording.hpp"
#include "proofmass/signal/recording_sequence.hpp"

namespace proofmass::app {
namespace {

using characterise::NoiseAnalysis;
using characterise::NoiseOptions;
using characterise::NoiseStream;

[[noreturn]] void refuse_part(const std::string& file, const std::string& why) {
  throw Failure(usage, file + ": --as-one: " + why);
}

/// One recording of the sequence: its channels, and its start.
struct Part {
  RestRecording rest;
  double start_s = 0.0;
};

std::optional<double> clock_s(const RestRecording& rest) {
  if (!rest.start_ns) return std::nullopt;
  return static_cast<double>(*rest.start_ns) * 1e-9;
}

/// The files, in order.
class Parts {
 public:
  Parts(const NoiseCommand& command, std::vector<Note>& notes) : command_(command), notes_(notes) {
    if (!command.starts_s.empty() && command.starts_s.size() != command.files.size())
      throw Failure(usage, fmt::format("--starts: {} times for {} files", command.starts_s.size(),
                                       command.files.size()));
    options_.files = command.files;
    options_.input = command.input;
    options_.output = command.output;
    options_.input.memory_mb = std::numeric_limits<double>::infinity();
    options_.leave_rest = true;  // the share at rest is not shown
  }

  /// The first file must be read before the others.
  [[nodiscard]] Part read(std::size_t k) {
    const std::string& file = command_.files[k];
    Part part{rest_recording(std::get<Recording>(open_rest(file, options_)), options_, notes_)};
    const std::optional<double> own_s = clock_s(part.rest);
    if (k == 0) first_clock_s_ = own_s;
    if (command_.starts_s.empty() && !own_s)
      refuse_part(file, "it has no clock from which its start is known: give --starts S,S…");
    part.start_s = command_.starts_s.empty()
                       ? *own_s
                       : fleet::start_near(command_.starts_s[k], command_.starts_s.front(), own_s,
                                           first_clock_s_);
    return part;
  }

 private:
  const NoiseCommand& command_;
  RestOptions options_;
  std::vector<Note>& notes_;
  std::optional<double> first_clock_s_;
};

std::size_t samples_of(const RestRecording& rest) {
  std::size_t samples = 0;
  for (const RestChannel& channel : rest.channels)
    samples = std::max(samples, channel.series.size());
  return samples;
}

/// A channel over all parts.
struct Joined {
  NoiseChannel channel;
  NoiseStream stream;
};

std::vector<Joined> begin(const Part& first, NoiseOptions options, std::size_t expected_samples) {
  std::vector<Joined> all;
  for (const RestChannel& one : first.rest.channels) {
    options.rate_hz = one.rate_hz;
    Result<NoiseStream> stream = NoiseStream::start(options, expected_samples);
    if (!stream) throw Failure(usage, stream.error().at(one.file));
    NoiseChannel channel{.rest = one, .shown = {}};
    channel.rest.title = one.name;
    channel.rest.series = {};
    channel.shown.name = one.name;
    channel.shown.unit = one.unit;
    all.push_back({std::move(channel), std::move(stream).value()});
  }
  return all;
}

// The channel in this part, which must match the previous parts.
const RestChannel& same_channel(const Part& part, const RestChannel& first) {
  constexpr double most_apart = 1e-3;
  const auto found = std::ranges::find(part.rest.channels, first.name, &RestChannel::name);
  const std::string& file = part.rest.channels.front().file;
  if (found == part.rest.channels.end())
    refuse_part(file, fmt::format("it has no channel {}, which {} has", first.name, first.file));
  if (found->unit != first.unit)
    refuse_part(file, fmt::format("{} is in {}, in {} in {}", first.name, found->unit.symbol,
                                  first.file, first.unit.symbol));
  if (std::abs(found->rate_hz - first.rate_hz) > most_apart * first.rate_hz)
    refuse_part(file, fmt::format("it has {:.6g} Hz, {} has {:.6g} Hz", found->rate_hz, first.file,
                                  first.rate_hz));
  return *found;
}

void add_part(Joined& joined, const RestChannel& part, std::size_t missing) {
  RestChannel& whole = joined.channel.rest;
  if (whole.refused.empty() && !part.refused.empty())
    whole.refused = report::file_name(part.file) + ": " + part.refused;
  if (!whole.refused.empty()) return;
  add_gap(joined.stream, missing);
  joined.stream.add(part.series);
  if (part.lsb) whole.lsb = whole.lsb ? std::min(*whole.lsb, *part.lsb) : *part.lsb;
}

void finish_joined(Joined& joined, double rate_hz) {
  NoiseChannel& channel = joined.channel;
  channel.rest.rate_hz = rate_hz;
  channel.shown.refused = channel.rest.refused;
  if (!channel.shown.refused.empty()) return;
  Result<NoiseAnalysis> found = joined.stream.finish({.rate_hz = rate_hz, .lsb = channel.rest.lsb});
  if (found)
    channel.shown.analysis = std::move(found).value();
  else
    channel.shown.refused = report::with_flags(found.error());
}

// Number of samples divided by the total duration of all parts.
class MeanRate {
 public:
  void add(double samples, double rate_hz) {
    samples_ += samples;
    duration_s_ += samples / rate_hz;
  }
  [[nodiscard]] double rate_hz() const { return samples_ / duration_s_; }

 private:
  double samples_ = 0.0, duration_s_ = 0.0;
};

}  // namespace

void add_gap(NoiseStream& stream, std::size_t missing) {
  constexpr std::size_t most_at_once = 8192;
  const std::vector<double> gap(std::min(missing, most_at_once),
                                std::numeric_limits<double>::quiet_NaN());
  for (std::size_t left = missing; left > 0;) {
    const std::size_t now = std::min(left, gap.size());
    stream.add(View<double>(gap).first(now));
    left -= now;
  }
}

std::vector<NoiseChannel> analyse_joined(const NoiseCommand& command,
                                         const NoiseOptions& noise,
                                         std::vector<Note>& notes) {
  check_joined_flags(command);
  Parts parts(command, notes);
  const std::size_t count = command.files.size();
  Part part = parts.read(0);
  const double rate_hz = part.rest.channels.front().rate_hz;
  std::optional<Part> last;
  if (count > 1) last = parts.read(count - 1);
  const Part& end = last ? *last : part;
  // Longer gaps are shortened: no term of a deviation extends over a gap as long as all recordings
  // together.
  const std::size_t longest = std::max(samples_of(part.rest), samples_of(end.rest));
  const std::size_t longest_gap = count * longest;
  const double expected = std::min(std::max(0.0, end.start_s - part.start_s) * rate_hz +
                                       static_cast<double>(samples_of(end.rest)),
                                   static_cast<double>(count * (longest + longest_gap)));
  std::vector<Joined> all = begin(part, noise, static_cast<std::size_t>(std::llround(expected)));
  signal::RecordingSequence sequence(rate_hz, longest_gap);
  MeanRate mean_rate;
  std::size_t gaps = 0;
  for (std::size_t k = 0; k < count; ++k) {
    if (k > 0) part = k + 1 == count ? std::move(*last) : parts.read(k);
    const std::size_t samples = samples_of(part.rest);
    const auto missing = sequence.append(part.start_s, samples);
    if (!missing) refuse_part(command.files[k], missing.error().message);
    mean_rate.add(static_cast<double>(samples), part.rest.channels.front().rate_hz);
    gaps += *missing > 0 ? 1 : 0;
    for (Joined& joined : all) add_part(joined, same_channel(part, joined.channel.rest), *missing);
  }
  std::vector<NoiseChannel> channels;
  for (Joined& joined : all) {
    finish_joined(joined, mean_rate.rate_hz());
    channels.push_back(std::move(joined.channel));
  }
  notes.push_back(
      {Severity::info, fmt::format("{} files analysed as one recording with {} between them", count,
                                   report::count_words(gaps, "gap"))});
  return channels;
}

}  // namespace proofmass::app
