#include <algorithm>
#include <fmt/format.h>

#include "proofmass/core/new_file.hpp"
#include "proofmass/sensor/file/fields.hpp"
#include "proofmass/sensor/sensor_file.hpp"

namespace proofmass::sensor {
namespace {

std::string toml_string(std::string_view text) {
  std::string out = "\"";
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\') out += '\\';
    if (byte < 0x20 || byte == 0x7F)
      out += fmt::format("\\u{:04X}", byte);
    else
      out += c;
  }
  return out + '"';
}

std::string key_text(std::string_view key) {
  const bool bare = !key.empty() && std::ranges::all_of(key, [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
           c == '-';
  });
  return bare ? std::string(key) : toml_string(key);
}

/// The trailing part that the figures of the three axes may share.
std::string unit_and_origin(const Figure& figure) {
  std::string out = fmt::format(", unit = {}", toml_string(figure.unit.symbol));
  if (!figure.origin.empty()) out += fmt::format(", origin = {}", toml_string(figure.origin));
  return out + " }";
}

std::string figure_text(const std::optional<Figure>& figure) {
  if (!figure) return "{}";
  std::string out = fmt::format("{{ value = {}", figure->value);
  if (figure->std) out += fmt::format(", std = {}", *figure->std);
  return out + unit_and_origin(*figure);
}

/// True if one table can hold all three.
bool alike(const AxisFigures& figures) {
  return std::ranges::all_of(figures, [&](const std::optional<Figure>& f) {
    return f && f->unit == figures[0]->unit && f->origin == figures[0]->origin &&
           f->std.has_value() == figures[0]->std.has_value();
  });
}

std::string figure_text(const AxisFigures& figures) {
  const auto& [x, y, z] = figures;
  if (!alike(figures))
    return fmt::format("[ {},\n  {},\n  {} ]", figure_text(x), figure_text(y), figure_text(z));
  std::string out = fmt::format("{{ value = [{}, {}, {}]", x->value, y->value, z->value);
  if (x->std) out += fmt::format(", std = [{}, {}, {}]", *x->std, *y->std, *z->std);
  return out + unit_and_origin(*x);
}

bool is_empty(const std::optional<Figure>& figure) {
  return !figure;
}
bool is_empty(const AxisFigures& figures) {
  return !figures[0] && !figures[1] && !figures[2];
}

template <class Covariance>
std::string covariance_text(const Covariance& covariance, std::string_view order) {
  if (!covariance) return {};
  std::string out = fmt::format("# of {}; SI\ncovariance = [\n", order);
  for (const auto& row : *covariance) out += fmt::format("  [{}],\n", fmt::join(row, ", "));
  return out + "]\n";
}

std::string unknown_text(const SensorModel& model, std::string_view section) {
  std::string out;
  for (const UnknownEntry& entry : model.unknown)
    if (entry.section == section) out += fmt::format("{} = {}\n", key_text(entry.key), entry.toml);
  return out;
}

std::string section_text(const SensorModel& model, std::string_view section) {
  std::string body;
  visit_texts(model, [&](std::string_view in, std::string_view key, const std::string& text) {
    if (in == section && !text.empty()) body += fmt::format("{} = {}\n", key, toml_string(text));
  });
  visit_figures(model,
                [&](std::string_view in, std::string_view key, const auto&, const auto& figure) {
                  if (in == section && !is_empty(figure))
                    body += fmt::format("{} = {}\n", key, figure_text(figure));
                });
  if (section == "calibration")
    body += covariance_text(model.calibration.covariance,
                            "bias x y z, scale x y z, misalignment yz zy zx");
  if (section == "gyroscope") body += covariance_text(model.gyroscope.covariance, gyroscope_order);
  return body + unknown_text(model, section);
}

}  // namespace

std::string format_sensor_file(const SensorModel& model) {
  std::string out = unknown_text(model, "");
  for (const std::string_view section : sections) {
    const std::string body = section_text(model, section);
    if (!body.empty()) out += fmt::format("{}[{}]\n{}", out.empty() ? "" : "\n", section, body);
  }
  return out;
}

Status write_sensor_file(const SensorModel& model, const std::string& path) {
  Status written = write_file(path, format_sensor_file(model));
  if (written) return written;
  return Error{Errc::unwritable,
               written.error().message +
                   ": the sensor file needs a folder that exists, is writable and has room"};
}

}  // namespace proofmass::sensor
