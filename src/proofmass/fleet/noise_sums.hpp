#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "proofmass/characterise/noise_stream.hpp"
#include "proofmass/core/recording.hpp"
#include "proofmass/core/result.hpp"

// One sensor's noise over many recordings: what is kept of each, and how they lie on one grid.
namespace proofmass::fleet {

/// One channel of a recording, on the recording's even grid.
struct SummedChannel {
  std::string name;
  Unit unit;
  std::string refused;                     ///< the reason, where it is not to be analysed
  std::optional<double> lsb;               ///< quantisation step
  std::optional<std::size_t> first_valid;  ///< index; absent: no sample is valid
  std::string sums;  ///< state of its NoiseStream, or its samples; empty where the place is unknown
};

/// Where a recording lies among those of its sensor: a word without blanks, "0:27:3,3,0".
struct SumsPlace {
  /// Their total has at most characterise::decimate_above samples: its samples are kept.
  bool as_samples = false;
  std::size_t first = 0;             ///< samples of the grid before it
  std::size_t digits = 0;            ///< binary digits of the total number of samples
  std::vector<std::size_t> origins;  ///< of each channel: its first valid sample on the grid

  [[nodiscard]] std::string word() const;
  [[nodiscard]] static std::optional<SumsPlace> parse(std::string_view word);
  [[nodiscard]] characterise::PartPlace of_channel(std::size_t channel) const;
};

/// What is kept of one recording of a sensor.
struct RecordingSums {
  std::string key;                 ///< a word: of the flags and the version that it was made with
  std::string sha256;              ///< of the recording; empty: unknown
  std::optional<SumsPlace> place;  ///< absent: the sums are still to be made
  std::string file;                ///< name of the recording
  std::uint64_t bytes = 0;         ///< of the recording
  std::string options;             ///< of the analysis; the same for all that are joined
  double rate_hz = 0.0;
  std::optional<double> clock_s;  ///< of its first sample, on its own clock
  std::size_t samples = 0;
  std::vector<SummedChannel> channels;
  std::vector<Note> notes;
};

/// Text of one head line and the rest in base64, with a checksum.
[[nodiscard]] std::string text_of(RecordingSums sums);

/// Errors: corrupt (cut off, changed, of another version or byte order).
[[nodiscard]] Result<RecordingSums> sums_of_text(std::string_view text);

/// What the head line says.
struct SumsHead {
  std::string key, sha256;
  std::string place;  ///< a word, or "none"
};

/// Whether the text begins as sums do.
[[nodiscard]] bool is_sums(std::string_view beginning);

/// The head of a file of sums that has its whole length; nullopt of any other.
[[nodiscard]] std::optional<SumsHead> head_of_sums(const std::string& path);

/// Start of a recording by a given time, which may be rounded to seconds: its own clock is more
/// precise where it agrees with that.
[[nodiscard]] double start_near(double given_s,
                                double first_given_s,
                                const std::optional<double>& own_s,
                                const std::optional<double>& first_own_s);

/// The channel of that name in another recording; refused with the reason if that does not fit.
/// Errors: invalid_argument.
[[nodiscard]] Result<std::size_t> matching_channel(const RecordingSums& part,
                                                   const RecordingSums& first,
                                                   std::size_t channel);

/// The place of each recording, in the order of time. starts_s: given starts; empty: their clocks.
/// Gaps longer than all recordings together count as that long. Errors: invalid_argument (they
/// overlap, or differ in rate or channels; one has no start), "file: reason".
[[nodiscard]] Result<std::vector<SumsPlace>> places_of(const std::vector<RecordingSums>& parts,
                                                       const std::vector<double>& starts_s);

}  // namespace proofmass::fleet
