#include "calibrated_samples.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <numeric>

#include "exit_status.hpp"

namespace proofmass::app {

CalibratedSamples::CalibratedSamples(const InputFlags& flags,
                                     const Recording& head,
                                     std::vector<Note>& notes)
    : models_(load_sensors(flags, notes)), pieces_(1) {
  choose(flags.channels, head);
  Recording& piece = pieces_.front();
  piece.source = head.source;
  piece.time = head.time;
  for (const std::size_t c : chosen_) {
    piece.channels.push_back(head.channels[c]);
    units_.push_back(head.channels[c].unit);
  }
  found_ = app::accelerometers(pieces_);
  to_si();  // which says what cannot be done before a sample is taken
  head_ = piece;
}

void CalibratedSamples::choose(const std::vector<std::string>& names, const Recording& head) {
  if (names.empty()) {
    chosen_.resize(head.channels.size());
    std::iota(chosen_.begin(), chosen_.end(), std::size_t{0});
    return;
  }
  for (const std::string& name : names) {
    const Channel* channel = head.find(name);
    if (channel == nullptr) {
      std::string known;
      for (const Channel& other : head.channels) known += (known.empty() ? "" : ", ") + other.name;
      throw Failure(usage, fmt::format("--channel {}: {} has {}", name, head.source, known));
    }
    chosen_.push_back(static_cast<std::size_t>(channel - head.channels.data()));
  }
}

void CalibratedSamples::to_si() {
  calibrate(models_, found_, pieces_);
  for (Channel& channel : pieces_.front().channels) {
    if (channel.unit.quantity != Quantity::angular_rate) continue;
    for (double& value : channel.values) value = channel.unit.si(value);
    channel.unit = *parse_unit("rad/s");
  }
}

Block CalibratedSamples::apply(const Block& raw) {
  Recording& piece = pieces_.front();
  for (std::size_t i = 0; i < chosen_.size(); ++i) {
    const View<double> values = raw.channels[chosen_[i]];
    piece.channels[i].unit = units_[i];
    piece.channels[i].values.assign(values.begin(), values.end());
  }
  to_si();
  Block block{raw.first, {}, raw.stamps_s};
  for (const Channel& channel : piece.channels) block.channels.emplace_back(channel.values);
  return block;
}

}  // namespace proofmass::app
