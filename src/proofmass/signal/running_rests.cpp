#include "proofmass/signal/running_rests.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "proofmass/core/contract.hpp"
#include "proofmass/signal/rests/blocks.hpp"
#include "proofmass/signal/rests/ends.hpp"
#include "proofmass/signal/rests/noise.hpp"
#include "proofmass/signal/rests/recent_blocks.hpp"
#include "proofmass/signal/rests/runs.hpp"

namespace proofmass::signal {
namespace {

constexpr std::size_t unseen_blocks = 2;  ///< at the end, where motion may have begun

double level_of(const RestNoise& noise, std::size_t axes) {
  double level = 0.0;
  for (std::size_t a = 0; a < axes; ++a) level += 0.5 * std::log(noise.block_variance[a]);
  return level / static_cast<double>(axes);
}

}  // namespace

struct RunningRests::State {
  State(std::size_t axes, const RestOptions& options) : axis_count(axes), recent(axes, options) {}

  void learn_noise();
  void look();
  void look_at(const RestBlocks& looked_at, RestNoise known, const std::vector<RestRun>& quiet);
  void rest_over(const RestBlocks& looked_at, const RestRun& run, bool goes_on);

  std::size_t axis_count;
  RecentBlocks recent;
  std::size_t closed = 0, since_rest = 0;  ///< in blocks
  std::optional<RestNoise> noise;
  RestRun rest{0, 0};  ///< index into the recent blocks
  RestState state;
};

void RunningRests::State::learn_noise() {
  constexpr std::size_t windows_to_begin = 6;
  RestBlocks blocks = recent.blocks();
  if (!noise && blocks.size() < windows_to_begin * blocks.window) return;
  std::optional<RestNoise> found = find_noise_and_drop_stuck(blocks);
  if (!found || !found->followed || found->unrest >= 1.0) return;
  const double rise = noise ? level_of(*found, axis_count) - level_of(*noise, axis_count) : 0.0;
  if (rise > std::log(1.5) && since_rest < RecentBlocks::most) return;
  noise = std::move(found);
}

void RunningRests::State::look() {
  const RestBlocks& blocks = recent.blocks();
  state.newest_s = recent.spans().back().end_s;
  state.newest_there = !blocks.missing(blocks.size() - 1);
  state.newest_mean = blocks.at(blocks.size() - 1).mean;
  if (!noise || closed % blocks.window == 0) learn_noise();
  if (noise) {
    RestBlocks looked_at = blocks;
    drop_stuck(looked_at, *noise);
    look_at(looked_at, *noise, quiet_runs(looked_at, *noise));
  }
  since_rest = state.phase == RestPhase::resting ? 0 : since_rest + 1;
}

void RunningRests::State::look_at(const RestBlocks& looked_at,
                                  RestNoise known,
                                  const std::vector<RestRun>& quiet) {
  const std::size_t end = looked_at.size();
  const std::vector<RestRun> runs = still_runs(looked_at, known, quiet);
  const bool was_resting = state.phase == RestPhase::resting;
  state.phase = RestPhase::moving;
  rest = {0, 0};
  if (looked_at.missing(end - 1) && state.newest_there) state.phase = RestPhase::stuck;
  if (runs.empty() || runs.back().end != end) return;
  state.phase = RestPhase::settling;
  RestRun run = runs.back();
  trim_ends(looked_at, known, run);
  run.end = std::min(run.end, end - std::min(end, unseen_blocks));
  if (run.first > 0) run.first += looked_at.window;
  if (run.first >= run.end) return;
  double count = 0.0;
  for (std::size_t k = run.first; k < run.end; ++k) count += looked_at.count[k];
  if (count < static_cast<double>(recent.shortest())) return;
  const bool goes_on =
      was_resting && runs.back().first == 0 && state.since_s < recent.spans().front().start_s;
  rest_over(looked_at, run, goes_on);
}

void RunningRests::State::rest_over(const RestBlocks& looked_at, const RestRun& run, bool goes_on) {
  const RestBlock all = joined(looked_at, run.first, run.size());
  PerAxis squares{};
  double free = 0.0;
  for (std::size_t k = run.first; k < run.end; ++k) {
    const RestBlock block = looked_at.at(k);
    if (block.count < 2.0) continue;
    for (std::size_t a = 0; a < axis_count; ++a) squares[a] += block.squares[a];
    free += block.count - 1.0;
  }
  rest = run;
  state.phase = RestPhase::resting;
  if (!goes_on) state.since_s = recent.spans()[run.first].start_s;
  state.until_s = recent.spans()[run.end - 1].end_s;
  state.samples = static_cast<std::size_t>(all.count);
  state.mean = all.mean;
  state.step = looked_at.quantum;
  for (std::size_t a = 0; a < axis_count; ++a)
    state.noise_std[a] = std::sqrt(squares[a] / std::max(1.0, free));
}

RunningRests::RunningRests(std::size_t axes, const RestOptions& options) {
  PM_EXPECTS(axes > 0 && axes <= most_axes);
  PM_EXPECTS(std::isfinite(options.rate_hz) && options.rate_hz >= 0.0);
  PM_EXPECTS(!options.shortest_s || *options.shortest_s > 0.0);
  state_ = std::make_unique<State>(axes, options);
}
RunningRests::RunningRests(RunningRests&&) noexcept = default;
RunningRests& RunningRests::operator=(RunningRests&&) noexcept = default;
RunningRests::~RunningRests() = default;

bool RunningRests::add(double time_s, View<double> values) {
  State& s = *state_;
  const std::size_t full = s.recent.add(time_s, values, s.noise);
  s.closed += full;
  if (full > 0) s.look();
  return full > 0;
}

const RestState& RunningRests::state() const {
  return state_->state;
}

std::size_t RunningRests::samples_a_block() const {
  return state_->recent.blocks().block;
}

std::vector<AllanLevel> RunningRests::levels(std::size_t axis) const {
  const State& s = *state_;
  const RestBlocks& blocks = s.recent.blocks();
  PM_EXPECTS(axis < s.axis_count);
  double steps = 0.0, count = 0.0;
  DyadicAllan ladder;
  for (std::size_t k = s.rest.first; k < s.rest.end; ++k) {
    const RestBlock block = blocks.at(k);
    if (blocks.missing(k) || block.count < 2.0) continue;
    steps += 0.5 * block.steps[axis];
    count += block.count - 1.0;
    ladder.add(block.mean[axis]);
  }
  if (count == 0.0) return {};
  // Differences of adjacent samples overlap: they carry as much information as two thirds as many
  // independent ones.
  std::vector<AllanLevel> levels{{1.0, steps / count, count / 1.5}};
  const std::vector<AllanLevel> slower = ladder.levels(static_cast<double>(blocks.block));
  levels.insert(levels.end(), slower.begin(), slower.end());
  return levels;
}

}  // namespace proofmass::signal
