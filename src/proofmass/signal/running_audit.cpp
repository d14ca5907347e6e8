#include "proofmass/signal/running_audit.hpp"

#include <algorithm>
#include <bit>
#include <functional>
#include <utility>

#include "proofmass/core/contract.hpp"
#include "proofmass/core/in_parallel.hpp"
#include "proofmass/signal/audit/audit_notes.hpp"
#include "proofmass/signal/audit/running_channel.hpp"
#include "proofmass/signal/audit/timing_audit.hpp"
#include "proofmass/signal/audit/value_excerpts.hpp"
#include "proofmass/signal/resample/counter.hpp"

namespace proofmass::signal {
namespace {

// All processing is in chunks that begin at multiples of this, so that the result does not depend
// on the block boundaries. Short enough for a chunk to stay in the first-level cache.
constexpr std::size_t chunk = ValueExcerpts::piece;

std::size_t sample_capacity(std::size_t channels) {
  constexpr std::size_t channels_in_full = 32, least = std::size_t{1} << 13;
  const std::size_t all = Subsample::usual_capacity * channels_in_full;
  return std::clamp(std::bit_floor(all / std::max<std::size_t>(channels, 1)), least,
                    Subsample::usual_capacity);
}

bool is_inertial(const Channel& channel) {
  return channel.unit.quantity == Quantity::acceleration ||
         channel.unit.quantity == Quantity::angular_rate;
}

struct CounterColumn {
  std::size_t channel;
  RunningCounter counter;
};

}  // namespace

struct RunningAudit::State {
  explicit State(const Recording& head)
      : rate_hz(head.time.rate_hz), timing(head.time), waiting(head.channels.size()) {
    const std::size_t count = head.channels.size();
    channels.assign(count, RunningChannel(sample_capacity(count)));
    for (std::size_t c = 0; c < count; ++c) {
      names.push_back(head.channels[c].name);
      if (is_inertial(head.channels[c])) inertial.push_back(c);
      if (is_counter_name(head.channels[c].name)) counters.push_back({c, {}});
    }
  }

  void take_chunks(const Block& chunks);
  void take(const Block& block, std::size_t from, std::size_t rows);
  void wait(const Block& block, std::size_t from, std::size_t rows);
  void take_waiting();
  void find_zero_rows(const Block& chunks);
  [[nodiscard]] std::size_t waiting_rows() const {
    return waiting.empty() ? 0 : waiting.front().size();
  }

