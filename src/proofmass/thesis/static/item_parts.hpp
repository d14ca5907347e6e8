#pragma once

#include <cstddef>
#include <string>

#include "proofmass/core/units.hpp"
#include "proofmass/report/drift/report.hpp"
#include "proofmass/thesis/item.hpp"
#include "proofmass/thesis/static_bias.hpp"

// Shared by the items of the static test.
namespace proofmass::thesis {

/// An acceleration displayed in mg.
[[nodiscard]] Finding milli_g(std::string key, std::string label);
/// A time in s.
[[nodiscard]] Finding seconds(std::string key, std::string label);
/// A share, shown in %.
[[nodiscard]] Finding percent(std::string key, std::string label);

/// The axis of table 4.1: the second, a y axis, or if it could not be analysed the first that
/// could.
[[nodiscard]] std::size_t fitted_axis(const StaticTest& test);
/// The axis of figure 5.2: the first that could be analysed.
[[nodiscard]] std::size_t first_axis(const StaticTest& test);

/// As expected by the figures of `drift`. The axis must have been analysed.
[[nodiscard]] report::ChannelDrift channel_of(const StaticTest& test, std::size_t axis);

/// The verdict on the warm-up, as a sentence: "No warm-up can be determined: steps …."
[[nodiscard]] std::string verdict_sentence(const StaticTest& test, std::size_t axis);

/// "one sample in 25", "every sample".
[[nodiscard]] std::string picked_words(const StaticRecord& record);

/// "simulated", or the file's name.
[[nodiscard]] std::string source_words(const StaticTest& test);

/// Samples per second before the means were taken.
[[nodiscard]] double sampled_hz(const StaticRecord& record);
[[nodiscard]] double duration_s(const StaticTest& test);

// Section 4.3: static/drift_fit_items.cpp.
[[nodiscard]] Item bias_data_item(const StaticTest& test);  ///< figure 4.5
[[nodiscard]] Item fit_item(const StaticTest& test);        ///< table 4.1
[[nodiscard]] Item residuals_item(
    const StaticTest& test);  ///< figure 4.6, static/drift_residual_item.cpp

// Section 5.1.1.
[[nodiscard]] Item static_noise_item(const StaticTest& test);  ///< figure 5.2
[[nodiscard]] Item bias_track_item(const StaticTest& test);    ///< figure 5.3

}  // namespace proofmass::thesis
