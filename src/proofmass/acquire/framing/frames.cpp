#include "proofmass/acquire/framing/frames.hpp"

#include <fmt/format.h>
#include <utility>

#include "proofmass/acquire/framing/cut.hpp"
#include "proofmass/acquire/framing/fields.hpp"
#include "proofmass/acquire/framing/plan.hpp"

namespace proofmass::acquire {
namespace {

class FrameDecoder final : public Decoder, private FrameSink {
 public:
  FrameDecoder(const FramingOptions& options, FrameLayout layout)
      : Decoder(options), layout_(std::move(layout)), values_(layout_.fields.size()) {
    switch (options_.framing) {
      case Framing::cobs:
        cutter_ = cobs_cutter(layout_.bytes);
        break;
      case Framing::slip:
        cutter_ = slip_cutter(layout_.bytes);
        break;
      case Framing::sync:
        cutter_ = sync_cutter(options_.sync, layout_.bytes, layout_.check.has_value());
        break;
      case Framing::lines:
      case Framing::packet:
        break;
    }
  }

  /// Determines the roles of the fields. Errors: as decide_plan.
  Status decide() {
    RowEvidence rows;
    std::vector<io::ColumnLabel> labels;
    for (const FrameField& field : layout_.fields) labels.push_back(io::read_label(field.name));
    io::complete_names(labels, rows_.notes());
    for (std::size_t f = 0; f < labels.size(); ++f) {
      const FrameField& field = layout_.fields[f];
      const bool is_whole = field.kind != FrameField::Kind::floating;
      rows.fields.push_back(
          {field.name, labels[f], is_whole ? static_cast<int>(8 * field.bytes) : 0});
    }
    auto decided = decide_plan(rows, options_);
    if (!decided) return decided.error();
    DecidedPlan plan = std::move(decided).value();
    for (Note& note : plan.notes) rows_.notes().push_back(std::move(note));
    settings_ = std::move(plan.settings);
    clock_field_ = plan.clock_field;
    rows_.begin(std::move(plan.plan), options_.carrier == Carrier::datagrams);
    return Done{};
  }

  void take(std::string_view bytes, std::int64_t host_ns) override {
    came_ += bytes.size();
    host_ns_ = host_ns;
    cutter_->take(bytes, *this);
  }
  void take_packet(std::string_view packet, std::int64_t host_ns) override {
    came_ += packet.size();
    host_ns_ = host_ns;
    if (packet.empty() || packet.size() % layout_.bytes != 0) {
      skipped(packet.size(), 1, false);
      return;
    }
    for (; !packet.empty(); packet.remove_prefix(layout_.bytes)) {
      const std::string_view bytes = packet.substr(0, layout_.bytes);
      if (is_sound(bytes))
        frame(bytes);
      else
        skipped(bytes.size(), 1, true);
    }
  }
  void finish(std::int64_t host_ns) override {
    host_ns_ = host_ns;
    if (cutter_) cutter_->finish(*this);
  }
  Result<bool> settle(bool) override { return true; }
  std::string what_came() const override {
    if (came_ == 0) return {};
    return fmt::format(
        "{} bytes came, but no frame of {} bytes{}: is the baud rate, the framing or one of the "
        "fields another?",
        came_, layout_.bytes, layout_.check ? " with a right checksum" : "");
  }

 private:
  bool is_sound(std::string_view bytes) const override { return layout_.is_sound(bytes); }
  void frame(std::string_view bytes) override {
    layout_.read(bytes, values_);
    std::optional<Tick> tick = Tick{};
    if (clock_field_) tick = read_tick(bytes, layout_.fields[*clock_field_]);
    rows_.add(values_, tick, host_ns_);
  }
  void skipped(std::size_t bytes, std::size_t frames, bool by_checksum) override {
    counts_.bytes += bytes;
    if (by_checksum) ++counts_.bad_checksums;
    rows_.lose(frames);
    if (frames == 0) {
      rows_.note(Severity::info,
                 fmt::format("{} bytes that belong to no whole frame skipped", bytes));
      return;
    }
    garbage_.add(by_checksum ? fmt::format("a wrong checksum: {} bytes skipped", bytes)
                             : fmt::format("skipped {} bytes that are not a frame of {}", bytes,
                                           layout_.bytes),
                 rows_.notes());
  }

  FrameLayout layout_;
  std::unique_ptr<FrameCutter> cutter_;  ///< for streams
  std::vector<double> values_;
  std::optional<std::size_t> clock_field_;
  std::int64_t host_ns_ = 0;
  std::uint64_t came_ = 0;
  RepeatedNote garbage_{"times bytes that are not a frame were skipped"};
};

}  // namespace

Result<std::unique_ptr<Decoder>> make_frame_decoder(const FramingOptions& options) {
  auto layout = FrameLayout::parse(options.fields, options.big_endian);
  if (!layout) return layout.error();
  auto decoder = std::make_unique<FrameDecoder>(options, std::move(layout).value());
  if (const Status decided = decoder->decide(); !decided) return decided.error();
  return std::unique_ptr<Decoder>(std::move(decoder));
}

}  // namespace proofmass::acquire