  double rate_hz;
  RunningTiming timing;
  std::vector<std::string> names;
  std::vector<RunningChannel> channels;
  std::vector<CounterColumn> counters;
  std::vector<std::size_t> inertial;
  std::vector<std::size_t> zero_rows;
  OddValues zeros;
  std::size_t samples = 0;  ///< processed samples
  double last_s = 0.0;
  bool has_stamps = false, is_finished = false;
  std::vector<std::vector<double>> waiting;  ///< rows that do not fill a chunk yet
  std::vector<double> waiting_stamps_s;
};

void RunningAudit::State::take(const Block& block, std::size_t from, std::size_t rows) {
  Block part;
  for (const View<double> channel : block.channels)
    part.channels.push_back(channel.subspan(from, rows));
  if (has_stamps) part.stamps_s = block.stamps_s.subspan(from, rows);
  take_chunks(part);
}

void RunningAudit::State::wait(const Block& block, std::size_t from, std::size_t rows) {
  const auto append = [&](View<double> values, std::vector<double>& to) {
    const View<double> part = values.subspan(from, rows);
    to.insert(to.end(), part.begin(), part.end());
  };
  for (std::size_t c = 0; c < waiting.size(); ++c) append(block.channels[c], waiting[c]);
  if (has_stamps) append(block.stamps_s, waiting_stamps_s);
}

void RunningAudit::State::take_waiting() {
  Block all;
  all.channels.assign(waiting.begin(), waiting.end());
  all.stamps_s = waiting_stamps_s;
  take_chunks(all);
  for (std::vector<double>& values : waiting) values.clear();
  waiting_stamps_s.clear();
}

// The parts of the audit go over the chunks independently of one another.
void RunningAudit::State::take_chunks(const Block& chunks) {
  const std::size_t rows = chunks.rows();
  const auto add_chunks = [&](View<double> values, const auto& add) {
    for (std::size_t from = 0; from < values.size(); from += chunk)
      add(from, values.subspan(from, std::min(chunk, values.size() - from)));
  };
  std::vector<std::function<void()>> tasks;
  for (std::size_t c = 0; c < channels.size(); ++c) {
    tasks.emplace_back([&, c] {
      add_chunks(chunks.channels[c], [&](std::size_t from, View<double> values) {
        const View<double> stamps_s =
            has_stamps ? chunks.stamps_s.subspan(from, values.size()) : View<double>{};
        channels[c].add(values, {samples + from, stamps_s, rate_hz});
      });
    });
    tasks.emplace_back([&, c] {
      add_chunks(chunks.channels[c],
                 [&](std::size_t, View<double> values) { channels[c].add_to_tails(values); });
    });
  }
  tasks.emplace_back([&] {
    add_chunks(chunks.stamps_s, [&](std::size_t, View<double> part_s) { timing.add(part_s); });
    for (CounterColumn& column : counters)
      add_chunks(chunks.channels[column.channel],
                 [&](std::size_t, View<double> values) { column.counter.add(values); });
    find_zero_rows(chunks);
  });
  run_tasks(rows * channels.size(), tasks);
  last_s = SampleTimes{samples, chunks.stamps_s, rate_hz}.at(samples + rows - 1).s;
  samples += rows;
}

// Gravity alone keeps a working sensor from an output of zero on all inertial channels, if there
// are at least three.
void RunningAudit::State::find_zero_rows(const Block& chunks) {
  if (inertial.size() < 3) return;
  const SampleTimes times{samples, chunks.stamps_s, rate_hz};
  const View<double> one = chunks.channels[inertial.front()];
  for (std::size_t k = 0; k < one.size(); ++k) {
    if (one[k] != 0.0) continue;
    if (!std::ranges::all_of(inertial, [&](std::size_t c) { return chunks.channels[c][k] == 0.0; }))
      continue;
    zeros.add(times.at(samples + k));
    if (zero_rows.size() < most_listed) zero_rows.push_back(samples + k);
  }
}

RunningAudit::RunningAudit(const Recording& head) : state_(std::make_unique<State>(head)) {}
RunningAudit::RunningAudit(RunningAudit&&) noexcept = default;
RunningAudit& RunningAudit::operator=(RunningAudit&&) noexcept = default;
RunningAudit::~RunningAudit() = default;

void RunningAudit::add(const Block& block) {
  State& s = *state_;
  const std::size_t rows = block.rows();
  PM_EXPECTS(!s.is_finished && block.channels.size() == s.channels.size());
  if (rows == 0) return;
  if (s.samples + s.waiting_rows() == 0) s.has_stamps = !block.stamps_s.empty();
  PM_EXPECTS(block.stamps_s.size() == (s.has_stamps ? rows : 0));
  PM_EXPECTS(std::ranges::all_of(block.channels, [&](View<double> c) { return c.size() == rows; }));
  std::size_t from = 0;
  if (s.waiting_rows() > 0) {
    from = std::min(rows, chunk - s.waiting_rows());
    s.wait(block, 0, from);
    if (s.waiting_rows() == chunk) s.take_waiting();
  }
  const std::size_t whole = (rows - from) / chunk * chunk;
  if (whole > 0) s.take(block, from, whole);
  from += whole;
  if (from < rows) s.wait(block, from, rows - from);
}

RecordingAudit RunningAudit::finish(const Recording& head) {
  State& s = *state_;
  PM_EXPECTS(!s.is_finished);
  if (s.waiting_rows() > 0) s.take_waiting();
  s.is_finished = true;
  RecordingAudit out;
  out.format = head.format;
  out.samples = s.samples;
  out.duration_s = s.samples < 2 ? 0.0 : s.last_s;
  out.notes = head.notes;
  out.timing = s.timing.finish(head.time);
  const auto counter = std::ranges::find_if(
      s.counters, [](const CounterColumn& column) { return column.counter.counts_rows(); });
  if (counter != s.counters.end()) out.timing.lost = counter->counter.lost_rows();
  note_timing(out.timing, out.notes);
  const PlaceWords words{head.first_line, s.rate_hz > 0.0 || s.has_stamps};
  std::size_t c = 0;
  for (const Channel& channel : head.channels) {
    // A channel may be missing from the head by now, but the others keep their order.
    if (head.channels.size() < s.channels.size())
      while (c < s.names.size() && s.names[c] != channel.name) ++c;
    PM_EXPECTS(c < s.channels.size());
    out.channels.push_back(s.channels[c].finish(channel));
    note_values(channel.name, s.channels[c], words, out.notes);
    note_channel(out.channels.back(), head.time.rate_hz, out.notes);
    ++c;
  }
  out.zero_rows = std::move(s.zero_rows);
  out.zero_row_count = s.zeros.count;
  note_zero_rows(s.zeros, words, out.notes);
  return out;
}

}  // namespace proofmass::signal
