#include "proofmass/acquire/framing/lines.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <utility>

#include "proofmass/acquire/framing/dialect.hpp"
#include "proofmass/acquire/framing/keys.hpp"
#include "proofmass/io/json_leaves.hpp"
#include "proofmass/io/shown_text.hpp"

namespace proofmass::acquire {
namespace {

constexpr std::size_t longest_line = 65'536;
constexpr std::string_view line_ends = "\r\n";

/// An OSC packet, or a JSON document on several lines.
bool is_document(std::string_view packet) {
  if (is_osc(packet)) return visit_osc(packet, [](auto, auto, const auto&) {});
  const std::size_t first = packet.find_first_not_of(" \t\r\n");
  if (first == std::string_view::npos || (packet[first] != '{' && packet[first] != '['))
    return false;
  return io::visit_json(packet, [](const io::JsonLeaf&) {}).has_value();
}

class LineDecoder final : public Decoder {
 public:
  explicit LineDecoder(const FramingOptions& options) : Decoder(options) {}

  void take(std::string_view bytes, std::int64_t host_ns) override {
    came_ += bytes.size();
    while (!bytes.empty()) {
      const std::size_t end = bytes.find_first_of(line_ends);
      const std::string_view piece = bytes.substr(0, end);
      if (end == std::string_view::npos) return keep(piece);
      if (partial_.empty() && skipped_ == 0) {
        line(piece, host_ns);
      } else {
        keep(piece);
        close(host_ns);
      }
      bytes.remove_prefix(end + 1);
    }
  }
  void take_packet(std::string_view packet, std::int64_t host_ns) override {
    came_ += packet.size();
    if (packet.size() <= longest_line && is_document(packet)) {
      line(packet, host_ns);
      return;
    }
    came_ -= packet.size();
    take(packet, host_ns);
    close(host_ns);
  }
  void finish(std::int64_t host_ns) override { close(host_ns); }
  Result<bool> settle(bool is_last_chance) override;
  std::string what_came() const override;

 private:
  void keep(std::string_view piece) {
    if (skipped_ == 0 && partial_.size() + piece.size() <= longest_line) {
      partial_ += piece;
      return;
    }
    skipped_ += partial_.size() + piece.size();
    partial_.clear();
  }
  /// End of a line, which was stored or skipped because of its length.
  void close(std::int64_t host_ns) {
    if (const std::uint64_t bytes = std::exchange(skipped_, 0); bytes > 0) {
      counts_.bytes += bytes;
      rows_.lose(1);
      garbage_.add(fmt::format("{} bytes without a line's end skipped", bytes), rows_.notes());
      return;
    }
    line(partial_, host_ns);
    partial_.clear();
  }
  void line(std::string_view text, std::int64_t host_ns) {
    constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
    if (!dialect_ && text.starts_with(byte_order_mark)) text.remove_prefix(byte_order_mark.size());
    if (text.size() > longest_line) {
      skipped_ = text.size();
      close(host_ns);
    } else if (text.find_first_not_of(std::string_view(" \t\0", 3)) == std::string_view::npos) {
      return;
    } else if (dialect_) {
      read(text, host_ns);
    } else {
      hold(text, host_ns);
    }
  }
  void hold(std::string_view text, std::int64_t host_ns) {
    held_.push_back({std::string(text), host_ns});
    held_bytes_ += text.size();
    if (held_bytes_ <= longest_line || held_.size() < 2) return;
    const std::size_t half = held_.size() / 2;
    for (std::size_t l = 0; l < half; ++l) held_bytes_ -= held_[l].text.size();
    held_.erase(held_.begin(), held_.begin() + static_cast<std::ptrdiff_t>(half));
    counts_.lines += half;
    misfits_.add(fmt::format("{} lines in which no columns were found skipped", half),
                 rows_.notes());
  }
  [[nodiscard]] bool is_enough() const;
  [[nodiscard]] Result<FoundDialect> find_dialect() const;
  [[nodiscard]] RowEvidence evidence(FoundDialect& found) const;
  void begin(FoundDialect found, DecidedPlan plan);
  void read(std::string_view text, std::int64_t host_ns);

