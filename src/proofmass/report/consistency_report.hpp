#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "proofmass/estimate/consistency.hpp"
#include "proofmass/report/document.hpp"
#include "proofmass/report/page.hpp"

// Whether a filter errs as far as it says, as every estimating verb tells it.
namespace proofmass::report {

/// What a verb's user calls the figures that the verdict would move; as nouns, or as the keys of a
/// flag.
struct NoiseNames {
  std::string measurement = "the noise of the readings";
  std::string process = "the noise of the motion";
  std::string slow = "the wander of the bias";
};

/// "consistent", "cautious", "coloured", "overconfident" or "undetermined".
[[nodiscard]] std::string_view name_of(estimate::Verdict verdict);

/// "measurement_noise", "process_noise", "both_noises", "slow_noise", "outliers" or "none".
[[nodiscard]] std::string_view name_of(estimate::Remedy remedy);

/// The verdict and what to move: "The innovations scatter 1.6 times as far as the filter says:
/// raise accel_std and jerk_std by a factor of 1.6."
[[nodiscard]] std::string consistency_conclusion(const estimate::Consistency& consistency,
                                                 const NoiseNames& names = {});

/// "mean NIS 1.005, expected 0.987 … 1.013 over 48 000 innovations"
[[nodiscard]] std::string nis_words(const estimate::Consistency& consistency);

/// The object "consistency" of a document: nis, nis_lower, nis_upper and all else that is behind
/// the verdict: $defs/consistency of the schemas.
[[nodiscard]] Value consistency_json(const estimate::Consistency& consistency,
                                     const NoiseNames& names = {});

/// The reason of every null in it.
[[nodiscard]] std::vector<std::string> consistency_nulls(const estimate::Consistency& consistency);

/// Section of a page: verdict, mean NIS, each channel, sums over stretches.
[[nodiscard]] Section consistency_section(const estimate::Consistency& consistency,
                                          const NoiseNames& names = {});

}  // namespace proofmass::report
