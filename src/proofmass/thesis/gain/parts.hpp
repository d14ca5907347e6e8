#pragma once

#include <cstdint>
#include <string>

#include "proofmass/estimate/gain_study.hpp"
#include "proofmass/thesis/item.hpp"

// The parts of sections 4.1.4, 5.2 and 5.3.
namespace proofmass::thesis {

/// One half of the study: Q > R or Q < R.
struct Half {
  estimate::GainStudyOptions options;
  std::string readings_id, gain_id;  ///< the two figures of the thesis
  std::string relation;              ///< "Q > R"
  double printed_settling_s;
};

/// ω of the simulated acceleration sin ωt.
inline constexpr double simulated_radps = 1.0;

inline const ShownUnit shown_seconds{"s"}, variance{"m²/s⁴"}, plain{};

[[nodiscard]] inline Uncertain exact(double value) {
  return {.value = value};
}

/// Figure 4.3.
[[nodiscard]] Item covariance_item();

/// Figure 5.7 or 5.9.
[[nodiscard]] Item readings_item(const Half& half, std::uint64_t seed);

/// Figure 5.8 or 5.10.
[[nodiscard]] Item settling_item(const Half& half);

}  // namespace proofmass::thesis
