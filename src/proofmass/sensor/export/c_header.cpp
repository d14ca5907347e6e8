#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <string_view>
#include <type_traits>
#include <utility>

#include "proofmass/sensor/calibration.hpp"
#include "proofmass/sensor/export/text.hpp"
#include "proofmass/sensor/file/fields.hpp"
#include "proofmass/sensor/sensor_export.hpp"

namespace proofmass::sensor {
namespace {

/// The character as permitted in an identifier: a lower-case letter, a digit or '_'.
char identifier_char(char c) {
  if (c >= 'A' && c <= 'Z') return static_cast<char>(c - 'A' + 'a');
  const bool allowed = (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9');
  return allowed ? c : '_';
}

/// "ADXL335 at the rim" as "adxl335_at_the_rim"; never two consecutive '_', which C++ reserves.
std::string identifier(const SensorModel& model) {
  std::string out;
  for (const char c : model.name)
    if (const char fit = identifier_char(c); fit != '_' || (!out.empty() && out.back() != '_'))
      out += fit;
  if (out.ends_with('_')) out.pop_back();
  if (out.empty()) return "sensor";
  return out.front() >= '0' && out.front() <= '9' ? "sensor_" + out : out;
}

std::string capitals(std::string text) {
  for (char& c : text)
    if (c >= 'a' && c <= 'z') c = static_cast<char>(c - 'a' + 'A');
  return text;
}

/// Suffix of a name for an SI unit: "_mps2".
std::string_view suffix(std::string_view si_symbol) {
  struct Suffix {
    std::string_view symbol, name;
  };
  static constexpr std::array<Suffix, 9> suffixes{{{"V", "_v"},
                                                   {"V/(m/s^2)", "_v_per_mps2"},
                                                   {"counts", "_counts"},
                                                   {"Hz", "_hz"},
                                                   {"m/s", "_mps"},
                                                   {"m/s^2", "_mps2"},
                                                   {"m/s^3", "_mps3"},
                                                   {"m/s^2/sqrt(Hz)", "_mps2_rthz"},
                                                   {"m/s^2/sqrt(s)", "_mps2_rts"}}};
  const auto found = std::ranges::find(suffixes, si_symbol, &Suffix::symbol);
  return found == suffixes.end() ? std::string_view() : found->name;
}

/// Origin of the figures, written once if it is the same for all.
std::string origins(const AxisFigures& figures) {
  const auto text = [](const std::optional<Figure>& f) {
    return !f ? std::string("not known") : f->origin.empty() ? "origin not stated" : f->origin;
  };
  const std::string x = text(figures[0]), y = text(figures[1]), z = text(figures[2]);
  if (x == y && y == z) return comment_text(x);
  return comment_text(fmt::format("x: {}; y: {}; z: {}", x, y, z));
}

/// Writes definitions, and keeps the first value that does not fit a float.
class Definitions {
 public:
  explicit Definitions(std::string prefix) : prefix_(std::move(prefix)) {}

  void scalar(std::string_view key, const Figure& figure) {
    const AxisFigures same{figure, figure, figure};
    define(key, figure.unit.si_symbol, same, number(key, figure.si()), "");
  }

  /// Three floats; an axis without a figure is `otherwise`.
  void array(std::string_view key,
             const AxisFigures& figures,
             std::string_view si_symbol,
             double otherwise = 0.0) {
    std::array<double, 3> values{};
    for (std::size_t axis = 0; axis < 3; ++axis)
      values[axis] = figures[axis] ? figures[axis]->si() : otherwise;
    define(key, si_symbol, figures, row(key, values), "[3]");
  }

  void matrix(std::string_view key, const std::array<std::array<double, 3>, 3>& rows) {
    text_ += fmt::format("static const float {}_{}[3][3] = {{\n", prefix_, key);
    for (const auto& values : rows) text_ += fmt::format("    {},\n", row(key, values));
    text_ += "};\n";
  }

  void comment(std::string_view text) { text_ += fmt::format("/* {} */\n", text); }

  [[nodiscard]] const std::string& text() const { return text_; }
  [[nodiscard]] const std::string& too_large() const { return too_large_; }

 private:
  std::string number(std::string_view key, double value) {
    const auto single = static_cast<float>(value + 0.0);  // +0 of −0
    if (!std::isfinite(single) && too_large_.empty()) too_large_ = key;
    std::string text = fmt::format("{}", single);
    if (text.find_first_of(".e") == std::string::npos) text += ".0";
    return text + 'f';
  }

  std::string row(std::string_view key, const std::array<double, 3>& values) {
    return fmt::format("{{{}, {}, {}}}", number(key, values[0]), number(key, values[1]),
                       number(key, values[2]));
  }

  void define(std::string_view key,
              std::string_view si_symbol,
              const AxisFigures& figures,
              const std::string& value,
              std::string_view extent) {
    text_ += fmt::format("/* {}; {} */\nstatic const float {}_{}{}{} = {};\n", si_symbol,
                         origins(figures), prefix_, key, suffix(si_symbol), extent, value);
  }

  std::string prefix_, text_, too_large_;
};

/// The unit of the reading that the calibration corrects, if firmware can do so on every axis.
Result<std::string> firmware_unit(const Calibration& calibration) {
  auto unit = reading_unit(calibration);
  if (!unit || *unit == "m/s^2") return unit;
  if (const std::string axes = missing_axes(calibration.scale); !axes.empty())
    return Error{
        Errc::invalid_argument,
        fmt::format("calibration.scale is missing on axis {}: calibrate all three axes, or "
                    "write it there",
                    axes)};
  return unit;
}

/// Description of the reading for the author of the firmware.
std::string reading_text(const Electrical& electrical, std::string_view unit) {
  const bool ratiometric = electrical.reference_supply.has_value();
  const bool by_volts = missing_axes(electrical.sensitivity).empty() &&
                        missing_axes(electrical.zero_g_fraction).empty() &&
                        (ratiometric || electrical.supply);
  if (unit == "V")
    return ratiometric ? "the output in V * reference_supply_v / supply in V" : "the output in V";
  if (unit == "counts") return "the output in counts";
  if (!by_volts) return "the output in m/s^2";
  return ratiometric ? "the output in m/s^2, of V volts at a supply of V_s:\n"
                       "     reading = (V / V_s - zero_g_fraction) * reference_supply_v / "
                       "sensitivity_v_per_mps2"
                     : "the output in m/s^2, of V volts:\n"
                       "     reading = (V - zero_g_fraction * supply_v) / sensitivity_v_per_mps2";
}

void define_figures(const SensorModel& model, std::string_view section, Definitions& out) {
  visit_figures(model, [&](std::string_view in, std::string_view key, const auto&,
                           const auto& figure) {
    if (in != section) return;
    if constexpr (std::is_same_v<std::decay_t<decltype(figure)>, AxisFigures>) {
      const std::string missing = missing_axes(figure);
      if (missing.empty())
        out.array(key, figure, figure[0]->unit.si_symbol);
      else
        out.comment(fmt::format("{}.{} is left out: not known on axis {}", section, key, missing));
    } else if (figure) {
      out.scalar(key, *figure);
    }
  });
}

}  // namespace

Result<std::string> c_header(const SensorModel& model) {
  const auto unit = firmware_unit(model.calibration);
  if (!unit) return unit.error();
  const std::string prefix = identifier(model);
  Definitions out(prefix);
  out.array("bias", model.calibration.bias, *unit);
  const std::string per = *unit == "m/s^2" ? "no unit" : "m/s^2 per " + *unit;
  out.comment(fmt::format("T diag(1/scale), row by row; {}; scale (1 where not known): {}", per,
                          origins(model.calibration.scale)));
  out.matrix("correction", correction_matrix(model.calibration));
  define_figures(model, "electrical", out);
  define_figures(model, "noise", out);
  if (!out.too_large().empty())
    return Error{Errc::invalid_argument,
                 fmt::format("{} is too large for a float of firmware: check the figure in the "
                             "sensor file",
                             out.too_large())};
  const std::string guard = fmt::format("PROOFMASS_{}_H", capitals(prefix));
  return fmt::format(
      "/* {}: calibration, electrical constants and noise; written by proofmass sensor export.\n"
      "   SI units, axes in the order x, y, z. Specific force in m/s^2:\n\n"
      "     f[i] = sum over j of correction[i][j] * (reading[j] - bias[j])\n\n"
      "   where reading is {}.\n"
      "   Noise coefficients are those of the Allan variance; white is the two-sided density. */\n"
      "#ifndef {}\n#define {}\n\n{}\n#endif /* {} */\n",
      name_or(model, "An accelerometer"), reading_text(model.electrical, *unit), guard, guard,
      out.text(), guard);
}

}  // namespace proofmass::sensor
