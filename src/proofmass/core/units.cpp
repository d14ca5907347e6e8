#include "proofmass/core/units.hpp"

#include <array>
#include <utility>

namespace proofmass {
namespace {

constexpr double g = standard_gravity_mps2;

struct Spelling {
  std::string_view text;
  Quantity quantity;
  double to_si;
  std::string_view symbol;
  double offset_si = 0.0;
};

// All spellings found in recordings, after plain() has replaced equivalent characters: ² by ^2, µ
// and μ by u, ° by deg, · by *.
constexpr std::array spellings = std::to_array<Spelling>({
    {"m/s^2", Quantity::acceleration, 1.0, "m/s^2"},
    {"m/s2", Quantity::acceleration, 1.0, "m/s^2"},
    {"m/s/s", Quantity::acceleration, 1.0, "m/s^2"},
    {"m/sec^2", Quantity::acceleration, 1.0, "m/s^2"},
    {"m/(s^2)", Quantity::acceleration, 1.0, "m/s^2"},
    {"m*s^-2", Quantity::acceleration, 1.0, "m/s^2"},
    {"m s^-2", Quantity::acceleration, 1.0, "m/s^2"},
    {"ms^-2", Quantity::acceleration, 1.0, "m/s^2"},
    {"ms-2", Quantity::acceleration, 1.0, "m/s^2"},
    {"mps2", Quantity::acceleration, 1.0, "m/s^2"},
    {"mpss", Quantity::acceleration, 1.0, "m/s^2"},
    {"mm/s^2", Quantity::acceleration, 1e-3, "mm/s^2"},
    {"cm/s^2", Quantity::acceleration, 1e-2, "cm/s^2"},
    {"gal", Quantity::acceleration, 1e-2, "cm/s^2"},
    {"ft/s^2", Quantity::acceleration, 0.3048, "ft/s^2"},
    {"g", Quantity::acceleration, g, "g"},
    {"gn", Quantity::acceleration, g, "g"},
    {"g0", Quantity::acceleration, g, "g"},
    {"mg", Quantity::acceleration, g * 1e-3, "mg"},
    {"ug", Quantity::acceleration, g * 1e-6, "ug"},
    {"rad/s", Quantity::angular_rate, 1.0, "rad/s"},
    {"rad/sec", Quantity::angular_rate, 1.0, "rad/s"},
    {"rads/s", Quantity::angular_rate, 1.0, "rad/s"},
    {"radps", Quantity::angular_rate, 1.0, "rad/s"},
    {"mrad/s", Quantity::angular_rate, 1e-3, "mrad/s"},
    {"deg/s", Quantity::angular_rate, rad_per_deg, "deg/s"},
    {"deg/sec", Quantity::angular_rate, rad_per_deg, "deg/s"},
    {"dps", Quantity::angular_rate, rad_per_deg, "deg/s"},
    {"mdps", Quantity::angular_rate, rad_per_deg * 1e-3, "mdeg/s"},
    {"rpm", Quantity::angular_rate, radps_per_rpm, "rpm"},
    {"rad", Quantity::angle, 1.0, "rad"},
    {"mrad", Quantity::angle, 1e-3, "mrad"},
    {"deg", Quantity::angle, rad_per_deg, "deg"},
    {"degree", Quantity::angle, rad_per_deg, "deg"},
    {"degrees", Quantity::angle, rad_per_deg, "deg"},
    {"turn", Quantity::angle, rad_per_turn, "turn"},
    {"turns", Quantity::angle, rad_per_turn, "turn"},
    {"s", Quantity::time, 1.0, "s"},
    {"sec", Quantity::time, 1.0, "s"},
    {"second", Quantity::time, 1.0, "s"},
    {"seconds", Quantity::time, 1.0, "s"},
    {"ms", Quantity::time, 1e-3, "ms"},
    {"msec", Quantity::time, 1e-3, "ms"},
    {"milliseconds", Quantity::time, 1e-3, "ms"},
    {"us", Quantity::time, 1e-6, "us"},
    {"usec", Quantity::time, 1e-6, "us"},
    {"microseconds", Quantity::time, 1e-6, "us"},
    {"ns", Quantity::time, 1e-9, "ns"},
    {"nsec", Quantity::time, 1e-9, "ns"},
    {"nanoseconds", Quantity::time, 1e-9, "ns"},
    {"min", Quantity::time, 60.0, "min"},
    {"h", Quantity::time, 3600.0, "h"},
    {"V", Quantity::voltage, 1.0, "V"},
    {"volt", Quantity::voltage, 1.0, "V"},
    {"volts", Quantity::voltage, 1.0, "V"},
    {"mV", Quantity::voltage, 1e-3, "mV"},
    {"uV", Quantity::voltage, 1e-6, "uV"},
    {"counts", Quantity::counts, 1.0, "counts"},
    {"count", Quantity::counts, 1.0, "counts"},
    {"LSB", Quantity::counts, 1.0, "counts"},
    {"raw", Quantity::counts, 1.0, "counts"},
    {"adc", Quantity::counts, 1.0, "counts"},
    {"degC", Quantity::temperature, 1.0, "degC", 273.15},
    {"C", Quantity::temperature, 1.0, "degC", 273.15},
    {"celsius", Quantity::temperature, 1.0, "degC", 273.15},
    {"K", Quantity::temperature, 1.0, "K"},
    {"degF", Quantity::temperature, 5.0 / 9.0, "degF", 459.67 * 5.0 / 9.0},
    {"m", Quantity::length, 1.0, "m"},
    {"mm", Quantity::length, 1e-3, "mm"},
    {"cm", Quantity::length, 1e-2, "cm"},
    {"km", Quantity::length, 1e3, "km"},
    {"m/s", Quantity::speed, 1.0, "m/s"},
    {"mps", Quantity::speed, 1.0, "m/s"},
    {"mm/s", Quantity::speed, 1e-3, "mm/s"},
    {"km/h", Quantity::speed, 1.0 / 3.6, "km/h"},
    {"Pa", Quantity::pressure, 1.0, "Pa"},
    {"hPa", Quantity::pressure, 100.0, "hPa"},
    {"mbar", Quantity::pressure, 100.0, "hPa"},
    {"kPa", Quantity::pressure, 1e3, "kPa"},
    {"T", Quantity::magnetic_field, 1.0, "T"},
    {"mT", Quantity::magnetic_field, 1e-3, "mT"},
    {"uT", Quantity::magnetic_field, 1e-6, "uT"},
    {"nT", Quantity::magnetic_field, 1e-9, "nT"},
    {"G", Quantity::magnetic_field, 1e-4, "G"},
    {"gauss", Quantity::magnetic_field, 1e-4, "G"},
    {"mGauss", Quantity::magnetic_field, 1e-7, "mG"},
});

constexpr std::array folds = std::to_array<std::pair<std::string_view, std::string_view>>({
    {"⁻²", "^-2"},
    {"²", "^2"},
    {"³", "^3"},
    {"µ", "u"},  // U+00B5, micro sign
    {"μ", "u"},  // U+03BC, Greek mu
    {"°", "deg"},
    {"º", "deg"},
    {"˚", "deg"},
    {"·", "*"},
    {"⋅", "*"},
    {"∕", "/"},
    {"**", "^"},
    {"\xB5", "u"},  // the same in Latin-1, which many loggers write
    {"\xB2", "^2"},
    {"\xB0", "deg"},
});

std::string plain(std::string_view text) {
  std::string out;
  for (std::size_t i = 0; i < text.size();) {
    const std::string_view rest = text.substr(i);
    std::size_t used = 1;
    std::string_view replacement = rest.substr(0, 1);
    for (const auto& [from, to] : folds) {
      if (!rest.starts_with(from)) continue;
      used = from.size();
      replacement = to;
      break;
    }
    out += replacement;
    i += used;
  }
  return out;
}

std::string_view stripped(std::string_view text) {
  constexpr std::string_view around = " \t\r\n\"'()[]{}<>";
  const auto first = text.find_first_not_of(around);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(around) - first + 1);
}

bool same_ignoring_case(std::string_view a, std::string_view b) {
  const auto lower = [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; };
  if (a.size() != b.size()) return false;
  for (std::size_t i = 0; i < a.size(); ++i)
    if (lower(a[i]) != lower(b[i])) return false;
  return true;
}

}  // namespace

