#include "input/block_reader.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "cli/exit_status.hpp"
#include "input/input.hpp"

namespace proofmass::app {

PieceSource::PieceSource(io::RecordingStream stream,
                         const InputFlags& flags,
                         const std::vector<sensor::SensorModel>& models)
    : stream_(std::move(stream)), flags_(flags), models_(models) {
  head_ = stream_.head();
  first_ = next_in_window();
  if (first_.rows() == 0) {
    throw Failure(usage, head_.source + ": --from and --to leave no sample");
  }
  if (head_.time.start_ns) *head_.time.start_ns += std::llround(window_start_s_ * 1e9);
  calibrate_block(first_);
  for (std::size_t c = 0; c < piece_.channels.size() && !models_.empty(); ++c) {
    head_.channels[c].unit = piece_.channels[c].unit;
  }
  has_first_ = true;
}

Block PieceSource::next() {
  if (std::exchange(has_first_, false)) return std::move(first_);
  Block block = next_in_window();
  if (block.rows() > 0) {
    calibrate_block(block);
    return block;
  }
  const Recording& last = stream_.head();
  head_.notes = last.notes;
  head_.first_line = last.first_line;
  head_.time.mended = last.time.mended;
  head_.time.mended_backwards = last.time.mended_backwards;
  if (!flags_.from_s && !flags_.to_s) {
    head_.labels = last.labels;
    head_.label_channel = last.label_channel;
  } else if (!last.labels.empty()) {
    head_.notes.push_back(
        {Severity::warning, "the labels of column " + last.label_channel +
                                " are left out: with --from and --to they need the whole "
                                "recording in memory: give more --memory"});
  }
  return block;
}

Block PieceSource::next_in_window() {
  for (;;) {
    Block raw = need(stream_.next(), Stage::reading);
    if (raw.rows() == 0 || (!flags_.from_s && !flags_.to_s)) {
      given_ += raw.rows();
      return raw;
    }
    keep_window(raw);
    Block kept;
    kept.first = given_;
    for (const Channel& channel : piece_.channels) kept.channels.emplace_back(channel.values);
    kept.stamps_s = piece_.time.stamps_s;
    given_ += kept.rows();
    // Continues after the end of the window, since the rest of the file may have notes.
    if (kept.rows() > 0) return kept;
  }
}

void PieceSource::keep_window(const Block& raw) {
  const double from_s = flags_.from_s.value_or(-std::numeric_limits<double>::infinity());
  const double to_s = flags_.to_s.value_or(std::numeric_limits<double>::infinity());
  piece_.channels.resize(raw.channels.size());
  for (Channel& channel : piece_.channels) channel.values.edit().clear();
  piece_.time.stamps_s.clear();
  std::size_t kept = 0;
  for (std::size_t r = 0; r < raw.rows(); ++r) {
    const double time_s = raw.stamps_s.empty() ? head_.time.at(raw.first + r) : raw.stamps_s[r];
    if (time_s < from_s || time_s >= to_s) continue;
    if (given_ + kept++ == 0) window_start_s_ = time_s;
    for (std::size_t c = 0; c < raw.channels.size(); ++c) {
      piece_.channels[c].values.edit().push_back(raw.channels[c][r]);
    }
    if (!raw.stamps_s.empty()) piece_.time.stamps_s.push_back(time_s - window_start_s_);
  }
}

void PieceSource::calibrate_block(Block& block) {
  if (models_.empty()) return;
  std::vector<Recording> pieces(1);
  Recording& piece = pieces.front();
  piece.source = head_.source;
  piece.time = head_.time;
  for (std::size_t c = 0; c < block.channels.size(); ++c) {
    const Channel& channel = stream_.head().channels[c];
    piece.channels.push_back({channel.name, channel.unit,
                              std::vector(block.channels[c].begin(), block.channels[c].end())});
  }
  calibrate(models_, accelerometers(pieces), pieces);
  std::vector<double> stamps_s = std::move(piece_.time.stamps_s);
  piece_ = std::move(piece);
  piece_.time.stamps_s = std::move(stamps_s);
  for (std::size_t c = 0; c < block.channels.size(); ++c) {
    block.channels[c] = piece_.channels[c].values;
  }
}

std::variant<Recording, io::RecordingStream> open_input(const std::string& file,
                                                        const InputFlags& flags,
                                                        const Progress& progress) {
  if (auto given = given_recording(file, flags)) return std::move(*given);
  constexpr double bytes_per_mb = 1e6;
  constexpr double most_bytes = 1e18;
  const double bytes = std::min(flags.memory_mb * bytes_per_mb, most_bytes);
  auto opened = need(
      io::open_recording(file, read_options(flags, progress), static_cast<std::uint64_t>(bytes)),
      Stage::reading);
  if (auto* recording = std::get_if<Recording>(&opened)) {
    return cut_to_window(std::move(*recording), flags);
  }
  return opened;
}

}  // namespace proofmass::app
