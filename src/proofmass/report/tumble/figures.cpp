#include "proofmass/report/tumble/figures.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <numbers>

#include "proofmass/report/wording.hpp"

namespace proofmass::report {
namespace {

using calibrate::TumblePosition;

constexpr Ink inks[] = {Ink::blue, Ink::orange, Ink::green, Ink::purple, Ink::red};

double turn_deg(double angle_rad) {
  const double angle = std::remainder(angle_rad, rad_per_turn) / rad_per_deg;
  return angle < -1e-9 ? angle + 360.0 : std::max(angle, 0.0);
}

// Positions with the same plane, mounting and direction.
struct Group {
  int plane = 1, direction = 0;
  double mount_rad = 0.0;
  std::vector<std::size_t> places;  // ascending in angle
};

std::vector<Group> groups_of(const ChannelTumble& channel) {
  std::vector<Group> groups;
  for (std::size_t k = 0; k < channel.positions.size(); ++k) {
    const TumblePosition& p = channel.positions[k];
    const auto same = [&](const Group& g) {
      return g.plane == p.plane && g.direction == p.direction &&
             std::abs(g.mount_rad - p.mount_rad) < 0.5 * rad_per_deg;
    };
    auto found = std::find_if(groups.begin(), groups.end(), same);
    if (found == groups.end())
      found = groups.insert(groups.end(), {p.plane, p.direction, p.mount_rad, {}});
    found->places.push_back(k);
  }
  for (Group& group : groups)
    std::stable_sort(group.places.begin(), group.places.end(), [&](std::size_t a, std::size_t b) {
      return turn_deg(channel.positions[a].angle_rad) < turn_deg(channel.positions[b].angle_rad);
    });
  return groups;
}

std::string label_of(const Group& group, const std::vector<Group>& all) {
  if (all.size() == 1) return "output";
  std::string text = fmt::format("plane {}", group.plane);
  if (group.mount_rad > 0.5 * rad_per_deg)
    text += fmt::format(", mounted at {}°", compact(group.mount_rad / rad_per_deg, 4));
  if (group.direction != 0) text += group.direction > 0 ? ", forwards" : ", backwards";
  return text;
}

Axis angle_axis() {
  return {.label = "Table angle (°)", .min = -5.0, .max = 365.0};
}

std::string unit_of(const ChannelTumble& channel) {
  return channel.unit.symbol.empty() ? "" : " (" + print_unit(channel.unit.symbol) + ")";
}

// First harmonics of the fit, which is all that is visible: K1 (K0 + g sin φ + δ g cos φ).
Curve fitted_curve(const ChannelTumble& channel, const Group& group, Ink ink) {
  Curve curve{.label = {}, .x = {}, .y = {}, .ink = ink, .mark = Mark::line};
  const auto* scale = channel.fit->find(calibrate::TumbleQuantity::K1);
  const auto* bias = channel.fit->find(calibrate::TumbleQuantity::K0_up_down);
  const auto phase = channel.axis.phase_rad[group.plane == 2 ? 1 : 0];
  if (scale == nullptr || !scale->value || bias == nullptr || !bias->value || !phase) return curve;
  for (int angle = 0; angle <= 360; angle += 3) {
    const double phi = angle * rad_per_deg + group.mount_rad + *phase;
    curve.x.push_back(angle);
    curve.y.push_back(*scale->value * (*bias->value + standard_gravity_mps2 * std::sin(phi)));
  }
  return curve;
}

// The 95 % band of the residuals of one group.
Band residual_band(const ChannelTumble& channel, const Group& group) {
  constexpr double two_sided_95 = 1.959964;
  Band band{.label = "± 95 %", .x = {}, .lower = {}, .upper = {}, .ink = Ink::grey};
  for (const std::size_t place : group.places) {
    const calibrate::TumbleResidual& r = channel.fit->positions[place];
    if (!r.std) continue;
    band.x.push_back(turn_deg(channel.positions[place].angle_rad));
    band.upper.push_back(two_sided_95 * *r.std);
    band.lower.push_back(-two_sided_95 * *r.std);
  }
  return band;
}

Callout suspect_callout(const TumblePosition& position, double residual) {
  const double angle = turn_deg(position.angle_rad);
  return {.text = position.label.empty() ? compact(angle, 4) + "°" : position.label,
          .x = angle,
          .y = residual,
          .ink = Ink::red};
}

}  // namespace

Figure tumble_output_figure(const ChannelTumble& channel) {
  Figure figure{.title = channel.name + ": output against angle",
                .description =
                    "Output at each position, and the sine given by scale factor and bias; the "
                    "other terms are too small to be visible.",
                .x = angle_axis(),
                .y = {.label = "Output" + unit_of(channel)}};
  const std::vector<Group> groups = groups_of(channel);
  for (std::size_t k = 0; k < groups.size(); ++k) {
    const Ink ink = inks[k % std::size(inks)];
    figure.curves.push_back(fitted_curve(channel, groups[k], ink));
    Curve points{
        .label = label_of(groups[k], groups), .x = {}, .y = {}, .ink = ink, .mark = Mark::points};
    for (const std::size_t place : groups[k].places) {
      points.x.push_back(turn_deg(channel.positions[place].angle_rad));
      points.y.push_back(channel.positions[place].output);
    }
    figure.curves.push_back(std::move(points));
  }
  return figure;
}

Figure tumble_residual_figure(const ChannelTumble& channel) {
  Figure figure{
      .title = channel.name + ": residuals against angle",
      .description =
          "Output less fit with all terms, and the band that is expected to contain 95 % of "
          "the residuals.",
      .x = angle_axis(),
      .y = {.label = "Residual" + unit_of(channel)},
      .levels = {{"", 0.0}}};
  const std::vector<Group> groups = groups_of(channel);
  Band band = residual_band(channel, groups.front());
  if (band.x.size() > 1) figure.bands.push_back(std::move(band));
  for (std::size_t k = 0; k < groups.size(); ++k) {
    Curve points{.label = groups.size() > 1 ? label_of(groups[k], groups) : "",
                 .x = {},
                 .y = {},
                 .ink = inks[k % std::size(inks)],
                 .mark = Mark::points};
    for (const std::size_t place : groups[k].places) {
      const calibrate::TumbleResidual& r = channel.fit->positions[place];
      points.x.push_back(turn_deg(channel.positions[place].angle_rad));
      points.y.push_back(r.residual);
      if (r.suspect)
        figure.callouts.push_back(suspect_callout(channel.positions[place], r.residual));
    }
    figure.curves.push_back(std::move(points));
  }
  return figure;
}

}  // namespace proofmass::report