  std::string partial_;
  std::uint64_t skipped_ = 0;  ///< bytes of an overlong line
  std::uint64_t came_ = 0;
  std::vector<HeldLine> held_;
  std::size_t held_bytes_ = 0;
  std::size_t tried_ = 0;  ///< number of lines at the last search for the columns
  std::unique_ptr<LineDialect> dialect_;
  std::optional<std::size_t> clock_field_;
  std::vector<double> values_;
  RepeatedNote misfits_{"lines skipped"}, garbage_{"lines without an end"};
  RepeatedNote restarts_{"headers"};
};

/// True if the lines determine the columns, and span enough time to determine a clock's unit.
bool LineDecoder::is_enough() const {
  if (held_.empty() || (tried_ > 0 && held_.size() < tried_ + tried_ / 4 + 1)) return false;
  constexpr std::size_t usual = 32, fewest = 8;
  constexpr std::int64_t long_enough_ns = 100'000'000, long_ns = 1'000'000'000;
  const std::int64_t span_ns = held_.back().host_ns - held_.front().host_ns;
  const bool is_long = span_ns >= long_enough_ns || held_bytes_ >= longest_line / 2;
  return (held_.size() >= usual && is_long) || (held_.size() >= fewest && span_ns >= long_ns);
}

Result<FoundDialect> LineDecoder::find_dialect() const {
  if (auto keyed = find_keyed(held_, options_); keyed.dialect) return keyed;
  return find_table(held_, options_);
}

RowEvidence LineDecoder::evidence(FoundDialect& found) const {
  RowEvidence rows{found.dialect->fields(), found.dialect->has_names()};
  rows.first.resize(rows.fields.size());
  std::vector<double> values(rows.fields.size());
  std::optional<Tick> tick;
  for (std::size_t l = found.begin; l < held_.size(); ++l) {
    if (found.dialect->read(held_[l].text, std::nullopt, values, tick) != LineFit::row) continue;
    for (std::size_t f = 0; f < values.size(); ++f) rows.first[f].push_back(values[f]);
    rows.host_ns.push_back(held_[l].host_ns);
  }
  found.dialect->notes().clear();
  return rows;
}

Result<bool> LineDecoder::settle(bool is_last_chance) {
  if (dialect_) return true;
  if (held_.empty() || (!is_last_chance && !is_enough())) return false;
  tried_ = held_.size();
  auto looked = find_dialect();
  if (!looked) return looked.error();
  FoundDialect found = std::move(looked).value();
  if (!found.dialect) return false;
  const RowEvidence rows = evidence(found);
  constexpr std::size_t fewest = 4;
  if (rows.host_ns.size() < (is_last_chance ? 1 : fewest)) return false;
  auto plan = decide_plan(rows, options_);
  if (!plan) return plan.error();
  begin(std::move(found), std::move(plan).value());
  return true;
}

void LineDecoder::begin(FoundDialect found, DecidedPlan plan) {
  dialect_ = std::move(found.dialect);
  dialect_->keep(plan.plan);
  values_.resize(dialect_->fields().size());
  clock_field_ = plan.clock_field;
  settings_ = std::move(plan.settings);
  for (Note& note : plan.notes) rows_.notes().push_back(std::move(note));
  rows_.begin(std::move(plan.plan), options_.carrier == Carrier::datagrams);
  for (Note& note : found.notes) rows_.notes().push_back(std::move(note));
  if (found.begin > 0)
    rows_.note(Severity::info, fmt::format("lines before the first row: {}; the last: {}",
                                           found.begin, io::shown(held_[found.begin - 1].text)));
  const std::vector<HeldLine> held = std::exchange(held_, {});
  for (std::size_t l = found.begin; l < held.size(); ++l) read(held[l].text, held[l].host_ns);
}

void LineDecoder::read(std::string_view text, std::int64_t host_ns) {
  std::optional<Tick> tick;
  const LineFit fit = dialect_->read(text, clock_field_, values_, tick);
  std::vector<Note>& notes = rows_.notes();
  std::ranges::move(dialect_->notes(), std::back_inserter(notes));
  dialect_->notes().clear();
  switch (fit) {
    case LineFit::row:
      rows_.add(values_, tick, host_ns);
      return;
    case LineFit::blank:
      return;
    case LineFit::header:
      rows_.begin_anew();
      restarts_.add("the header was repeated: the device restarted", notes);
      return;
    case LineFit::broken:
      rows_.lose(1);
      break;
    case LineFit::words:
      break;
  }
  ++counts_.lines;
  misfits_.add(fmt::format("skipped a line that is not a row: {}", io::shown(text)), notes);
}

std::string LineDecoder::what_came() const {
  if (came_ == 0) return {};
  if (held_.empty())
    return fmt::format(
        "{} bytes came, but no line: is the baud rate another, or are these frames (framing=)?",
        came_);
  return fmt::format(
      "{} lines came, but no rows: expected figures between commas, semicolons, tabs or blanks, "
      "label:value pairs or JSON objects; the last line: {}",
      held_.size(), io::shown(held_.back().text));
}

}  // namespace

Result<std::unique_ptr<Decoder>> make_line_decoder(const FramingOptions& options) {
  return std::unique_ptr<Decoder>(std::make_unique<LineDecoder>(options));
}

}  // namespace proofmass::acquire
