#pragma once

#include <algorithm>
#include <optional>
#include <vector>

#include "proofmass/estimate/drive/clock.hpp"
#include "proofmass/estimate/drive/model.hpp"
#include "proofmass/estimate/drive/trace.hpp"

// From traces and fixes to a smoothed path. Private to the module.
namespace proofmass::estimate::drive {

/// All recordings of a drive, with forward positive and the clocks roughly related.
struct Recorded {
  std::vector<Trace> wheels;
  std::optional<Trace> frame;
  std::optional<LocalFixes> fixes;  ///< stamps in seconds of their clock
  std::array<double, most_clocks> offset_s{}, offset_std_s{};
  [[nodiscard]] bool wheels_have_yaw() const {
    return std::ranges::any_of(wheels, [](const Trace& trace) { return !trace.yaw_rad.empty(); });
  }
  [[nodiscard]] bool has_yaw() const { return frame.has_value() || wheels_have_yaw(); }
  double start_s = 0.0, end_s = 0.0;  ///< common to all wheels, on the first wheel's clock
};

/// What is known before the filter runs.
struct Setting {
  Vehicle vehicle;
  std::array<double, most_drive_wheels> radius_std{};  ///< relative
  Uncertain track_m{}, base_m{};
};

struct Fitted {
  Setting setting;
  Noise noise;
  Pass pass;
  bool converged = false;  ///< the last linearisation about the path did not move its end
};

/// How much is spent on a path: enough to compare hypotheses on which wheels steer, with the usual
/// noise parameters (by Pass::chi2) or those that the recordings make most probable (by the
/// likelihood), or the path to be reported.
enum class Effort { quick_comparison, comparison, full };

/// Path by filter and relinearised smoother.
[[nodiscard]] Fitted fit_path(const Recorded& recorded,
                              const Setting& setting,
                              Effort effort,
                              const Progress& progress);

/// The measurements of each epoch, with each trace interpolated at vehicle.offset_s.
[[nodiscard]] std::vector<Epoch> epochs_of(const Recorded& recorded, const Vehicle& vehicle);

/// Replaces the fixes by one for each `window_s`: the median of their distances from the path,
/// added to the path in the middle. A receiver filters its fixes, so that their errors hardly
/// change from one to the next: taken one by one, they would appear far more precise than they are
/// over a minute. `path` has a state for each epoch. Source: A. T. Sinclair, Data Screening and
/// Normal Point Formation (1997), for the term and use.
void form_normal_points(const Vehicle& vehicle,
                        const std::vector<Mat<at::states>>& path,
                        double window_s,
                        std::vector<Epoch>& epochs);

/// Adds the course of the fixes as the yaw of the frame: directions of chords of some metres, while
/// the vehicle moves.
void add_course(const Vehicle& vehicle, std::vector<Epoch>& epochs);

}  // namespace proofmass::estimate::drive
