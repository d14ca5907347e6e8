#include "proofmass/sensor/export/text.hpp"

#include <fmt/format.h>
#include <vector>

namespace proofmass::sensor {

std::string comment_text(std::string_view text) {
  std::string out;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    const bool breaks =
        !out.empty() && ((out.back() == '*' && c == '/') || (out.back() == '/' && c == '*') ||
                         (out.back() == '?' && c == '?'));
    if (breaks) out += ' ';
    out += byte < 0x20 || byte == 0x7F || c == '\\' ? ' ' : c;
  }
  return out;
}

std::string name_or(const SensorModel& model, std::string_view otherwise) {
  return model.name.empty() ? std::string(otherwise) : comment_text(model.name);
}

std::string missing_axes(const AxisFigures& figures) {
  std::vector<std::string_view> missing;
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (!figures[axis]) missing.push_back(std::string_view("xyz").substr(axis, 1));
  return fmt::format("{}", fmt::join(missing, ", "));
}

}  // namespace proofmass::sensor
