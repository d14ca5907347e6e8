#include <fmt/format.h>
#include <utility>

#include "proofmass/acquire/recorder/session.hpp"

// Exchange with the analysis.
namespace proofmass::acquire {
namespace {

constexpr std::chrono::milliseconds analysis_patience{50};

}  // namespace

void RecordSession::begin_analysis(std::unique_ptr<LiveAnalysis> analysis) {
  columns_ = analysis->columns();
  left_out_ = 0;
  analysis_ = std::make_unique<AnalysisThread>(std::move(analysis), options_.queue_bytes,
                                               [this] { queue_.wake(); });
}

/// A source that waits for its reader waits for the analysis too.
void RecordSession::analyse(const Block& block, std::int64_t host_ns) {
  if (analysis_->put(block, host_ns))
    report_left_out();
  else
    leave_out(block);
  while (!head_.is_paced && analysis_ && !analysis_->is_idle()) {
    take_estimates(analysis_patience);
    ask_stopped();
    if (file_) file_->tick(host_now_ns());
  }
}

void RecordSession::leave_out(const Block& block) {
  if (left_out_ == 0)
    report(EventKind::note, Severity::warning,
           "the analysis is too slow and what waits for it too much: rows are left out of the "
           "estimates from here on, not of the recording");
  left_out_ += block.rows();
}

void RecordSession::report_left_out() {
  if (left_out_ == 0) return;
  report(EventKind::note, Severity::warning,
         fmt::format("{} rows were left out of the estimates, as their analysis was too slow",
                     std::exchange(left_out_, 0)));
}

/// Waits for the first one only.
void RecordSession::take_estimates(std::chrono::milliseconds wait) {
  while (analysis_ && analysis_->take(analysed_, wait)) {
    wait = std::chrono::milliseconds(0);
    keep_estimates();
    for (const Note& note : analysed_.notes)
      report({EventKind::note, note.severity, analysed_.time_s, 0.0, 0, note.text, note.advice});
    if (!analysed_.failure) continue;
    report({EventKind::note, Severity::bad, analysed_.time_s, 0.0, 0,
            "the estimates end here: " + analysed_.failure->message, analysed_.failure->advice});
    analysis_.reset();
    columns_.clear();
  }
}

void RecordSession::keep_estimates() {
  if (analysed_.estimates.rows() == 0) return;
  // If samples wait for the reader, a full queue gives no information on the latency.
  if (head_.is_paced && analysed_.host_ns)
    latency_.add(static_cast<double>(host_now_ns() - *analysed_.host_ns) * 1e-9);
  const Block rows = view_of(analysed_.estimates, static_cast<std::size_t>(estimate_rows_));
  estimate_rows_ += rows.rows();
  if (gate_)
    gate_->add_estimates(rows, keepers());
  else
    write_estimates(rows);
  if (watch_.estimates) watch_.estimates(rows);
}

bool RecordSession::is_stop_requested() const {
  return end_ == RecordEnd::stopped || end_ == RecordEnd::disk_failed ||
         (watch_.stopped && watch_.stopped());
}

/// Analyses all waiting samples, unless a stop is requested and it takes too long.
void RecordSession::finish_analysis() {
  if (!analysis_) return;
  analysis_->finish();
  std::optional<std::int64_t> requested_ns;
  while (analysis_ && !analysis_->is_done()) {
    take_estimates(analysis_patience);
    if (file_) file_->tick(host_now_ns());
    const std::int64_t now_ns = host_now_ns();
    if (!requested_ns && is_stop_requested()) requested_ns = now_ns;
    if (requested_ns && static_cast<double>(now_ns - *requested_ns) * 1e-9 > options_.catch_up_s)
      left_out_ += analysis_->forget_waiting();
  }
  report_left_out();
  analysis_.reset();
  columns_.clear();
}

}  // namespace proofmass::acquire
