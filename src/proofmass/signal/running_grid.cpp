#include "proofmass/signal/running_grid.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "proofmass/core/contract.hpp"
#include "proofmass/signal/channel_audit.hpp"

namespace proofmass::signal {
namespace {

constexpr std::size_t piece_places = 4096;
// Additional missing samples allowed while the recording continues, relative to one that ends here:
// a second of computation.
constexpr double patience = 1e8;

}  // namespace

RunningEvenGrid::RunningEvenGrid(const TimeBase& time,
                                 std::size_t channels,
                                 std::size_t expected_samples)
    : finder_(time.rate_hz, time.band_s),
      expected_(expected_samples),
      held_(channels),
      piece_(channels, std::vector<double>(piece_places)) {
  PM_EXPECTS(time.rate_hz > 0.0);
}

Status RunningEvenGrid::add(const Block& block, const GridSink& sink) {
  const std::size_t rows = block.rows();
  PM_EXPECTS(block.channels.size() == piece_.size());
  if (rows == 0) return Done{};
  if (finder_.samples() == 0) has_stamps_ = !block.stamps_s.empty();
  PM_EXPECTS(block.stamps_s.size() == (has_stamps_ ? rows : 0));
  if (has_stamps_)
    finder_.add(block.stamps_s, fresh_);
  else
    finder_.add_even(rows);
  if (Status possible = finder_.check(std::max(finder_.samples(), expected_), patience); !possible)
    return possible;
  lay(block, sink);
  // Samples not yet on the grid are in the block, except those that were pending before and still
  // are.
  const std::size_t from = rows - std::min(rows, finder_.samples() - laid_);
  for (std::size_t c = 0; c < held_.size(); ++c) {
    const std::size_t kept = finder_.samples() - laid_ - (rows - from);
    held_[c].erase(held_[c].begin(), held_[c].end() - static_cast<std::ptrdiff_t>(kept));
    const View<double> late = block.channels[c].subspan(from);
    held_[c].insert(held_[c].end(), late.begin(), late.end());
  }
  flush(sink);
  return Done{};
}

Result<EvenGrid> RunningEvenGrid::finish(const GridSink& sink) {
  if (has_stamps_) finder_.finish(fresh_);
  if (Status possible = finder_.check(finder_.samples(), 0.0); !possible) return possible.error();
  Block none;
  none.channels.resize(piece_.size());
  lay(none, sink);
  flush(sink);
  EvenGrid grid = finder_.grid();
  grid.holes = std::move(listed_);
  return grid;
}

// Passes on all decided samples, pending ones and those of the block, with the holes.
void RunningEvenGrid::lay(const Block& block, const GridSink& sink) {
  for (const Hole& hole : fresh_) {
    copy(block, laid_, hole.before, sink);
    laid_ = hole.before;
    skip(hole.missing, sink);
    if (listed_.size() < most_holes) listed_.push_back(hole);
  }
  fresh_.clear();
  copy(block, laid_, finder_.decided(), sink);
  laid_ = finder_.decided();
}

void RunningEvenGrid::copy(const Block& block,
                           std::size_t from,
                           std::size_t to,
                           const GridSink& sink) {
  const std::size_t block_first = finder_.samples() - block.rows();
  const std::size_t held_first = held_.empty() ? block_first : block_first - held_.front().size();
  while (from < to) {
    const bool waited = from < block_first;
    const std::size_t end =
        std::min({to, from + piece_places - filled_, waited ? block_first : to});
    for (std::size_t c = 0; c < piece_.size(); ++c) {
      const View<double> values =
          waited ? View<double>(held_[c]).subspan(from - held_first, end - from)
                 : block.channels[c].subspan(from - block_first, end - from);
      std::ranges::transform(values, piece_[c].begin() + static_cast<std::ptrdiff_t>(filled_),
                             plausible_or_nan);
    }
    filled_ += end - from;
    from = end;
    if (filled_ == piece_places) flush(sink);
  }
}

void RunningEvenGrid::skip(std::size_t places, const GridSink& sink) {
  while (places > 0) {
    const std::size_t now = std::min(places, piece_places - filled_);
    for (std::vector<double>& values : piece_)
      std::fill_n(values.begin() + static_cast<std::ptrdiff_t>(filled_), now,
                  std::numeric_limits<double>::quiet_NaN());
    filled_ += now;
    places -= now;
    if (filled_ == piece_places) flush(sink);
  }
}

void RunningEvenGrid::flush(const GridSink& sink) {
  if (filled_ == 0) return;
  std::vector<View<double>> views;
  views.reserve(piece_.size());
  for (const std::vector<double>& values : piece_)
    views.push_back(View<double>(values).first(filled_));
  sink(views);
  filled_ = 0;
}

}  // namespace proofmass::signal
