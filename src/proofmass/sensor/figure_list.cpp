#include "proofmass/sensor/figure_list.hpp"

#include <array>
#include <string_view>
#include <type_traits>

#include "proofmass/sensor/file/fields.hpp"

namespace proofmass::sensor {

std::string FigureSlot::axis_name() const {
  constexpr std::array<std::string_view, 3> axes{"x", "y", "z"};
  constexpr std::array<std::string_view, 3> pairs{"yz", "zy", "zx"};
  if (!axis) return {};
  return std::string(key == "misalignment" ? pairs[*axis] : axes[*axis]);
}

std::string FigureSlot::name() const {
  return section + "." + key + (axis ? " " + axis_name() : std::string());
}

std::vector<FigureSlot> figure_slots(const SensorModel& model) {
  std::vector<FigureSlot> slots;
  visit_figures(
      model, [&](std::string_view section, std::string_view key, const auto&, const auto& figure) {
        const std::string in(section), named(key);
        if constexpr (std::is_same_v<std::decay_t<decltype(figure)>, AxisFigures>) {
          for (std::size_t axis = 0; axis < 3; ++axis)
            slots.push_back({in, named, axis, figure[axis]});
        } else {
          slots.push_back({in, named, std::nullopt, figure});
        }
      });
  return slots;
}

}  // namespace proofmass::sensor
