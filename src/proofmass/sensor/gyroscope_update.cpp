#include "proofmass/sensor/gyroscope_update.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "proofmass/sensor/file/change.hpp"

namespace proofmass::sensor {
namespace {

/// The figures in the order of the covariance, three by three.
std::array<AxisFigures*, 7> groups_of(Gyroscope& gyroscope) {
  auto& [x, y, z] = gyroscope.g_sensitivity;
  return {
      &gyroscope.bias, &gyroscope.scale, &gyroscope.misalignment, &gyroscope.alignment, &x, &y, &z};
}

std::string unit_of_group(std::size_t group, const std::string& reading) {
  if (group == 0) return reading;
  if (group == 1) return reading == "rad/s" ? "1" : reading + "/(rad/s)";
  return group < 4 ? "rad" : reading + "/(m/s^2)";
}

Status check_gyroscope(const MeasuredGyroscope& measured) {
  constexpr std::array<std::string_view, 3> units{"rad/s", "V", "counts"};
  if (std::ranges::find(units, measured.reading_unit) == units.end())
    return Error{Errc::invalid_argument,
                 fmt::format("gyroscope: readings in {}; expected rad/s, V or counts",
                             measured.reading_unit)};
  for (std::size_t k = 0; k < gyroscope_figures; ++k) {
    const auto& figure = measured.figures[k];
    if (!figure) continue;
    if (!std::isfinite(figure->value) || !std::isfinite(figure->std))
      return Error{Errc::not_finite, "gyroscope: a figure is not finite"};
    if (figure->std < 0.0 || (k >= 3 && k < 6 && figure->value == 0.0))
      return Error{Errc::invalid_argument, "gyroscope: a scale of 0 or a negative std"};
  }
  return Done{};
}

}  // namespace

Status update_gyroscope(SensorModel& model, const MeasuredGyroscope& measured) {
  if (const Status fits = check_gyroscope(measured); !fits) return fits;
  const auto groups = groups_of(model.gyroscope);
  bool all = true;
  for (std::size_t k = 0; k < gyroscope_figures; ++k) {
    std::optional<Figure>& place = (*groups[k / 3])[k % 3];
    place.reset();
    all &= measured.figures[k].has_value();
    if (!measured.figures[k]) continue;
    place = make_figure(measured.figures[k]->value, unit_of_group(k / 3, measured.reading_unit),
                        measured.origin);
    place->std = measured.figures[k]->std;
  }
  model.gyroscope.covariance = all ? measured.covariance : std::nullopt;
  return Done{};
}

Status update_gyroscope(const std::string& path, const MeasuredGyroscope& measured) {
  return change_sensor_file(path,
                            [&](SensorModel& model) { return update_gyroscope(model, measured); });
}

}  // namespace proofmass::sensor
