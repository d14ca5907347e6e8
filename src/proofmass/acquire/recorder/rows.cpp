#include <algorithm>
#include <fmt/format.h>
#include <utility>

#include "proofmass/acquire/recorder/names.hpp"
#include "proofmass/acquire/recorder/session.hpp"

namespace proofmass::acquire {

void RecordSession::report(EventKind kind,
                           Severity severity,
                           std::string text,
                           std::vector<Advice> advice) {
  report({kind, severity, line_->last_s(), 0.0, 0, std::move(text), std::move(advice)});
}

void RecordSession::report(const RecordEvent& event) {
  const bool is_listed = tally_.add(event);
  if (is_listed && file_) file_->add_event(event, host_times_now());
  if (watch_.event) watch_.event(event);
}

void RecordSession::report_notes(const std::vector<Note>& notes) {
  for (const Note& note : notes) report(EventKind::note, note.severity, note.text, note.advice);
}

void RecordSession::keep(const Block& block, std::int64_t host_ns) {
  if (gate_)
    gate_->add_samples(block, keepers());
  else
    keep_samples(block);
  if (watch_.samples) watch_.samples(block);
  if (analysis_) analyse(block, host_ns);
}

LevelGate::Keep RecordSession::keepers() {
  return {.begin_stretch =
              [this](double from_s) {
                if (!file_) return;
                if (!file_->has_begun()) begin_file(from_s);
                file_->begin_stretch(fmt::format("stretch {}", ++stretches_));
              },
          .triggered =
              [this](double time_s) {
                const Channel& channel = head_.recording.channels[trigger_channel_];
                const bool is_rising = options_.trigger->edge == LevelTrigger::Edge::rising;
                report({EventKind::triggered, Severity::info, time_s, 0.0, 0,
                        fmt::format("{} {} {} {}", channel.name, is_rising ? "rose to" : "fell to",
                                    options_.trigger->level, channel.unit.symbol)});
              },
          .samples = [this](const Block& rows) { keep_samples(rows); },
          .estimates = [this](const Block& rows) { write_estimates(rows); }};
}

/// Splits the rows exactly where a new file is due.
void RecordSession::keep_samples(const Block& block) {
  std::size_t done = 0;
  while (done < block.rows() && file_) {
    const Block rest = part_of(block, done, block.rows() - done);
    if (!file_->has_begun()) begin_file(rest.stamps_s.front());
    std::size_t count = rest.rows();
    if (options_.rotate_s) {
      const auto end =
          std::ranges::lower_bound(rest.stamps_s, file_->origin_s() + *options_.rotate_s);
      count = static_cast<std::size_t>(end - rest.stamps_s.begin());
    }
    file_->add_rows(part_of(rest, 0, count));
    done += count;
    const bool is_large = options_.rotate_bytes && file_->bytes() >= *options_.rotate_bytes;
    if (done < block.rows() || (is_large && file_->rows() > 0)) rotate();
  }
}

void RecordSession::begin_file(double origin_s) {
  file_->begin(origin_s, start_ns_ + static_cast<std::int64_t>(origin_s * 1e9));
}

void RecordSession::write_estimates(const Block& rows) {
  if (file_ && file_->has_begun()) file_->add_estimates(rows);
}

Status RecordSession::new_file(bool is_numbered) {
  const PartNames names = is_numbered ? next_numbered(options_.path) : part_names(options_.path);
  auto part = create_(names);
  if (!part) return part.error();
  RecordWords metadata = options_.metadata;
  if (is_numbered) {
    metadata["first_row"] = std::to_string(rows_);
    metadata["part"] = std::to_string(closed_.size() + 1);
  }
  auto file = RecordFile::create(disk_, std::move(part).value(),
                                 {head_, columns_, std::move(metadata), options_.sensor_files});
  if (!file) return file.error();
  file_ = std::move(file).value();
  file_path_ = names.path;
  file_->while_waiting = [this] { ask_stopped(); };
  return Done{};
}

void RecordSession::rotate() {
  tally_.report_clock();
  file_->close(tally_.words());
  const std::string before = file_path_;
  add_closed();
  file_.reset();
  if (const Status created = new_file(true); !created) {
    end(RecordEnd::disk_failed, created.error().message);
    return;
  }
  report(EventKind::rotated, Severity::info, "goes on from " + before);
}

void RecordSession::add_closed() {
  std::vector<Note>& audit = tally_.summary.audit;
  audit.insert(audit.end(), file_->notes().begin(), file_->notes().end());
  closed_.push_back({file_path_, file_->part(), file_->rows()});
}

}  // namespace proofmass::acquire
