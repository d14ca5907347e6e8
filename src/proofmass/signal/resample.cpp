#include "proofmass/signal/resample.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <set>
#include <utility>
#include <vector>

#include "proofmass/core/contract.hpp"
#include "proofmass/signal/resample/counter.hpp"
#include "proofmass/signal/resampler.hpp"

namespace proofmass::signal {
namespace {

constexpr std::array<std::pair<ResampleMethod, std::string_view>, 5> methods{
    {{ResampleMethod::sinc, "sinc"},
     {ResampleMethod::linear, "linear"},
     {ResampleMethod::cubic, "cubic"},
     {ResampleMethod::nearest, "nearest"},
     {ResampleMethod::mean, "mean"}}};

/// Number of samples from 0 to `duration_s`; very large if it cannot be counted, so that it is
/// rejected.
std::size_t count_of(double duration_s, double rate_hz) {
  const double count = std::floor(duration_s * rate_hz * (1.0 + 1e-12) + 1e-6) + 1.0;
  return count < 1e15 ? static_cast<std::size_t>(std::max(count, 0.0)) : std::size_t{1} << 50;
}

/// "accelerations and gyro.x"
std::vector<Channel> channels_on(const Recording& recording, const Resampler& resampler) {
  const auto counter = find_counter(recording);
  std::vector<Channel> out;
  for (std::size_t c = 0; c < recording.channels.size(); ++c) {
    const Channel& channel = recording.channels[c];
    out.push_back(
        {channel.name, channel.unit,
         counter == c ? resampler.nearest(channel.values) : resampler.apply(channel.values)});
  }
  return out;
}

/// Labels whose samples still exist, by their times.
std::vector<Label> labels_on(const Recording& recording, const TimeGrid& grid) {
  std::vector<Label> out;
  for (const Label& label : recording.labels) {
    const double first =
        std::ceil((recording.time.at(label.first) - grid.from_s) * grid.rate_hz - 1e-6);
    const double last =
        std::floor((recording.time.at(label.last) - grid.from_s) * grid.rate_hz + 1e-6);
    const double begin =
        std::max(first, out.empty() ? 0.0 : static_cast<double>(out.back().last) + 1.0);
    const double end = std::min(last, static_cast<double>(grid.count) - 1.0);
    if (end >= begin)
      out.push_back({label.text, static_cast<std::size_t>(begin), static_cast<std::size_t>(end)});
  }
  return out;
}

Note note_on(const Recording& recording, const TimeGrid& grid, ResampleMethod method) {
  return {Severity::info,
          fmt::format("resampled from {:.6g} Hz{} to {:.6g} Hz by {}; gaps are left empty",
                      recording.time.rate_hz, recording.time.is_uniform() ? "" : ", by stamps,",
                      grid.rate_hz, name_of(method))};
}

Result<Recording> on_grid(const Recording& recording, ResampleMethod method, const TimeGrid& grid) {
  const auto resampler = Resampler::make(recording.time, recording.samples(), method, grid);
  if (!resampler) return resampler.error();
  Recording out;
  out.source = recording.source;
  out.format = recording.format;
  out.time = {.source = recording.time.source,
              .channel = recording.time.channel,
              .rate_hz = grid.rate_hz,
              .stamps_s = {},
              .start_ns = recording.time.start_ns,
              .mended = recording.time.mended,
              .mended_backwards = recording.time.mended_backwards};
  out.channels = channels_on(recording, *resampler);
  out.notes = recording.notes;
  out.notes.push_back(note_on(recording, grid, method));
  out.labels = labels_on(recording, grid);
  if (!out.labels.empty()) out.label_channel = recording.label_channel;
  return out;
}

/// Start and end of each recording, in seconds from the earliest start.
struct Spans {
  std::int64_t origin_ns = 0;
  std::vector<double> starts_s;
  double from_s = 0.0;
  double to_s = 0.0;
};

Spans spans_of(std::span<const Recording> recordings) {
  Spans out;
  bool is_known = false;
  for (const Recording& recording : recordings) {
    if (!recording.time.start_ns) continue;
    out.origin_ns =
        is_known ? std::min(out.origin_ns, *recording.time.start_ns) : *recording.time.start_ns;
    is_known = true;
  }
  out.to_s = 1e300;
  for (const Recording& recording : recordings) {
    const auto start_ns = recording.time.start_ns.value_or(out.origin_ns);
    // In two steps, because the difference of two stamps can exceed 63 bits.
    const double start_s = static_cast<double>(static_cast<std::uint64_t>(start_ns) -
                                               static_cast<std::uint64_t>(out.origin_ns)) /
                           1e9;
    out.starts_s.push_back(start_s);
    out.from_s = std::max(out.from_s, start_s);
    out.to_s = std::min(out.to_s, start_s + recording.duration_s());
  }
  return out;
}

/// Makes the names unique.
void name_apart(std::vector<Channel>& channels, const std::vector<std::string>& sources) {
  std::multiset<std::string> names;
  for (const Channel& channel : channels) names.insert(channel.name);
  std::set<std::string> taken;
  for (std::size_t c = 0; c < channels.size(); ++c) {
    std::string& name = channels[c].name;
    if (names.count(name) > 1 && !sources[c].empty()) name = sources[c] + "." + name;
    const std::string base = name;
    for (int again = 2; !taken.insert(name).second; ++again)
      name = fmt::format("{}_{}", base, again);
  }
}

void note_unknown_start(const Recording& part, std::vector<Note>& notes) {
  notes.push_back({Severity::warning,
                   fmt::format("{}: does not say when it began: taken to begin with the earliest",
                               part.source)});
}

}  // namespace

std::optional<ResampleMethod> parse_resample_method(std::string_view word) {
  for (const auto& [method, name] : methods)
    if (name == word) return method;
  return std::nullopt;
}

std::string_view name_of(ResampleMethod method) {
  return std::ranges::find(methods, method, &std::pair<ResampleMethod, std::string_view>::first)
      ->second;
}

Result<Recording> resample(const Recording& recording, const ResampleOptions& options) {
  const double rate_hz = options.target_hz == 0.0 ? recording.time.rate_hz : options.target_hz;
  const std::size_t count =
      recording.samples() == 0 ? 0 : count_of(recording.duration_s(), rate_hz);
  return on_grid(recording, options.method, {0.0, rate_hz, count});
}

Result<Recording> join(std::span<const Recording> recordings, const ResampleOptions& options) {
  PM_EXPECTS(!recordings.empty());
  const Spans spans = spans_of(recordings);
  double rate_hz = options.target_hz;
  if (rate_hz == 0.0)
    for (const Recording& part : recordings) rate_hz = std::max(rate_hz, part.time.rate_hz);
  if (spans.to_s < spans.from_s)
    return Error{Errc::too_few_samples,
                 fmt::format("the tables do not overlap in time: the first ends {:.6g} s before "
                             "the last begins",
                             spans.from_s - spans.to_s)};
  const std::size_t count = count_of(spans.to_s - spans.from_s, rate_hz);
  Recording out;
  std::vector<std::string> sources;
  for (std::size_t i = 0; i < recordings.size(); ++i) {
    const TimeGrid grid{spans.from_s - spans.starts_s[i], rate_hz, count};
    auto part = on_grid(recordings[i], options.method, grid);
    if (!part) return part.error().at(recordings[i].source);
    Recording moved = std::move(part).value();
    if (i == 0) {
      out.format = moved.format;
      out.time = moved.time;
    }
    sources.insert(sources.end(), moved.channels.size(), recordings[i].source);
    std::ranges::move(moved.channels, std::back_inserter(out.channels));
    for (Note& note : moved.notes)
      out.notes.push_back({note.severity, recordings[i].source.empty()
                                              ? note.text
                                              : recordings[i].source + ": " + note.text});
    if (!recordings[i].time.start_ns && recordings.size() > 1)
      note_unknown_start(recordings[i], out.notes);
    if (!out.labels.empty()) continue;
    out.labels = std::move(moved.labels);
    out.label_channel = std::move(moved.label_channel);
  }
  name_apart(out.channels, sources);
  out.time.start_ns = spans.origin_ns + std::llround(spans.from_s * 1e9);
  return out;
}

}  // namespace proofmass::signal
