#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <vector>

#include "cli/common_flags.hpp"
#include "proofmass/core/recording.hpp"
#include "proofmass/signal/encoder.hpp"

// An encoder beside the accelerometers of a wheel.
namespace proofmass::app {

struct EncoderFlags {
  bool wanted = false;
  std::string channel, index, edges;
  std::optional<double> counts_per_turn, wrap;
};

/// `wanted`: the help of --encoder.
void add_encoder_flags(CLI::App& verb, EncoderFlags& flags, const char* wanted);

/// The encoder of a recording, on its clock.
struct EncoderChannel {
  std::string name;
  signal::AngleFixes fixes;
  double step_rad = 0.0;
  std::optional<double> counts_per_turn;
  bool has_index = false;
  bool absolute = false;                       ///< an angle, not counts
  std::vector<signal::CountSlip> index_slips;  ///< between two pulses
};

/// Adds the encoder's channels to those to read, if --channel restricts them.
void read_encoder_too(const EncoderFlags& flags, InputFlags& input);

/// Throws Failure: no such channel, a unit that is neither counts nor an angle, counts without
/// --counts-per-turn.
[[nodiscard]] EncoderChannel encoder_of(const Recording& recording,
                                        const EncoderFlags& flags,
                                        const InputFlags& input,
                                        std::vector<Note>& notes);

}  // namespace proofmass::app