std::optional<Unit> parse_unit(std::string_view text) {
  const std::string folded = plain(stripped(text));
  const auto unit = [](const Spelling& s) {
    return Unit{s.quantity, s.to_si, s.offset_si, std::string(s.symbol)};
  };
  for (const Spelling& s : spellings)
    if (s.text == folded) return unit(s);
  // Long words have the same meaning in any case ("Volts", "M/S^2"); for short ones the case
  // matters.
  if (folded.size() < 3) return std::nullopt;
  for (const Spelling& s : spellings)
    if (s.text.size() >= 3 && same_ignoring_case(s.text, folded)) return unit(s);
  return std::nullopt;
}

std::string_view name_of(Quantity quantity) {
  switch (quantity) {
    case Quantity::unknown:
      return "unknown";
    case Quantity::counts:
      return "counts";
    case Quantity::time:
      return "time";
    case Quantity::acceleration:
      return "acceleration";
    case Quantity::angular_rate:
      return "angular rate";
    case Quantity::angle:
      return "angle";
    case Quantity::voltage:
      return "voltage";
    case Quantity::temperature:
      return "temperature";
    case Quantity::length:
      return "length";
    case Quantity::speed:
      return "speed";
    case Quantity::pressure:
      return "pressure";
    case Quantity::magnetic_field:
      return "magnetic field";
  }
  return "unknown";
}

}  // namespace proofmass
