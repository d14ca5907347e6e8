#pragma once

#include <comedilib.h>
#include <cstddef>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "proofmass/core/recording.hpp"
#include "proofmass/core/result.hpp"

namespace proofmass::acquire {

struct CloseComedi {
  void operator()(comedi_t* device) const { comedi_close(device); }
};
using ComediDevice = std::unique_ptr<comedi_t, CloseComedi>;

struct ComediRequest {
  std::string path{};
  std::vector<unsigned> channels{};  ///< all of the card's if empty
  double rate_hz = 1000.0;
  unsigned range = 0;  ///< as the card counts its own
  unsigned reference = AREF_GROUND;
};

/// Samples of a card's inputs at an even rate, set up and not yet begun.
struct ComediCommand {
  ComediDevice device;
  unsigned subdevice = 0;
  std::vector<unsigned> list;  ///< channel, range and reference, packed
  comedi_cmd command{};        ///< its list is `list`
  std::size_t sample_bytes = 2;
  std::vector<comedi_polynomial_t> to_physical;  ///< of each channel
  std::vector<Channel> heads;
  double rate_hz = 0.0;  ///< granted
  std::vector<std::pair<std::string, std::string>> settings;
  std::vector<Note> notes;
};

/// What the library's last failure means: "Device or resource busy".
[[nodiscard]] std::string comedi_reason();

/// Errors: device (not there, no analogue input, no timed reading), invalid_argument (a channel,
/// range or reference that the card has not: with those there are).
[[nodiscard]] Result<ComediCommand> prepare_command(const ComediRequest& request);

/// Errors: device (busy: somebody else reads).
[[nodiscard]] Status start(ComediCommand& command);

}  // namespace proofmass::acquire
