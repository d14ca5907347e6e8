#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "proofmass/estimate/consistency.hpp"
#include "proofmass/report/fields.hpp"
#include "proofmass/report/page/page.hpp"

// Consistency of a filter, in the form common to all estimating verbs.
namespace proofmass::report {

/// Names of the noise parameters that the remedy refers to: nouns, or parameters of a model.
struct NoiseNames {
  std::string measurement = "the measurement noise";
  std::string process = "the process noise";
  std::string slow = "the bias random walk";
};

/// "consistent", "cautious", "coloured", "overconfident" or "undetermined".
[[nodiscard]] std::string_view name_of(estimate::Verdict verdict);

/// "measurement_noise", "process_noise", "both_noises", "slow_noise", "outliers" or "none".
[[nodiscard]] std::string_view name_of(estimate::Remedy remedy);

/// The verdict and the remedy: "The innovations have 1.6 times their predicted standard deviation:
/// raise accel_std and jerk_std by a factor of 1.6."
[[nodiscard]] std::string consistency_conclusion(const estimate::Consistency& consistency,
                                                 const NoiseNames& names = {});

/// "mean NIS 1.005, expected 0.987 … 1.013 over 48 000 innovations"
[[nodiscard]] std::string nis_words(const estimate::Consistency& consistency);

/// The entry "consistency" of a document: NIS with its bounds, verdict, remedy, each channel.
[[nodiscard]] Field consistency_field(const estimate::Consistency& consistency,
                                      const NoiseNames& names = {});

/// Section of a page: verdict, mean NIS, each channel, sums over intervals.
[[nodiscard]] Section consistency_section(const estimate::Consistency& consistency,
                                          const NoiseNames& names = {});

}  // namespace proofmass::report
