#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <string_view>

#include "proofmass/sensor/export/text.hpp"
#include "proofmass/sensor/sensor_export.hpp"

namespace proofmass::sensor {
namespace {

/// YAML 1.1 parses 1e-05 as text: a number needs a decimal point.
std::string yaml_number(double value) {
  std::string text = fmt::format("{}", value);
  if (text.find('.') == std::string::npos) text.insert(std::min(text.find('e'), text.size()), ".0");
  return text;
}

std::string yaml_string(std::string_view text) {
  std::string out = "\"";
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\') out += '\\';
    if (byte < 0x20 || byte == 0x7F)
      out += fmt::format("\\x{:02X}", byte);
    else
      out += c;
  }
  return out + '"';
}

/// A comment line for each axis: "#   x: 0.00104 ± 2e-06, noise of static.csv".
std::string yaml_axes(const AxisFigures& figures) {
  std::string out;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto& figure = figures[axis];
    out += fmt::format("#   {}: ", "xyz"[axis]);
    out += figure ? fmt::format("{:.6g}", figure->si()) : "not in the sensor file";
    if (figure && figure->std) out += fmt::format(" ± {:.2g}", *figure->std_si());
    if (figure && !figure->origin.empty()) out += ", " + comment_text(figure->origin);
    out += '\n';
  }
  return out;
}

/// The largest of the known axes; 0 if none is known.
double worst(const AxisFigures& figures) {
  double largest = 0.0;
  for (const auto& figure : figures)
    if (figure) largest = std::max(largest, figure->si());
  return largest;
}

/// The gyroscope's two entries; commented out where the file does not have them.
std::string yaml_gyroscope(const Gyroscope& gyroscope) {
  const auto entry = [](const AxisFigures& figures, std::string_view head, std::string_view key,
                        std::string_view why) {
    std::string out = fmt::format("# {}:\n{}", head, yaml_axes(figures));
    const double largest = worst(figures);
    if (largest > 0.0 && missing_axes(figures).empty())
      return out + fmt::format("{}: {}\n", key, yaml_number(largest));
    return out + fmt::format("# {}:  # {}\n", key, why);
  };
  return "\n" +
         entry(gyroscope.white, "Gyroscope: white noise, N, in rad/s/sqrt(Hz)",
               "gyroscope_noise_density", "rad/s/sqrt(Hz); measure it at rest") +
         entry(gyroscope.random_walk,
               "Gyroscope: random walk of the bias, K, in rad/s^2/sqrt(Hz), which is rad/s/sqrt(s)",
               "gyroscope_random_walk",
               "rad/s^2/sqrt(Hz); record at rest for longer, or fill in what may be assumed") +
         "\n";
}

Status check_white(const AxisFigures& white) {
  constexpr std::string_view remedy =
      "measure it at rest, or write it into the sensor file from "
      "the datasheet (one-sided density / sqrt(2))";
  if (const std::string axes = missing_axes(white); !axes.empty())
    return Error{Errc::invalid_argument,
                 fmt::format("noise.white is missing on axis {}: {}", axes, remedy),
                 {Advice{"update-sensor"}}};
  if (worst(white) <= 0.0)
    return Error{
        Errc::not_observable,
        fmt::format("noise.white is 0 on all axes, as where a recording could not determine "
                    "it: {}",
                    remedy),
        {Advice{"update-sensor"}}};
  return Done{};
}

std::string yaml_random_walk(const AxisFigures& random_walk) {
  const double largest = worst(random_walk);
  std::string out = "# Random walk of the bias, K, in m/s^3/sqrt(Hz), which is m/s^2/sqrt(s):\n" +
                    yaml_axes(random_walk);
  if (largest > 0.0)
    return out + fmt::format("accelerometer_random_walk: {}\n", yaml_number(largest));
  return out +
         "# No axis is known to have one: record at rest for longer, or fill in what may be "
         "assumed.\n"
         "# accelerometer_random_walk:\n";
}

std::string yaml_rate(const std::optional<double>& rate_hz) {
  if (rate_hz) return fmt::format("update_rate: {}  # Hz\n", yaml_number(*rate_hz));
  return "# update_rate:  # Hz; fill in\n";
}

}  // namespace

Result<std::string> imu_yaml(const SensorModel& model, const ImuYamlOptions& options) {
  const double rate_hz = options.rate_hz.value_or(1.0);
  if (!std::isfinite(rate_hz) || rate_hz <= 0.0)
    return Error{Errc::invalid_argument, "the rate must be positive and finite"};
  if (const Status fits = check_white(model.noise.white); !fits) return fits.error();
  std::string out = fmt::format(
      "# Noise of {}, for visual-inertial calibration; written by proofmass sensor export.\n"
      "# One number for three axes: that of the noisiest, so that none is overweighted.\n"
      "# Densities are two-sided, as the Allan deviation gives them.\n\n"
      "# White noise, N, in m/s^2/sqrt(Hz):\n",
      name_or(model, "an accelerometer"));
  out += yaml_axes(model.noise.white);
  out += fmt::format("accelerometer_noise_density: {}\n", yaml_number(worst(model.noise.white)));
  out += yaml_random_walk(model.noise.random_walk);
  out += yaml_gyroscope(model.gyroscope);
  out += fmt::format("rostopic: {}\n", yaml_string(options.rostopic));
  return out + yaml_rate(options.rate_hz);
}

}  // namespace proofmass::sensor
