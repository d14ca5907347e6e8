#include "proofmass/report/tumble/report.hpp"

#include <limits>

namespace proofmass::report {
namespace {

using calibrate::TumblePosition;

// The channel with the most positions determines the rows.
const ChannelTumble* longest(const TumbleReport& report) {
  const ChannelTumble* found = nullptr;
  for (const ChannelTumble& channel : report.channels) {
    if (!channel.fit) continue;
    if (found == nullptr || channel.positions.size() > found->positions.size()) found = &channel;
  }
  return found;
}

bool same_place(const TumblePosition& a, const TumblePosition& b) {
  return a.angle_rad == b.angle_rad && a.mount_rad == b.mount_rad && a.plane == b.plane &&
         a.direction == b.direction && a.time_s == b.time_s && a.label == b.label;
}

void add_columns(const ChannelTumble& channel, const ChannelTumble& rows, Recording& out) {
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  const std::size_t n = rows.positions.size();
  std::vector<double> output(n, none), fitted(n, none), residual(n, none), std(n, none);
  std::size_t k = 0;
  for (std::size_t j = 0; j < n && k < channel.positions.size(); ++j) {
    if (!same_place(rows.positions[j], channel.positions[k])) continue;
    const calibrate::TumbleResidual& r = channel.fit->positions[k];
    output[j] = channel.positions[k].output;
    fitted[j] = r.fitted;
    residual[j] = r.residual;
    std[j] = r.std.value_or(none);
    ++k;
  }
  const std::string& name = channel.name;
  out.channels.push_back({name, channel.unit, std::move(output)});
  out.channels.push_back({name + "_fit", channel.unit, std::move(fitted)});
  out.channels.push_back({name + "_residual", channel.unit, std::move(residual)});
  out.channels.push_back({name + "_residual_std", channel.unit, std::move(std)});
}

}  // namespace

std::vector<Note> tumble_notes(const TumbleReport& report) {
  std::vector<Note> notes = report.notes;
  const bool any = longest(report) != nullptr;
  for (const ChannelTumble& channel : report.channels) {
    const std::string prefix = channel.name + ": ";
    const bool harmless = any && !channel.axis.follows_angle();
    if (!channel.refused.empty())
      notes.push_back({harmless ? Severity::warning : Severity::bad, prefix + channel.refused});
    if (!channel.fit) continue;
    for (const std::string& text : channel.fit->notes)
      notes.push_back({Severity::warning, prefix + text});
  }
  return notes;
}

Recording tumble_series(const TumbleReport& report) {
  Recording out;
  out.source = "proofmass tumble";
  out.format = "series";
  const ChannelTumble* rows = longest(report);
  if (rows == nullptr) return out;
  const Unit plain{Quantity::unknown, 1.0, 0.0, "1"};
  std::vector<double> angle, direction, mount, plane;
  for (const TumblePosition& p : rows->positions) {
    angle.push_back(p.angle_rad);
    direction.push_back(p.direction);
    mount.push_back(p.mount_rad);
    plane.push_back(p.plane);
  }
  out.channels = {{"angle", *parse_unit("rad"), std::move(angle)},
                  {"direction", plain, std::move(direction)},
                  {"mount", *parse_unit("rad"), std::move(mount)},
                  {"plane", plain, std::move(plane)}};
  for (const ChannelTumble& channel : report.channels)
    if (channel.fit) add_columns(channel, *rows, out);
  return out;
}

}  // namespace proofmass::report
