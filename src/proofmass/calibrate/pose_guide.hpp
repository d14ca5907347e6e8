#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "proofmass/calibrate/pose.hpp"
#include "proofmass/core/block.hpp"
#include "proofmass/signal/running_rests.hpp"

// Leads a person through a procedure, position by position, by the samples that come.
namespace proofmass::calibrate {

enum class GuideProcedure {
  multi_position,  ///< by hand, all over the sphere, until bias and scale are known well enough
  tumble,  ///< a table about a horizontal axis, evenly spaced angles and the first once more
  still,   ///< one long rest, for noise
};

struct GuideOptions {
  GuideProcedure procedure = GuideProcedure::multi_position;
  /// Of the blocks, the axes x, y, z of one sensor; multi_position needs all three, the others one
  /// to three.
  std::vector<std::size_t> channels{};
  double rate_hz = 0.0;           ///< nominal; 0: measured by the stamps
  std::optional<double> one_g{};  ///< what the channels read at 1 g; absent: volts, counts
  /// To which bias, scale and angles shall be known, as an error of a reading at 1 g.
  double target_std_g = 1e-3;
  /// multi_position: at least so many, 12 if absent; tumble: so many in a turn, 12 if absent.
  std::optional<std::size_t> positions{};
  double shortest_rest_s = 2.0, longest_rest_s = 20.0;
  /// still: how long. Absent: until the noise has shown its floor, five minutes to an hour.
  std::optional<double> still_s{};
};

enum class GuideKind {
  prompt,      ///< what to do next
  hold_still,  ///< it lies still: leave it
  captured,
  redo,    ///< what came was not what was asked for
  enough,  ///< what has been reached
  done,    ///< nothing more is asked for
};

/// One sentence for a person.
struct GuideStep {
  GuideKind kind = GuideKind::prompt;
  std::string text;
  double time_s = 0.0;  ///< of the samples it hangs on
};

/// How it stands at this moment, for a line that is written over.
struct GuideLive {
  signal::RestPhase phase = signal::RestPhase::listening;
  std::optional<double> seconds_left;  ///< of the rest that is under way
  std::string words;                   ///< "hold still: 3 s more", "34° to go"
};

/// A rest is taken once its mean is known to half of the target, or gets no better by waiting, in
/// two to twenty seconds. Which position comes next:
///
/// multi_position: the faces first, then edges and corners that are far from all before; from nine
/// on the one that tells most (next_pose). Any new position is taken, not only the one asked for;
/// one within ten degrees of another is not. Enough is when there are as many as asked for and no
/// error at 1 g exceeds the target, or three times as many.
///
/// tumble: k · 360°/positions. The table's angle is measured by gravity as soon as the positions so
/// far tell how the axes turn; a rest that is off by more than a third of a step or 5° is not
/// taken. Until then, and of one axis alone, each rest that is new counts.
///
/// still: the clock starts anew with each motion. Without still_s it runs until ten times the
/// averaging time at which white noise has fallen to the floor (flicker).
///
/// However the samples are cut into blocks, the steps are the same. Memory: that of RunningRests.
class PoseGuide {
 public:
  explicit PoseGuide(const GuideOptions& options);
  PoseGuide(PoseGuide&&) noexcept;
  PoseGuide& operator=(PoseGuide&&) noexcept;
  ~PoseGuide();

  /// The samples behind those before; the first call brings the first prompt. Nothing follows done.
  [[nodiscard]] std::vector<GuideStep> add(const Block& block);
  /// Leaves out the position that is asked for.
  [[nodiscard]] std::vector<GuideStep> skip();
  [[nodiscard]] GuideLive live() const;
  [[nodiscard]] bool done() const;

  /// The rests that were taken, in their order, with their times and means; labels as "pose 3".
  [[nodiscard]] const std::vector<Pose>& poses() const;
  /// Of a tumble, the table's angle at each of them.
  [[nodiscard]] std::vector<double> angles_deg() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace proofmass::calibrate
