#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "proofmass/core/block.hpp"
#include "proofmass/core/recording.hpp"
#include "proofmass/core/result.hpp"
#include "proofmass/io/pyramid.hpp"
#include "proofmass/serve/view/mapped_values.hpp"

namespace proofmass::serve {

/// A stretch of time, since the recording's first sample.
struct Stretch {
  double from_s = 0.0, to_s = 0.0;
};

/// What a view is of.
struct ViewHead {
  std::uint64_t samples = 0;
  double rate_hz = 0.0;  ///< 0: unknown, and times are sample numbers
  double end_s = 0.0;    ///< time of the last sample
  bool has_stamps = false;
  std::vector<Channel> channels;  ///< without values
  std::vector<Stretch> rests;
  std::string why_no_rests;
  std::vector<double> outliers_s;  ///< within the rests
};

/// Lays a recording that comes in pieces down in a folder so that any stretch of it can be drawn
/// without reading the rest: a file of doubles for each channel, one for the stamps, and the
/// pyramid of minima and maxima (io/pyramid.hpp).
class ViewWriter {
 public:
  /// Errors of all: unwritable.
  [[nodiscard]] static Result<ViewWriter> create(const std::string& folder,
                                                 const Recording& head,
                                                 bool has_stamps);
  ViewWriter(ViewWriter&&) noexcept;
  ~ViewWriter();

  [[nodiscard]] Status add(const Block& block);
  /// Finds rests and outliers, of recordings of up to 5 million samples, and completes the folder.
  [[nodiscard]] Status finish(const Recording& head);

 private:
  struct State;
  explicit ViewWriter(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

/// What is drawn of a stretch: the samples themselves where they are few, else the smallest and the
/// largest of equal runs of them.
struct ViewWindow {
  bool are_samples = false;
  std::vector<double> time_s;            ///< time of each sample, or of the first of each run
  std::vector<std::vector<double>> min;  ///< one list a channel; NaN where there is no value
  std::vector<std::vector<double>> max;  ///< empty where are_samples
};

/// Figures of a channel within a stretch, over its finite values.
struct StretchFigures {
  std::size_t count = 0;
  double mean = 0.0, rms = 0.0, std = 0.0, min = 0.0, max = 0.0;
};

/// A folder that a ViewWriter has completed.
class ViewFile {
 public:
  /// Errors: unreadable, corrupt.
  [[nodiscard]] static Result<ViewFile> open(const std::string& folder);

  [[nodiscard]] const ViewHead& head() const { return head_; }
  /// At most about `pixels` runs, and one more sample on either side of the stretch. Expects
  /// from_s < to_s, pixels ≥ 1.
  /// Cost: O(pixels · 256) at any zoom.
  [[nodiscard]] ViewWindow window(const Stretch& stretch, std::size_t pixels) const;
  /// Statistics of each channel. Cost: O(samples of the stretch).
  [[nodiscard]] std::vector<StretchFigures> figures(const Stretch& stretch) const;
  /// The samples of a stretch, those of one channel alone.
  /// Errors: invalid_argument (no such channel, more than `most` samples), too_few_samples.
  [[nodiscard]] Result<Recording> cut(const Stretch& stretch,
                                      std::size_t channel,
                                      std::size_t most) const;

 private:
  struct Range {
    std::size_t first, last;  ///< last excluded
  };
  [[nodiscard]] double time_at(std::size_t sample) const;
  [[nodiscard]] Range range_of(const Stretch& stretch) const;

  ViewHead head_;
  std::vector<MappedValues> channels_;
  MappedValues stamps_;
  io::Pyramid pyramid_;
};

/// The stretch of a pyramid alone, for a recording whose samples are not at hand yet.
[[nodiscard]] ViewWindow pyramid_window(const io::Pyramid& pyramid,
                                        const Stretch& stretch,
                                        std::size_t pixels);

}  // namespace proofmass::serve
