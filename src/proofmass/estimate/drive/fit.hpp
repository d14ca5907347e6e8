#pragma once

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
};

/// Path by filter and smoother, relinearised until the clock offsets no longer move, with the
/// noise parameters that the recordings make most probable.
[[nodiscard]] Fitted fit_path(const Recorded& recorded,
                              const Setting& setting,
                              const Progress& progress);

/// The measurements of each epoch, with each trace interpolated at vehicle.offset_s.
[[nodiscard]] std::vector<Epoch> epochs_of(const Recorded& recorded, const Vehicle& vehicle);

}  // namespace proofmass::estimate::drive
