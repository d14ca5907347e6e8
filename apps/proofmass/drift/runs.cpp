#include "drift/runs.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <string_view>

#include "proofmass/characterise/run_set.hpp"
#include "proofmass/core/in_parallel.hpp"
#include "proofmass/report/wording.hpp"

namespace proofmass::app {
namespace {

using characterise::Run;

constexpr std::size_t fewest_runs = 3;

// The runs of one channel.
struct RunsOfChannel {
  report::ChannelRuns shown;
  std::vector<Run> runs;
};

const RestChannel* find(const RestRecording& recording, const std::string& name) {
  const auto found = std::ranges::find(recording.channels, name, &RestChannel::name);
  return found == recording.channels.end() ? nullptr : &*found;
}

// The channel in each recording; empty if one of them does not have it.
std::vector<const RestChannel*> everywhere(const std::vector<RestRecording>& recordings,
                                           const std::string& name,
                                           std::vector<Note>& notes) {
  std::vector<const RestChannel*> found;
  for (const RestRecording& recording : recordings) {
    found.push_back(find(recording, name));
    if (found.back() != nullptr) continue;
    const std::string file = report::file_name(recording.channels.front().file);
    notes.push_back(
        {Severity::warning,
         fmt::format("{}: {} does not have it: its runs are not compared", name, file)});
    return {};
  }
  return found;
}

RunsOfChannel gathered(const std::vector<const RestChannel*>& channels, std::vector<Note>& notes) {
  RunsOfChannel out;
  out.shown.name = channels.front()->name;
  out.shown.unit = channels.front()->unit;
  for (const RestChannel* channel : channels) {
    if (channel->unit != out.shown.unit) {
      out.shown.refused = fmt::format(
          "in {} it is in {}, in {} in {}", report::file_name(channels.front()->file),
          out.shown.unit.symbol, report::file_name(channel->file), channel->unit.symbol);
      return out;
    }
    if (channel->refused.empty()) {
      out.runs.push_back({report::file_name(channel->file), channel->series, channel->rate_hz});
    } else {
      notes.push_back({Severity::warning, channel->title + ": refused, so no run of the set"});
    }
  }
  if (out.runs.size() < fewest_runs) {
    out.shown.refused = fmt::format("{} left, a set needs {}",
                                    report::count_words(out.runs.size(), "run"), fewest_runs);
  }
  return out;
}

bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

// The digits from `at` on, without leading zeros; advances `at` past them.
std::string_view number_at(std::string_view text, std::size_t& at) {
  const std::size_t from = at;
  while (at < text.size() && is_digit(text[at])) ++at;
  std::string_view digits = text.substr(from, at - from);
  while (digits.size() > 1 && digits.front() == '0') digits.remove_prefix(1);
  return digits;
}

// Numbers in names count by value: "run2" is before "run10".
bool natural_less(std::string_view a, std::string_view b) {
  std::size_t i = 0, j = 0;
  while (i < a.size() && j < b.size()) {
    if (is_digit(a[i]) && is_digit(b[j])) {
      const std::string_view x = number_at(a, i), y = number_at(b, j);
      if (x.size() != y.size()) return x.size() < y.size();
      if (x != y) return x < y;
      continue;
    }
    if (a[i] != b[j]) return a[i] < b[j];
    ++i;
    ++j;
  }
  return a.size() - i < b.size() - j;
}

// True if the stamps count from 1970, not from power-up.
bool is_epoch(const RestRecording& recording) {
  constexpr std::int64_t least_ns = 100'000'000'000'000'000;  // 1973
  return recording.start_ns.value_or(0) > least_ns;
}

void compare(RunsOfChannel& of_channel, const characterise::DriftOptions& options) {
  if (!of_channel.shown.refused.empty()) return;
  Result<characterise::RunSet> found = characterise::compare_runs(of_channel.runs, options);
  if (found)
    of_channel.shown.set = std::move(found).value();
  else
    of_channel.shown.refused = found.error().message;
}

}  // namespace

void put_in_time_order(std::vector<RestRecording>& recordings, std::vector<Note>& notes) {
  if (recordings.size() < fewest_runs) return;
  const bool dated = std::ranges::all_of(recordings, is_epoch);
  const auto before = [&](const RestRecording& a, const RestRecording& b) {
    if (dated && a.start_ns != b.start_ns) return *a.start_ns < *b.start_ns;
    return natural_less(a.channels.front().file, b.channels.front().file);
  };
  if (std::ranges::is_sorted(recordings, before)) return;
  std::ranges::stable_sort(recordings, before);
  notes.push_back(
      {Severity::info,
       fmt::format(
           "the files are taken by {}, from {} to {}, not in the order given; --order given "
           "keeps that",
           dated ? "their time stamps" : "the numbers in their names",
           report::file_name(recordings.front().channels.front().file),
           report::file_name(recordings.back().channels.front().file))});
}

std::vector<report::ChannelRuns> compare_recordings(const std::vector<RestRecording>& recordings,
                                                    double since_switch_on_s,
                                                    const Progress& progress,
                                                    std::vector<Note>& notes) {
  if (recordings.size() == 2) {
    notes.push_back({Severity::warning,
                     "two recordings are analysed separately: a comparison of power-ups of one "
                     "sensor needs three or more"});
  }
  if (recordings.size() < fewest_runs) return {};
  std::vector<RunsOfChannel> all;
  for (const RestChannel& channel : recordings.front().channels) {
    const auto channels = everywhere(recordings, channel.name, notes);
    if (!channels.empty()) all.push_back(gathered(channels, notes));
  }
  in_parallel(all.size(), progress, [&](std::size_t k, Progress own) {
    compare(all[k],
            {.rate_hz = 0.0, .since_switch_on_s = since_switch_on_s, .progress = std::move(own)});
  });
  std::vector<report::ChannelRuns> shown;
  shown.reserve(all.size());
  for (RunsOfChannel& one : all) shown.push_back(std::move(one.shown));
  return shown;
}

}  // namespace proofmass::app
